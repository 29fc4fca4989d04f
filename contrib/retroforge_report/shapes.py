# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Pictures of the billet, and of sensitivities on surfaces."""
import dataclasses
import itertools

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import cm, colors

from retroforge_report.refine import refined
from retroforge_report.render import FROM_THE_SIDE, METAL, Scene, View, view_onto
from retroforge_report.units import per_volume
from retroforge_report.vtu import Surface
from retroforge_report.whole import clipped, cut_open, whole, whole_vectors, within

MOST_ARROWS = 250
MOVED_BY_MORE = 1e-3  # of the strongest: what counts when the eye looks for the place that matters
CLOSE = 0.05  # the same where a small picture shows the strongest place only
SHARPEST = 0.1  # at edges sharper than this, normals cancel and the part along them fades
COLOURS = 24  # of a scale; where a triangle would have more, it is cut
BESIDE = 0.12  # of a die is shown, over the size of the workpiece


CELL_FIELDS = (("equivalent_strain", "equivalent strain"), ("strain_rate [1/s]", "equivalent strain rate [1/s]"),
               ("von_mises_stress [MPa]", "von Mises stress [MPa]"))


def forging(run, use_vtk):
    """The whole part and the dies, before and after; the last shape again with fields that were written, cut open for those of
    the inside."""
    name = "shape where it failed" if run.failure else "final shape" if run.finished else "last shape"
    mesh = run.final.workpiece
    first, last, before, after, shown = _with_dies(run)
    opened = cut_open(mesh.surface(), mesh.symmetry_planes, FROM_THE_SIDE.eye)
    panels = [("initial shape", first, None, None, None, before), (name, last, None, None, None, after)]
    for field, label in CELL_FIELDS:
        if field in mesh.cell_data:
            values = mesh.to_nodes(mesh.cell_data[field])[opened.node]
            panels.append((f"{name}, {label.split(' [')[0]}", opened, values, label, "viridis", ()))
    if "contact_pressure [MPa]" in mesh.point_data:
        pressure = _even_pressure(last, mesh.point_data["contact_pressure [MPa]"][last.node])
        panels.append((f"{name}, contact", last, pressure, "contact pressure [MPa]", "magma_r", ()))
    with_dies, alone = Scene(shown, use_vtk), Scene(np.concatenate([first.points, last.points]), use_vtk, margin=1.2)
    figure = plt.figure(figsize=(11, 4.4 * ((len(panels) + 1) // 2)), layout="constrained")
    for place, (title, surface, values, label, cmap, dies) in enumerate(panels, 1):
        position = ((len(panels) + 1) // 2, 2, place)
        if values is None:
            axes = with_dies.draw(figure, position, surface, np.tile(METAL, (len(surface.triangles), 1)), edges=surface, dies=dies)
        else:
            known = values[np.isfinite(values)] if np.isfinite(values).any() else np.zeros(1)
            norm = colors.Normalize(min(0, known.min()), max(np.percentile(known, 99), 1e-300))
            axes = _coloured(alone, figure, position, surface, values, norm, cmap, label)
        axes.set_title(title)
    return figure


def _with_dies(run):
    """The whole part before and after, the dies around it at both times, and all points of these pictures."""
    steps = (run.initial, run.final)
    first, last = (whole(step.workpiece.surface(), step.workpiece.symmetry_planes) for step in steps)
    points = np.concatenate([first.points, last.points])
    low, high = points.min(axis=0), points.max(axis=0)
    beside = BESIDE * (high - low).max()
    dies = [[within(whole(clipped(die.surface(), step.workpiece.symmetry_planes), step.workpiece.symmetry_planes), low - beside, high + beside)
             for die in step.dies] for step in steps]
    return first, last, *dies, np.concatenate([points, *(die.points for die in itertools.chain(*dies))])


def _even_pressure(surface, pressure):
    """The nodal pressures as a smooth picture means them; NaN where nothing touches. At the rim of a contact the nodal force is shared
    out to the faces that touch with all corners, not to all around the node; and each node takes the mean of its faces, since single
    nodes carry by turns more and less than their neighbours. The force stays, but for the rim's."""
    touching = (pressure[surface.triangles] > 0).all(axis=1)
    contact = dataclasses.replace(surface, triangles=surface.triangles[touching], cell=surface.cell[touching])
    areas = contact.nodal_areas()
    with np.errstate(divide="ignore", invalid="ignore"):
        at_nodes = pressure * surface.nodal_areas() / areas
        forces = contact.nodal_sums(contact.to_triangles(at_nodes) * np.linalg.norm(contact.area_vectors(), axis=1) / 3)
        return forces / areas


def overview(run, shows, use_vtk):
    """Three pictures of a run: before, after, and what it `shows`: a field of the last shape (as in CELL_FIELDS), `billet` or
    `die NAME`, the sensitivity of the first objective to that surface."""
    first, last, before, after, shown = _with_dies(run)
    scene = Scene(shown, use_vtk)
    figure = plt.figure(figsize=(13, 4), layout="constrained")
    for place, (title, surface, dies) in enumerate((("before", first, before), ("after", last, after)), 1):
        scene.draw(figure, (1, 3, place), surface, np.tile(METAL, (len(surface.triangles), 1)), edges=surface, dies=dies).set_title(title)
    labels = {label.split(" [")[0]: (field, label) for field, label in CELL_FIELDS}
    if shows in labels:
        mesh, (field, label) = run.final.workpiece, labels[shows]
        opened = cut_open(mesh.surface(), mesh.symmetry_planes, FROM_THE_SIDE.eye)
        values = mesh.to_nodes(mesh.cell_data[field])[opened.node]
        norm = colors.Normalize(min(0, values.min()), np.percentile(values, 99))
        _coloured(scene, figure, (1, 3, 3), opened, values, norm, "viridis", label).set_title(shows)
        return figure
    mesh, variable = (run.sensitivity, "X0") if shows == "billet" else (run.die_sensitivities[shows[len("die "):]], "Xdie")
    objective, field = run.sensitivities(mesh, variable)[0]
    seen = _of_billet(mesh, field) if shows == "billet" else _of_die(mesh, field, CLOSE)
    axes = _along_normal(Scene(seen.points, use_vtk, seen.view), figure, (1, 3, 3), seen, objective, variable)
    axes.set_title(f"{objective['name']} by the shape of {'the billet' if shows == 'billet' else shows}", fontsize=11)
    return figure


@dataclasses.dataclass
class Sensitivity:
    """Per area of a surface: the vectors `density` of its points, and their normal parts; `points` are what the picture shows."""
    surface: Surface
    density: np.ndarray
    normal: np.ndarray
    points: np.ndarray
    view: View = FROM_THE_SIDE
    motion: str = "moving the surface outward"
    edges: bool = True


def _of_billet(mesh, field):
    """Of the whole part, whose nodes all move as the model's. None when the objective does not depend on the shape."""
    surface = whole(mesh.surface(), mesh.symmetry_planes)
    density, normal = _per_area(surface, whole_vectors(mesh.point_data[field], mesh.surface(), mesh.symmetry_planes))
    return Sensitivity(surface, density, normal, surface.points) if density.any() else None


def _of_die(mesh, field, matters_from=MOVED_BY_MORE):
    """Seen from the workpiece, and around the part that matters (from which part of the strongest on): dies may be much larger.
    None when nothing matters."""
    surface = mesh.surface()
    density, normal = _per_area(surface, mesh.point_data[field][surface.node])
    if not density.any():
        return None
    length = np.linalg.norm(density, axis=1)
    matters = length > matters_from * length.max()
    view = view_onto(surface.nodal_area_vectors()[matters].sum(axis=0))
    return Sensitivity(surface, density, normal, _neighbourhood(surface.points, matters), view, "moving the die towards the workpiece",
                       edges=False)


def billet_sensitivity(mesh, field, objective, use_vtk):
    return _sensitivity(_of_billet(mesh, field), objective, "X0", use_vtk, margin=1.5)


def die_sensitivity(mesh, field, objective, use_vtk):
    return _sensitivity(_of_die(mesh, field), objective, "Xdie", use_vtk, margin=1.25)


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


def _sensitivity(seen, objective, variable, use_vtk, margin):
    """Along the normal as colour, whole as arrows, for which there is more room; None when there is nothing."""
    if seen is None:
        return None
    figure = plt.figure(figsize=(11, 5.2), layout="constrained")
    axes = _along_normal(Scene(seen.points, use_vtk, seen.view), figure, (1, 2, 1), seen, objective, variable)
    axes.set_title(f"{seen.motion}: red raises, blue lowers", fontsize=11)
    scene = Scene(seen.points, use_vtk, seen.view, margin)
    axes = scene.draw(figure, (1, 2, 2), seen.surface, np.tile(METAL, (len(seen.surface.triangles), 1)),
                      _arrows(scene, seen.surface, seen.density), seen.surface if seen.edges else None)
    axes.set_title(f"{_derivative(objective, variable)}, longest arrow {_longest(seen.density):.3g} "
                   f"{per_volume(objective.get('unit'))}", fontsize=11)
    return figure


def _along_normal(scene, figure, position, seen, objective, variable):
    limit = _strong(np.abs(seen.normal))
    return _coloured(scene, figure, position, seen.surface, seen.normal, colors.Normalize(-limit, limit), "RdBu_r",
                     f"{_derivative(objective, variable)} · n [{per_volume(objective.get('unit'))}]", seen.edges)


def _derivative(objective, variable):
    return f"d {objective['name']} / d {variable}"


def _coloured(scene, figure, position, surface, nodal, norm, cmap, label, edges=True):
    """By values of the points, linear between them. Triangles without a value (NaN) keep the colour of the metal."""
    fine, values = refined(surface, nodal, (norm.vmax - norm.vmin) / COLOURS, scene.radius / 100)
    mapping = cm.ScalarMappable(norm, cmap)
    mapping.cmap = mapping.cmap.copy()
    mapping.cmap.set_bad(METAL)
    axes = scene.draw(figure, position, fine, mapping.to_rgba(np.ma.masked_invalid(values)), edges=surface if edges else None)
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
