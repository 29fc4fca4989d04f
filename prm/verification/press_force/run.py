#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Is the force of the press one number, and how far does it and the energy depend on the steps?   run.py BUILD PART

gap: a cube under a gap, in closed form. balance: hub, tripod, a rod with flash, a sphere punch and 20 random dies at all
defaults: force against power. offset: slopes of the energy by the offset of the moving die against the force, on eleven
scenes; offset_quick on two. order: the hub's first mesh in 10 to 160 increments. hub_roughness, tripod_roughness: not remeshed, 11 radii.
defaults: tutorials at all defaults against steps ten times finer. filling: a cavity filled to its last corner."""
import csv
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "curved_dies"))
import dies  # noqa: E402
import random_dies  # noqa: E402
import runs  # noqa: E402
import sphere  # noqa: E402

TUTORIAL = os.path.join(HERE, "..", "..", "tutorial")
HUB = os.path.join(TUTORIAL, "hub", "hub.prm")
TRIPOD = os.path.join(TUTORIAL, "tripod", "tripod.prm")
NEVER = {"Remeshing/when": "never", "Remeshing/first mesh": "false", "Output/fields every": 0}
ENERGY_ONLY = {"Objectives/names": "energy", "Output/fields every": 0}


def forge(options, command, case, output, settings=None, at=None):
    """A run that has to come to its end."""
    run = runs.forge(options.build, command, case, output, {**(settings or {}), **options.settings}, at, options.timeout)
    if not run.ended:
        sys.exit(f"{case}: {run.message}")
    return run


def history(run):
    """Columns of history.csv by name, with the state before the first increment left out."""
    with open(os.path.join(run.output, "history.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in ("stroke", "force", "energy", "balance")}


# ---- a cube under a gap ----

HEIGHT, STROKE, SPEED, K, M = 30.0, 6.0, 100.0, 1.7, 0.15


def exact(gap):
    """Energy, and its derivative by the upper die's offset, of a quarter of a frictionless cube that is reached after `gap`."""
    end = HEIGHT - (STROKE - gap)
    factor = 3 ** (0.5 * (M + 1)) * K * SPEED**M * HEIGHT**3 / 4
    return factor * (end**-M - HEIGHT**-M) / M, factor * end ** (-M - 1)


def gap(options):
    worst = {"energy": 0.0, "slope": 0.0}
    print("| gap [mm] | increments | energy off | slope off |\n" + "| --- " * 4 + "|")
    for size in (0.05, 0.3, 1.0):
        case = runs.write_case(f"cube_{size}.prm", {
            "Billet/shape": "box", "Billet/size": "30, 30, 30", "Billet/element size": 30, "Billet/symmetry planes": "-1, 0, 0; 0, -1, 0",
            "Dies/names": "lower, upper", **runs.plane("lower", 0, 1, 0), **runs.plane("upper", HEIGHT + size, -1, 0, -SPEED),
            "Material/consistency": K, "Material/strain rate sensitivity": M, "Press/stroke": STROKE, "Press/largest move": 10,
            "Press/largest volume change": 0.1, "Contact/penetration": 1e-7, "Design/parameters": "die upper/offset", **NEVER})
        for increments in (15, 40, 133):
            run = forge(options, "gradient", case, "cube", {"Press/increments": increments})
            energy, slope = exact(size)
            off = {"energy": abs(run.energy / energy - 1), "slope": abs(abs(run.slope("die upper/offset")) / slope - 1)}
            print(f"| {size} | {increments} | {off['energy']:.1e} | {off['slope']:.1e} |", flush=True)
            worst = {name: max(worst[name], off[name]) for name in worst}
    for name, value in worst.items():
        runs.figure(f"gap_{name}", value)


# ---- force against power ----

def rod_with_flash():
    """A rod on its side between two U grooves that are too small for it: a flash of 2 mm is left of a gap of 7."""
    depth, gap_at_end, face = 6.5, 2.0, 3.5
    groove = dies.extruded(dies.u_profile(10.0, depth, 3.0, 2.0, 7.0, 30.0, 96), 40.0)
    dies.write("groove_upper.stl", groove)
    dies.write("groove_lower.stl", dies.as_lower(groove))
    return runs.write_case("rod.prm", {
        **runs.cylinder(10, 30, 5), "Billet/rotation axis": "1, 0, 0", "Billet/rotation angle": 90,
        "Billet/translation": "0, 15, 0", "Dies/names": "lower, upper",
        **runs.stl("lower", "groove_lower.stl", (0, 0, -face), "0, 0, 1", 0.3, 0), **runs.stl("upper", "groove_upper.stl", (0, 0, face)),
        "Press/stroke": 2 * face - gap_at_end})


FORCE = {"Objectives/names": "energy, force", "Objective force/type": "maximum effort", "Output/fields every": 0}


