# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Billet and dies cut by a plane, drawn flat: what lies in what, and how far things are apart."""
import dataclasses

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from retroforge_report.curves import BLUE, GREEN, INK, LEGEND_HEIGHT, ORANGE, PURPLE
from retroforge_report.whole import clipped, symmetries, whole

METAL, BAD = "#b9bcc2", "#b03000"
COLORS = (BLUE, ORANGE, GREEN, PURPLE)  # of the dies, in turn
BAND = 0.025  # of the picture: how thick the dies' side is drawn
MARGIN = 0.12  # around what is shown
EDGES = np.array([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])


@dataclasses.dataclass
class Cut:
    """A plane through a point; `axes` are the two unit vectors along which it is drawn, to the right and up."""
    point: np.ndarray
    normal: np.ndarray
    axes: np.ndarray

    def flat(self, points):
        return np.asarray(points, float) @ self.axes.T

    def distance(self, points):
        return (points - self.point) @ self.normal


def cuts(path, point):
    """Two planes through a point and along a path, normal to the two axes of space that are most across it."""
    up = -np.asarray(path, float) / np.linalg.norm(path)
    found = []
    for across in np.argsort(np.abs(up))[:2]:
        normal = np.eye(3)[across] - up[across] * up
        normal /= np.linalg.norm(normal)
        right = np.cross(up, normal)
        right *= np.sign(right[np.argmax(np.abs(right))])
        upwards = up * np.sign(up[np.argmax(np.abs(up))])
        found.append(Cut(np.asarray(point, float), normal, np.array([right, upwards])))
    return found


def lines(surface, cut):
    """Where a surface is cut: segments (n, 2, 3) with the normals of their triangles (n, 3)."""
    corners = surface.points[surface.triangles]
    distance = cut.distance(corners)
    side = distance > 0
    crossed = np.flatnonzero(side.any(axis=1) & ~side.all(axis=1))
    corners, distance, side = corners[crossed], distance[crossed], side[crossed]
    alone = np.argmax(side == (side.sum(axis=1) == 1)[:, None], axis=1)  # the corner that is alone on its side
    row = np.arange(len(crossed))
    ends = []
    for step in (1, 2):
        other = (alone + step) % 3
        part = distance[row, alone] / (distance[row, alone] - distance[row, other])
        ends.append(corners[row, alone] + part[:, None] * (corners[row, other] - corners[row, alone]))
    normals = surface.area_vectors()[crossed]
    return np.stack(ends, axis=1), normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def cells(mesh, cut):
    """Where the tetrahedra of the whole part are cut: polygons of three or four points, a list of (n, 3) arrays."""
    polygons = []
    for A, b in symmetries(mesh.symmetry_planes):
        points = mesh.points @ A.T + b
        distance = cut.distance(points)
        side = distance[mesh.cells] > 0
        for cell in mesh.cells[side.any(axis=1) & ~side.all(axis=1)]:
            ends = [(i, j) for i, j in cell[EDGES] if (distance[i] > 0) != (distance[j] > 0)]
            polygon = np.array([points[i] + distance[i] / (distance[i] - distance[j]) * (points[j] - points[i]) for i, j in ends])
            polygons.append(polygon if len(ends) == 3 else polygon[_around(cut.flat(polygon))])
    return polygons


def _around(flat):
    """The order of the corners of a convex polygon."""
    middle = flat - flat.mean(axis=0)
    return np.argsort(np.arctan2(middle[:, 1], middle[:, 0]))


def trace(plane, cut):
    """Two points, flat, of the line in which a plane of symmetry meets a cut; None where they are parallel."""
    point, normal = plane[:3], plane[3:]
    across = cut.flat(normal)
    if across @ across < 1e-12:
        return None
    shifted = point + ((cut.point - point) @ cut.normal) * cut.normal
    foot = cut.flat(shifted) - (shifted - point) @ normal * across / (across @ across)
    return foot, foot + np.array([-across[1], across[0]])


