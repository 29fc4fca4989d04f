# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Billets that dies touch along lines or at points only, and first equilibria.

A mesh feels the narrow contact of a round bar on its side, or of a block on its edge, as a line: nothing in its equations keeps the
body from rolling, and a run ends in the first increments unless what is loose is held. Here each such body is forged, in at most
MOST Newton steps an increment with both of its stages, or the message names the motion. Usage: loose_billets.py RETROFORGE"""
import math
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import changed, history_of, judge, main, prm, run, summary_of, text_of, upsetting  # noqa: E402

MOST = 30


def stl(facets):
    lines = ["solid made"]
    for facet in facets:
        lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {x!r} {y!r} {z!r}" for x, y, z in facet), "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid", ""])


def sheet(points, up):
    """Facets over a grid of rows of points, seen from above or from below."""
    facets = []
    for row, after in zip(points, points[1:]):
        for a, d, b, c in zip(row, row[1:], after, after[1:]):
            facets += [t if up else t[::-1] for t in ((a, b, c), (a, c, d))]
    return facets


def groove(side):
    """A half round groove of radius 9.5 along x, 150 degrees of it, with level lands; side -1: the lower die."""
    angles = [math.radians(75 * (i / 12 - 1)) for i in range(25)]
    contour = [(9.5 * math.sin(a), side * 9.5 * math.cos(a)) for a in angles]
    land = side * 0.75
    rows = [(-30.0, land), (contour[0][0] - 2, land), *contour, (contour[-1][0] + 2, land), (30.0, land)]
    return sheet([[(x, y, z) for y, z in rows] for x in (-40.0, 60.0)], side < 0)


def bell(n):
    """A Gaussian 4 mm high, over a plane that looks down."""
    at = [30 * (2 * i / n - 1) for i in range(n + 1)]
    return sheet([[(x, y, -4 * math.exp(-(x * x + y * y) / 50)) for y in at] for x in at], False)


ALONE = {"Billet": {"symmetry planes": ""}, "Output": {"fields every": 0}, "Remeshing": {"when": "never"}, "Objectives": {"names": "energy"},
         "Dies": {"names": "lower, upper"}}


def scene(*what, **more):
    return changed(changed(upsetting(*what), ALONE), more)


def bar(size, radius=10, length=40, stroke=1, increments=20):
    return scene("cylinder", {"radius": radius, "height": length}, size, 2 * radius, stroke, increments,
                 Billet={"rotation axis": "0, 1, 0", "rotation angle": 90, "translation": f"0, 0, {radius}"})


def tilted(case, point, degrees, axis):
    """The upper die turned; axis 0: its normal leans along x."""
    lean = [0.0, 0.0, -math.cos(math.radians(degrees))]
    lean[axis] = math.sin(math.radians(degrees))
    return changed(case, {"Die upper": {"facing": ", ".join(map(repr, lean)), "point": ", ".join(map(repr, point))}})


BOX = {"size": "20, 20, 20"}
ROD = {"Billet": {"translation": "0, 0, 0"}, "Die lower": {"shape": "stl", "file": "groove_lower.stl", "point": "0, 0, -0.6"},
       "Die upper": {"shape": "stl", "file": "groove_upper.stl", "point": "0, 0, 0.6"}, "Press": {"stroke": 0.5, "increments": 10}}
EDGE = scene("box", BOX, 5, 20 * math.sqrt(2), 1, 10, Billet={"rotation axis": "1, 0, 0", "rotation angle": 45, "translation": f"0, 0, {10 / math.sqrt(2)!r}"})
SLIPPERY = {"Die lower": {"friction": 0}, "Die upper": {"friction": 0}}
BLOCK = scene("box", BOX, 5, 20, 1, 10)
FILES = {"groove_lower.stl": stl(groove(-1)), "groove_upper.stl": stl(groove(1)), "bell.stl": stl(bell(40)),
         **{f"bar{size}.prm": prm(bar(size)) for size in (5, 6, 8)},
         **{f"rod{size}.prm": prm(changed(bar(size), ROD)) for size in (5, 6, 8)},
         "slender.prm": prm(bar(4, 5, 120, 0.3, 6)), "edge.prm": prm(EDGE),
         "bell.prm": prm(scene("box", {"size": "30, 30, 20"}, 5, 20, 2, 10, **{
             "Die upper": {"shape": "stl", "file": "bell.stl", "point": "0, 0, 24"}, "Material": {"strain rate sensitivity": 0.01}})),
         "slope.prm": prm(tilted(BLOCK, (-10.0, 0.0, 20.0), 10, 0)),
         "wedge.prm": prm(tilted(bar(5), (20.0, -10 * math.sin(math.radians(10)), 10 + 10 * math.cos(math.radians(10))), 10, 1))}


def forged():
    for name in ("bar5", "bar6", "bar8", "rod5", "rod6", "rod8", "slender", "edge", "bell", "slope"):
        done = run("simulate", name, "--overwrite", case=name + ".prm")
        judge(f"{name}: ends", done.returncode == 0, done.stderr)
        is_loose = name.startswith("bar") or name in ("slender", "edge")
        judge(f"{name}: what is held is told", ("warning: dies touch the billet along lines" in done.stdout) == is_loose, done.stdout)
        steps = [int(row["newton"]) for row in history_of(name)]
        judge(f"{name}: Newton steps", steps and max(steps) <= MOST, steps)
        change = summary_of(name)["volume_final"] / summary_of(name)["volume_initial"] - 1
        # In one increment of bar6 a whole row of nodes arrives, which makes 4e-4 of its volume.
        judge(f"{name}: volume", abs(change) < (5e-4 if name == "bar6" else 1e-4), change)


def any_solver():
    """The hold stands in the direct solver's matrix by rows of its own, and in a Krylov operator as a product."""
    energies = [summary_of("edge")["objectives"][0]["value"]]
    for method in ("direct", "multigrid"):
        done = run("simulate", method, f"Linear solver/method={method}", case="edge.prm")
        judge(f"{method}: ends", done.returncode == 0, done.stderr)
        energies.append(summary_of(method)["objectives"][0]["value"])
    judge("solvers: the same energy", max(energies) / min(energies) - 1 < 1e-7, energies)


