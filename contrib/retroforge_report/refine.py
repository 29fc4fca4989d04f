# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Cuts triangles for flat colouring: a die's facets may be much larger than what happens on them."""
import numpy as np

from retroforge_report.vtu import Surface

MOST_CUTS = 14  # of one triangle


def refined(surface, nodal, tolerance, finest):
    """The surface cut until a nodal field differs by no more than `tolerance` within a triangle; and its means there.

    Each cut halves the longest edge; triangles whose edges are shorter than `finest` stay. The result shares no points.
    """
    corners, values, cell = surface.points[surface.triangles], nodal[surface.triangles], surface.cell
    done = []
    for _ in range(MOST_CUTS):
        lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        cut = (np.ptp(values, axis=1) > tolerance) & (lengths.max(axis=1) > finest)
        done.append((corners[~cut], values[~cut], cell[~cut]))
        corners, values, cell = corners[cut], values[cut], np.tile(cell[cut], 2)
        first = lengths[cut].argmax(axis=1)
        corners, values = _halves(corners, first), _halves(values[:, :, None], first)[:, :, 0]
    done.append((corners, values, cell))
    corners, values, cell = (np.concatenate(pieces) for pieces in zip(*done))
    node = np.arange(3 * len(corners))
    return Surface(corners.reshape(-1, 3), node.reshape(-1, 3), cell, node), values.mean(axis=1)


def _halves(corners, first):
    """Triangles cut in the middle of the edge from corner `first` to the next: all one halves, then all others."""
    order = (first[:, None] + np.arange(3)) % 3
    a, b, c = np.moveaxis(np.take_along_axis(corners, order[:, :, None], axis=1), 1, 0)
    middle = (a + b) / 2
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
