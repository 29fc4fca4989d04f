#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A cylinder r 20, h 60 pressed by a sphere of radius 30:   sphere.py BUILD radius|offset|growth|facets

radius, offset, growth: the energy at 17 values, and whether the local slopes have the slope of a curve through the energies: along
the billet's radius (a quarter, +-1 %), the punch's offset in a direction inclined by 45 degrees (the whole body, +-0.3 mm), and
the growth of the punch, all its vertices along their normals (a quarter, +-0.3 mm; one STL file for each value, the slope is the
sensitivity by the vertices times their normals). facets: the same sphere cut into 40, 160 and 640 facets per turn, turned by
random angles: energy and d/d radius."""
import os
import sys

import numpy as np

import dies
import runs

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "contrib", "python"))
import retroforge  # noqa: E402

RADIUS, GAP = 30.0, 0.35  # of the sphere; between it and the billet at the start, more than it ever grows or shifts [mm]
CASE = {
    **runs.cylinder(20, 60, 5, sector_angle=90),
    "Dies/names": "lower, upper",
    **runs.plane("lower", 0),
    "Press/stroke": 10 + GAP,
    "Press/increments": 40,
    "Remeshing/when": "never",
    "Design/parameters": "billet/radius, die upper/offset",
    "Output/fields every": 0,
}


def punch(name, radius=RADIUS, per_turn=240, angle=0.0):
    return dies.write(name, dies.sphere(radius, per_turn, angle))


def write_case(options, facing="0, 0, -1", **more):
    """The case, with a punch cut into the number of facets asked for."""
    die = runs.stl("upper", punch("sphere.stl", per_turn=options.per_turn), (0, 0, 60 + GAP), facing)
    return runs.write_case("sphere.prm", {**CASE, **die, **more, **options.settings})


def radius(options):
    values = 20.0 * np.linspace(0.99, 1.01, options.points)
    line = runs.scan(options.build, write_case(options), "billet/radius", values, "radius", timeout=options.timeout)
    runs.report_trend("sphere_radius", values, *line)


def offset(options):
    """The whole body; the punch is moved by its point, the facing only says along which direction its offset counts."""
    case = write_case(options, "1, 0, -1", **{"Billet/sector angle": 0, "Billet/element size": 7})
    values = np.linspace(-0.3, 0.3, options.points)

    def move(value):
        step = value / np.sqrt(2.0)
        return {"Die upper/point": f"{step!r}, 0, {60 + GAP - step!r}"}
    line = runs.scan(options.build, case, "die upper/offset", values, "offset", timeout=options.timeout, move=move)
    runs.report_trend("sphere_offset", values, *line)


def by_growth(output, centre):
    """d(energy)/d(growth): the sensitivity by the punch's vertices times their normals, outwards from its centre."""
    _, points, gradients = retroforge.read_nodal(os.path.join(output, "sensitivity_die_upper_nodes.csv"))
    normals = points - centre
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return float(np.einsum("ki,ki->", gradients["energy"], normals))


def growth(options):
    """The centre stays where it is, so that the lowest point of the punch comes down by its growth."""
    case = write_case(options)
    values, energies, slopes = np.linspace(-0.3, 0.3, options.points), [], []
    print("| growth [mm] | energy [mJ] | slope | s |\n" + "| --- " * 4 + "|")
    for i, value in enumerate(values):
        settings = {"Die upper/file": punch("grown.stl", RADIUS + value, options.per_turn), "Die upper/point": f"0, 0, {60 + GAP - value!r}"}
        run = runs.forge(options.build, "gradient", case, f"growth_{i:02d}", settings, timeout=options.timeout)
        energies.append(run.energy)
        slopes.append(by_growth(run.output, (0, 0, 60 + GAP + RADIUS)) if run.ended else float("nan"))
        print(f"| {value:+.4f} | {run.energy:.9g} | {slopes[-1]:.6g} | {run.seconds:.1f} | {run.message[:150]}", flush=True)
    runs.report_trend("sphere_growth", values, energies, slopes)


def facets(options):
    """One sphere cut differently; the mesh of the billet is the same in all runs."""
    case, rng, found = write_case(options), np.random.default_rng(1), {}
    print("| facets per turn | turned by | energy [mJ] | d/d radius | s |\n" + "| --- " * 5 + "|")
    for per_turn in (40, 160, 640):
        for angle in [0.0] + list(rng.uniform(0, 90, options.turns)):
            file = punch("cut.stl", per_turn=per_turn, angle=angle)
            run = runs.forge(options.build, "gradient", case, f"facets_{per_turn}", {"Die upper/file": file}, timeout=options.timeout)
            found.setdefault(per_turn, []).append((run.energy, run.slope("billet/radius")))
            print(f"| {per_turn} | {angle:.2f} | {run.energy:.9g} | {found[per_turn][-1][1]:.6g} | {run.seconds:.1f} |", flush=True)
    finest = np.mean(found[640], axis=0)
    for per_turn, of_turns in found.items():
        for name, off in zip(("energy", "gradient"), np.abs(np.array(of_turns) / finest - 1.0).max(axis=0)):
            runs.figure(f"facets_{name}_{per_turn}", off)


def main():
    def more(parser):
        parser.add_argument("--points", type=int, default=17, help="number of values along a line")
        parser.add_argument("--per-turn", type=int, default=240, help="facets of the sphere per turn")
        parser.add_argument("--turns", type=int, default=3, help="random angles of `facets`")
    parts = {"radius": radius, "offset": offset, "growth": growth, "facets": facets}
    options = runs.arguments(__doc__, *parts, extra=more)
    parts[options.part](options)


if __name__ == "__main__":
    sys.exit(main())