def half_of_it():
    """What is held bears nothing where the body is symmetric: a half, which a plane keeps from rolling, has half the energy."""
    done = run("simulate", "half", "Billet/symmetry planes=0, -1, 0", "Press/stroke=0.2", "Press/increments=4", case="bar6.prm")
    judge("half: ends", done.returncode == 0, done.stderr)
    done = run("simulate", "whole", "Press/stroke=0.2", "Press/increments=4", case="bar6.prm")
    whole, half = (summary_of(name)["objectives"][0]["value"] for name in ("whole", "half"))
    # Two meshes: their energies differ as those of meshes with elements of 5 and 6 mm do.
    judge("half: energy", abs(whole / (2 * half) - 1) < 0.2, (whole, half))


def derivatives():
    """Adjoint, tangent and replay know what the hold does. Only the hold's number in the free run follows the consistency."""
    done = run("check", "check", "Press/stroke=0.15", "Press/increments=3", "Design/parameters=billet/radius, material/K, die upper/offset",
               "Check/taylor start=3e-6", case="bar6.prm")
    judge("derivatives pass", done.returncode == 0 and done.stdout.count("passed") >= 4, done.stdout + done.stderr)
    agreement = [abs(float(x)) for x in re.findall(r"^  \S.*?e[+-]\d+ +(-?\d\.\de[+-]\d+) ", done.stdout, re.MULTILINE)]
    judge("adjoint against tangent", len(agreement) >= 4 and max(agreement) < 1e-9, agreement)


def resumed():
    settings = ("Press/stroke=0.2", "Press/increments=4")
    run("gradient", "at_once", *settings, case="bar8.prm")
    run("gradient", "in_two", "Press/stroke=0.1", "Press/increments=2", case="bar8.prm")
    done = run("gradient", "in_two", "--resume", *settings, case="bar8.prm")
    judge("resumed: ends", done.returncode == 0, done.stderr)
    judge("resumed: energy and gradient", summary_of("in_two")["objectives"] == summary_of("at_once")["objectives"])
    judge("resumed: steps", [row["newton"] for row in history_of("in_two")] == [row["newton"] for row in history_of("at_once")])


def told():
    for name, case, settings, expected in (
            ("a bar squeezed out", "wedge.prm", [], r"^retroforge: Billet: at stroke 0 mm its dies press it aside, .* slide along \(0, 0\.9.*% of their force;"),
            ("a slippery block under a slope", "slope.prm", SLIPPERY, r"^retroforge: Billet: no die holds it: it is free to slide along y"),
            ("half of it", "slope.prm", {**SLIPPERY, "Billet": {"symmetry planes": "0, -1, 0"}}, r"^retroforge: Billet: at stroke 0 mm its dies press it aside, .* slide along \(0\.9"),
            ("a bar that nothing holds", "bar6.prm", {"Contact": {"loose billet": "free"}, "Press": {"max cuts": 2}},
             r"^retroforge: Billet: stops at .* along lines or at points only: it is free to slide along x, slide along y, turn about x")):
        words = [f"{section}/{key}={value}" for section, of in dict(settings).items() for key, value in of.items()]
        done = run("simulate", "told", "--overwrite", *words, case=case)
        judge(name, done.returncode == 1 and done.stderr.count("\n") == 1 and re.search(expected, done.stderr), done.stderr)


def unchanged():
    """A block whose faces touch is not held: with and without, it has the same bits."""
    rows = []
    for loose in ("held", "free"):
        done = run("simulate", loose, f"Contact/loose billet={loose}", "Press/stroke=0.5", "Press/increments=5", case="slope.prm")
        judge(f"{loose}: ends", done.returncode == 0, done.stderr)
        rows.append(text_of(loose, "history.csv").splitlines())
    columns = [[row.split(",")[:5] for row in of] for of in rows]
    judge("the same bits", columns[0] == columns[1], columns)


if __name__ == "__main__":
    main(FILES, (forged, any_solver, half_of_it, derivatives, resumed, told, unchanged))
