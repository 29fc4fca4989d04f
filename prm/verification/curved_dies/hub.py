#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A cylinder r 16, h 40 forged by a die with a hub cavity:   hub.py BUILD accuracy|whole|radii|slopes|odd|symmetry

accuracy: radius 15.6, 20 mm in 40 increments, elements of 5, 4 and 3 mm against --reference mm (2), whose energy may be given by
--energy; and how deep metal lies in the die. whole: the whole body, centred and 2 mm off the centre, to the final gap.
radii: a quarter at radii from 15 to 16.5, in 16 and 40 increments: which end, and how smooth their energies are. slopes: a quarter,
20 mm deep in 40 increments, at radii within 1 % of 15.6: have the local slopes that of the energies. odd: scenes
that once ran forever. symmetry: how round the whole body stays."""
import sys

import numpy as np

import dies
import penetration
import runs

FINAL = 27.0  # stroke to the final gap [mm]
CASE = {
    **runs.cylinder(16, 40, 4, sector_angle=90),
    "Dies/names": "lower, upper",
    **runs.plane("lower", 0),
    "Press/stroke": FINAL,
    "Press/increments": 40,
    "Remeshing/when": "quality",
    "Design/parameters": "billet/radius",
    "Output/fields every": 5,
}


def write_case(options, name="hub", **shape):
    """The hub's case with its die."""
    die = runs.stl("upper", dies.write(f"{name}.stl", dies.hub(**shape)), (0, 0, 40))
    return runs.write_case(f"{name}.prm", {**CASE, **die, **options.settings})


def accuracy(options):
    case = write_case(options)
    settings = {"Billet/radius": 15.6, "Press/stroke": 20}
    print("| element size | energy [mJ] | against the finest | deepest in the die [mm] | of the size | hidden [mm^3] | nodes | s |\n" + "| --- " * 8 + "|")
    reference = options.energy
    for size in ([] if reference else [options.reference]) + options.sizes:
        run = runs.forge(options.build, "simulate", case, f"accuracy_{size:g}", {**settings, "Billet/element size": size}, timeout=options.timeout)
        if not run.ended:
            reference = reference or float("nan")  # without its run there is none
            print(f"| {size:g} | {run.outcome}: {run.message[:200]} | | | | | | {run.seconds:.1f} |", flush=True)
            continue
        reference = reference or run.energy
        deep = penetration.penetration(run.output)
        error = run.energy / reference - 1.0
        print(f"| {size:g} | {run.energy:.8g} | {error:+.2%} | {deep['deepest']:.3g} | {deep['deepest'] / size:.2%} | {deep['hidden']:.3g} "
              f"| {run.nodes} | {run.seconds:.1f} |", flush=True)
        if size != options.reference:
            runs.figure(f"hub_energy_{size:g}", abs(error))
        runs.figure(f"hub_depth_{size:g}", deep["deepest"] / size)


def whole(options):
    case = write_case(options)
    print("| element size | off the centre [mm] | outcome | increments | energy [mJ] | deepest of the size | volume lost | s |\n" + "| --- " * 8 + "|")
    ended, deepest = 0, 0.0
    for size in options.sizes:
        for off in (0.0, 2.0):
            settings = {"Billet/sector angle": 0, "Billet/element size": size, "Billet/translation": f"{off}, 0, 0", "Press/increments": 30}
            run = runs.forge(options.build, "simulate", case, f"whole_{size:g}_{off:g}", settings, timeout=options.timeout)
            increments, lost = run.history()
            depth = run.depth() / size
            outcome = "end" if run.ended else f"{run.outcome}: {run.message[:200]}"
            print(f"| {size:g} | {off:g} | {outcome} | {increments} | {run.energy:.8g} | {depth:.2%} | {lost:.1e} | {run.seconds:.1f} |", flush=True)
            ended += run.ended
            deepest = np.fmax(deepest, depth)
    runs.figure("whole_missing", 2 * len(options.sizes) - ended)
    runs.figure("whole_depth", deepest)


def radii(options):
    case = write_case(options)
    values = np.linspace(15.0, 16.5, options.points)
    for increments in (16, 40):
        energies, depths = [], []
        for radius in values:
            settings = {"Billet/element size": options.sizes[0], "Press/increments": increments}
            run = runs.forge(options.build, "simulate", case, "radius", settings, {"billet/radius": float(radius)}, options.timeout)
            energies.append(run.energy)
            depths.append(run.depth())
            print(f"{increments} increments, radius {radius:.4g}: {run.energy:.8g} mJ, {depths[-1]:.2g} mm deep, {run.seconds:.1f} s"
                  + ("" if run.ended else f", {run.outcome}: {run.message[:200]}"), flush=True)
        fit = runs.trend(values, energies)
        print(f"off a cubic: rms {fit.off:.2e}, largest {fit.worst:.2e}")
        runs.figure(f"radii_missing_{increments}", np.isnan(energies).sum())
        runs.figure(f"radii_off_{increments}", fit.off)
        runs.figure(f"radii_off_max_{increments}", fit.worst)
        runs.figure(f"radii_depth_{increments}", np.nanmax(depths) / options.sizes[0])


