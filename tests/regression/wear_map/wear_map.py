# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The largest wear along a die, with the lines of the manual's page on hot metal. Proved, on an upset quarter of a cylinder:
- the map of the run has the largest value, and its place, that the summary tells, and the value of the objective lies below by at most 10 %;
- what its sites have, each for its square, is the total wear to 3 %;
- metal slides along the rays: on two thirds of the radius the map hardly depends on the angle, and has little in the middle;
- a run with two ranks has the same map.
Usage: wear_map.py RETROFORGE"""
import csv
import os
import re
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, changed, command, judge, main, prm, run, start, summary_of, text_of, upsetting  # noqa: E402

SIZE, RADIUS = 2.5, 10.0
CASE = upsetting("cylinder", {"radius": RADIUS, "height": 16}, SIZE, 16, 4, 8)


def lines_of_the_page():
    """The section of the objective that the page shows."""
    page = text_of(ROOT, "doc/manual/hot_metal.md")
    return re.search(r"subsection Objective wear above\n(.*?)\n    end", page, re.S).group(1)


def map_of(output):
    rows = list(csv.reader(text_of(output, "map_wear_above.csv").splitlines()))
    judge("columns", rows[0] == ["x [mm]", "y [mm]", "z [mm]", "wear above [mJ/mm^2]"], rows[0])
    table = np.array(rows[1:], float)
    return table[:, :3], table[:, 3]


def wear_map():
    settings = dict(line.strip()[len("set "):].split("=") for line in lines_of_the_page().splitlines())
    settings = {name.strip(): value.strip() for name, value in settings.items()}
    judge("page asks for the largest", settings.get("wear") == "largest", settings)
    case = changed(CASE, {"Objectives": {"names": "wear above, all of it"}, "Objective wear above": settings,
                          "Objective all of it": {"type": "die wear", "wear": "total"}, "Output": {"fields every": 0}})
    with open("case.prm", "w", encoding="utf-8") as file:
        file.write(prm(case))
    done = run("simulate", "one")
    judge("run", done.returncode == 0, done.stderr)
    places, wear = map_of("one")
    found = {objective["name"]: objective for objective in summary_of("one")["objectives"]}
    largest, details = found["wear above"]["value"], found["wear above"]["details"]
    s = int(wear.argmax())
    judge("largest of the map", abs(wear[s] / details["true maximum"] - 1) < 1e-14)
    judge("its place", np.allclose(places[s], [details[f"at {axis} [mm]"] for axis in "xyz"], rtol=1e-14, atol=1e-14))
    judge("below the largest", 0.9 * wear[s] < largest < wear[s], largest / wear[s])
    # The radius is two sizes, and sites are half of it apart; a plane of symmetry halves the squares of those on it.
    total = (wear * np.prod(np.where(abs(places[:, :2]) < 1e-9, 0.5, 1.0), axis=1)).sum() * SIZE**2
    judge("total", abs(total / found["all of it"]["value"] - 1) < 0.03, total / found["all of it"]["value"])
    r = np.hypot(places[:, 0], places[:, 1])
    ring = wear[abs(r - 2 / 3 * RADIUS) < 0.5 * SIZE]
    judge("along a ring", len(ring) > 3 and ring.std() < 0.15 * ring.mean(), ring)
    judge("in the middle", wear[r < SIZE].max() < 0.7 * wear[s], wear[r < SIZE])
    done = start(["mpirun", "-np", "2", *command("simulate", "two")])
    judge("two ranks", done.returncode == 0, done.stderr)
    judge("the same map", np.allclose(map_of("two")[1], wear, rtol=1e-6, atol=1e-6 * wear[s]))


if __name__ == "__main__":
    main({}, (wear_map,))
