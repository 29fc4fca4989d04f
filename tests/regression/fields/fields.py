# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Files of fields as VTK reads them. Proved, of known functions of the place written by write_fields:
- cells share their points, which are the nodes in their order; linear fields have their values there, under names with units; fields of
  cells are data of cells; tensors are symmetric, row by row; what is beyond single precision is infinite; planes of symmetry read back to
  the same bits;
- a quadratic velocity is VTK's quadratic tetrahedra, the middles of the edges points that they share, and between the points, too, it is
  the function;
- surfaces are triangles with values at their vertices;
- two runs write the same bytes;
- of whole runs: a time series has the workpiece and the dies at each time, and on two ranks, through a remeshing, the fields are those
  of one rank but for the solver's tolerance. Usage: fields.py RETROFORGE WRITE_FIELDS"""
import os
import shutil
import sys
import xml.etree.ElementTree as xml

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import changed, command, cube, judge, main, prm, run, start, text_of  # noqa: E402

WRITE_FIELDS = os.path.abspath(sys.argv[2])
FILES = ("linear.vtu", "quadratic.vtu", "one_cell.vtu", "surface.vtu")
TRIANGLE, TETRAHEDRON, QUADRATIC_TETRAHEDRON = 5, 10, 24
SINGLE = 2e-6  # of numbers near ten
CASE = changed(cube(20, 7, 2, 4), {"Remeshing": {"when": "increments", "every": 2}, "Contact": {"approach": 1},
                                   "Output": {"fields every": 2}, "Newton": {"tolerance": 1e-10}})


def read(file):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    return reader.GetOutput()


def points(grid):
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(float)


def fields(data):
    return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def connectivity(grid):
    return vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)


def types(grid):
    return set(vtk_to_numpy(grid.GetCellTypesArray()))


def linear(x):
    return 1 + 2 * x[:, 0] - 3 * x[:, 1] + 0.5 * x[:, 2]


def quadratic(x):
    return np.stack([x[:, 0]**2 - x[:, 1] * x[:, 2], 1 + x[:, 1] * x[:, 0], x[:, 2]**2 + 0.25 * x[:, 0]], axis=1)


def near(a, b, tolerance=SINGLE):
    return a.shape == b.shape and np.abs(a - b).max() < tolerance * max(1, np.abs(b).max())


def between(grid, n=200):
    """Random places inside, and the fields there as VTK interpolates them."""
    places = vtk.vtkPoints()
    for x in np.random.default_rng(1).uniform(0.2, 2.8, (n, 3)):
        places.InsertNextPoint(x)
    probed = vtk.vtkPolyData()
    probed.SetPoints(places)
    probe = vtk.vtkProbeFilter()
    probe.SetInputData(probed)
    probe.SetSourceData(grid)
    probe.Update()
    judge("places are inside", probe.GetValidPoints().GetNumberOfTuples() == n)
    return points(probe.GetOutput()), fields(probe.GetOutput().GetPointData())


def written():
    for folder in ("first", "second"):
        done = start([WRITE_FIELDS])
        judge(f"{folder}: written", done.returncode == 0, done.stderr)
        os.mkdir(folder)
        for file in FILES:
            shutil.move(file, folder)
    judge("two runs write the same bytes", all(text_of("first", file) == text_of("second", file) for file in FILES))


