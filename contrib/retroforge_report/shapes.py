# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Pictures of the billet, and of sensitivities on surfaces."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import cm, colors

from retroforge_report.refine import refined
from retroforge_report.render import FROM_THE_SIDE, METAL, Scene, view_onto
from retroforge_report.units import per_volume
from retroforge_report.whole import clipped, cut_open, whole, whole_vectors

MOST_ARROWS = 250
MOVED_BY_MORE = 1e-3  # of the strongest: what counts when the eye looks for the place that matters
SHARPEST = 0.1  # at edges sharper than this, normals cancel and the part along them fades


CELL_FIELDS = (("equivalent_strain", "equivalent strain"), ("strain_rate [1/s]", "equivalent strain rate [1/s]"),
               ("von_mises_stress [MPa]", "von Mises stress [MPa]"))


def forging(run, use_vtk):
    """The whole part and the dies, before and after; the last shape again with fields that were written, cut open for those of
    the inside."""
    name = "shape where it failed" if run.failure else "final shape" if run.finished else "last shape"
    mesh = run.final.workpiece
    first, last = (whole(step.workpiece.surface(), step.workpiece.symmetry_planes) for step in (run.initial, run.final))
    opened = cut_open(mesh.surface(), mesh.symmetry_planes, FROM_THE_SIDE.eye)
    panels = [("initial shape", first, None, None, None, run.initial), (name, last, None, None, None, run.final)]
    for field, label in CELL_FIELDS:
        if field in mesh.cell_data:
            panels.append((f"{name}, {label.split(' [')[0]}", opened, mesh.cell_data[field][opened.cell], label, "viridis", None))
    if "contact_pressure [MPa]" in mesh.point_data:
        pressure = mesh.point_data["contact_pressure [MPa]"][last.node]
        touching = (pressure[last.triangles] > 0).all(axis=1)
        pressure = np.where(touching, last.to_triangles(pressure), np.nan)
        panels.append((f"{name}, contact", last, pressure, "contact pressure [MPa]", "magma_r", None))
    scene = Scene(np.concatenate([first.points, last.points]), use_vtk, margin=1.3)
    figure = plt.figure(figsize=(11, 4.4 * ((len(panels) + 1) // 2)), layout="constrained")
    for place, (title, surface, values, label, cmap, step) in enumerate(panels, 1):
        position = ((len(panels) + 1) // 2, 2, place)
        if values is None:
            axes = scene.draw(figure, position, surface, np.tile(METAL, (len(surface.triangles), 1)), dies=_dies(step))
        else:
            known = values[np.isfinite(values)] if np.isfinite(values).any() else np.zeros(1)
            norm = colors.Normalize(min(0, known.min()), max(np.percentile(known, 99), 1e-300))
            axes = _coloured(scene, figure, position, surface, values, norm, cmap, label)
        axes.set_title(title)
    return figure


def _dies(step):
    """Of the whole part, as is the workpiece."""
    planes = step.workpiece.symmetry_planes
    return [whole(clipped(die.surface(), planes), planes) for die in step.dies]


def billet_sensitivity(mesh, field, objective, use_vtk):
    """Of the whole part, whose nodes all move as the model's. None when the objective does not depend on the shape."""
    surface = whole(mesh.surface(), mesh.symmetry_planes)
    density, normal = _per_area(surface, whole_vectors(mesh.point_data[field], mesh.surface(), mesh.symmetry_planes))
    if not density.any():
        return None
    scenes = Scene(surface.points, use_vtk), Scene(surface.points, use_vtk, margin=1.5)
    coloured = surface, surface.to_triangles(normal)
    return _sensitivity(coloured, (surface, density), scenes, objective, "X0", "moving the surface outward")


def die_sensitivity(mesh, field, objective, use_vtk):
    """Seen from the workpiece, and around the part that matters: dies may be much larger. None when nothing matters."""
    surface = mesh.surface()
    density, normal = _per_area(surface, mesh.point_data[field][surface.node])
    if not density.any():
        return None
    length = np.linalg.norm(density, axis=1)
    matters = length > MOVED_BY_MORE * length.max()
    view = view_onto(surface.nodal_area_vectors()[matters].sum(axis=0))
    points = _neighbourhood(surface.points, matters)
    scenes = Scene(points, use_vtk, view), Scene(points, use_vtk, view, margin=1.25)
    coloured = refined(surface, normal, _strong(np.abs(normal)) / 10, scenes[0].radius / 100)
    return _sensitivity(coloured, (surface, density), scenes, objective, "Xdie", "moving the die towards the workpiece",
                        edges=False)


def _per_area(surface, gradient):
    """Nodal derivatives over the area around the node, so that mesh size does not show; and their normal part.

    The length of the area vector is the area that a displacement along the normal sweeps: with it, the derivative of a
    volume has the normal part one at edges and corners too.
    """
    vectors = surface.nodal_area_vectors()
    size = np.maximum(np.linalg.norm(vectors, axis=1), SHARPEST * surface.nodal_areas())[:, None]
    density = gradient / size
    return density, (density * vectors / size).sum(axis=1)


def _neighbourhood(points, chosen):
    """Corners of a box around the chosen points, and some of what is beside them."""
    low, high = points[chosen].min(axis=0), points[chosen].max(axis=0)
    beside = 0.15 * np.linalg.norm(high - low) or np.inf
    return np.array([[bounds[k][d] for d, k in enumerate(corner)]
                     for bounds in [(np.maximum(points.min(axis=0), low - beside),
                                     np.minimum(points.max(axis=0), high + beside))]
                     for corner in np.ndindex(2, 2, 2)])


def _sensitivity(coloured, arrowed, scenes, objective, variable, motion, edges=True):
    """Along the normal as colour (surface, value per triangle), whole as arrows (surface, vector per point)."""
    limit = _strong(np.abs(coloured[1]))
    unit = per_volume(objective.get("unit"))
    derivative = f"d {objective['name']} / d {variable}"
    figure = plt.figure(figsize=(11, 5.2), layout="constrained")
    axes = _coloured(scenes[0], figure, (1, 2, 1), *coloured, colors.Normalize(-limit, limit), "RdBu_r",
                     f"{derivative} · n [{unit}]", edges)
    axes.set_title(f"{motion}: red raises, blue lowers", fontsize=11)
    surface, density = arrowed
    axes = scenes[1].draw(figure, (1, 2, 2), surface, np.tile(METAL, (len(surface.triangles), 1)),
                          _arrows(scenes[1], surface, density), edges)
    axes.set_title(f"{derivative}, longest arrow {_longest(density):.3g} {unit}", fontsize=11)
    return figure


def _coloured(scene, figure, position, surface, values, norm, cmap, label, edges=True):
    """Triangles without a value (NaN) keep the colour of the metal."""
    mapping = cm.ScalarMappable(norm, cmap)
    mapping.cmap = mapping.cmap.copy()
    mapping.cmap.set_bad(METAL)
    axes = scene.draw(figure, position, surface, mapping.to_rgba(np.ma.masked_invalid(values)), edges=edges)
    low, high = (values < norm.vmin).any(), (values > norm.vmax).any()
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[low, high]
    figure.colorbar(mapping, ax=axes, label=label, shrink=0.8, extend=extend)
    return axes


def _strong(values):
    """What 2 % of the values that are not zero exceed."""
    values = values[values > 0]
    return np.percentile(values, 98) if len(values) else 1.0


def _longest(vectors):
    return _strong(np.linalg.norm(vectors, axis=1))


def _arrows(scene, surface, vectors):
    """A few of the nodes that face the eye; longer than the longest (edges, corners) are cut to it."""
    length = np.linalg.norm(vectors, axis=1)
    longest = _longest(vectors)
    scale = 0.3 * scene.radius / np.maximum(longest, length)
    facing = np.flatnonzero((surface.nodal_area_vectors() @ scene.view.eye > 0) & (length > MOVED_BY_MORE * longest))
    chosen = facing[np.linspace(0, len(facing) - 1, min(MOST_ARROWS, len(facing))).astype(int)]
    return surface.points[chosen], (vectors * scale[:, None])[chosen]
