# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Pictures of the billet: the surface is rendered by VTK when it is there, by matplotlib otherwise."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import cm, colors
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

VIEW = np.array([1.0, -1.6, 0.75]) / np.linalg.norm([1.0, -1.6, 0.75])  # from the object to the eye; z is up
RIGHT = np.cross([0, 0, 1], VIEW) / np.linalg.norm(np.cross([0, 0, 1], VIEW))
UP = np.cross(VIEW, RIGHT)
LIGHT = (VIEW + UP) / np.linalg.norm(VIEW + UP)
METAL = (0.72, 0.74, 0.77, 1.0)
PIXELS = 900
MOST_ARROWS = 250


class Scene:
    """What all pictures of one figure share: the middle, what is seen around it, and who renders."""

    def __init__(self, surfaces, use_vtk, margin=1.04):
        points = np.concatenate([surface.points for surface in surfaces])
        self.centre = (points.min(axis=0) + points.max(axis=0)) / 2
        self.radius = np.linalg.norm(points - self.centre, axis=1).max()
        self.half_width, self.half_height = margin * np.abs((points - self.centre) @ np.array([RIGHT, UP]).T).max(axis=0)
        self.use_vtk = use_vtk

    def draw(self, figure, position, surface, rgba, arrows=None):
        """Into one place of a figure. `rgba`: one colour per triangle. `arrows`: (origins, vectors)."""
        if self.use_vtk:
            axes = figure.add_subplot(*position)
            axes.imshow(_render(self, surface, rgba, arrows))
        else:
            axes = figure.add_subplot(*position, projection="3d")
            _plot(self, axes, surface, rgba, arrows)
        axes.axis("off")
        return axes


