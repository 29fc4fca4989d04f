# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Blocks of cubes as tetrahedral meshes, and their Gmsh files: what tests of whole runs damage, or press."""
import itertools

import numpy as np


def block(n, place=lambda corner: corner, missing=lambda cube: False):
    """Points and tetrahedra, six to a cube around its diagonal (Kuhn), of n[0] x n[1] x n[2] cubes.
    @param place    where a corner of the grid is"""
    number, points, cells = {}, [], []
    for cube in itertools.product(*map(range, n)):
        for axes in itertools.permutations(range(3)) if not missing(cube) else ():
            walk = [cube]
            for axis in axes:
                walk.append(tuple(c + (i == axis) for i, c in enumerate(walk[-1])))
            for corner in walk:
                if corner not in number:
                    number[corner] = len(points)
                    points.append(place(corner))
            cells.append([number[corner] for corner in walk])
    return points, oriented(points, cells)


def oriented(points, cells):
    """The cells, all of positive volume."""
    x = np.array(points, float)
    return [cell if np.linalg.det(x[cell[1:]] - x[cell[0]]) > 0 else [cell[1], cell[0], *cell[2:]] for cell in cells]


def msh(points, elements, groups=()):
    """The text of a Gmsh file, version 2.2.
    @param elements  (kind, group, nodes from 0): kind 2 is a triangle, 4 a tetrahedron
    @param groups    (dimension, group, name)"""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
    if groups:
        lines += ["$PhysicalNames", len(groups), *(f'{dimension} {group} "{name}"' for dimension, group, name in groups), "$EndPhysicalNames"]
    lines += ["$Nodes", len(points), *(f"{k + 1} {x} {y} {z}" for k, (x, y, z) in enumerate(points)), "$EndNodes"]
    lines += ["$Elements", len(elements), *(" ".join(map(str, [i + 1, kind, 2, group, group, *(k + 1 for k in nodes)]))
                                            for i, (kind, group, nodes) in enumerate(elements)), "$EndElements", ""]
    return "\n".join(map(str, lines))


def msh_of_cube(n, side):
    """A cube of n^3 cubes on z = 0, without patches."""
    points, cells = block((n, n, n), lambda corner: tuple(side / n * x for x in corner))
    return msh(points, [(4, 1, cell) for cell in cells])
