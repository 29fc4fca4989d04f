# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Forgings that cannot reach the end of their stroke say why, and keep what was computed. A billet of 20 x 20 x 20 mm fills a square cavity of
24 x 24 mm when it is 8000/576 = 13.889 mm high, after 6.111 mm; one stroke less is forged to its end. A bar that hangs between dies is carried
along by the die that comes first; where it finds no equilibrium, the bar is named and not its mesh. Usage: ends.py RETROFORGE"""
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import whole_runs  # noqa: E402
from whole_runs import history_of, judge, judge_message, prm, run  # noqa: E402

WIDTH, SIDE, DEPTH = 24.0, 20.0, 40.0
FULL = SIDE - SIDE**3 / WIDTH**2
CAVITY = prm(whole_runs.changed(whole_runs.cube(SIDE, 4, 7, 28), {
    "Die lower": {"shape": "stl", "file": "cavity.stl"}, "Output": {"fields every": 0}, "Remeshing": {"when": "quality"}}))
BAR = prm(whole_runs.changed(whole_runs.upsetting("cylinder", {"radius": 10, "height": 40}, 5, 22, 4, 10), {
    "Billet": {"symmetry planes": "", "rotation axis": "0, 1, 0", "rotation angle": 90, "translation": "0, 0, 11"},
    "Newton": {"max iterations": 3}, "Output": {"fields every": 0}, "Press": {"max cuts": 1}}))


def cavity():
    """A floor and four walls as STL, which face what is between them."""
    a = WIDTH / 2
    rim = [(-a, -a), (a, -a), (a, a), (-a, a)]
    quads = [[(x, y, 0.0) for x, y in rim]]
    quads += [[(*rim[i], 0.0), (*rim[i - 1], 0.0), (*rim[i - 1], DEPTH), (*rim[i], DEPTH)] for i in range(4)]
    facets = [(q[i], q[j], q[k]) for q in quads for i, j, k in ((0, 1, 2), (0, 2, 3))]
    lines = ["solid cavity"]
    for facet in facets:
        lines += ["facet normal 0 0 0", "outer loop"] + [f"vertex {x} {y} {z}" for x, y, z in facet] + ["endloop", "endfacet"]
    return "\n".join(lines + ["endsolid", ""])


def full_cavity():
    for stroke in (6.5, 7.0):
        done = run("simulate", f"to_{stroke}", f"Press/stroke={stroke}", "Press/increments=26", case="cavity.prm")
        judge_message(f"cavity overfull at {stroke} mm", done, r"Press/stroke: the cavity is full at")
        told = float(re.search(r"is full at ([\d.]+) mm", done.stderr)[1])
        judge(f"and it is full at {told} mm of {FULL:.4f}", abs(told - FULL) < 0.03)
        last = history_of(f"to_{stroke}")[-1]
        judge("what was forged before is kept", abs(float(last["stroke"]) - told) < 1e-3 and float(last["depth"]) < 0.2, str(last))
    done = run("simulate", "room", "Press/stroke=5.9", "Press/increments=24", case="cavity.prm")
    judge("cavity with room is forged", done.returncode == 0, done.stderr)


def carried_along():
    done = run("simulate", "bar", case="bar.prm")
    judge_message("bar between dies", done, r"Billet: stops at stroke .*(no die touches the billet|die upper alone touches the billet)")


whole_runs.main({"cavity.prm": CAVITY, "bar.prm": BAR, "cavity.stl": cavity()}, (full_cavity, carried_along))
