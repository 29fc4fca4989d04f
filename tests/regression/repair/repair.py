# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Metal thinner than an element is taken away in a run, which goes on, and its adjoint goes back across that: adjoint and tangent agree to
1e-10, replayed differences to 1e-6, by the positions of all nodes and by parameters of process and material. Where nothing may be taken
away, nothing is. Usage: repair.py RETROFORGE

Two blocks of cubes. One has a slot from one side to the middle, and at the slot's corner a tooth, that comes through the other wall as
the slot closes. The other has a node next to the middle of an upright edge, on a side: a cell flatter than a degree, which
the edge between two patches keeps."""
import itertools
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from block_meshes import block, msh, oriented  # noqa: E402
from whole_runs import changed, judge, main, prm, run, summary_of, upsetting  # noqa: E402

EDGE = 5.0  # of a cube, mm


def outer_faces(cells):
    """Faces that belong to one cell, by their corners."""
    count = {}
    for face in (tuple(sorted(face)) for cell in cells for face in itertools.combinations(cell, 3)):
        count[face] = count.get(face, 0) + 1
    return [face for face, cells_there in count.items() if cells_there == 1]


def gmsh(points, cells):
    """Its file, with two physical surfaces: `right`, at the largest x, and `skin`."""
    points = EDGE * np.array(points)
    right = points[:, 0] > points[:, 0].max() - 0.01 * EDGE
    elements = [(2, 1 + all(right[list(face)]), face) for face in outer_faces(cells)]
    elements += [(4, 3, cell) for cell in oriented(points, cells)]
    return msh(points.tolist(), elements, ((2, 1, "skin"), (2, 2, "right"), (3, 3, "body")))


def toothed():
    """4 x 3 x 4.5 cubes; the slot is half a cube wide, and the tooth as long as four fifths of that."""
    def place(corner):
        x, y, z = corner
        return (x, y, z if z <= 2 else z - 0.5 - (0.4 if corner == (4, 0, 3) else 0.0))
    return gmsh(*block((4, 3, 5), place, lambda cube: cube[0] >= 2 and cube[2] == 2))


def capped():
    """3 x 3 x 3 cubes, and a node at the upright edge x = y = 3, on the side x = 3."""
    points, cells = block((3, 3, 3))
    edge = [points.index((3, 3, z)) for z in (1, 2)]
    face = next(face for face in outer_faces(cells) if set(edge) < set(face) and all(points[k][0] == 3 for k in face))
    return gmsh([*points, (3.004, 2.998, 1.5)], [*cells, [*face, len(points)]])


def scene(name, height):
    """A block pressed from its whole height; nothing of it is a symmetry."""
    sections = upsetting("file", {}, 0, height, 1.5, 6)
    return changed({**sections, "Billet": {"shape": "file", "file name": f"{name}.msh"}}, {
        "Objectives": {"names": "energy, mean strain"}, "Design": {"parameters": "die upper/friction, material/m"},
        "Output": {"fields every": 0}, "Check": {"free differences": "false", "steps": "1e-5, 1e-6, 1e-7"}})


SCENES = {"toothed": changed(scene("toothed", 22.5), {"Remeshing": {"largest repair": 0.05}}),
          "capped": changed(scene("capped", 15.0), {"Remeshing": {"when": "increments", "every": 2}})}


def repaired_and_checked(name):
    done = run("check", name, case=f"{name}.prm")
    judge(f"{name}: adjoint, tangent and replayed differences agree", done.returncode == 0, done.stdout[-3000:] + done.stderr)
    summary = summary_of(name)
    judge(f"{name}: two objectives checked by nodes and two parameters", len(summary["check"]) == 6, [row["parameter"] for row in summary["check"]])
    judge(f"{name}: repaired", summary["volume_repaired"] > 0.0 and summary["remeshings"] > 0, summary["volume_repaired"])
    judge(f"{name}: said", "put back elsewhere" in done.stdout, done.stdout)
    lost = 1.0 - summary["volume_final"] / summary["volume_initial"]
    judge(f"{name}: the volume is put back", abs(lost) < 1e-4, lost)


def checks():
    for name in SCENES:
        repaired_and_checked(name)


def nothing_may_be_taken_away():
    done = run("simulate", "fold", "Remeshing/largest repair=0", case="toothed.prm")
    judge("toothed, nothing allowed: stops", done.returncode == 1 and "its surface crosses itself" in done.stderr, done.stderr)
    done = run("simulate", "sliver", "Remeshing/largest repair=0", case="capped.prm")
    judge("capped, nothing allowed: ends", done.returncode == 0, done.stderr)
    judge("capped, nothing allowed: not repaired", summary_of("sliver")["volume_repaired"] == 0.0)


main({"toothed.msh": toothed(), "capped.msh": capped(), **{f"{name}.prm": prm(sections) for name, sections in SCENES.items()}},
     (checks, nothing_may_be_taken_away))
