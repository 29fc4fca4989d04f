# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A scene turned as a whole, billet, dies and velocity, by two rotations one after the other, and by the one they make together: the
same energy and the same gradients, of the billet's measures and of the die's place too. Usage: rotations.py RETROFORGE

By hand: numpy's product of the two matrices, the second one in front; its axis is what it leaves as it is."""
import os
import pathlib
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, changed, judge, main, prm, run, summary_of, upsetting, write  # noqa: E402

sys.path.insert(0, os.path.join(ROOT, "prm", "tutorial", "hub"))
import make_die  # noqa: E402

TURNS = ((1, 2, 3, 37), (-2, 1, 0.4, 143))
UPRIGHT = changed(upsetting("cylinder", {"radius": 10, "height": 15}, 5, 15, 3, 6), {
    "Die upper": {"shape": "stl", "file": "cone.stl", "rotation axis": "0, 0, 1", "rotation angle": 20},
    "Newton": {"tolerance": 1e-12}, "Adjoint": {"tolerance": 1e-14}, "Output": {"fields every": 0},
    "Design": {"parameters": "billet/radius, billet/height, die upper/offset, die upper/speed, dies/friction"}})


def matrix(x, y, z, degrees):
    """Rodrigues' formula."""
    axis = np.array([x, y, z]) / np.linalg.norm([x, y, z])
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def axis_and_angle(turned):
    values, vectors = np.linalg.eig(turned)
    axis = np.real(vectors[:, np.argmin(abs(values - 1))])
    angle = np.degrees(np.arccos((np.trace(turned) - 1) / 2))
    return axis, angle if np.allclose(matrix(*axis, angle), turned) else -angle


def text(numbers):
    return ", ".join(repr(float(x)) for x in numbers)


def listed(turns):
    return "; ".join(text(turn) for turn in turns)


def results(name, scene):
    write(f"{name}.prm", prm(scene))
    done = run("gradient", name, case=f"{name}.prm")
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    summary = summary_of(name)
    return np.array([summary["objectives"][0]["value"], *(p["gradient"]["energy"] for p in summary["parameters"])])


def turned_alike():
    make_die.FACETS_PER_TURN = 16
    make_die.write_stl(pathlib.Path("cone.stl"), make_die.revolved([(float(r), 0.1 * (15 - r)) for r in range(0, 31, 5)]))
    whole = np.eye(3)
    for turn in TURNS:
        whole = matrix(*turn) @ whole
    axis, angle = axis_and_angle(whole)
    dies = {f"Die {name}": {key: text(whole @ [float(x) for x in UPRIGHT[f"Die {name}"][key].split(",")])
                            for key in ("point", "facing", "velocity") if key in UPRIGHT[f"Die {name}"]} for name in ("lower", "upper")}
    twice = changed(UPRIGHT, {"Billet": {"rotations": listed(TURNS)}, **dies})
    upper = twice["Die upper"]
    del upper["rotation axis"], upper["rotation angle"]
    upper["rotations"] = listed(((0, 0, 1, 20), *TURNS))
    once = changed(twice, {"Billet": {"rotation axis": text(axis), "rotation angle": repr(float(angle))}})
    del once["Billet"]["rotations"]
    upright = results("upright", UPRIGHT)
    for name, scene in (("twice", twice), ("once", once)):
        error = np.abs(results(name, scene) / upright - 1).max()
        judge(f"{name}: energy and gradients are those of the upright scene", error < 1e-8, f"{error:.1e}")
        print(f"  {error:.1e}")


main({}, (turned_alike,))
