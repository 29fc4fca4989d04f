#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What sizes that follow the error gain:   run.py BUILD [SCENE]...

Each scene is forged with `Remeshing/sizes` uniform, dies and error on a series of element sizes, and with error and the element and size
of --reference, which says what is right. Prints the nodes (mean over the increments, remeshings counted), seconds of processor time, and the errors of the
energy and of one local objective; and at equal nodes, by straight lines between the points of a series in logarithms, how many times
smaller the errors are than with uniform sizes, and how many times sooner an error is reached. --element P2-P1 for quadratic
velocities, --sizes for others than those of the scene."""
import argparse
import json
import math
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PRM = os.path.join(HERE, "..", "..")
sys.path.insert(0, PRM)
from case_tools import figure  # noqa: E402

KINDS = ("uniform", "dies", "error")
FLAT = ("uniform", "error")  # without curved dies, `dies` is `uniform`


class Scene:
    def __init__(self, case, kinds, local, sizes, reference, settings):
        self.case, self.kinds, self.local, self.settings = os.path.join(PRM, case), kinds, local, settings
        self.sizes, self.reference = sizes, reference  # {element: [size, ...]}, (element, size)


SCENES = {
    "bar": Scene("tutorial/bar_bending/bar_bending.prm", KINDS, "largest strain", {"mini": [6, 5, 4, 3], "P2-P1": [12, 9, 7]},
                 ("P2-P1", 7), {"Press/stroke": 6, "Press/increments": 20, "Remeshing/growth": 0.5}),
    "cube": Scene("verification/speed_against_error/cube.prm", FLAT, "maximum strain", {"mini": [6, 5, 4, 3], "P2-P1": [16, 12, 9]},
                  ("P2-P1", 6), {"Objectives/names": "energy, maximum strain", "Remeshing/when": "quality"}),
    "hub": Scene("tutorial/hub/hub.prm", KINDS, "unfilled", {"mini": [6, 5, 4], "P2-P1": []}, ("mini", 2.5),
                 {"Billet/radius": 15.6, "Press/stroke": 20, "Press/increments": 40}),
}


class Run:
    """One `simulate`."""

    def __init__(self, build, scene, element, kind, size, more, timeout):
        settings = {**scene.settings, "Discretization/element": element, "Billet/element size": size, "Remeshing/sizes": kind,
                    "Output/fields every": 0, "Output/record": "false", "Design/parameters": "", **more}
        words = ["timeout", str(timeout), os.path.join(build, "retroforge"), "simulate", scene.case, "--output", "run", "--overwrite"]
        for name, value in settings.items():
            words += ["--set", f"{name}={value}"]
        log = os.open("run.log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        child = os.posix_spawnp("timeout", words, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, log, 1), (os.POSIX_SPAWN_DUP2, log, 2)])
        os.close(log)
        _, status, usage = os.wait4(child, 0)
        self.kind, self.size, self.ended = kind, size, os.waitstatus_to_exitcode(status) == 0
        self.seconds = usage.ru_utime + usage.ru_stime
        if self.ended:
            with open("run/summary.json", encoding="utf-8") as file:
                self.values = {row["name"]: row["value"] for row in json.load(file)["objectives"]}
            with open("run.log", encoding="utf-8") as file:
                self.nodes = mean_nodes(file.read())


def mean_nodes(log):
    """Over the increments, from what a run prints."""
    nodes, counts = 0, []
    for line in log.split("\n"):
        told = re.search(r"(\d+) nodes", line)
        if told:
            nodes = int(told.group(1))
        elif re.match(r"\s+\d+\s+[\d.]+\s", line):
            counts.append(nodes)
    return sum(counts) / len(counts)


def at(points, x):
    """y at x, by straight lines through points (x, y) in logarithms; none beyond the points."""
    points = sorted(points)
    for (a, f), (b, g) in zip(points, points[1:]):
        if a <= x <= b:
            return f * (g / f) ** (math.log(x / a) / math.log(b / a)) if b > a else g
    return None


def compare(name, runs, reference, local):
    """Means over the points of each kind that lie between points of uniform sizes: errors at equal nodes, seconds at equal errors."""
    for what in ("energy", local):
        error = {run: max(abs(run.values[what] / reference.values[what] - 1.0), 1e-9) for run in runs}
        uniform = [run for run in runs if run.kind == "uniform"]
        for kind in KINDS[1:]:
            of_kind = [run for run in runs if run.kind == kind]
            smaller = [e / error[run] for run in of_kind if (e := at([(u.nodes, error[u]) for u in uniform], run.nodes))]
            sooner = [s / run.seconds for run in of_kind if (s := at([(error[u], u.seconds) for u in uniform], error[run]))]
            for told, values in (("errors at equal nodes, times smaller", smaller), ("seconds to an error, times fewer", sooner)):
                if values:
                    mean = math.exp(sum(map(math.log, values)) / len(values))
                    print(f"{what}, {kind} against uniform, {told}: {mean:.2f} (of {len(values)})")
                    figure(f"{name}_{what.replace(' ', '_')}_{kind}_{'error' if values is smaller else 'seconds'}", mean)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join(SCENES) + "; default all")
    parser.add_argument("--element", default="mini", choices=("mini", "P2-P1"))
    parser.add_argument("--sizes", help="element sizes, separated by commas [mm]")
    parser.add_argument("--reference", nargs=2, metavar=("ELEMENT", "SIZE"), help="of the run that says what is right; default that of the scene")
    parser.add_argument("--set", action="append", default=[], metavar="Section/name=value")
    parser.add_argument("--timeout", type=float, default=900, help="seconds after which a run is given up")
    options = parser.parse_args()
    unknown = [name for name in options.scenes if name not in SCENES]
    if unknown:
        raise SystemExit(f"error_driven_sizes: there is no scene {unknown[0]}; there are {', '.join(SCENES)}")
    more = dict(word.split("=", 1) for word in options.set)
    for name in options.scenes or SCENES:
        scene = SCENES[name]
        sizes = [float(size) for size in options.sizes.split(",")] if options.sizes else scene.sizes[options.element]
        if not sizes:
            continue
        element, size = options.reference or scene.reference
        reference = Run(options.build, scene, element, "error", float(size), more, 4 * options.timeout)
        if not reference.ended:
            print(f"{name}: the reference, {reference.size:g} mm, did not end")
            continue
        print(f"\n{name}: reference {element}, error, {reference.size:g} mm, {reference.nodes:.0f} nodes, {reference.seconds:.3g} s: energy "
              f"{reference.values['energy']:.6g} mJ, {scene.local} {reference.values[scene.local]:.5g}\n")
        print(f"| sizes | element size [mm] | nodes | s | energy | {scene.local} |\n" + "| --- " * 6 + "|", flush=True)
        runs = []
        for size in sizes:
            for kind in scene.kinds:
                run = Run(options.build, scene, options.element, kind, size, more, options.timeout)
                if not run.ended:
                    print(f"| {kind} | {size:g} | did not end | {run.seconds:.3g} | | |", flush=True)
                    continue
                runs.append(run)
                errors = [run.values[what] / reference.values[what] - 1.0 for what in ("energy", scene.local)]
                print(f"| {kind} | {size:g} | {run.nodes:.0f} | {run.seconds:.3g} | {errors[0]:+.2%} | {errors[1]:+.1%} |", flush=True)
        print()
        compare(name, runs, reference, scene.local)


if __name__ == "__main__":
    main()