def forging(run, use_vtk):
    """Billet before and after; the final shape again with each field that was written."""
    first, last = run.initial.surface(), run.final.surface()
    panels = [("initial shape", first, None, None, None), ("final shape", last, None, None, None)]
    if "strain_rate" in run.final.cell_data:
        rate = np.atleast_2d(run.final.cell_data["strain_rate"].T).T
        rate = np.linalg.norm(rate, axis=1) if rate.shape[1] > 1 else rate[:, 0]
        panels.append(("final shape, strain rate", last, rate[last.cell], "equivalent strain rate [1/s]", "viridis"))
    if "contact_pressure" in run.final.point_data:
        pressure = run.final.point_data["contact_pressure"][last.node]
        touching = (pressure[last.triangles] > 0).all(axis=1)
        pressure = np.where(touching, last.to_triangles(pressure), np.nan)
        panels.append(("final shape, contact", last, pressure, "contact pressure [MPa]", "magma_r"))
    scene = Scene([first, last], use_vtk)
    figure = plt.figure(figsize=(11, 4.4 * ((len(panels) + 1) // 2)), layout="constrained")
    for place, (title, surface, values, label, cmap) in enumerate(panels, 1):
        position = ((len(panels) + 1) // 2, 2, place)
        if values is None:
            axes = scene.draw(figure, position, surface, np.tile(METAL, (len(surface.triangles), 1)))
        else:
            known = values[np.isfinite(values)] if np.isfinite(values).any() else np.zeros(1)
            norm = colors.Normalize(min(0, known.min()), max(np.percentile(known, 99), 1e-300))
            axes = _coloured(scene, figure, position, surface, values, norm, cmap, label)
        axes.set_title(title)
    return figure


def sensitivity(mesh, objective, unit, use_vtk):
    """Per unit of area, so that mesh size does not show: along the normal as colour, whole as arrows."""
    surface = mesh.surface()
    gradient = mesh.point_data[f"d{objective}_dX0"][surface.node]
    areas = surface.nodal_area_vectors()
    size = np.linalg.norm(areas, axis=1, keepdims=True)
    density = gradient / size
    normal = surface.to_triangles((density * areas / size).sum(axis=1))
    limit = np.percentile(np.abs(normal), 98) or 1.0
    scene = Scene([surface], use_vtk)
    figure = plt.figure(figsize=(11, 5.2), layout="constrained")
    per_area = f"{unit or '1'}/mm³"
    norm = colors.Normalize(-limit, limit)
    axes = _coloured(scene, figure, (1, 2, 1), surface, normal, norm, "RdBu_r", f"d {objective} / d X0 · n [{per_area}]")
    axes.set_title("moving the surface outward: red raises, blue lowers")
    scene = Scene([surface], use_vtk, margin=1.5)
    axes = scene.draw(figure, (1, 2, 2), surface, np.tile(METAL, (len(surface.triangles), 1)),
                      _arrows(scene, surface, density))
    axes.set_title(f"d {objective} / d X0, longest arrow {_longest(density):.3g} {per_area}")
    return figure


def _coloured(scene, figure, position, surface, values, norm, cmap, label):
    """Triangles without a value (NaN) keep the colour of the metal."""
    mapping = cm.ScalarMappable(norm, cmap)
    mapping.cmap = mapping.cmap.copy()
    mapping.cmap.set_bad(METAL)
    axes = scene.draw(figure, position, surface, mapping.to_rgba(np.ma.masked_invalid(values)))
    low, high = (values < norm.vmin).any(), (values > norm.vmax).any()
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[low, high]
    figure.colorbar(mapping, ax=axes, label=label, shrink=0.8, extend=extend)
    return axes


def _longest(vectors):
    return np.percentile(np.linalg.norm(vectors, axis=1), 98)


def _arrows(scene, surface, vectors):
    """A few of the nodes that face the eye; longer than the longest (edges, corners) are cut to it."""
    length = np.linalg.norm(vectors, axis=1)
    longest = _longest(vectors) or 1.0
    scale = 0.3 * scene.radius / np.maximum(longest, length)
    facing = np.flatnonzero(surface.nodal_area_vectors() @ VIEW > 0)
    chosen = facing[np.linspace(0, len(facing) - 1, min(MOST_ARROWS, len(facing))).astype(int)]
    return surface.points[chosen], (vectors * scale[:, None])[chosen]


def _plot(scene, axes, surface, rgba, arrows):
    normals = surface.area_vectors()
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shaded = rgba.copy()
    shaded[:, :3] *= (0.85 + 0.15 * np.clip(normals @ LIGHT, -1, 1))[:, None]
    axes.add_collection3d(Poly3DCollection(surface.points[surface.triangles], facecolors=shaded,
                                           edgecolors=(0.2, 0.2, 0.2, 0.35), linewidths=0.2))
    if arrows:
        axes.quiver(*arrows[0].T, *arrows[1].T, color="#b03000", linewidth=0.8)
    for set_limits, middle in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), scene.centre):
        set_limits(middle - 0.7 * scene.radius, middle + 0.7 * scene.radius)
    axes.set_box_aspect((1, 1, 1))
    axes.set_proj_type("ortho")
    axes.view_init(np.degrees(np.arcsin(VIEW[2])), np.degrees(np.arctan2(VIEW[1], VIEW[0])))


def _render(scene, surface, rgba, arrows):
    """Off-screen picture as an array (rows, columns, 3)."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(_surface_actor(vtk, surface, rgba))
    if arrows:
        renderer.AddActor(_arrow_actor(vtk, *arrows))
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*scene.centre)
    camera.SetPosition(*(scene.centre + 4 * scene.radius * VIEW))
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(scene.half_height)
    light = vtk.vtkLight()
    light.SetLightTypeToCameraLight()
    light.SetPosition(-0.5, 1.0, 1.0)  # seen from the eye: above, a little left
    renderer.AddLight(light)
    renderer.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(PIXELS, int(PIXELS * scene.half_height / scene.half_width))
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    columns, rows, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, -1)[::-1, :, :3]


def _surface_actor(vtk, surface, rgba):
    from vtk.util.numpy_support import numpy_to_vtk
    data = vtk.vtkPolyData()
    data.SetPoints(_vtk_points(vtk, surface.points))
    triangles = vtk.vtkCellArray()
    for triangle in surface.triangles:
        triangles.InsertNextCell(3, [int(node) for node in triangle])
    data.SetPolys(triangles)
    data.GetCellData().SetScalars(numpy_to_vtk((255 * rgba[:, :3]).astype(np.uint8), deep=True))
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    appearance = actor.GetProperty()
    appearance.SetInterpolationToFlat()
    appearance.SetAmbient(0.78)  # little shading, so that colours stay close to those of the scale
    appearance.SetDiffuse(0.25)
    appearance.EdgeVisibilityOn()
    appearance.SetEdgeColor(0.25, 0.25, 0.25)
    appearance.SetLineWidth(0.6)
    return actor


def _arrow_actor(vtk, origins, vectors):
    from vtk.util.numpy_support import numpy_to_vtk
    data = vtk.vtkPolyData()
    data.SetPoints(_vtk_points(vtk, origins))
    data.GetPointData().SetVectors(numpy_to_vtk(np.ascontiguousarray(vectors), deep=True))
    shape = vtk.vtkArrowSource()
    shape.SetTipRadius(0.16)
    shape.SetShaftRadius(0.05)
    glyphs = vtk.vtkGlyph3D()
    glyphs.SetInputData(data)
    glyphs.SetSourceConnection(shape.GetOutputPort())
    glyphs.SetScaleModeToScaleByVector()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(glyphs.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.69, 0.19, 0.0)
    return actor


def _vtk_points(vtk, points):
    from vtk.util.numpy_support import numpy_to_vtk
    result = vtk.vtkPoints()
    result.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    return result
