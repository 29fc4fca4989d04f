#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Scenes with dies that are hard on contact and remeshing. Each must run to its end, or stop with a reason and a record that
can be read:   run.py BUILD"""
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

CASE = os.path.join(HERE, "case.prm")


def extrusion(name, points):
    """An STL file of a profile in x and z, extruded along y from -100 to 100; it faces the side to the left of its path."""
    facets = []
    for (x, z), (u, w) in zip(points, points[1:]):
        a, b, c, d = (x, -100, z), (u, -100, w), (u, 100, w), (x, 100, z)
        facets += [(a, b, c), (a, c, d)]
    with open(name, "w", encoding="utf-8") as file:
        file.write("solid profile\n")
        for facet in facets:
            file.write("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {p[0]} {p[1]} {p[2]}\n" for p in facet) + "endloop\nendfacet\n")
        file.write("endsolid profile\n")
    return os.path.abspath(name)


def stl(die, file, facing):
    return {f"Die {die}/shape": "stl", f"Die {die}/file": file, f"Die {die}/facing": facing, f"Die {die}/point": "0, 0, 0"}


def scenes():
    # A punch narrower than the block, with sharp edges: the block's surface meets the die's edge.
    punch = extrusion("punch.stl", [(9, 60), (9, 30), (-9, 30), (-9, 60)])
    # A ridge with a radius of 1 mm under elements of 5 mm.
    ridge = extrusion("ridge.stl", [(-60, -6), (-1, -0.4), (-0.7, -0.1), (0, 0), (0.7, -0.1), (1, -0.4), (60, -6)])
    # A box without a lid: metal runs along vertical walls.
    trough = extrusion("trough.stl", [(-18, 60), (-18, 0), (18, 0), (18, 60)])
    step = extrusion("step.stl", [(-60, 0), (10, 0), (10, -5), (60, -5)])
    return {
        "punch with sharp edges": stl("upper", punch, "0, 0, -1"),
        "radius below an element": stl("lower", ridge, "0, 0, 1"),
        "along vertical walls": stl("lower", trough, "0, 0, 1"),
        "corner over a step": stl("lower", step, "0, 0, 1"),
        "thin flash": {"Press/stroke": 27, "Press/increments": 54},
        "fold between sticking dies": {"Die lower/friction": 1, "Die upper/friction": 1, "Press/stroke": 22, "Press/increments": 44},
    }


def run(build, name, settings):
    output = name.replace(" ", "_")
    words = [os.path.join(build, "retroforge"), "gradient", CASE, "--output", output]
    for key, value in settings.items():
        words += ["--set", f"{key}={value}"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=1800)
    if done.returncode == 0:
        with open(os.path.join(output, "summary.json"), encoding="utf-8") as file:
            s = json.load(file)
        print(f"| {name} | to the end | {s['increments']} | {s['cuts']} | {s['remeshings']} | {s['newton_iterations'] / s['increments']:.1f} "
              f"| {1 - s['volume_final'] / s['volume_initial']:.1e} |", flush=True)
        return "end"
    message = done.stderr.strip()
    steps = len(os.listdir(os.path.join(output, "record"))) - 1 if os.path.isdir(os.path.join(output, "record")) else 0
    print(f"| {name} | {message[:300]} | {steps} | | | | |", flush=True)
    return "reason" if message.startswith("retroforge: ") and message.count(";") >= 2 and steps > 0 else "failed"


def main():
    print("| scene | ran | increments | cuts | remeshings | Newton per increment | volume lost |\n" + "| --- " * 7 + "|")
    ends = [run(sys.argv[1], name, settings) for name, settings in scenes().items()]
    case_tools.figure("failed", ends.count("failed"))
    case_tools.figure("to_the_end", ends.count("end"))


if __name__ == "__main__":
    main()
