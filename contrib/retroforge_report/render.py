# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Draws a coloured surface and arrows: by VTK when it is there, by matplotlib otherwise."""
import numpy as np
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

METAL = (0.72, 0.74, 0.77, 1.0)
DIE = (0.36, 0.47, 0.62, 0.3)  # seen through
DIE_EDGE = (0.16, 0.24, 0.36)
SHARP = 30  # degrees by which a die turns at the edges that are drawn
PIXELS = 900
SHADING = {True: 0.15, False: 0.3}  # with edges, without: little, so that colours stay close to the scale


class View:
    """Where the eye is: `eye` from the object to it, `right` and `up` as it sees them; z is up. `light` is beside it."""

    def __init__(self, eye, light_above=None):
        self.eye = unit(np.asarray(eye, float))
        self.right = unit(np.cross([0, 0, 1], self.eye))
        self.up = np.cross(self.eye, self.right)
        self.light = unit(self.eye + (self.up if light_above is None else light_above))


def unit(vector):
    return vector / (np.linalg.norm(vector) or 1.0)


FROM_THE_SIDE = View([1.0, -1.6, 0.75])


def view_onto(direction):
    """Onto what faces a direction, from 40 degrees beside it. Without a direction, from the side."""
    normal = unit(direction)
    if not normal.any():
        return FROM_THE_SIDE
    side = FROM_THE_SIDE.eye - (FROM_THE_SIDE.eye @ normal) * normal
    return View(normal + np.tan(np.radians(40)) * unit(side), light_above=normal)


class Scene:
    """What all pictures of one figure share: the middle, what is seen around it, and who renders."""

    def __init__(self, points, use_vtk, view=FROM_THE_SIDE, margin=1.04):
        self.centre = (points.min(axis=0) + points.max(axis=0)) / 2
        self.radius = np.linalg.norm(points - self.centre, axis=1).max()
        extent = np.abs((points - self.centre) @ np.array([view.right, view.up]).T).max(axis=0)
        self.half_width, self.half_height = margin * np.maximum(extent, 0.3 * extent.max())
        self.use_vtk, self.view = use_vtk, view

    def draw(self, figure, position, surface, rgba, arrows=None, edges=None, dies=()):
        """Into one place of a figure. `rgba`: one colour per triangle. `arrows`: (origins, vectors). `dies`: surfaces.

        `edges`: the surface whose edges are drawn, which may be one with fewer triangles; without, there is more shading instead.
        """
        if self.use_vtk:
            axes = figure.add_subplot(*position)
            axes.imshow(_render(self, surface, rgba, arrows, edges, dies))
        else:
            axes = figure.add_subplot(*position, projection="3d")
            _plot(self, axes, surface, rgba, arrows, edges, dies)
        axes.axis("off")
        return axes


def sharp_edges(surface):
    """Ends (edge, 2, 3) of the edges where the surface ends, or turns by much. Points at one place count as one."""
    size = np.ptp(surface.points, axis=0).max() if len(surface.points) else 1.0
    _, node = np.unique(np.round(surface.points / (1e-6 * size or 1.0)), axis=0, return_inverse=True)
    pairs = np.concatenate([surface.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    areas = surface.area_vectors()
    normals = np.tile(areas / np.maximum(np.linalg.norm(areas, axis=1), 1e-300)[:, None], (3, 1))
    _, first, edge, count = np.unique(np.sort(node.reshape(-1)[pairs], axis=1), axis=0, return_index=True, return_inverse=True,
                                      return_counts=True)
    sums = np.zeros((len(first), 3))
    np.add.at(sums, edge.reshape(-1), normals)
    # Two unit normals that turn by an angle have a sum of length 2 cos(angle/2).
    is_sharp = (count == 1) | ((count == 2) & (np.linalg.norm(sums, axis=1) < 2 * np.cos(np.radians(SHARP / 2))))
    return surface.points[pairs[first[is_sharp]]]


def _plot(scene, axes, surface, rgba, arrows, edges, dies):
    normals = surface.area_vectors()
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shaded = rgba.copy()
    shading = SHADING[edges is not None]
    shaded[:, :3] *= (1 - shading + shading * np.clip(normals @ scene.view.light, -1, 1))[:, None]
    axes.add_collection3d(Poly3DCollection(surface.points[surface.triangles], facecolors=shaded,
                                           edgecolors=(0.2, 0.2, 0.2, 0.35) if edges is surface else shaded, linewidths=0.2))
    for die in dies:
        axes.add_collection3d(Poly3DCollection(die.points[die.triangles], facecolors=DIE))
        axes.add_collection3d(Line3DCollection(sharp_edges(die), colors=[DIE_EDGE], linewidths=0.6))
    if arrows:
        axes.computed_zorder = False  # by order of drawing: arrows begin where the surface faces the eye
        axes.quiver(*arrows[0].T, *arrows[1].T, color="#b03000", linewidth=0.8)
    for set_limits, middle in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), scene.centre):
        set_limits(middle - 0.7 * scene.radius, middle + 0.7 * scene.radius)
    axes.set_box_aspect((1, 1, 1))
    axes.set_proj_type("ortho")
    eye = scene.view.eye
    axes.view_init(np.degrees(np.arcsin(eye[2])), np.degrees(np.arctan2(eye[1], eye[0])))


