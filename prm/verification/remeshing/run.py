#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Remeshing again and again a cylinder and a gear-like star that are upset to a third: angles, nodes kept, volume, and what
becomes of a Gaussian, by local remeshing and by rebuilding; and slopes of runs that are remeshed, everything decided anew:
run.py BUILD quick | many | tripod | diffusion | diffusion_10k | slopes | trends

The Gaussian has a standard deviation of two mean edge lengths, so that when the workpiece is upset it is left with less than one
along the axis, on any mesh; the last row of diffusion_10k has the Gaussian of the coarse mesh on the fine one."""
import os
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402


def study(build, shape, size, remeshings, method, width=()):
    program = os.path.join(build, "tests", "verification", "remeshing", "remeshing_study")
    done = subprocess.run([program, shape, str(size), str(remeshings), method, *map(str, width)], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{shape}, {method}: {done.stderr}")
    table = np.genfromtxt(done.stdout.splitlines(), delimiter=",", names=True, ndmin=1)
    for row in table:
        print(f"| {shape} | {method} | {row['nodes']:.0f} | {row['remeshings']:.0f} | {row['L2']:.4f} | {row['cells_L2']:.4f} | {row['cells_integral']:+.1e} | {row['angle']:.1f} "
              f"| {row['kept']:.1%} | {row['volume']:.1e} | {row['drift']:.1e} | {row['microseconds']:.1f} |", flush=True)
    return table[-1]


def tripod(build):
    """Forged in 112 increments and remeshed after each."""
    case = os.path.join(HERE, "..", "..", "reproduction", "laroussi_2003", "tripod", "case.prm")
    settings = {"Press/increments": 112, "Remeshing/when": "increments", "Remeshing/every": 1, "Output/fields every": 0,
                "Output/record": "false"}
    summary, _ = case_tools.run(build, "simulate", case, settings, "run_tripod")
    print(f"tripod: {summary['remeshings']} remeshings in {summary['increments']} increments, "
          f"energy {case_tools.energy(summary):.8g} mJ, {summary['wall_seconds']['remeshing']:.1f} s of {summary['wall_seconds']['total']:.1f} s")
    case_tools.figure("tripod_remeshings", summary["remeshings"])
    case_tools.figure("tripod_volume_lost", abs(summary["volume_final"] / summary["volume_initial"] - 1))


BALL = {"Billet/shape": "cylinder", "Billet/radius": 16, "Billet/height": 24, "Billet/sector angle": 90, "Billet/element size": 4.75,
        "Dies/names": "lower, upper", "Die lower/facing": "0, 0, 1", "Die lower/friction": 0.3,
        "Die upper/shape": "stl", "Die upper/file": "ball.stl", "Die upper/point": "0, 0, 24.05", "Die upper/facing": "0, 0, -1",
        "Die upper/rotation angle": 2.3, "Die upper/velocity": "0, 0, -100", "Die upper/friction": 0.3,
        "Material/consistency": 10, "Material/strain rate sensitivity": 0.15, "Press/stroke": 4.5, "Press/increments": 9,
        "Remeshing/when": "increments", "Remeshing/every": 4,
        "Design/parameters": "billet/radius, die upper/offset, die upper/friction", "Adjoint/remeshings": "hold", "Check/steps": "1e-4, 1e-5, 1e-6",
        "Check/taylor halvings": 2, "Output/fields every": 0, "Output/record": "false"}


COLD = {"Objectives/names": "energy, force", "Objective force/type": "maximum effort"}
HOT = {"Billet/sector angle": 60, "Billet/element size": 4.9, "Material/law": "power", "Material/consistency": 32,
       "Material/further numbers": "n: 0.2, q0: 0.05, beta: 0.0025, T0: 1100", "Material/temperature": 1100, "Heat/heating": "conduction",
       "Heat/transfer time": 2, "Objectives/names": "energy, least temperature", "Press/stroke": 6, "Press/increments": 12,
       "Design/parameters": "billet/radius, billet/temperature, material/n, die upper/offset", "Check/steps": "1e-5, 3e-6, 1e-6"}


def write_ball(path):
    """The lower 50 degrees of a ball of radius 20 that stands on the origin."""
    def at(i, j):
        polar, around = np.radians(50) * i / 14, 2 * np.pi * j / 72
        return 20 * np.array([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), 1 - np.cos(polar)])
    with open(path, "w", encoding="utf-8") as file:
        file.write("solid ball\n")
        for i in range(14):
            for j in range(72):
                for a, b, c in [[at(i, j), at(i + 1, j + 1), at(i, j + 1)]] * (i > 0) + [[at(i, j), at(i + 1, j), at(i + 1, j + 1)]]:
                    n = np.cross(b - a, c - a)
                    if n[2] > 0:
                        b, c, n = c, b, -n
                    corners = "".join("vertex {:.9g} {:.9g} {:.9g}\n".format(*x) for x in (a, b, c))
                    file.write("facet normal {:.9g} {:.9g} {:.9g}\nouter loop\n".format(*n / np.linalg.norm(n)) + corners + "endloop\nendfacet\n")
        file.write("endsolid ball\n")


def slopes(build):
    """A cylinder under a ball, remeshed twice: energy and largest force, of a hot one energy and least temperature, differences that decide everything
    anew beside the adjoint, as `check` fits them. Random positions and vertices make other meshes at some steps, with another mesher at others: they are
    printed only."""
    write_ball("ball.stl")
    with open("ball.prm", "w", encoding="utf-8"):
        pass
    scenes = {"mini": {**BALL, **COLD}, "p2_p1": {**BALL, **COLD, "Discretization/element": "P2-P1"}, "hot": {**BALL, **HOT}}
    for name, settings in scenes.items():
        summary, text = case_tools.run(build, "check", "ball.prm", settings, f"run_slopes_{name}", may_fail=True)
        if summary is None:
            sys.exit(text)
        for row in summary["check"]:
            print(f"{name}, {row['objective']} by {row['parameter']}: {row['free']['slope'] / row['adjoint'] - 1:.1e} "
                  f"+- {row['free']['uncertainty'] / abs(row['adjoint']):.1e}")
        case_tools.figure(f"slopes_{name}", max(abs(row["free"]["slope"] / row["adjoint"] - 1) for row in summary["check"]
                                                if "random" not in row["parameter"]))


PRM = os.path.join(HERE, "..", "..")
HOT_HUB = {"Heat/heating": "none", "Heat/transfer time": 0, "Heat/dwell time": 0, "Die upper/friction": 0, "Die lower/friction": 0,
           "Billet/volume held by": "", "Objectives/names": "energy, unfilled", "Press/stroke": 20, "Optimisation/objective": "", "Optimisation/at most": "",
           "Optimisation/lower bounds": "", "Optimisation/upper bounds": "", "Optimisation/scales": ""}


def trends(build):
    """Slopes by the radius of hubs that are remeshed some ten to twenty times, beside the trend of runs that decide anew: the tutorial's, whose metal sticks to the
    dies, and one that hardens without friction, with two sizes of elements."""
    hub, hot = os.path.join(PRM, "tutorial", "hub", "hub.prm"), os.path.join(PRM, "verification", "optimisation", "hot_hub.prm")
    coarse, fine = (3.85, 3.9, 3.95, 4, 4.05, 4.1, 4.15, 4.2), (2.7, 2.75, 2.8, 2.85)
    print("| scene | objective | mean slope beside the trend | single ones, rms |\n" + "| --- " * 4 + "|")
    for name, case, settings, sizes in (("hub", hub, {}, coarse), ("hardening", hot, HOT_HUB, coarse), ("hardening_fine", hot, HOT_HUB, fine)):
        found = case_tools.Trends(build, case, settings, {"billet/radius": 0.04}, sizes, f"trend_{name}")
        for objective in found.pairs["billet/radius"]:
            mean, error, single = found.beside("billet/radius", objective)
            print(f"| {name} | {objective} | {mean:+.1%} ± {error:.1%} | {single:.1%} |", flush=True)
            if objective == "energy":
                case_tools.figure(f"trend_{name}", abs(mean))


def main():
    build, what = sys.argv[1:3]
    if what in ("slopes", "trends"):
        return {"slopes": slopes, "trends": trends}[what](build)
    print("| shape | method | nodes | remeshings | L2 error | in cells | its integral | least angle | nodes kept | volume per remeshing | drift of the side | us per tet |\n" + "| --- " * 12 + "|")
    if what == "tripod":
        tripod(build)
    elif what == "quick":
        last = study(build, "cylinder", 6, 20, "local")
        case_tools.figure("angle_quick", last["angle"])
        case_tools.figure("kept_quick", last["kept"])
        case_tools.figure("volume_quick", last["volume"])
        case_tools.figure("cells_quick", last["cells_L2"])
        case_tools.figure("cells_integral_quick", abs(last["cells_integral"]))
    elif what == "many":
        rows = [study(build, shape, 4, 100, "local") for shape in ("cylinder", "star")]
        case_tools.figure("angle_100", min(row["angle"] for row in rows))
        case_tools.figure("kept_100", min(row["kept"] for row in rows))
        case_tools.figure("volume_100", max(row["volume"] for row in rows))
        # The star's tips have a radius below the element size: its chords alone are farther off.
        case_tools.figure("drift_100", rows[0]["drift"])
    else:
        size = 4 if what == "diffusion" else 1.9
        last = study(build, "cylinder", size, 60, "local")
        case_tools.figure(f"{what}_local", last["L2"])
        case_tools.figure(f"{what}_cells", last["cells_L2"])
        case_tools.figure(f"{what}_rebuilt", study(build, "cylinder", size, 60, "rebuild")["L2"])
        if what == "diffusion_10k":
            case_tools.figure("diffusion_10k_wide", study(build, "cylinder", size, 60, "local", [8])["L2"])


if __name__ == "__main__":
    sys.exit(main())
