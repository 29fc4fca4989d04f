#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""d(energy)/dV by differences inside the elements against automatic differentiation: run.py BUILD"""
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402


def draw(steps, errors, own):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6, 4))
    axes.loglog(steps, errors, "o-", label="differences inside the elements")
    axes.axhline(max(own, 1e-17), color="black", linestyle="--", label="the program's derivative")
    axes.axhline(1e-7, color="grey", linestyle=":", label="thesis, at best")
    axes.set_xlabel("perturbation of the velocity [mm/s]")
    axes.set_ylabel("relative error of d(energy)/dV")
    axes.legend()
    figure.tight_layout()
    figure.savefig("figure_45.png", dpi=100)


def main():
    program = os.path.join(sys.argv[1], "tests", "verification", "energy_derivative", "energy_derivative")
    done = subprocess.run([program, "accuracy", "9.3"], capture_output=True, text=True, check=True)
    lines = [line.split() for line in done.stdout.splitlines()]
    curve = sorted((float(words[1]), float(words[2])) for words in lines if words[0] == "difference")
    own = next(float(words[1]) for words in lines if words[0] == "default")
    nodes = next(words[1] for words in lines if words[0] == "nodes")
    steps, errors = zip(*curve)
    print(f"{nodes} nodes\n\n| perturbation [mm/s] | relative error |\n| --- | --- |")
    for step, error in curve:
        print(f"| {step:.1e} | {error:.1e} |")
    draw(steps, errors, own)
    case_tools.figure("default_derivative", own)
    case_tools.figure("semi_analytic_best", min(errors))
    best = errors.index(min(errors))
    # Slopes of the two branches of the V, a decade and more from its bottom.
    case_tools.figure("branches_seen", float(errors[0] > 1e3 * errors[best] and errors[-1] > 1e3 * errors[best]))


if __name__ == "__main__":
    main()
