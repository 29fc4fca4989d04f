#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Scenes with dies made at random:   random_dies.py BUILD [--count 60] [--seed 1] [--only I] [--jobs 1]

Cavities and bosses of revolution, stamps without a face, V and U grooves and ridges, with roundings or sharp, above or below,
centred (a sector) or off the centre and tilted (the whole body). Each scene starts with the dies just touching the billet, leaves
at least 15 % of the height between them, and stands firm: friction where symmetry does not hold it. Scene I of a seed is always
the same. Writes random_dies.csv, and the table as it goes; each scene has a folder."""
import concurrent.futures
import csv
import os
import sys

import numpy as np

import dies
import runs

KINDS = ("cavity", "boss", "stamp", "V groove", "U groove", "V ridge", "U rib")
LEAST_GAP = 0.15  # of the billet's height, between the dies at the end
CELLS = 250  # volume over element size cubed, at most: keeps a run short


class Unfit(Exception):
    """What was drawn makes no sensible scene; draw again."""


def draw_billet(rng, box):
    """A cylinder or a box, its measures, and the volume of the whole."""
    height, radius = rng.uniform(20, 40), rng.uniform(10, 20)
    if height > 3 * radius:
        raise Unfit("it would buckle")
    sides = (2 * radius, rng.uniform(1.0, 1.6) * 2 * radius) if box else (2 * radius, 2 * radius)
    area = sides[0] * sides[1] if box else np.pi * radius**2
    return {"box": box, "height": height, "radius": radius, "sides": sides, "volume": area * height}


def draw_choices(rng):
    """What kind of scene it is, before its measures: no measure that does not fit makes a kind rarer."""
    kind = str(rng.choice(KINDS))
    whole, above = bool(rng.random() < 0.4), bool(rng.random() < 0.7) or kind == "stamp"
    sector = 0 if whole else 90 if kind not in KINDS[:3] else int(rng.choice([45, 60, 90, 180]))
    return {"kind": kind, "above": above, "sector": sector, "sharp": bool(rng.random() < 0.25), "small": bool(rng.random() < 0.2),
            "tilted": whole and above and bool(rng.random() < 0.6), "off": whole and bool(rng.random() < 0.7),
            "box": sector in (0, 90) and bool(rng.random() < 0.3)}


def draw_profile(rng, kind, sharp, radius, rim):
    """A profile r, z or x, z that fits the billet; roundings of 1 to 5 mm, or none."""
    edge, fillet = (0.0, 0.0) if sharp else rng.uniform(1, 5, 2)
    width, deep, draft = rng.uniform(0.35, 0.9) * radius, rng.uniform(0.25, 0.8) * radius, rng.uniform(3, 12)
    per_turn = int(rng.choice([48, 96, 144]))
    if kind in ("cavity", "boss") and width - deep * np.tan(np.radians(draft)) < 1.2 * fillet:
        raise Unfit("no room for the rounding at the bottom")
    try:
        if kind == "stamp":
            return dies.stamp_profile(width, 60.0, edge, 0.5, per_turn)
        if kind in ("cavity", "boss"):
            make = dies.cavity_profile if kind == "cavity" else dies.punch_profile
            edge, fillet = (edge, fillet) if kind == "cavity" else (fillet, edge)
            profile = make(width, deep, edge, fillet, draft, rim, per_turn)
        elif kind.startswith("V"):
            profile = dies.v_profile(width, deep if kind == "V groove" else -deep, fillet, edge, rim, per_turn)
        else:
            profile = dies.u_profile(width, deep if kind == "U groove" else -deep, fillet, edge, draft, rim, per_turn)
    except ValueError as problem:
        raise Unfit(str(problem)) from None
    if (np.diff(np.array(profile)[:, 0]) < -1e-9).any():
        raise Unfit("the roundings overlap")
    return profile


def footprint(billet, grow=1.0):
    """Points x, y all over the billet's base and along its rim."""
    n = 25
    if billet["box"]:
        u, v = np.meshgrid(np.linspace(-0.5, 0.5, n) * billet["sides"][0], np.linspace(-0.5, 0.5, n) * billet["sides"][1])
    else:
        r, a = np.meshgrid(np.linspace(0, 1, 13) * billet["radius"], np.linspace(0, 2 * np.pi, 49)[:-1])
        u, v = r * np.cos(a), r * np.sin(a)
    return grow * u.ravel(), grow * v.ravel()