def scenes(options):
    """(name, case, settings) of the scenes whose forces are compared; all settings that choose steps are the defaults."""
    yield "hub", HUB, {}
    yield "rod with flash", rod_with_flash(), {}
    yield "tripod", TRIPOD, {}
    options.per_turn = 240
    yield "sphere", sphere.write_case(options), {"Press/increments": 0, "Remeshing/when": "quality", "Design/parameters": ""}
    for number in range(20):
        words, settings, facets = random_dies.scene(2, number)
        curved = "upper" if "above" in words["kind"] else "lower"
        settings[f"Die {curved}/file"] = dies.write(os.path.abspath(f"random_{number:02d}.stl"), facets)
        yield f"random {number}", runs.write_case(f"random_{number:02d}.prm", settings), {"Press/increments": 0}


def largest_efforts(run):
    """The largest force of the history, and what the summary says of the objective `force` and of the true maximum."""
    for objective in run.summary["objectives"]:
        if objective["name"] == "force":
            return objective["value"], objective["details"]["true maximum"]
    return math.nan, math.nan


def balance(options):
    """Force and power of each increment, what closing gaps takes, and the largest force of history, summary and objective."""
    apart, over, closing95, closing_worst, maxima = [], [], [], [], []
    print("| scene | increments | force and power apart, worst | closing work over the run | 95 % below | worst | largest force off |\n" + "| --- " * 7 + "|")
    for name, case, settings in scenes(options):
        run = runs.forge(options.build, "simulate", case, "balance", {**FORCE, **settings, **options.settings}, timeout=options.timeout)
        if not run.ended:
            print(f"| {name} | {run.message[:200]} |", flush=True)
            continue
        of = history(run)
        energy, stroke = (np.diff(of[key], prepend=0.0) for key in ("energy", "stroke"))
        power = energy / stroke
        sizeable = of["force"] > 0.02 * of["force"].max()
        difference = np.abs(of["force"] / power - 1)[sizeable]
        fitted, true_maximum = largest_efforts(run)
        spread = max(abs(fitted / of["force"].max() - 1), abs(true_maximum / of["force"].max() - 1))
        closing = run.summary["power_balance"]
        apart.append(difference.max())
        over.append(abs(of["force"] @ stroke / of["energy"][-1] - 1))
        closing95.append(abs(closing["95_percent_below"]))
        closing_worst.append(abs(closing["largest"]))
        maxima.append(spread)
        print(f"| {name} | {len(power)} | {apart[-1]:.1e} | {closing['over_run']:.2%} | {closing95[-1]:.2%} | {closing_worst[-1]:.2%} | {spread:.2%} |", flush=True)
    runs.figure("balance_missing", 24 - len(apart))
    runs.figure("balance_worst", max(apart))
    runs.figure("balance_run", max(over))
    runs.figure("balance_closing_95", max(closing95))
    runs.figure("balance_closing_worst", max(closing_worst))
    runs.figure("largest_force", max(maxima))


# ---- slopes ----

def lobed_pan(name, **billet):
    """A low cylinder under a lobed pan, 1 mm of air between them."""
    return runs.write_case(f"pan_{name}.prm", {
        **runs.cylinder(12, 22, 3.5, **billet), "Dies/names": "lower, upper", **runs.plane("lower", 0),
        **runs.stl("upper", dies.write("pan.stl", dies.lobed_pan()), (0, 0, 19), velocity=-80), "Material/consistency": 40,
        "Material/strain rate sensitivity": 0.15, "Press/stroke": 14})


def slope_over_force(options, case, settings):
    """d energy / d offset of the upper die over the force at the end, with the run and its forces; None where it does not end."""
    run = runs.forge(options.build, "gradient", case, "offset",
                     {**ENERGY_ONLY, **settings, "Design/parameters": "die upper/offset", **options.settings}, timeout=options.timeout)
    if not run.ended:
        return None, run, None
    of = history(run)
    return abs(run.slope("die upper/offset")) / of["force"][-1] - 1, run, of


def offset_quick(options):
    """The hub to 2 mm, whose die begins on the metal, and a pan whose corners are sharp: slope, and the work of closing at the end."""
    off = {}
    for name, case, settings in (("hub", HUB, {"Press/stroke": 2}), ("pan", lobed_pan("60", sector_angle=60), {})):
        off[name], run, of = slope_over_force(options, case, settings)
        if of is None:
            sys.exit(f"{case}: {run.message}")
        print(f"{name}: {off[name]:+.2%}; closing work of the last four increments {np.abs(of['balance'][-4:]).max():.2%}")
        runs.figure(f"offset_{name}", abs(off[name]))
    runs.figure("end_of_stroke", np.abs(of["balance"][-4:]).max())


