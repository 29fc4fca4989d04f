#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""How smooth is the energy in the design, and at which bias?   run.py BUILD

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
LAWS = {f"approach {k}": {"Contact/approach": k} for k in (1, 2, 4, 8)}
LAWS.update({f"layer {l}": {"Contact/layer": l} for l in (0.5, 0.4, 0.3)})
DEFAULT = "approach 1"
COARSE, MIDDLE, FINE = 10, 7, 5.5  # element sizes [mm]: about 100, 200 and 350 nodes
GRID = [(MIDDLE, 18, 40), (COARSE, 18, 12), (FINE, 18, 12), (COARSE, 36, 12), (COARSE, 72, 12)]


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
    """Energy of approach 1 at vanishing increments, extrapolated linearly from 72 and 144; a fit takes out its own kinks."""
    coarse, fine = (evaluate(scan(build, size, n, {}, RANGE, 7))[2] for n in (72, 144))
    return 2.0 * fine - coarse


def draw(lines):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7, 4))
    for name, line in lines.items():
        axes.plot(line["mu"], 100.0 * evaluate(line)[3], ".-", label=name)
    axes.set_xlabel("offset of the die [mm]")
    axes.set_ylabel("local slope against the fit's [%]")
    axes.legend()
    figure.tight_layout()
    figure.savefig("roughness.png", dpi=90)


def main():
    build = sys.argv[1]
    references, lines = {}, {}
    print("| nodes | increments | law | roughness rms | max | bias of the energy |\n" + "| --- " * 6 + "|")
    for size, increments, points in GRID:
        references.setdefault(size, reference(build, size))
        for name, settings in LAWS.items():
            line = scan(build, size, increments, settings, RANGE, points)
            rms, largest, energy, _ = evaluate(line)
            bias = energy / references[size] - 1.0
            print(f"| {int(line['nodes'][0])} | {increments} | {name} | {rms:.2%} | {largest:.2%} | {bias:+.2%} |",
                  flush=True)
            if (size, increments) == (MIDDLE, 18):
                lines[name] = line
                label = name.replace(" ", "_").replace(",", "")
                case_tools.figure(f"rms_{label}", rms)
                case_tools.figure(f"max_{label}", largest)
                case_tools.figure(f"bias_{label}", abs(bias))
    for name in (DEFAULT, "approach 4"):
        line = scan(build, MIDDLE, 18, {**LAWS[name], "Design/parameters": "billet/stretch"}, RANGE / 2, 20)
        print(f"{name}, billet/stretch over 1 % of the size to either side: rms {evaluate(line)[0]:.2%}, "
              f"max {evaluate(line)[1]:.2%}")
    draw(lines)


if __name__ == "__main__":
    main()