def draw_pose(rng, facets, choices):
    """A die turned, tilted and shifted, as far as symmetry allows; in words too."""
    whole, revolution = choices["sector"] == 0, choices["kind"] in KINDS[:3]
    tilt = rng.uniform(1, 10) if choices["tilted"] else 0.0
    turn = rng.uniform(0, 360) if whole or revolution else 0.0
    shift = rng.uniform(-3, 3, 2) if choices["off"] else np.zeros(2)
    facets = dies.tilted(dies.turned(facets, (0, 0, 1), turn), tilt, rng.uniform(0, 360))
    return dies.shifted(facets, (*shift, 0.0)), f"tilt {tilt:.1f}, off {np.hypot(*shift):.1f}"


def place(facets, billet, above):
    """How far the die is moved along z so that it just touches the billet."""
    x, y = footprint(billet)
    sign = 1.0 if above else -1.0
    heights = dies.lowest(facets if above else dies.as_lower(facets), x, y if above else -y)  # turned over, y changes its sign
    if not np.isfinite(heights).any():
        raise Unfit("the die misses the billet")
    margin = 0.02 if above else 0.0
    return sign * (margin - heights.min()) + (billet["height"] if above else 0.0)


def closest_approach(facets, place_at, billet, stroke, above):
    """Least height between the curved die and the flat one opposite, at the end, where metal may come."""
    grow = 1.3 * np.sqrt(billet["height"] / (billet["height"] - stroke))
    x, y = footprint(billet, grow)
    heights = dies.lowest(facets if above else dies.as_lower(facets), x, y if above else -y)
    lowest = heights[np.isfinite(heights)].min()
    if above:
        return lowest + place_at - stroke
    return billet["height"] - stroke - (place_at - lowest)


def rim_of(rng, billet, small):
    """Radius of a face wide enough for the metal, or deliberately not."""
    half = max(billet["sides"]) / 2
    return half * rng.uniform(1.1, 1.4) if small else 1.6 * half * np.sqrt(1.0 / 0.3)


def draw_die(rng, choices, billet):
    """(facets of a die above or below, its pose in words)"""
    rim = rim_of(rng, billet, choices["small"])
    profile = draw_profile(rng, choices["kind"], choices["sharp"], billet["radius"], rim)
    revolution = choices["kind"] in KINDS[:3]
    facets = dies.revolved(profile, int(rng.choice([48, 96]))) if revolution else dies.extruded(profile, max(rim, 45.0))
    facets, pose = draw_pose(rng, facets, choices)
    return facets if choices["above"] else dies.as_lower(facets), pose


def draw_stroke(rng, facets, at, billet, above):
    """40 to 70 % of the height, less where the dies would come too close."""
    stroke = rng.uniform(0.4, 0.7) * billet["height"]
    while closest_approach(facets, at, billet, stroke, above) < LEAST_GAP * billet["height"]:
        stroke -= 0.02 * billet["height"]
        if stroke < 0.3 * billet["height"]:
            raise Unfit("too little way")
    return stroke


def draw_size(rng, billet, sector):
    """The element size, 3 to 6 mm, with no more elements than are quick."""
    size = max(rng.uniform(3, 6), (billet["volume"] * (sector / 360 if sector else 1.0) / CELLS) ** (1 / 3))
    if size > 6:
        raise Unfit("too large to be quick")
    return size


def draw(rng, choices):
    """One scene: (words, settings but for the file of the die, facets)."""
    billet = draw_billet(rng, choices["box"])
    above, sector = choices["above"], choices["sector"]
    facets, pose = draw_die(rng, choices, billet)
    at = place(facets, billet, above)
    stroke = draw_stroke(rng, facets, at, billet, above)
    friction = 0.0 if 0 < sector <= 90 and rng.random() < 0.15 else rng.uniform(0.1, 0.6)
    size = draw_size(rng, billet, sector)
    settings = settings_of(billet, sector, size, friction, stroke, at, above)
    settings["Press/increments"] = int(rng.choice([25, 40, 60]))
    words = {"kind": f"{choices['kind']} {'above' if above else 'below'}", "edges": "sharp" if choices["sharp"] else "round",
             "rim": "small" if choices["small"] else "wide", "pose": pose, "billet": "box" if billet["box"] else "cylinder",
             "sector": sector, "size": round(size, 2), "friction": round(friction, 2), "reduction": round(stroke / billet["height"], 2)}
    return words, settings, facets


