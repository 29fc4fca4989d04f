# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Draws a coloured surface and arrows: by VTK when it is there, by matplotlib otherwise."""
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

METAL = (0.72, 0.74, 0.77, 1.0)
DIE = (0.45, 0.52, 0.62, 0.22)  # seen through
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

    def draw(self, figure, position, surface, rgba, arrows=None, edges=True, dies=()):
        """Into one place of a figure. `rgba`: one colour per triangle. `arrows`: (origins, vectors). `dies`: surfaces.

        Without the edges of triangles there is more shading instead.
        """
        if self.use_vtk:
            axes = figure.add_subplot(*position)
            axes.imshow(_render(self, surface, rgba, arrows, edges, dies))
        else:
            axes = figure.add_subplot(*position, projection="3d")
            _plot(self, axes, surface, rgba, arrows, edges, dies)
        axes.axis("off")
        return axes


def _plot(scene, axes, surface, rgba, arrows, edges, dies):
    normals = surface.area_vectors()
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shaded = rgba.copy()
    shading = SHADING[edges]
    shaded[:, :3] *= (1 - shading + shading * np.clip(normals @ scene.view.light, -1, 1))[:, None]
    axes.add_collection3d(Poly3DCollection(surface.points[surface.triangles], facecolors=shaded,
                                           edgecolors=(0.2, 0.2, 0.2, 0.35) if edges else shaded, linewidths=0.2))
    for die in dies:
        axes.add_collection3d(Poly3DCollection(die.points[die.triangles], facecolors=DIE))
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
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(_surface_actor(vtk, surface, rgba, edges))
    for die in dies:
        renderer.AddActor(_die_actor(vtk, die))
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


def _surface_actor(vtk, surface, rgba, edges):
    from vtk.util.numpy_support import numpy_to_vtk
    data = _poly_data(vtk, surface)
    data.GetCellData().SetScalars(numpy_to_vtk((255 * rgba[:, :3]).astype(np.uint8), deep=True))
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    appearance = actor.GetProperty()
    appearance.SetInterpolationToFlat()
    appearance.SetAmbient(0.93 - SHADING[edges])
    appearance.SetDiffuse(0.1 + SHADING[edges])
    appearance.SetEdgeVisibility(edges)
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
    actor.GetProperty().SetAmbient(0.5)
    actor.GetProperty().SetDiffuse(0.6)
    return actor


def _vtk_points(vtk, points):
    from vtk.util.numpy_support import numpy_to_vtk
    result = vtk.vtkPoints()
    result.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    return result
