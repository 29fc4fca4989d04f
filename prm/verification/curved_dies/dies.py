#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Surfaces of dies as arrays of triangles, n x 3 corners x 3 coordinates, and as STL files:   dies.py [FOLDER]

All are drawn as upper dies: the working face lies at z = 0, cavities reach up (z > 0), punches down, and the normals point
down to the workpiece. `as_lower` turns a die over. A profile is a polyline r, z from the axis outwards (of an extrusion x, z
from -x to +x); `rounded` puts arcs into its corners. In files all digits of a double are written.

As a program it writes the dies of the hub: hub.stl and small.stl, whose face ends at radius 20.
"""
import os
import sys

import numpy as np

RIM = 45.0  # radius at which a face ends, unless said otherwise [mm]


# ---- profiles ----

def arc(centre, radius, begin, end, per_turn):
    """Points of an arc from one angle to another [degrees], both ends included, with `per_turn` segments in a full circle."""
    n = max(1, int(np.ceil(per_turn * abs(end - begin) / 360.0 - 1e-9)))
    angles = np.radians(np.linspace(begin, end, n + 1))
    return [(centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)) for a in angles]


def rounded_corner(before, corner, after, radius, per_turn):
    """The arc that rounds one corner of a polyline; the corner itself for radius 0 or no turn."""
    before, corner, after = (np.asarray(p, float) for p in (before, corner, after))
    into, out = (corner - before) / np.linalg.norm(corner - before), (after - corner) / np.linalg.norm(after - corner)
    turn = np.arctan2(into[0] * out[1] - into[1] * out[0], into @ out)
    if radius <= 0.0 or abs(turn) < 1e-9:
        return [tuple(corner)]
    length = radius * np.tan(abs(turn) / 2.0)
    if length > min(np.linalg.norm(corner - before), np.linalg.norm(after - corner)):
        raise ValueError(f"a radius of {radius} does not fit into the corner {tuple(corner)}")
    side = np.sign(turn)
    centre = corner - length * into + radius * side * np.array([-into[1], into[0]])
    begin = np.degrees(np.arctan2(*(corner - length * into - centre)[::-1]))
    return arc(centre, radius, begin, begin + np.degrees(turn), per_turn)


def rounded(corners, radii, per_turn):
    """A polyline with its inner corners rounded; `radii` of the corners without the two ends."""
    points = [tuple(corners[0])]
    for i, radius in enumerate(radii, 1):
        points += rounded_corner(corners[i - 1], corners[i], corners[i + 1], radius, per_turn)
    return points + [tuple(corners[-1])]


def cavity_profile(mouth, depth, edge, fillet, draft=7.0, rim=RIM, per_turn=96):
    """A cavity in a flat face: `mouth` is the radius where wall and face would meet, `edge` rounds there, `fillet` at the roof."""
    top = mouth - depth * np.tan(np.radians(draft))
    return rounded([(0.0, depth), (top, depth), (mouth, 0.0), (rim, 0.0)], [fillet, edge], per_turn)


def punch_profile(foot, height, edge, fillet, draft=7.0, rim=RIM, per_turn=96):
    """A boss on a flat face: `foot` is its radius at the face, `edge` rounds its end, `fillet` its foot."""
    end = foot - height * np.tan(np.radians(draft))
    return rounded([(0.0, -height), (end, -height), (foot, 0.0), (rim, 0.0)], [edge, fillet], per_turn)


def stamp_profile(radius, height, edge, draft=0.5, per_turn=96):
    """A cylindrical punch: a flat end at z = 0 and a wall upwards, with no face around it."""
    return rounded([(0.0, 0.0), (radius, 0.0), (radius + height * np.tan(np.radians(draft)), height)], [edge], per_turn)


def sphere_profile(radius, polar=60.0, per_turn=240):
    """A cap of a sphere that touches z = 0 from above, up to a polar angle [degrees]."""
    points = arc((0.0, radius), radius, -90.0, polar - 90.0, per_turn)
    return [(0.0, 0.0)] + points[1:]


def hub_profile(rim=RIM, per_turn=96, segments=8):
    """That of the scene hub: mouth 12, depth 14, draft 7 degrees, roundings of 3; `segments` on each of the two arcs."""
    turn = 83.0  # degrees each arc turns by
    return cavity_profile(12.0, 14.0, 3.0, 3.0, 7.0, rim, min(per_turn, segments * 360.0 / turn))


def v_profile(half_width, depth, bottom, edge, reach=RIM, per_turn=96):
    """A V groove in a flat face; a ridge for a negative depth."""
    corners = [(-reach, 0.0), (-half_width, 0.0), (0.0, depth), (half_width, 0.0), (reach, 0.0)]
    return rounded(corners, [edge, bottom, edge], per_turn)


def u_profile(half_width, depth, bottom, edge, draft=7.0, reach=RIM, per_turn=96):
    """A U groove in a flat face; a rib for a negative depth."""
    floor = half_width - abs(depth) * np.tan(np.radians(draft))
    corners = [(-reach, 0.0), (-half_width, 0.0), (-floor, depth), (floor, depth), (half_width, 0.0), (reach, 0.0)]
    return rounded(corners, [edge, bottom, bottom, edge], per_turn)


# ---- surfaces ----

def revolved(profile, per_turn=96, angle=0.0):
    """The body of revolution of a profile that begins on the axis; `angle` turns its pattern of facets [degrees]."""
    turn = np.radians(angle) + 2.0 * np.pi * np.arange(per_turn) / per_turn
    cos, sin = np.cos(turn), np.sin(turn)

    def ring(r, z):
        return np.column_stack([r * cos, r * sin, np.full(per_turn, z)])
    facets = []
    for inner, outer in zip(profile, profile[1:]):
        a, b = ring(*inner), ring(*outer)
        c, d = np.roll(b, -1, axis=0), np.roll(a, -1, axis=0)
        facets.append(np.stack([a, c, b], axis=1))
        if inner[0] > 0.0:
            facets.append(np.stack([a, d, c], axis=1))
    return np.concatenate(facets)


def extruded(profile, half_length=RIM):
    """A profile in x and z extruded along y to both sides."""
    facets = []
    for (x, z), (u, w) in zip(profile, profile[1:]):
        a, b, c, d = (x, -half_length, z), (u, -half_length, w), (u, half_length, w), (x, half_length, z)
        facets += [(a, c, b), (a, d, c)]
    return np.array(facets)


def rotation(axis, angle):
    """The matrix of a rotation about an axis through the origin [degrees]."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    a = np.radians(angle)
    return np.eye(3) + np.sin(a) * cross + (1.0 - np.cos(a)) * cross @ cross


