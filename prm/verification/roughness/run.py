#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""How smooth is the energy in the design, and at which bias?   run.py BUILD default|grid|third

`default`: the default mesh and increment, by the default law and by the thesis'. `grid`: five laws and three increments on two
coarser meshes, 40 points each, and the picture. `third`: the same laws and increments on a mesh between these and the
default, 12 points each.
The die's offset is scanned over 1 % of the billet's size to either side. Roughness: the adjoint's local slopes against
the slope of a cubic fitted to the energies. Bias: the fit against the law of approach 1 at vanishing increments.
"""
import os
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

RANGE = 0.3  # mm, 1 % of 30
SHARP = {"Contact/layer": 0}
LAWS = {f"approach {k}": {"Contact/approach": k, **SHARP} for k in (1, 2, 4, 8)}
LAWS["default"] = {}
DEFAULT_SIZE = 3  # a tenth of the billet
MESHES = (10, 7)  # element sizes: about 100 and 200 nodes
INCREMENTS = (18, 36, 72)
# (element size, increments (0: the default), points, laws)
GRID = {"default": [(DEFAULT_SIZE, 0, 12, ("default", "approach 1"))],
        "grid": [(size, increments, 40, tuple(LAWS)) for size in MESHES for increments in INCREMENTS],
        "third": [(5, increments, 12, tuple(LAWS)) for increments in INCREMENTS]}


def scan(build, size, increments, settings, half_width, points):
    program = os.path.join(build, "tests", "verification", "roughness", "roughness_scan")
    settings = {"Billet/element size": size, "Press/increments": increments, **settings}
    done = subprocess.run([program, os.path.join(HERE, "case.prm"), str(-half_width), str(half_width), str(points)]
                          + [f"{name}={value}" for name, value in settings.items()], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    return np.genfromtxt(done.stdout.splitlines(), delimiter=",", names=True, ndmin=1)


def evaluate(line):
    """(rms and largest relative deviation of the local slopes, energy of the fit in the middle)"""
    fit = np.polynomial.Polynomial.fit(line["mu"], line["energy"], 3)
    deviation = line["gradient"] / fit.deriv()(line["mu"]) - 1.0
    return np.sqrt(np.mean(deviation**2)), np.abs(deviation).max(), fit(0.0), deviation


def reference(build, size):
    """Energy of approach 1 at vanishing increments, extrapolated linearly from 67 and 134; a fit takes out its own kinks."""
    coarse, fine = (evaluate(scan(build, size, n, SHARP, RANGE, 6))[2] for n in (67, 134))
    return 2.0 * fine - coarse


def draw(lines):
    """One panel per increment: the middle mesh's slopes along the offset."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, panels = pyplot.subplots(1, len(lines), figsize=(4 * len(lines), 4), sharey=True)
    for axes, (increments, of_laws) in zip(panels, lines.items()):
        for name, line in of_laws.items():
            axes.plot(line["mu"], 100.0 * evaluate(line)[3], ".-", markersize=3, linewidth=0.8, label=name)
        axes.set_title(f"{increments} increments")
        axes.set_xlabel("offset of the die [mm]")
    panels[0].set_ylabel("local slope against the fit's [%]")
    panels[0].legend()
    figure.tight_layout()
    figure.savefig("roughness.png", dpi=90)


def main():
    build, part = sys.argv[1:3]
    references, lines = {}, {}
    print("| nodes | increments | law | roughness rms | max | bias of the energy |\n" + "| --- " * 6 + "|")
    for size, increments, points, laws in GRID[part]:
        if size not in references:
            references[size] = reference(build, size)
        for name in laws:
            line = scan(build, size, increments, LAWS[name], RANGE, points)
            rms, largest, energy, _ = evaluate(line)
            bias = energy / references[size] - 1.0
            print(f"| {int(line['nodes'][0])} | {int(line['increments'][0])} | {name} | {rms:.2%} | {largest:.2%} "
                  f"| {bias:+.2%} |", flush=True)
            if size == MESHES[1]:
                lines.setdefault(increments, {})[name] = line
            if size == DEFAULT_SIZE and name == "default":
                case_tools.figure("rms_default", rms)
                case_tools.figure("bias_default", abs(bias))
    if lines:
        draw(lines)


if __name__ == "__main__":
    main()
