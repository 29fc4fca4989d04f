#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Seconds against errors of the energy and of a derivative of it:   run.py BUILD [SCENE]...

A scene is run, forward and backward, with two methods, each on a series of ever finer discretisations: pairs of elements on
meshes (cube, cylinder, sphere, tripod, hub), or time schemes with increments on one mesh (cube-time, hub-time). A finer run says
what is right, or numbers that are known. Seconds are of the processor, all of the run, least of --repeat; runs of both methods take turns. Prints a table for
each scene, and at the errors named how many times longer the first method takes, by straight lines between its points in logarithms;
where it does not come so far, that is a lower bound (>) from its finest run. --picture FILE draws them all."""
import argparse
import json
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PRM = os.path.join(HERE, "..", "..")
sys.path[:0] = [PRM, os.path.join(HERE, "..", "curved_dies")]
import dies  # noqa: E402
import runs as curved  # noqa: E402
from case_tools import energy, figure, gradient  # noqa: E402

MINI, QUADRATIC = "mini", "P2-P1"
EULER, MIDPOINT = "euler", "midpoint"

# What a method is, what makes it finer, and how that is called in tables.
ELEMENTS = ("Discretization/element", "Billet/element size", "size [mm]")
SCHEMES = ("Press/scheme", "Press/increments", "increments")


class Known:
    """What is right, where no run comes near enough."""
    ended, seconds = True, 0.0

    def __init__(self, energy_, slope):
        self.energy, self.slope = energy_, slope


def sphere():
    """A block of 40 x 40 x 30 mm (a quarter) into which a sphere of radius 20 is pressed 6 mm deep; all faces but those under it are flat."""
    return curved.write_case("sphere.prm", {
        "Billet/shape": "box", "Billet/size": "40, 40, 30", "Billet/symmetry planes": "-1, 0, 0; 0, -1, 0", "Dies/names": "lower, upper",
        **curved.plane("lower", 0), **curved.stl("upper", dies.write("sphere.stl", dies.sphere(20.0)), (0, 0, 30.05), velocity=-30),
        "Material/consistency": 47, "Material/strain rate sensitivity": 0.139, "Press/stroke": 6.05, "Press/increments": 30,
        "Remeshing/when": "never", "Design/parameters": "billet/stretch"})


class Scene:
    """Where a scene is, or what writes it, and how it is run."""

    def __init__(self, case, parameter, kind, series, reference, bars, settings=None, round_billet=None):
        self.case, self.parameter, self.kind, self.series, self.settings = case, parameter, kind, series, settings or {}
        self.reference = reference  # method, fineness and, if there are, more settings; or Known
        self.bars = bars  # errors of energy and derivative at which seconds are compared
        self.round_billet = round_billet  # radius, height, sector angle of a cylinder whose volume the mesh is to have

    def words(self, method, fineness, **others):
        settings = {**self.settings, self.kind[0]: method, self.kind[1]: fineness, "Output/fields every": 0, **others}
        return [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]

    def at(self, build, method, fineness):
        """The sides of a round billet's mesh are chords: the radius at which it has the billet's volume, on the same mesh."""
        if not self.round_billet:
            return []
        radius, height, angle = self.round_billet
        words = [os.path.join(build, "retroforge"), "simulate", self.case, "--output", "first", "--overwrite"]
        words += self.words(method, fineness, **{"Press/stroke": 0.01, "Press/increments": 1, "Output/record": "false"})
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with open("first/summary.json", encoding="utf-8") as file:
            volume = json.load(file)["volume_initial"]
        return ["--at", f"billet/radius={radius * math.sqrt(math.radians(angle) / 2 * radius**2 * height / volume)!r}"]


CUBE = os.path.join(HERE, "cube.prm")
SCENES = {
    "cube": Scene(CUBE, "billet/stretch", ELEMENTS, {MINI: [6, 4, 3, 2.2, 1.7, 1.3, 1.05], QUADRATIC: [20, 16, 12, 9, 7]},
                  (QUADRATIC, 5), (0.0012, 0.002)),
    "cylinder": Scene(os.path.join(HERE, "..", "speed", "case.prm"), "billet/radius", ELEMENTS,
                      {MINI: [6, 4, 3, 2.2, 1.7], QUADRATIC: [14, 10, 8, 6]}, (QUADRATIC, 4), (0.005, 0.005),
                      {"Press/stroke": 12, "Press/increments": 24}, (20, 40, 90)),
    # The energy is where the lines of mini from 2 to 1 mm and of curved P2-P1 from 4 to 3 mm meet (README); slopes are not compared.
    "sphere": Scene(sphere, "billet/stretch", ELEMENTS,
                    {MINI: [6, 4, 3, 2], QUADRATIC: [10, 8, 6, 5, 4, 3]}, Known(102600.0, None), (0.01, 0.02)),
    "tripod": Scene(os.path.join(PRM, "reproduction", "laroussi_2003", "tripod", "case.prm"), "billet/radius", ELEMENTS,
                    {MINI: [7, 5, 4, 3, 2], QUADRATIC: [12, 9, 7, 5]}, (QUADRATIC, 3.5), (0.005, 0.01),
                    {"Press/stroke": 10, "Press/increments": 20, "Design/parameters": "billet/radius"}, (20, 60, 60)),
    "hub": Scene(os.path.join(PRM, "tutorial", "hub", "hub.prm"), "billet/radius", ELEMENTS,
                 {MINI: [5, 3, 2, 1.5], QUADRATIC: [12, 8, 5]},
                 (QUADRATIC, 5, {"Remeshing/chord error": 0.025, "Remeshing/smallest size": 0.15}), (0.01, 0.02),
                 {"Billet/radius": 15.6, "Press/stroke": 20, "Press/increments": 40, "Design/parameters": "billet/radius"}, (15.6, 40, 90)),
    "cube-time": Scene(CUBE, "billet/stretch", SCHEMES, {EULER: [4, 8, 16, 32, 64, 128], MIDPOINT: [2, 4, 8, 16, 32]},
                       (MIDPOINT, 256), (0.001, 0.001), {"Billet/element size": 5, "Press/stroke": 20}),
    "hub-time": Scene(os.path.join(PRM, "tutorial", "hub", "hub.prm"), "billet/radius", SCHEMES,
                      {EULER: [10, 20, 40, 80, 160], MIDPOINT: [5, 10, 20, 40, 80]}, (MIDPOINT, 320), (0.001, 0.001),
                      {"Press/stroke": 8, "Remeshing/when": "never", "Design/parameters": "billet/radius"}),
}


class Run:
    """One `gradient`; its seconds of processor time are the least of several."""

    def __init__(self, build, scene, method, fineness, repeat, timeout, more=None):
        words = ["timeout", str(timeout), os.path.join(build, "retroforge"), "gradient", scene.case, "--output", "run", "--overwrite"]
        words += scene.words(method, fineness, **(more or {})) + scene.at(build, method, fineness)
        self.method, self.fineness, self.seconds, self.ended = method, fineness, math.inf, True
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
        return self.energy / reference.energy - 1.0, self.slope / reference.slope - 1.0 if reference.slope else math.nan


def reference_of(build, scene, timeout):
    if isinstance(scene.reference, Known):
        return scene.reference
    method, fineness, *more = scene.reference
    return Run(build, scene, method, fineness, 1, timeout, *more)


def seconds_to(points, error):
    """Least seconds from which on the errors of (seconds, error) stay below `error`, by straight lines in logarithms; and whether they do."""
    points = sorted(points)
    above = [i for i, (_, e) in enumerate(points) if e > error]
    if not above:
        return points[0][0], True
    if above[-1] == len(points) - 1:
        return points[-1][0], False
    (s, e), (t, f) = points[above[-1]], points[above[-1] + 1]
    return s * (t / s) ** (math.log(e / error) / math.log(e / f)), True


def line(runs, method, reference, i):
    return [(run.seconds, abs(run.errors(reference)[i])) for run in runs if run.method == method]


def compare(name, scene, runs, reference):
    """At each bar: how many times longer the first method takes."""
    first, second = scene.series
    for i, what in enumerate(("energy", "derivative") if reference.slope else ("energy",)):
        lines = [line(runs, method, reference, i) for method in (first, second)]
        if not all(lines):
            continue
        (slow, there), (fast, found) = (seconds_to(points, scene.bars[i]) for points in lines)
        if not found:
            print(f"{what}, {scene.bars[i]:.2%}: {second} does not come so far here" + ("" if not there else f", {first} in {slow:.2g} s"))
            continue
        bound = "" if there else "> "
        print(f"{what}, {scene.bars[i]:.2%}: {first} {bound}{slow:.3g} s, {second} {fast:.3g} s: {bound}{slow / fast:.2g} times")
        figure(f"{name}_{what}_ratio", slow / fast)


def draw(results, file):
    """Errors over seconds, one column for each scene."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot, ticker
    page, axes = pyplot.subplots(2, len(results), figsize=(3.6 * len(results), 6.4), squeeze=False, sharex="col")
    for column, (name, (runs, reference)) in enumerate(results.items()):
        for row, what in enumerate(("energy", "derivative") if reference.slope else ("energy",)):
            for method, mark in zip(SCENES[name].series, ("o-", "s-")):
                axes[row][column].loglog(*zip(*sorted(line(runs, method, reference, row))), mark, label=method.replace("-", "/"))
            axes[row][column].set_title(f"{name}: {what}")
            axes[row][column].grid(True, which="both", alpha=0.3)
            axes[row][column].legend()
        axes[1][column].set_xlabel("seconds")
        axes[1][column].xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axes[1][column].xaxis.set_major_formatter("{x:g}")
        axes[1][column].xaxis.set_minor_formatter(ticker.NullFormatter())
    axes[0][0].set_ylabel("relative error")
    axes[1][0].set_ylabel("relative error")
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
        if callable(scene.case):
            scene.case = scene.case()
        reference = reference_of(options.build, scene, 4 * options.timeout)
        if not reference.ended:
            print(f"{name}: the reference, {scene.reference}, did not end")
            continue
        what = "known" if isinstance(scene.reference, Known) else f"{scene.reference[0]}, {scene.kind[2]} {scene.reference[1]:g}"
        slope = f", derivative by {scene.parameter} {reference.slope:.6g}" if reference.slope else ""
        print(f"\n{name}: reference {what}: energy {reference.energy:.6g} mJ{slope}, {reference.seconds:.3g} s\n")
        print(f"| {scene.kind[0].split('/')[1]} | {scene.kind[2]} | nodes | s | energy | derivative |\n" + "| --- " * 6 + "|", flush=True)
        runs, series = [], {method: list(steps) for method, steps in scene.series.items()}
        while any(series.values()):
            for method, steps in series.items():
                if steps:
                    run = Run(options.build, scene, method, steps.pop(0), options.repeat, options.timeout)
                    if not run.ended:
                        print(f"| {method} | {run.fineness:g} | did not end | {run.seconds:.3g} | | |", flush=True)
                        continue
                    runs.append(run)
                    errors = run.errors(reference)
                    print(f"| {method} | {run.fineness:g} | {run.nodes} | {run.seconds:.3g} | {errors[0]:+.3%} | "
                          + (f"{errors[1]:+.3%} |" if reference.slope else "– |"), flush=True)
        print()
        compare(name, scene, runs, reference)
        results[name] = (runs, reference)
    if options.picture and results:
        draw(results, options.picture)


if __name__ == "__main__":
    main()