def slopes(options):
    values = 15.6 * np.linspace(0.99, 1.01, options.points)
    settings = {"Press/stroke": 20, "Billet/element size": options.sizes[0], "Output/fields every": 0}
    line = runs.scan(options.build, write_case(options), "billet/radius", values, "slopes", settings, options.timeout)
    runs.report_trend("hub_slopes", values, *line)


def odd_scenes(options):
    """{name: (case, settings)} of scenes that once ran forever; each must end, or say why not, within a bounded time."""
    hub, small = write_case(options), write_case(options, "small", rim=20.0, per_turn=48, segments=4)
    flat = runs.write_case("flat.prm", {**CASE, **runs.plane("upper", 40, -1, velocity=-100), **options.settings})
    # The cup closes on the lower die after 20 mm, and is smaller than the billet by 28 %.
    profile = dies.cavity_profile(18.0, 20.0, 2.0, 2.0, 3.0, per_turn=72)
    cup = runs.stl("upper", dies.write("cup.stl", dies.revolved(profile, 72)), (0, 0, 20.05))
    closed = runs.write_case("closed.prm", {**CASE, **cup, **options.settings})
    return {
        "past the rim of a small die": (small, {"Press/stroke": 26, "Billet/element size": 4}),
        "punch that nodes hardly sink into": (hub, {"Die upper/depth of contact": 1e-9, "Press/stroke": 20, "Billet/element size": 5}),
        "flat dies down to 0.1 mm": (flat, {"Press/stroke": 39.9, "Billet/element size": 5}),
        "more metal than the closed cavity holds": (closed, {"Billet/radius": 15, "Press/stroke": 19.9, "Billet/element size": 5}),
    }


def odd(options):
    limit = min(options.timeout, 300.0)
    print("| scene | outcome | exit | increments | s | deepest [mm] | message |\n" + "| --- " * 7 + "|")
    bounded = []
    for i, (name, (case, settings)) in enumerate(odd_scenes(options).items()):
        run = runs.forge(options.build, "simulate", case, f"odd_{i}", settings, timeout=limit)
        bounded.append(run.outcome in ("end", "reason"))
        print(f"| {name} | {run.outcome} | {run.code} | {run.history()[0]} | {run.seconds:.1f} | {run.depth():.2g} | {run.message[:300]} |", flush=True)
    runs.figure("odd_unbounded", len(bounded) - sum(bounded))


def symmetry(options):
    settings = {"Billet/sector angle": 0, "Billet/element size": options.sizes[0], "Press/increments": 30}
    run = runs.forge(options.build, "simulate", write_case(options), "symmetry", settings, timeout=options.timeout)
    print(f"{run.outcome} after {run.history()[0]} increments, {run.seconds:.1f} s {run.message[:200]}")
    spread = float("nan")
    if run.ended:
        faces = penetration.surface(penetration.fields(run.output)[-1][1], [])
        extents = [faces[..., 0].max(), -faces[..., 0].min(), faces[..., 1].max(), -faces[..., 1].min()]
        spread = np.ptp(extents) / np.mean(extents)
        print("extents +x, -x, +y, -y: " + ", ".join(f"{x:.3f}" for x in extents) + f"; mean {np.mean(extents):.3f} mm")
    runs.figure("asymmetry", spread)


def main():
    def more(parser):
        parser.add_argument("--reference", type=float, default=2.0, help="element size of the reference of `accuracy` [mm]")
        parser.add_argument("--energy", type=float, help="its energy, if known: it is not run [mJ]")
        parser.add_argument("--sizes", type=lambda text: [float(word) for word in text.split(",")], help="element sizes, as 5,4,3 [mm]")
        parser.add_argument("--points", type=int, default=31, help="number of radii")
    parts = {"accuracy": accuracy, "whole": whole, "radii": radii, "slopes": slopes, "odd": odd, "symmetry": symmetry}
    options = runs.arguments(__doc__, *parts, extra=more)
    options.sizes = options.sizes or {"accuracy": [5.0, 4.0, 3.0], "whole": [5.0, 4.0]}.get(options.part, [5.0])
    parts[options.part](options)


if __name__ == "__main__":
    sys.exit(main())
