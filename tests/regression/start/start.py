# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""How dies stand to the billet before the first increment, and what a run sees of parts that are finer than its mesh.

A cone (radius 1 at height 3, as a cylinder up to 8) over the middle of a facet, a bar on its side whose true lowest
line is known whatever its mesh, the same billet whole and cut by planes, and dies of facets: each with the numbers
that follow by hand. Usage: start.py RETROFORGE"""
import math
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import changed, cube, history_of, judge, main, prm, run, summary_of, upsetting  # noqa: E402

NUMBER = r"(-?[\d.]+(?:e-?\d+)?)"
PLACE = rf"\({NUMBER}, {NUMBER}, {NUMBER}\)"


def stl(facets):
    """ASCII STL of facets of three points each."""
    lines = ["solid made"]
    for facet in facets:
        lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {x!r} {y!r} {z!r}" for x, y, z in facet), "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid", ""])


def revolved(contour, n):
    """Facets of n sectors about z, of a contour of (r, z) from the axis to the axis, seen from outside when it goes up."""
    def at(r, z, i):
        return (r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n), float(z)) if r else (0.0, 0.0, float(z))
    facets = []
    for (r, z), (s, y) in zip(contour, contour[1:]):
        for i in range(n):
            a, b, c, d = at(r, z, i), at(r, z, i + 1), at(s, y, i + 1), at(s, y, i)
            facets += [t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]
    return facets


def slab(x, y, z):
    """A closed box between pairs of coordinates."""
    p = [(float(a), float(b), float(c)) for c in z for b in y for a in x]
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return [t for a, b, c, d in quads for t in ((p[a], p[b], p[c]), (p[a], p[c], p[d]))]


WHOLE = {"Billet": {"symmetry planes": ""}, "Dies": {"names": "lower, upper"}}
CONE = changed(changed(cube(40, 5, 4, 8), WHOLE), {
    "Die upper": {"shape": "stl", "file": "cone.stl", "point": "1.7, 0.9, 40"}, "Output": {"fields every": 0}})
BAR = changed(changed(upsetting("cylinder", {"radius": 10, "height": 40}, 5, 20, 1, 20), WHOLE), {
    "Billet": {"rotation axis": "0, 1, 0", "rotation angle": 90, "translation": "0, 0, 10"}, "Output": {"fields every": 0}})
QUARTER = changed(cube(20, 5, 2, 8), {"Output": {"fields every": 0}})
ONE = ("Press/stroke=0.1", "Press/increments=1")
UNSEEN = r"warning: Die upper is (\S+) mm wide where it comes into the billet at .* contact does not see it; set Billet/element size = (\S+),"


def simulate(case, *settings):
    return run("simulate", "out", "--overwrite", *settings, case=case)


def tip_between_nodes():
    done = simulate("cone.prm", "Remeshing/when=never", "Press/stroke=0.6", "Press/increments=2")
    told = re.search(UNSEEN, done.stdout)
    # 0.6 deep it is 0.2 in radius, and its sides lean by atan(1/3): 0.4 cos(atan(1/3)) wide, less what its 24 sides cut off.
    width = 0.4 * math.cos(math.atan(1 / 3)) * math.cos(math.pi / 24)
    judge("a tip between nodes is told", done.returncode == 0 and told and abs(float(told[1]) / width - 1) < 0.01, done.stdout + done.stderr)
    judge("with a size that sees it", told and 0.9 * width < float(told[2]) <= width and "or Remeshing/when = quality and" in done.stdout)
    depth = [float(row["depth"]) for row in history_of("out")]
    judge("and how deep it is", len(depth) == 2 and abs(depth[0] - 0.3) < 0.02 and abs(depth[1] - 0.6) < 0.02, str(depth))
    judge("in the summary", summary_of("out")["deepest"]["die"] == "upper" and abs(summary_of("out")["deepest"]["depth"] - 0.6) < 0.02)
    done = simulate("cone.prm", "Press/stroke=2", "Press/increments=8")
    force = [float(row["force"]) for row in history_of("out")]
    # Indentation takes about three times the flow stress, 3.6 MPa, on the section of the tip, whose radius is a third of its depth.
    least = 3 * 3.6 * math.pi * (2 / 3) ** 2
    judge("where the mesh is refined at the start, it presses", done.returncode == 0 and force[-1] > least and "does not see" not in done.stdout,
          done.stdout + done.stderr)


def spike_in_the_billet():
    done = simulate("cone.prm", "Die upper/point=1.7, 0.9, 35", *ONE)
    told = re.search(rf"Die upper: a part of it stands 5 mm inside the billet, deepest at {PLACE}; .* move the die by {PLACE} mm, "
                     rf"to Die upper/point = {NUMBER}, {NUMBER}, {NUMBER},", done.stderr)
    judge("a spike in the billet is refused", done.returncode == 1 and done.stderr.count("\n") == 1 and told, done.stderr)
    if told:
        place, move, point = ([float(told[i]) for i in range(first, first + 3)] for first in (1, 4, 7))
        judge("at its tip", place == [1.7, 0.9, 35], str(place))
        judge("with the move that frees it", move[:2] == [0, 0] and 5 <= move[2] < 5.001 and abs(point[2] - 35 - move[2]) < 1e-4, str(move))
        done = simulate("cone.prm", "Die upper/point=" + ", ".join(map(str, point)), "Remeshing/when=never", *ONE)
        judge("which is accepted", done.returncode == 0 and not re.search("stands .* inside", done.stdout), done.stdout + done.stderr)


def same_bar_on_any_mesh():
    """The lower die stands at 0.2, the bar's lowest line at 0: 0.2 mm are told; 1.5 mm, more than 5 % of the cube root of
    its volume (1.16 mm), are refused; 0.02 mm touch."""
    for height, expected in ((0.02, ""), (0.2, "warning: Die lower: the billet stands (\\S+) mm inside it, deepest at .*free when the die "
                                               f"is moved by {PLACE} mm"),
                             (1.5, "Die lower: the billet stands (\\S+) mm inside it, deepest at ")):
        for size in (5, 8, 9):
            done = simulate("bar.prm", f"Die lower/point=0, 0, {height}", f"Billet/element size={size}", "Press/stroke=0.05", "Press/increments=1")
            found = re.search(expected, done.stdout + done.stderr)
            good = (found and abs(float(found[1]) - height) < 0.01) if expected else not re.search("stands .* inside", done.stdout + done.stderr)
            judge(f"bar {height} mm too low, elements of {size} mm", good and ("Die lower: " in done.stderr) == (height > 1), done.stdout + done.stderr)


def same_part_whole_or_cut():
    """0.015 mm touch in a billet of 20 mm, 0.03 mm do not, whichever part of it is meshed."""
    for height, told in ((19.985, False), (19.97, True)):
        for name, more in (("quarter", []), ("half", ["Billet/symmetry planes=-1, 0, 0"]), ("whole", ["Billet/symmetry planes="])):
            done = simulate("quarter.prm", f"Die upper/point=0, 0, {height}", *more, *ONE)
            judge(f"{name}, die at {height}", done.returncode == 0 and ("inside it" in done.stdout) == told, done.stdout + done.stderr)


def what_it_says():
    for name, settings, expected in (
            ("a die that moves away", ["Die upper/velocity=0, 0, 100"], r"Die upper: moves away from the billet: it starts 0 mm from it, .*; turn its velocity"),
            ("one that passes by", ["Die upper/shape=stl", "Die upper/file=beside.stl"], r"does not reach the billet, .* it starts 5 mm away, .* and passes by;"),
            ("one that comes too late", ["Die upper/shape=stl", "Die upper/file=cone.stl", "Die upper/point=3, 3, 23"],
             rf"starts 3 mm away and meets it after 3 mm, at \(3, 3, 20\), and the stroke is 2 mm;"),
            ("facets that look the wrong way", ["Die upper/shape=stl", "Die upper/file=turned.stl"], r"turn the facets of its file round"),
            ("a plane that faces the wrong way", ["Die upper/facing=0, 0, 1"], r"turn the die's facing round"),
            ("a blade in the billet", ["Die upper/shape=stl", "Die upper/file=blade.stl", "Die upper/point=0, 3, 17"],
             r"a part of it stands 3 mm inside the billet")):
        done = simulate("quarter.prm", *settings)
        judge(name, done.returncode == 1 and done.stderr.count("\n") == 1 and re.search(expected, done.stderr), done.stderr)


def dies_drawn_anew():
    """A die that another drawing brings 0.2 mm into the billet begins as one that a design brings there, and it is told."""
    for name, upper in (("as before", "flat.stl"), ("drawn anew", "lower_flat.stl")):
        done = simulate("quarter.prm", "Die upper/shape=stl", f"Die upper/file={upper}", "Die upper/point=0, 0, 20", *ONE)
        told = re.search(rf"warning: Die upper: the billet stands 0.2 mm inside it, .* moved by \(0, 0, 0.2\S*\) mm", done.stdout)
        judge(f"die {name}", done.returncode == 0 and bool(told) == (upper == "lower_flat.stl"), done.stdout + done.stderr)


def rims_and_chamfers():
    done = simulate("quarter.prm", "Die upper/shape=stl", "Die upper/file=short.stl", "Die upper/point=0, 0, 20", *ONE)
    judge("a die short of a plane of symmetry", len(re.findall(r"warning: Die upper ends 0.01 mm before the plane symmetry", done.stdout)) == 2,
          done.stdout + done.stderr)


def quarter_sheet(begin, end, height):
    corners = [(x, y, height) for x, y in ((begin, begin), (begin, end), (end, end), (end, begin))]
    return [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]


FILES = {"cone.stl": revolved(((0, 0), (1, 3), (1, 8), (0, 8)), 24), "beside.stl": slab((15, 20), (-5, 5), (0, 5)),
         "flat.stl": slab((-15, 15), (-15, 15), (0, 5)), "lower_flat.stl": slab((-15, 15), (-15, 15), (-0.2, 5)),
         "turned.stl": [facet[::-1] for facet in slab((-15, 15), (-15, 15), (0, 5))],
         "blade.stl": slab((-15, 15), (-0.2, 0.2), (0, 5)), "short.stl": quarter_sheet(0.01, 15.0, 0.0)}

main({**{name: stl(facets) for name, facets in FILES.items()}, "cone.prm": prm(CONE), "bar.prm": prm(BAR), "quarter.prm": prm(QUARTER)},
     (tip_between_nodes, spike_in_the_billet, same_bar_on_any_mesh, same_part_whole_or_cut, what_it_says, dies_drawn_anew, rims_and_chamfers))