def box():
    for name, kind, corners, n_points in (("linear", TETRAHEDRON, 4, 4**3), ("quadratic", QUADRATIC_TETRAHEDRON, 10, 7**3)):
        grid = read(f"first/{name}.vtu")
        x, data, cells, of_cells = points(grid), fields(grid.GetPointData()), connectivity(grid), fields(grid.GetCellData())
        judge(f"{name}: cells that share their points", types(grid) == {kind} and cells.shape == (162, corners) and len(x) == n_points)
        judge(f"{name}: they fill the box", abs(sum(np.linalg.det(x[c[1:4]] - x[c[0]]) for c in cells) / 6 - 27) < 1e-4)
        judge(f"{name}: names", set(data) == {"pressure [MPa]", "displacement [mm]", "label", "velocity [mm/s]"} and
              set(of_cells) == {"number", "stress [MPa]"}, (set(data), set(of_cells)))
        judge(f"{name}: scalar", near(data["pressure [MPa]"], linear(x)))
        judge(f"{name}: vector", near(data["displacement [mm]"], x))
        judge(f"{name}: velocity at the points", near(data["velocity [mm/s]"], quadratic(x)))
        judge(f"{name}: too large", np.isinf(data["label"]).all())
        number = of_cells["number"]
        judge(f"{name}: of cells", (number == np.arange(len(cells))).all())
        stress = of_cells["stress [MPa]"].reshape(-1, 3, 3)
        expected = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]]) + number[:, None, None] * np.diag([1, 0, 0])
        judge(f"{name}: tensor", (stress == expected).all())
        planes = fields(grid.GetFieldData())["symmetry_planes"]
        judge(f"{name}: planes of symmetry", np.array_equal(planes, [[0.1, 0, 1 / 3, -1, 0, 0], [0, 0, 0, 0, -1, 0]]), planes)
        x, data = between(grid)
        judge(f"{name}: a linear field between the points", near(data["pressure [MPa]"], linear(x), 1e-5))
        is_quadratic = near(data["velocity [mm/s]"], quadratic(x), 1e-5)
        judge(f"{name}: velocity between the points", is_quadratic == (name == "quadratic"))


def surface():
    grid = read("first/surface.vtu")
    x, cells = points(grid), connectivity(grid)
    judge("surface: triangles", types(grid) == {TRIANGLE} and near(x[cells[:, 2]], np.ones((4, 3))))
    normals = np.cross(x[cells[:, 1]] - x[cells[:, 0]], x[cells[:, 2]] - x[cells[:, 0]])
    judge("surface: they keep their orientation", (normals[:, 2] > 0).all(), normals)
    judge("surface: vector", near(fields(grid.GetPointData())["gradient"], quadratic(x)))


def series():
    run("simulate", "alone")
    done = start(["mpirun", "-np", "2"] + command("simulate", "together"))
    judge("series: ends on two ranks, remeshed", done.returncode == 0 and done.stdout.count("remeshed") == 1, done.stdout + done.stderr)
    entries = [(float(entry.get("timestep")), entry.get("file")) for entry in xml.parse("together/fields.pvd").iter("DataSet")]
    judge("series: times and files", entries == [(time, f"{name}_{number}.vtu") for time, number in (
        (0, "000000"), (0.01, "000002"), (0.02, "000004")) for name in ("fields", "die_lower", "die_upper")], entries)
    # It ends where fields were written, too.
    done = run("simulate", "failed", "Press/stroke=18", "Press/increments=6", "Press/max cuts=0", "Press/largest move=0.3",
               "Remeshing/when=never", "Output/fields every=1")
    last = [(entry.get("timestep"), entry.get("file")) for entry in xml.parse("failed/fields.pvd").iter("DataSet")]
    judge("series: where it failed there is one picture", done.returncode == 1 and len({time for time, _ in last[-6:]}) == 2 and
          [file for _, file in last[-3:]] == ["failed.vtu", "die_lower_failed.vtu", "die_upper_failed.vtu"], last)
    for file in (file for _, file in entries):
        one, two = (read(f"{folder}/{file}") for folder in ("alone", "together"))
        a, b = ({"points": points(grid), **fields(grid.GetPointData()), **fields(grid.GetCellData())} for grid in (one, two))
        off = {name: np.abs(a[name] - b[name]).max() / max(np.abs(a[name]).max(), 1e-30) for name in a}
        judge(f"series: {file} is that of one rank", a.keys() == b.keys() and max(off.values()) < 1e-4, off)


main({"case.prm": prm(CASE)}, (written, box, surface, series))