def settings_of(billet, sector, size, friction, stroke, at, above):
    """The case's settings, but for the file of the curved die."""
    if billet["box"]:
        shape = {"Billet/shape": "box", "Billet/element size": size, "Billet/size": f"{billet['sides'][0]}, {billet['sides'][1]}, {billet['height']}"}
        if sector:
            shape["Billet/symmetry planes"] = "-1, 0, 0; 0, -1, 0"
    else:
        shape = runs.cylinder(billet["radius"], billet["height"], size, sector_angle=sector)
    curved, flat = ("upper", "lower") if above else ("lower", "upper")
    opposite = runs.plane(flat, 0 if above else billet["height"], 1 if above else -1, friction, 0 if above else -100)
    die = runs.stl(curved, f"{curved}.stl", (0, 0, at), "0, 0, -1" if above else "0, 0, 1", friction, -100 if above else 0)
    return {**shape, "Dies/names": "lower, upper", **opposite, **die, "Press/stroke": stroke, "Remeshing/when": "quality",
            "Output/fields every": 5}


def scene(seed, number):
    """Scene of a number, whatever others were drawn."""
    rng = np.random.default_rng([seed, number])
    choices = draw_choices(rng)
    for _ in range(10000):
        try:
            return draw(rng, choices)
        except Unfit:
            continue
    raise SystemExit(f"scene {number} of seed {seed}: {choices} fits nothing")


def run_scene(options, number):
    """Run one scene in its folder and measure it: a row of the table."""
    words, settings, facets = scene(options.seed, number)
    folder = os.path.abspath(f"scene_{options.seed}_{number:02d}")
    os.makedirs(folder, exist_ok=True)
    curved = "upper" if "above" in words["kind"] else "lower"
    if options.default_increments:
        settings["Press/increments"] = 0
    settings[f"Die {curved}/file"] = dies.write(os.path.join(folder, f"{curved}.stl"), facets)
    case = runs.write_case(os.path.join(folder, "scene.prm"), {**settings, **options.settings})
    run = runs.forge(options.build, "simulate", case, os.path.join(folder, "run"), timeout=options.timeout)
    increments, lost = run.history()
    return {"scene": number, **words, "outcome": run.outcome, "seconds": round(run.seconds, 1), "increments": increments,
            "nodes": run.nodes, "volume lost": f"{lost:.1e}", "depth": f"{run.depth() / words['size']:.4f}", "message": run.message[:200]}


def print_row(row):
    print("| " + " | ".join(str(value) for value in row.values()) + " |", flush=True)


def write_csv(rows):
    with open("random_dies.csv", "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows(sorted(rows, key=lambda row: row["scene"]))


def figures(rows, name):
    ended = [row for row in rows if row["outcome"] == "end"]
    depths, losses = ([float(row[key]) for row in ended] for key in ("depth", "volume lost"))
    runs.figure(f"{name}_missing", len(rows) - len(ended))
    runs.figure(f"{name}_hangs", sum(row["outcome"] == "timeout" for row in rows))
    runs.figure(f"{name}_crashes", sum(row["outcome"] == "crash" for row in rows))
    runs.figure(f"{name}_volume", np.abs(losses).max() if ended else float("nan"))
    runs.figure(f"{name}_depth", max(depths) if ended else float("nan"))
    runs.figure(f"{name}_depth_median", float(np.median(depths)) if ended else float("nan"))


def main():
    def more(parser):
        parser.add_argument("--count", type=int, default=60, help="number of scenes")
        parser.add_argument("--seed", type=int, default=1)
        parser.add_argument("--only", type=int, nargs="*", metavar="I", help="these scenes alone, counted from 0")
        parser.add_argument("--default-increments", action="store_true", help="as many as the default accuracy needs, instead of 25, 40 or 60")
        parser.add_argument("--jobs", type=int, default=1, help="scenes at the same time")
        parser.set_defaults(timeout=600.0)
    options = runs.arguments(__doc__, extra=more)
    numbers, rows = options.only or range(options.count), []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for done in concurrent.futures.as_completed([pool.submit(run_scene, options, number) for number in numbers]):
            rows.append(done.result())
            if len(rows) == 1:
                print("| " + " | ".join(rows[0]) + " |\n" + "| --- " * len(rows[0]) + "|")
            print_row(rows[-1])
            write_csv(rows)
    figures(rows, "random_default" if options.default_increments else "random")


if __name__ == "__main__":
    sys.exit(main())
