#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Seconds against errors of the energy and of a derivative of it, for both pairs of elements:   run.py BUILD [SCENE]...

Each scene is run on a series of meshes with `Discretization/element` mini and P2-P1, forward and backward, and once on a finer mesh
that says what is right. Seconds are of the processor, all of the run, least of --repeat; runs of both elements take turns. Prints a
table for each scene, and at the errors named how many times longer the mini element takes, by straight lines between its points in
logarithms; where it does not come so far, that is a lower bound (>) from its finest mesh. --picture FILE draws them all."""
import argparse
import json
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PRM = os.path.join(HERE, "..", "..")
sys.path.insert(0, PRM)
from case_tools import energy, figure, gradient  # noqa: E402

MINI, QUADRATIC = "mini", "P2-P1"


class Scene:
    """Where a scene is and on which meshes it is run."""

    def __init__(self, case, parameter, sizes, reference, bars, settings=None):
        self.case, self.parameter, self.sizes, self.reference, self.settings = case, parameter, sizes, reference, settings or {}
        self.bars = bars  # errors of energy and derivative at which seconds are compared


SCENES = {
    "cube": Scene(os.path.join(HERE, "cube.prm"), "billet/stretch", {MINI: [6, 4, 3, 2.2, 1.7, 1.3, 1.05], QUADRATIC: [20, 16, 12, 9, 7]},
                  (QUADRATIC, 5), (0.0012, 0.002)),
    "cylinder": Scene(os.path.join(HERE, "..", "speed", "case.prm"), "billet/radius",
                      {MINI: [6, 4, 3, 2.2, 1.7], QUADRATIC: [14, 10, 8, 6]}, (QUADRATIC, 4), (0.005, 0.005),
                      {"Press/stroke": 12, "Press/increments": 24}),
    "tripod": Scene(os.path.join(PRM, "reproduction", "laroussi_2003", "tripod", "case.prm"), "billet/radius",
                    {MINI: [7, 5, 4, 3], QUADRATIC: [12, 9, 7]}, (MINI, 2), (0.005, 0.01),
                    {"Press/stroke": 10, "Press/increments": 20, "Design/parameters": "billet/radius"}),
    "hub": Scene(os.path.join(PRM, "tutorial", "hub", "hub.prm"), "billet/radius",
                 {MINI: [8, 5, 4, 3], QUADRATIC: [12, 8]}, (MINI, 2), (0.01, 0.02),
                 {"Billet/radius": 15.6, "Press/stroke": 20, "Press/increments": 40, "Objectives/names": "energy",
                  "Design/parameters": "billet/radius"}),
}


class Run:
    """One `gradient`; its seconds of processor time are the least of several."""

    def __init__(self, build, scene, element, size, repeat, timeout):
        words = ["timeout", str(timeout), os.path.join(build, "retroforge"), "gradient", scene.case, "--output", "run", "--overwrite"]
        settings = {**scene.settings, "Discretization/element": element, "Billet/element size": size, "Output/fields every": 0}
        for name, value in settings.items():
            words += ["--set", f"{name}={value}"]
        self.element, self.size, self.seconds, self.ended = element, size, math.inf, True
        for _ in range(repeat):
            log = os.open("run.log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            child = os.posix_spawnp("timeout", words, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, log, 1), (os.POSIX_SPAWN_DUP2, log, 2)])
            os.close(log)
            _, status, usage = os.wait4(child, 0)
            self.ended = self.ended and os.waitstatus_to_exitcode(status) == 0
            self.seconds = min(self.seconds, usage.ru_utime + usage.ru_stime)
        if self.ended:
            with open("run/summary.json", encoding="utf-8") as file:
                summary = json.load(file)
            self.nodes, self.energy, self.slope = summary["mesh"]["nodes"], energy(summary), gradient(summary)[scene.parameter]

    def errors(self, reference):
        return self.energy / reference.energy - 1.0, self.slope / reference.slope - 1.0


def seconds_to(points, error):
    """Least seconds at which the errors of (seconds, error) have fallen below `error`, by straight lines in logarithms; and whether it does."""
    points = sorted(points)
    for (s, e), (t, f) in zip([(points[0][0], max(points[0][1], error))] + points, points):
        if f <= error:
            part = 1.0 if e <= f else math.log(e / error) / math.log(e / f)
            return s * (t / s) ** part, True
    return points[-1][0], False


def compare(name, scene, runs, reference):
    """At each bar: how many times longer the mini element takes."""
    for i, what in enumerate(("energy", "derivative")):
        line = {element: [(run.seconds, abs(run.errors(reference)[i])) for run in runs if run.element == element] for element in (MINI, QUADRATIC)}
        if not all(line.values()):
            continue
        (mini, there), (quadratic, found) = (seconds_to(line[element], scene.bars[i]) for element in (MINI, QUADRATIC))
        if not found:
            print(f"{what}, {scene.bars[i]:.2%}: P2/P1 does not come so far on these meshes" + ("" if not there else f", mini in {mini:.2g} s"))
            continue
        print(f"{what}, {scene.bars[i]:.2%}: mini {'' if there else '> '}{mini:.3g} s, P2/P1 {quadratic:.3g} s: {'' if there else '> '}{mini / quadratic:.2g} times")
        figure(f"{name}_{what}_ratio", mini / quadratic)


def draw(results, file):
    """Errors over seconds, one column for each scene."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    page, axes = pyplot.subplots(2, len(results), figsize=(3.6 * len(results), 6.4), squeeze=False, sharex="col")
    for column, (name, (runs, reference)) in enumerate(results.items()):
        for row, what in enumerate(("energy", "derivative")):
            for element, mark in ((MINI, "o-"), (QUADRATIC, "s-")):
                points = sorted((run.seconds, abs(run.errors(reference)[row])) for run in runs if run.element == element)
                axes[row][column].loglog(*zip(*points), mark, label=element.replace("-", "/"))
            axes[row][column].set_title(f"{name}: {what}")
            axes[row][column].grid(True, which="both", alpha=0.3)
        axes[1][column].set_xlabel("seconds")
    axes[0][0].set_ylabel("relative error")
    axes[1][0].set_ylabel("relative error")
    axes[0][0].legend()
    page.tight_layout()
    page.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=", ".join(SCENES) + "; default all")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=900, help="seconds after which a run is given up")
    parser.add_argument("--picture", help="a PNG or SVG file")
    options = parser.parse_args()
    unknown = [name for name in options.scenes if name not in SCENES]
    if unknown:
        raise SystemExit(f"speed_against_error: there is no scene {unknown[0]}; there are {', '.join(SCENES)}")
    results = {}
    for name in options.scenes or SCENES:
        scene = SCENES[name]
        reference = Run(options.build, scene, *scene.reference, 1, 4 * options.timeout)
        if not reference.ended:
            print(f"{name}: the reference, {scene.reference}, did not end")
            continue
        print(f"\n{name}: reference {scene.reference[0]}, {scene.reference[1]:g} mm: energy {reference.energy:.6g} mJ, "
              f"derivative by {scene.parameter} {reference.slope:.6g}, {reference.seconds:.3g} s\n")
        print("| element | size [mm] | nodes | s | energy | derivative |\n" + "| --- " * 6 + "|", flush=True)
        runs, series = [], {element: list(sizes) for element, sizes in scene.sizes.items()}
        while any(series.values()):
            for element, sizes in series.items():
                if sizes:
                    run = Run(options.build, scene, element, sizes.pop(0), options.repeat, options.timeout)
                    if not run.ended:
                        print(f"| {element} | {run.size:g} | did not end | {run.seconds:.3g} | | |", flush=True)
                        continue
                    runs.append(run)
                    errors = run.errors(reference)
                    print(f"| {element} | {run.size:g} | {run.nodes} | {run.seconds:.3g} | {errors[0]:+.2%} | {errors[1]:+.2%} |", flush=True)
        print()
        compare(name, scene, runs, reference)
        results[name] = (runs, reference)
    if options.picture and results:
        draw(results, options.picture)


if __name__ == "__main__":
    main()
