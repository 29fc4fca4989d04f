#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""How smooth is the energy in the design, and at which bias?   run.py BUILD default|grid|third

`default`: the default mesh and increment, by the default law and by the thesis'. `grid`: five laws and three increments on two
coarser meshes, 40 points each, and the picture. `third`: the same laws and increments on a mesh between these and the
default, 12 points each.
The die's offset is scanned over 1 % of the billet's size to either side. Roughness: the adjoint's local slopes against
the slope of a cubic fitted to the energies, by `retroforge scan`. Bias: the fit against the law of approach 1 at vanishing increments.
"""
import csv
import json
import os
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

RANGE = 0.01  # of the billet's 30 mm
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


def scan(build, size, increments, settings, points):
    """Columns of scan.csv, and the summary of the first point."""
    settings = {"Billet/element size": size, "Press/increments": increments, "Scan/points": points, "Scan/range": RANGE,
                **settings}
    arguments = [os.path.join(build, "retroforge"), "scan", os.path.join(HERE, "case.prm"), "--output", "scan", "--overwrite"]
    for name, value in settings.items():
        arguments += ["--set", f"{name}={value}"]
    done = subprocess.run(arguments, capture_output=True, text=True)
    with open(os.path.join("scan", "scan.json")) as file:
        if done.returncode or json.load(file)["failed"]:
            sys.exit(done.stdout[-4000:] + done.stderr)
    with open(os.path.join("scan", "scan.csv"), newline="") as file:
        rows = list(csv.DictReader(file))
    with open(os.path.join("scan", "points", "die_upper_offset_001", "summary.json")) as file:
        first = json.load(file)
    names = {"mu": "value", "energy": "energy [mJ]", "gradient": "energy: gradient", "slope": "energy: slope of the fit"}
    return {key: np.array([float(row[name]) for row in rows]) for key, name in names.items()}, first


def evaluate(line):
    """(rms and largest relative deviation of the local slopes, energy of the fit in the middle)"""
    deviation = line["gradient"] / line["slope"] - 1.0
    middle = np.polynomial.Polynomial.fit(line["mu"], line["energy"], 3)(0.0)
    return np.sqrt(np.mean(deviation**2)), np.abs(deviation).max(), middle, deviation


def reference(build, size):
    """Energy of approach 1 at vanishing increments, extrapolated linearly from 67 and 134; a fit takes out its own kinks."""
    coarse, fine = (evaluate(scan(build, size, n, SHARP, 6)[0])[2] for n in (67, 134))
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
            line, first = scan(build, size, increments, LAWS[name], points)
            rms, largest, energy, _ = evaluate(line)
            bias = energy / references[size] - 1.0
            print(f"| {first['mesh']['nodes']} | {first['increments']} | {name} | {rms:.2%} | {largest:.2%} "
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
