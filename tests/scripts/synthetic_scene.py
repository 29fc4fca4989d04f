# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The folder of a scene made up by formulas: a quarter of a box, SIDE high, that stands 1 mm inside a plane die, a second die 2 mm above."""
import json

import numpy as np
from synthetic_run import SIDE, cube, write_vtu

REFUSAL = "Die lower: the billet stands <1 mm> inside it; a billet starts outside of all dies; move the die"
WARNING = "warning: Material/consistency = 200: the consistency is in MPa s^m"
PLANES = np.array([[0.0, 0, 0, -1, 0, 0], [0.0, 0, 0, 0, -1, 0]])


def plane(height, upwards):
    """Points and triangles of a square."""
    low, high = -10.0, SIDE + 10
    points = np.array([(low, low, height), (high, low, height), (high, high, height), (low, high, height)])
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    return points, triangles if upwards else triangles[:, ::-1]


def write(directory, refused=True, with_billet=True, with_dies=True):
    directory.mkdir(parents=True, exist_ok=True)
    points, cells = cube(3)
    depth = 1.0 if refused else 0.0
    if with_billet:
        gap = np.minimum(points[:, 2] - depth, SIDE + 2 - points[:, 2])
        file = directory / "scene_billet.vtu"
        write_vtu(file, points, cells, {"gap [mm]": gap}, {}, "zlib")
        numbers = " ".join(str(x) for x in PLANES.reshape(-1))
        field = f'<FieldData><DataArray type="Float64" Name="symmetry_planes" NumberOfComponents="6" format="ascii">{numbers}</DataArray></FieldData>'
        file.write_text(file.read_text().replace("<UnstructuredGrid>", "<UnstructuredGrid>" + field, 1))
    dies = []
    if with_dies:
        write_vtu(directory / "scene_die_lower.vtu", *plane(depth, True), {}, {}, "ascii")
        write_vtu(directory / "scene_die_upper.vtu", *plane(SIDE + 2, False), {}, {}, "ascii")
        common = {"shape": "plane", "facets": 1, "extents": None, "friction": 0.3, "smallest_size": None}
        lower = {**common, "name": "lower", "point": [0, 0, depth], "facing": [0, 0, 1], "velocity": [0, 0, 0], "leads": False,
                 "gap": {"distance": 0, "place": [0, 0, 0]}, "touches": not refused}
        if refused:
            lower["overlap"] = {"distance": 1, "place": [SIDE, SIDE, 0], "of_the_die": False, "frees": [0, 0, -1]}
        touch = {"distance": 2, "place": [SIDE / 2, SIDE / 2, SIDE], "stroke": 2}
        upper = {**common, "name": "upper", "point": [0, 0, SIDE + 2], "facing": [0, 0, -1], "velocity": [0, 0, -100], "leads": True,
                 "gap": {"distance": 2, "place": [SIDE / 2, SIDE / 2, SIDE]}, "touches": False, "first_touch": touch, "moves_away": False}
        dies = [lower, upper]
    scene = {"schema": 1, "command": "scene", "version": "0.1.0", "commit": "0000000", "case": "box.prm",
             "refusals": [REFUSAL] if refused else [], "warnings": [WARNING], "dies": dies, "wall_seconds": 0.3}
    if with_billet:
        scene["billet"] = {
            "shape": "box", "extents": [[0, 0, 0], [SIDE] * 3], "nodes": len(points), "cells": len(cells), "element_size": 17,
            "shortest_edge": SIDE / 3, "longest_edge": SIDE / 3 * 2**0.5, "smallest_angle": 45, "volume": SIDE**3,
            "volume_of_shape": 1.01 * SIDE**3, "whole": {"copies": 4, "force_factor": 4}, "patches": [{"name": "top", "area": SIDE**2}],
            "symmetry_planes": [{"name": f"symmetry {i + 1}", "point": list(p[:3]), "normal": list(p[3:])} for i, p in enumerate(PLANES)]}
    if with_dies:
        scene["press"] = {"leading_die": "upper", "stroke": 10, "seconds": 0.1, "increments": 20 if with_billet else 0}
        scene["estimate"] = {"name": "slab method", "speed": 100, "strain_rate": 2, "stress": 30, "first_force": 1.25e5, "final_force": None}
    (directory / "scene.json").write_text(json.dumps(scene))