def turned(facets, axis, angle):
    return facets @ rotation(axis, angle).T


def tilted(facets, angle, direction=0.0):
    """Tilted by an angle about the horizontal axis that points in a direction, both in degrees, x being 0."""
    return turned(facets, (np.cos(np.radians(direction)), np.sin(np.radians(direction)), 0.0), angle)


def shifted(facets, by):
    return facets + np.asarray(by, float)


def as_lower(facets):
    """Turned over: the face looks up."""
    return turned(facets, (1.0, 0.0, 0.0), 180.0)


def hub(rim=RIM, per_turn=96, segments=8, angle=0.0):
    return revolved(hub_profile(rim, 360, segments), per_turn, angle)


def sphere(radius=30.0, per_turn=240, angle=0.0, polar=60.0):
    return revolved(sphere_profile(radius, polar, per_turn), per_turn, angle)


def lobed_pan(per_turn=96):
    """A pan 7 mm deep within r = 15 + 2 cos 3 phi, its wall 5 mm wide, with a round island of 3 mm in its middle."""
    radii = np.array([*np.arange(0, 31) * 0.75, 24, 27, 31, 36])
    phi = 2.0 * np.pi * np.arange(per_turn) / per_turn
    r, phi = np.meshgrid(radii, phi, indexing="ij")

    def step(t):
        t = np.clip(t, 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)
    z = 7.0 * step((17.5 + 2.0 * np.cos(3.0 * phi) - r) / 5.0) - 3.0 * step((6.5 - r) / 3.0)
    rings = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=2)
    facets = []
    for i, (inner, outer) in enumerate(zip(rings, rings[1:])):
        c, d = np.roll(outer, -1, axis=0), np.roll(inner, -1, axis=0)
        facets.append(np.stack([inner, c, outer], axis=1))
        if i > 0:
            facets.append(np.stack([inner, d, c], axis=1))
    return np.concatenate(facets)


# ---- files and measures ----

def write(file, facets):
    """An ASCII STL file with all digits; the path of the file, absolute."""
    normals = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    facet = ("facet normal %.6g %.6g %.6g\nouter loop\n" + "vertex %.17g %.17g %.17g\n" * 3 + "endloop\nendfacet\n")
    with open(file, "w", encoding="utf-8") as stream:
        stream.write("solid die\n")
        for row in np.concatenate([normals, facets.reshape(-1, 9)], axis=1).tolist():
            stream.write(facet % tuple(row))
        stream.write("endsolid die\n")
    return os.path.abspath(file)


def lowest(facets, x, y):
    """The lowest point of a surface on each vertical line (x, y); infinite where there is none [mm]."""
    a, b, c = facets[:, 0], facets[:, 1], facets[:, 2]
    det = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    flat = np.abs(det) > 1e-12  # all but walls that stand upright
    a, b, c, det = a[flat], b[flat], c[flat], det[flat]
    heights = np.full(len(x), np.inf)
    for i, (u, v) in enumerate(zip(x, y)):
        s = ((u - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (v - a[:, 1])) / det
        t = ((b[:, 0] - a[:, 0]) * (v - a[:, 1]) - (u - a[:, 0]) * (b[:, 1] - a[:, 1])) / det
        hit = (s > -1e-9) & (t > -1e-9) & (s + t < 1.0 + 1e-9)
        if hit.any():
            heights[i] = (a[:, 2] + s * (b[:, 2] - a[:, 2]) + t * (c[:, 2] - a[:, 2]))[hit].min()
    return heights


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "."
    os.makedirs(folder, exist_ok=True)
    write(os.path.join(folder, "hub.stl"), hub())
    write(os.path.join(folder, "small.stl"), hub(rim=20.0, per_turn=48, segments=4))


if __name__ == "__main__":
    main()
