#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Writes hub_die.stl: an upper die with a hub cavity of revolution, as a binary STL.

The working face is at z = 0, the cavity goes up from there, and all normals point to the workpiece. To forge another hub, change
the measures below and run `make_die.py`, or `make_die.py FILE` to write elsewhere.
"""
import pathlib
import struct
import sys

import numpy as np

RADIUS, DEPTH, DRAFT = 12.0, 14.0, 7.0  # of the hub at the face [mm], of the cavity [mm], of the wall [degrees]
FILLET, EDGE = 3.0, 3.0  # radii at the roof and at the face [mm]
OUTER_RADIUS = 45.0  # of the face [mm]
FACETS_PER_ROUNDING, FACETS_PER_TURN = 8, 96


def arc(centre, radius, begin, end):
    """Points (r, z), angles in degrees."""
    angles = np.radians(np.linspace(begin, end, FACETS_PER_ROUNDING + 1))
    return [(centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)) for a in angles]


def contour():
    """Points (r, z) from the axis outwards: roof, fillet, wall with draft, edge, face."""
    slope, slant = np.tan(np.radians(DRAFT)), np.cos(np.radians(DRAFT))
    z = DEPTH - FILLET
    fillet = arc((RADIUS - z * slope - FILLET / slant, z), FILLET, 90, DRAFT)
    edge = arc((RADIUS - EDGE * slope + EDGE / slant, EDGE), EDGE, 180 + DRAFT, 270)
    return [(0.0, DEPTH), *fillet, *edge, (OUTER_RADIUS, 0.0)]


def revolved(points):
    """Triangles (n, 3, 3) whose right-handed normals point down, to the workpiece."""
    angles = np.linspace(0, 2 * np.pi, FACETS_PER_TURN + 1)
    rings = np.array([[(r * np.cos(a), r * np.sin(a), z) for a in angles] for r, z in points])
    triangles = []
    for inner, outer in zip(rings[:-1], rings[1:]):
        for k in range(FACETS_PER_TURN):
            triangles.append((inner[k], outer[k + 1], outer[k]))
            if inner[k] @ inner[k] > inner[k][2]**2:  # off the axis
                triangles.append((inner[k], inner[k + 1], outer[k + 1]))
    return np.array(triangles)


def write_stl(path, triangles):
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    with open(path, "wb") as file:
        file.write(b"hub die, mm".ljust(80) + struct.pack("<I", len(triangles)))
        for normal, corners in zip(normals, triangles):
            file.write(struct.pack("<12fH", *normal, *corners.ravel(), 0))


if __name__ == "__main__":
    write_stl(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "hub_die.stl", revolved(contour()))