class Picture:
    """Panels side by side of a scene: `billet` a mesh or None, `dies` (what the legend says, surface, velocity), `planes` of symmetry,
    `marks` (place, text)."""

    def __init__(self, billet, dies, planes, marks):
        self.billet, self.planes, self.marks = billet, planes, marks
        self.dies = [(label, whole(clipped(surface, planes), planes), np.asarray(velocity, float)) for label, surface, velocity in dies]

    def draw(self, shown):
        """@param shown  (cut, title, window or None: (middle, half a width) of the part that is magnified)"""
        figure, panels = plt.subplots(1, len(shown), figsize=(5.2 * len(shown), 5.2), squeeze=False, layout="constrained")
        for axes, (cut, title, window) in zip(panels[0], shown):
            self._panel(axes, cut, window)
            axes.set_title(title, fontsize=11, pad=26)  # arrows of dies may leave the frame
        handles, labels = panels[0, 0].get_legend_handles_labels()
        room = LEGEND_HEIGHT / figure.get_figheight()
        figure.get_layout_engine().set(rect=(0, room, 1, 1 - room))
        figure.legend(handles, labels, loc="lower center", ncols=5)
        return figure

    def _panel(self, axes, cut, window):
        metal = [cut.flat(polygon) for polygon in cells(self.billet, cut)] if self.billet else []
        pieces = [lines(surface, cut) for _, surface, _ in self.dies]
        low, high = self._frame(cut, metal, pieces) if window is None else (cut.flat(window[0]) - window[1], cut.flat(window[0]) + window[1])
        size = (high - low).max()
        low, high = low - MARGIN * size, high + MARGIN * size
        for (label, _, velocity), (ends, normals), color in zip(self.dies, pieces, COLORS * (1 + len(pieces) // len(COLORS))):
            flat, out = cut.flat(ends), cut.flat(normals)
            out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12)
            behind = flat - BAND * size * out[:, None]
            axes.add_collection(PolyCollection(np.concatenate([flat, behind[:, ::-1]], axis=1), facecolors=color, alpha=0.35, zorder=3))
            axes.add_collection(LineCollection(flat, colors=color, linewidths=2.2, zorder=4))
            axes.plot([], [], color=color, label=label)
            _way(axes, flat, cut.flat(velocity), color, low, high)
        axes.add_collection(PolyCollection(metal, facecolors=METAL, edgecolors="#8d9199", linewidths=0.4, zorder=2))
        axes.fill([], [], color=METAL, label="billet")
        self._planes(axes, cut, low, high)
        for place, text in self.marks:
            x, y = cut.flat(place)
            if (low <= (x, y)).all() and ((x, y) <= high).all():
                axes.plot(x, y, "x", color=BAD, markersize=11, markeredgewidth=2.5, zorder=6)
                is_left = x < (low[0] + high[0]) / 2  # the text stays inside of the frame
                axes.annotate(text, (x, y), (8 if is_left else -8, 10), textcoords="offset points", ha="left" if is_left else "right",
                              color=BAD, fontsize=10, zorder=6, bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1})
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel=_axis(cut.axes[0]), ylabel=_axis(cut.axes[1]))
        axes.set_aspect("equal")

    def _planes(self, axes, cut, low, high):
        label = "symmetry plane"
        for plane in self.planes:
            ends = trace(plane, cut)
            if ends is not None:
                axes.axline(*ends, linestyle="-.", color=INK, linewidth=1, zorder=3, label=label)
                label = None

    def _frame(self, cut, metal, pieces):
        """Around the metal, and the point of each die that is next to it."""
        points = np.concatenate(metal) if metal else np.concatenate([cut.flat(ends).reshape(-1, 2) for ends, _ in pieces] or [np.zeros((1, 2))])
        low, high = points.min(axis=0), points.max(axis=0)
        for ends, _ in pieces if metal else ():
            if len(ends):
                flat = cut.flat(ends)
                nearest = np.clip(_on_segments(flat, (low + high) / 2), flat.min(axis=1), flat.max(axis=1))
                outside = np.maximum(np.maximum(low - nearest, nearest - high), 0)
                place = nearest[np.argmin(np.linalg.norm(outside, axis=1))]
                low, high = np.minimum(low, place), np.maximum(high, place)
        return low, high


def _way(axes, flat, way, color, low, high):
    """An arrow along the velocity of a die, from behind it to the middle of its lines that are in the frame."""
    middles = flat.mean(axis=1)
    shown = ((middles >= low) & (middles <= high)).all(axis=1)
    if not shown.any() or np.linalg.norm(way) == 0:
        return
    lengths = np.linalg.norm(flat[shown, 1] - flat[shown, 0], axis=1)
    tip = np.average(middles[shown], axis=0, weights=np.maximum(lengths, 1e-300))
    tail = tip - MARGIN * (high - low).max() * way / np.linalg.norm(way)
    axes.annotate("", tip, tail, arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 2, "mutation_scale": 18}, zorder=5)


def _on_segments(ends, point):
    """The points of segments that are next to a point."""
    way = ends[:, 1] - ends[:, 0]
    part = np.einsum("ij,ij->i", point - ends[:, 0], way) / np.maximum(np.einsum("ij,ij->i", way, way), 1e-300)
    return ends[:, 0] + np.clip(part, 0, 1)[:, None] * way


def _axis(direction):
    """The name of an axis of a picture."""
    biggest = int(np.argmax(np.abs(direction)))
    is_axis = abs(direction[biggest]) > 1 - 1e-9
    return f"{'xyz'[biggest]} [mm]" if is_axis else f"along ({', '.join(f'{x:.2g}' for x in direction)}) [mm]"