def offset(options):
    """A moving die that is nearer by an offset presses farther by it: d energy / d offset is the force at the end."""
    cases = [("hub", HUB, {}), ("tripod", TRIPOD, {}), *((f"lobed pan, {name}", lobed_pan(name, **billet), {}) for name, billet in (
        ("60", {"sector_angle": 60}), ("120", {"sector_angle": 120}), ("whole", {"translation": "1, 0.5, 0"})))]
    for number in range(6):
        words, settings, facets = random_dies.scene(3, number)
        curved = "upper" if "above" in words["kind"] else "lower"
        settings[f"Die {curved}/file"] = dies.write(os.path.abspath(f"slope_{number}.stl"), facets)
        cases.append((f"random {number}: {words['kind']}", runs.write_case(f"slope_{number}.prm", settings), {"Press/increments": 0}))
    print("| scene | increments | force at the end [N] | d energy / d offset over it |\n" + "| --- " * 4 + "|")
    off = []
    for name, case, settings in cases:
        ratio, run, of = slope_over_force(options, case, settings)
        if of is None:
            print(f"| {name} | {run.message[:200]} |", flush=True)
            continue
        off.append(ratio)
        print(f"| {name} | {len(of['force'])} | {of['force'][-1]:.6g} | {ratio:+.2%} |", flush=True)
    runs.figure("offset_missing", len(cases) - len(off))
    runs.figure("offset_worst", max(map(abs, off)))
    runs.figure("offset_median", float(np.median(np.abs(off))))


# ---- time ----

def order(options):
    """The hub's first mesh to 8 mm; errors against 320 increments."""
    counts = (10, 20, 40, 80, 320)
    energies = {n: forge(options, "simulate", HUB, "order", {"Press/stroke": 8, "Press/increments": n, **ENERGY_ONLY, **NEVER}).energy for n in counts}
    errors = {n: energies[n] / energies[320] - 1 for n in counts[:-1]}
    print("| increments | energy [mJ] | error |\n| --- | --- | --- |")
    for n, error in errors.items():
        print(f"| {n} | {energies[n]:.8g} | {error:+.3%} |", flush=True)
        runs.figure(f"order_{n}", abs(error))
    runs.figure("order", math.log2(abs(errors[10] / errors[40])) / 2)


def roughness(options, name, case, settings, radius):
    values = radius * np.linspace(0.99, 1.01, 11)
    settings = {"Press/increments": 20, **ENERGY_ONLY, **NEVER, **settings, **options.settings}
    runs.report_trend(name, values, *runs.scan(options.build, case, "billet/radius", values, name, settings, options.timeout))


def hub_roughness(options):
    roughness(options, "hub", HUB, {"Press/stroke": 8}, 16.0)


def tripod_roughness(options):
    roughness(options, "tripod", TRIPOD, {"Press/stroke": 20}, 20.0)


def defaults(options):
    """Tutorials at all defaults: energy and largest force against those of steps ten times as accurate."""
    print("| scene | increments | energy off | force off | increments, finer |\n" + "| --- " * 5 + "|")
    worst = {"energy": 0.0, "force": 0.0}
    for name in ("bar_flattening", "ring_test", "heading", "hub"):
        case = os.path.join(TUTORIAL, name, f"{name}.prm")
        found = [forge(options, "simulate", case, f"defaults_{accuracy}", {"Press/increments": 0, "Press/accuracy": accuracy, "Output/fields every": 0})
                 for accuracy in (1e-3, 1e-5)]
        energy, force = (history(found[0])[key].max() / history(found[1])[key].max() - 1 for key in ("energy", "force"))
        counts = [run.summary["increments"] for run in found]
        print(f"| {name} | {counts[0]} | {energy:+.2%} | {force:+.2%} | {counts[1]} |", flush=True)
        worst = {"energy": max(worst["energy"], abs(energy)), "force": max(worst["force"], abs(force))}
    for name, value in worst.items():
        runs.figure(f"defaults_{name}", value)


# ---- filling ----

def filling(options):
    """The hub pressed until its cavity is full: what `unfilled volume` says is left, over the cavity."""
    settings = {"Press/stroke": 33.5, "Press/increments": 34, "Billet/element size": 5, "Objectives/names": "energy, unfilled", "Output/fields every": 0}
    run = forge(options, "simulate", HUB, "filling", settings)
    details = run.summary["objectives"][1]["details"]
    print(details)
    runs.figure("filling", details["of the cavity [%]"] / 100)


def main():
    parts = {f.__name__: f for f in (gap, balance, offset, offset_quick, order, hub_roughness, tripod_roughness, defaults, filling)}
    options = runs.arguments(__doc__, *parts)
    parts[options.part](options)


if __name__ == "__main__":
    main()