def _render(scene, surface, rgba, arrows, edges, dies):
    """Off-screen picture as an array (rows, columns, 3)."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    vtk.vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(_surface_actor(vtk, surface, rgba, edges is not None))
    if edges is not None:
        renderer.AddActor(_line_actor(vtk, edges.points[_edges_of(edges)], (0.25, 0.25, 0.25), 0.6))
    for die in dies:
        if len(die.triangles):
            renderer.AddActor(_die_actor(vtk, die))
            renderer.AddActor(_line_actor(vtk, sharp_edges(die), DIE_EDGE, 1.4))
    if arrows:
        renderer.AddActor(_arrow_actor(vtk, *arrows))
    view = scene.view
    camera = renderer.GetActiveCamera()
    distance = 4 * np.linalg.norm(surface.points - scene.centre, axis=1).max()  # the surface may exceed the picture
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*scene.centre)
    camera.SetPosition(*(scene.centre + distance * view.eye))
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(scene.half_height)
    light = vtk.vtkLight()
    light.SetLightTypeToCameraLight()
    a_little_left = np.array([-0.35, 0, 0])
    light.SetPosition(*(np.array([view.right, view.up, view.eye]) @ view.light + a_little_left))
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


def _poly_data(vtk, surface):
    from vtk.util.numpy_support import numpy_to_vtkIdTypeArray
    data = vtk.vtkPolyData()
    data.SetPoints(_vtk_points(vtk, surface.points))
    triangles = vtk.vtkCellArray()
    n = len(surface.triangles)
    triangles.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 3 * n + 1, 3), deep=True),
                      numpy_to_vtkIdTypeArray(surface.triangles.reshape(-1).astype(np.int64), deep=True))
    data.SetPolys(triangles)
    return data


def _die_actor(vtk, surface):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(_poly_data(vtk, surface))
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*DIE[:3])
    actor.GetProperty().SetOpacity(DIE[3])
    actor.GetProperty().SetInterpolationToFlat()
    return actor


def _edges_of(surface):
    """Pairs of points, each edge once."""
    pairs = np.concatenate([surface.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def _line_actor(vtk, ends, color, width):
    """Of segments (n, 2, 3)."""
    from vtk.util.numpy_support import numpy_to_vtkIdTypeArray
    data = vtk.vtkPolyData()
    data.SetPoints(_vtk_points(vtk, ends.reshape(-1, 3)))
    lines, n = vtk.vtkCellArray(), len(ends)
    lines.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 2 * n + 1, 2), deep=True), numpy_to_vtkIdTypeArray(np.arange(2 * n), deep=True))
    data.SetLines(lines)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, -2)  # before the triangles they bound
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*color)
    actor.GetProperty().SetLineWidth(width)
    actor.GetProperty().LightingOff()
    return actor


def _surface_actor(vtk, surface, rgba, with_edges):
    from vtk.util.numpy_support import numpy_to_vtk
    data = _poly_data(vtk, surface)
    data.GetCellData().SetScalars(numpy_to_vtk((255 * rgba[:, :3]).astype(np.uint8), deep=True))
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    appearance = actor.GetProperty()
    appearance.SetInterpolationToFlat()
    appearance.SetAmbient(0.93 - SHADING[with_edges])
    appearance.SetDiffuse(0.1 + SHADING[with_edges])
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
    actor.GetProperty().SetAmbient(0.5)
    actor.GetProperty().SetDiffuse(0.6)
    return actor


def _vtk_points(vtk, points):
    from vtk.util.numpy_support import numpy_to_vtk
    result = vtk.vtkPoints()
    result.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    return result
