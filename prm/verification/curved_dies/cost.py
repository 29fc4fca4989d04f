#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Seconds and errors of two builds:   cost.py NEW tripod|hub OLD

Energy and d/d radius on several meshes against NEW on a fine one, and the seconds of forward and backward run. The figure
`sooner`: the seconds OLD needs for an error of 1 % in the energy over those NEW needs, between the meshes run (logarithms)."""
import os
import sys

import numpy as np

import dies
import hub
import runs
import tripod

SIZES = {"tripod": [5.6, 4.0, 2.8], "hub": [5.0, 4.0, 3.0]}
FINE = {"tripod": 2.0, "hub": 2.0}


def case_of(options):
    """(parameter file, settings) of the scene, at the end of its stroke."""
    if options.part == "tripod":
        return options.case, {"Output/fields every": 0, **tripod.PARTS["long"], **options.settings}
    die = runs.stl("upper", dies.write("hub.stl", dies.hub()), (0, 0, 40))
    case = runs.write_case("hub.prm", {**hub.CASE, **die, "Output/fields every": 0})
    return case, {"Billet/radius": 15.6, "Press/stroke": 20, **options.settings}


def measure(options, build, name, size):
    """(energy, d/d radius, seconds) of a run on one mesh"""
    case, settings = case_of(options)
    run = runs.forge(build, "gradient", case, f"{options.part}_{name}_{size:g}", {**settings, "Billet/element size": size}, timeout=options.timeout)
    if not run.ended:
        print(f"{name}, {size:g} mm: {run.outcome} after {run.seconds:.1f} s: {run.message[:200]}", flush=True)
    return run.energy, run.slope("billet/radius"), run.seconds


def seconds_for(error, errors, seconds):
    """Seconds at which the error falls below a bar: interpolated between the runs, all errors being made no larger than those before."""
    order = np.argsort(seconds)
    log_seconds, log_errors = np.log(np.array(seconds)[order]), np.log(np.maximum.accumulate(np.array(errors)[order][::-1])[::-1])
    if not np.isfinite(log_errors).all() or log_errors.min() > np.log(error):
        return float("inf")
    return float(np.exp(np.interp(-np.log(error), -log_errors, log_seconds)))


def table(options, reference):
    """Prints the rows of both builds; {name: ([errors of the energy], [seconds])}"""
    print("| build | element size | energy [mJ] | error | d/d radius | error | s |\n" + "| --- " * 7 + "|")
    found = {}
    for name, build in (("new", options.build), ("old", options.old)):
        for size in options.sizes:
            E, g, seconds = measure(options, build, name, size)
            errors = abs(E / reference[0] - 1.0), abs(g / reference[1] - 1.0)
            print(f"| {name} | {size:g} | {E:.8g} | {errors[0]:.2%} | {g:.6g} | {errors[1]:.2%} | {seconds:.1f} |", flush=True)
            runs.figure(f"{options.part}_{name}_energy_{size:g}", errors[0])
            runs.figure(f"{options.part}_{name}_gradient_{size:g}", errors[1])
            found.setdefault(name, ([], []))
            found[name][0].append(errors[0])
            found[name][1].append(seconds)
    return found


def main():
    def more(parser):
        parser.add_argument("old", type=os.path.abspath, help="build folder of the other program")
        parser.add_argument("--sizes", type=lambda text: [float(word) for word in text.split(",")], help="element sizes [mm]")
        parser.add_argument("--fine", type=float, help="element size of the reference [mm]")
        parser.add_argument("--reference", type=float, nargs=2, metavar=("E", "G"), help="its energy and slope, if known")
        parser.add_argument("--error", type=float, default=0.01, help="error at which the seconds are compared")
        parser.add_argument("--case", default=tripod.CASE, help="parameter file of the tripod")
    options = runs.arguments(__doc__, *SIZES, extra=more)
    options.sizes = options.sizes or SIZES[options.part]
    fine = options.fine or FINE[options.part]
    reference = options.reference
    if not reference:
        *reference, seconds = measure(options, options.build, "new_fine", fine)
        print(f"reference of {fine:g} mm: {reference[0]:.8g} mJ, {reference[1]:.6g} mJ/mm, {seconds:.1f} s")
    found = table(options, reference)
    new, old = (seconds_for(options.error, *found[name]) for name in ("new", "old"))
    print(f"an error of {options.error:.1%} in the energy takes {new:.1f} s, by the old build {old:.1f} s")
    runs.figure(f"{options.part}_sooner", old / new if np.isfinite(new) else 0.0)


if __name__ == "__main__":
    sys.exit(main())
