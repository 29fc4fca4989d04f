# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The whole part, of which symmetry planes left a sector: a surface and its mirror images.

A plane is six numbers, a point and the normal out of the model.
"""
import numpy as np

from retroforge_report.vtu import Surface

MOST_COPIES = 64  # planes that give more bound no whole part


def symmetries(planes):
    """The maps x -> A x + b, as (A, b), that the planes' reflections generate; the identity alone where they have no end."""
    mirrors = [np.eye(4) for _ in planes]
    for mirror, plane in zip(mirrors, planes):
        point, normal = plane[:3], plane[3:]
        mirror[:3, :3] -= 2 * np.outer(normal, normal)
        mirror[:3, 3] = 2 * normal * (normal @ point)
    size = 1 + max((np.abs(mirror).max() for mirror in mirrors), default=0)
    found = [np.eye(4)]
    for known in found:  # which grows meanwhile
        for mirror in mirrors:
            new = mirror @ known
            if all(np.abs(new - other).max() > 1e-6 * size for other in found):
                found.append(new)
        if len(found) > MOST_COPIES:
            return [(np.eye(3), np.zeros(3))]
    return [(m[:3, :3], m[:3, 3]) for m in found]


def whole(surface, planes):
    """The surface, without what lies in symmetry planes, and its mirror images; as it is where they bound no whole part."""
    maps = symmetries(planes)
    return surface if len(maps) == 1 else _images(_without(surface, planes), maps)


def cut_open(surface, planes, eye):
    """The whole but for the image that is next to the eye: one looks onto the planes, into the part."""
    maps = symmetries(planes)
    if len(maps) == 1:
        return surface
    middle = surface.points.mean(axis=0)
    nearest = np.argmax([(A @ middle + b) @ eye for A, b in maps])
    return _images(surface, maps[:nearest] + maps[nearest + 1:])


def _images(surface, maps):
    n = len(surface.points)
    triangles = [surface.triangles[:, ::int(np.sign(np.linalg.det(A)))] + n * copy for copy, (A, _) in enumerate(maps)]
    return Surface(np.concatenate([surface.points @ A.T + b for A, b in maps]), np.concatenate(triangles),
                   np.tile(surface.cell, len(maps)), np.tile(surface.node, len(maps)))


def whole_vectors(vectors, surface, planes):
    """At the points of the whole of a surface, from those of the mesh's nodes."""
    part = whole(surface, planes)
    maps = symmetries(planes)
    return np.einsum("cij,cpj->cpi", [A for A, _ in maps], vectors[part.node].reshape(len(maps), -1, 3)).reshape(-1, 3)


def _without(surface, planes):
    """What does not lie in a plane."""
    size = np.ptp(surface.points, axis=0).max()
    distances = [np.abs((surface.points - plane[:3]) @ plane[3:]) for plane in planes]
    outside = ~np.any([(d[surface.triangles] < 1e-6 * size).all(axis=1) for d in distances], axis=0)
    node, triangles = np.unique(surface.triangles[outside], return_inverse=True)
    return Surface(surface.points[node], triangles.reshape(-1, 3), surface.cell[outside], surface.node[node])


def clipped(surface, planes):
    """The part of a surface on the model's side of all planes; it shares no points. A die may stand on either side."""
    corners, cell = surface.points[surface.triangles], surface.cell
    for plane in planes:
        corners, cell = _clip(corners, cell, (corners - plane[:3]) @ plane[3:])
    node = np.arange(3 * len(corners))
    return Surface(corners.reshape(-1, 3), node.reshape(-1, 3), cell, node)


def within(surface, low, high):
    """The part of a surface in a box."""
    axes = np.eye(3)
    return clipped(surface, [np.concatenate(plane) for plane in [*((low, -axis) for axis in axes), *((high, axis) for axis in axes)]])


def _clip(corners, cell, distance):
    """Triangles cut where their corners' distances change from negative, inside, to positive."""
    inside = distance <= 0
    count = inside.sum(axis=1)
    done, cells = [corners[count == 3]], [cell[count == 3]]
    for n_inside in (1, 2):
        chosen = count == n_inside
        # turned until the corner that is alone on its side comes first
        first = np.argmax(inside[chosen] == (n_inside == 1), axis=1)
        order = (first[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(corners[chosen], order[:, :, None], axis=1), 1, 0)
        d = np.take_along_axis(distance[chosen], order, axis=1)[:, :, None]
        ab, ac = ((a * d[:, i] - end * d[:, 0]) / (d[:, i] - d[:, 0]) for i, end in ((1, b), (2, c)))
        pieces = [(a, ab, ac)] if n_inside == 1 else [(ab, b, c), (ab, c, ac)]
        done += [np.stack(piece, axis=1) for piece in pieces]
        cells += [cell[chosen]] * len(pieces)
    return np.concatenate(done), np.concatenate(cells)
