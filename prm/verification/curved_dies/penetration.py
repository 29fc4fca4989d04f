#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""How deep the workpiece lies in the dies:   penetration.py RESULTS [--all]

Reads only what a run leaves in its folder: the last fields_*.vtu (with --all every one), the dies' surfaces die_NAME.stl as they
stood at the start, and parameters.prm for planes, velocities and symmetry planes. Samples the nodes of the surface, the middles of
its edges and faces, and a lattice of ten points on each face; faces on symmetry planes do not count, nor do points behind the
rim of an open die. The distances are VTK's, not the program's; those of a finely cut die are exact to its chords.
"""
import argparse
import os
import sys
import xml.etree.ElementTree

import numpy as np
import vtk

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "contrib"))
from retroforge_report import vtu  # noqa: E402

LATTICE = np.array([(i, j, 3 - i - j) for i in range(4) for j in range(4 - i)]) / 3.0
CHORDS = np.array([(0.5, 0.5, 0.0), (0.0, 0.5, 0.5), (0.5, 0.0, 0.5), (1 / 3, 1 / 3, 1 / 3)])


def read_parameters(file):
    """{"Die upper/point": "0, 0, 40"} of a parameter file; names in lower case but for sections."""
    settings, sections = {}, []
    with open(file, encoding="utf-8") as stream:
        for line in (line.split("#")[0].strip() for line in stream):
            if line.startswith("subsection "):
                sections.append(line[11:].strip())
            elif line == "end":
                sections.pop()
            elif line.startswith("set "):
                name, value = line[4:].split("=", 1)
                settings["/".join(sections + [name.strip()])] = value.strip()
    return settings


def numbers(text):
    return np.array([float(word) for word in text.split(",")])


def rotation(axis, degrees):
    axis = axis / np.linalg.norm(axis)
    cross = np.cross(np.eye(3), axis)
    a = np.radians(degrees)
    return np.eye(3) + np.sin(a) * cross + (1.0 - np.cos(a)) * cross @ cross


def symmetry_planes(settings):
    """[(point, unit normal)] of the billet's symmetry planes, where the billet stands."""
    def billet(name):
        return settings["Billet/" + name]
    base, where = numbers(billet("base centre")), billet("symmetry point")
    height = numbers(billet("size"))[2] if billet("shape") == "box" else float(billet("height"))
    point = {"base": base, "centre": base + (0.0, 0.0, height / 2)}.get(where)
    point = numbers(where) if point is None else point
    planes = [(point, numbers(normal)) for normal in billet("symmetry planes").split(";") if normal.strip()]
    sector = np.radians(float(billet("sector angle")))
    if 0.0 < sector < 6.28:
        planes += [(base, np.array([0.0, -1.0, 0.0])), (base, np.array([-np.sin(sector), np.cos(sector), 0.0]))]
    turn, shift = rotation(numbers(billet("rotation axis")), float(billet("rotation angle"))), numbers(billet("translation"))
    return [(turn @ p + shift, turn @ n / np.linalg.norm(n)) for p, n in planes]


def surface(file, planes):
    """Faces of a workpiece that lie on no symmetry plane, n x 3 corners x 3 coordinates."""
    skin = vtu.read(file).surface()
    faces = skin.points[skin.triangles]
    tolerance = 1e-5 * np.linalg.norm(np.ptp(skin.points, axis=0))
    for point, normal in planes:
        faces = faces[np.abs((faces - point) @ normal).max(axis=1) > tolerance]
    return faces


class Plane:
    """A flat die."""

    def __init__(self, point, facing):
        self.point, self.facing = point, facing / np.linalg.norm(facing)

    def depths(self, points):
        return -(points - self.point) @ self.facing


class Surface:
    """A die of facets, read from a file."""

    def __init__(self, file):
        reader = vtk.vtkSTLReader()
        reader.SetFileName(file)
        clean = vtk.vtkCleanPolyData()  # a seam whose points differ by rounding is no rim
        clean.SetInputConnection(reader.GetOutputPort())
        clean.SetTolerance(1e-7)
        clean.Update()
        self.distance = vtk.vtkImplicitPolyDataDistance()
        self.distance.SetInput(clean.GetOutput())
        rim = vtk.vtkFeatureEdges()
        rim.SetInputConnection(clean.GetOutputPort())
        rim.BoundaryEdgesOn()
        rim.FeatureEdgesOff()
        rim.ManifoldEdgesOff()
        rim.NonManifoldEdgesOff()
        rim.Update()
        self.tolerance = 1e-6 * clean.GetOutput().GetLength()
        self.rim = None
        if rim.GetOutput().GetNumberOfCells():
            self.rim = vtk.vtkStaticCellLocator()
            self.rim.SetDataSet(rim.GetOutput())
            self.rim.BuildLocator()

    def depth(self, point):
        """How deep a point lies inside [mm], negative outside; minus infinity behind the rim."""
        closest = [0.0, 0.0, 0.0]
        depth = -self.distance.EvaluateFunctionAndGetClosestPoint(point, closest)
        return -np.inf if depth > 0.0 and self.at_rim(closest) else depth

    def at_rim(self, point):
        if self.rim is None:
            return False
        at, cell, sub, square = [0.0, 0.0, 0.0], vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
        self.rim.FindClosestPoint(point, at, cell, sub, square)
        return float(square) < self.tolerance**2

    def depths(self, points):
        distinct, back = np.unique(points.reshape(-1, 3), axis=0, return_inverse=True)
        return np.array([self.depth(point) for point in distinct])[back].reshape(points.shape[:-1])


def read_dies(results, settings):
    """{name: (die where it starts, velocity)}"""
    dies = {}
    for name in (name.strip() for name in settings["Dies/names"].split(",")):
        section = f"Die {name}/"
        if settings[section + "shape"] == "plane":
            die = Plane(numbers(settings[section + "point"]), numbers(settings[section + "facing"]))
        else:
            die = Surface(os.path.join(results, f"die_{name}.stl"))
        dies[name] = die, numbers(settings[section + "velocity"])
    return dies


def fields(results):
    """[(time, file)] of the workpiece, in the order of the run"""
    tree = xml.etree.ElementTree.parse(os.path.join(results, "fields.pvd"))
    return [(float(entry.get("timestep")), os.path.join(results, entry.get("file"))) for entry in tree.iter("DataSet")
            if not entry.get("file").startswith("die_")]


def measure(faces, die, displacement):
    """Deepest node, deepest middle of edge or face, deepest of the lattice [mm], where, and the volume hidden [mm^3]."""
    nodes, chords, lattice = (np.einsum("pc,fcx->fpx", weights, faces) - displacement for weights in (np.eye(3), CHORDS, LATTICE))
    depths = [np.maximum(die.depths(points), 0.0) for points in (nodes, chords, lattice)]
    all_points = np.concatenate([points.reshape(-1, 3) for points in (nodes, chords, lattice)]) + displacement
    areas = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1) / 2.0
    where = all_points[np.argmax(np.concatenate([depth.ravel() for depth in depths]))]
    hidden = float(areas @ depths[2].mean(axis=1))
    return {"nodes": depths[0].max(), "chords": depths[1].max(), "lattice": depths[2].max(), "where": where, "hidden": hidden}


def penetration(results, entry=-1):
    """The deepest a workpiece lies in any of its dies at one of the times written, by default the last.

    {"deepest", "nodes", "chords", "lattice" [mm], "hidden" [mm^3], "where", "die", "time", "file"}
    """
    settings = read_parameters(os.path.join(results, "parameters.prm"))
    time, file = fields(results)[entry]
    faces = surface(file, symmetry_planes(settings))
    found = []
    for name, (die, velocity) in read_dies(results, settings).items():
        one = measure(faces, die, velocity * time)
        one.update(deepest=max(one["nodes"], one["chords"], one["lattice"]), die=name, time=time, file=file)
        found.append(one)
    worst = max(found, key=lambda one: one["deepest"])
    for key in ("nodes", "chords", "lattice"):
        worst[key] = max(one[key] for one in found)
    worst["hidden"] = sum(one["hidden"] for one in found)
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="folder of a run's results")
    parser.add_argument("--all", action="store_true", help="at all times written, not only the last")
    options = parser.parse_args()
    print("| fields | node [mm] | middle of edge or face | lattice | hidden [mm^3] | deepest in | at |\n" + "| --- " * 7 + "|")
    for entry in range(1, len(fields(options.results))) if options.all else [-1]:
        p = penetration(options.results, entry)
        at = ", ".join(f"{x:.3f}" for x in p["where"])
        print(f"| {os.path.basename(p['file'])} | {p['nodes']:.2g} | {p['chords']:.3g} | {p['lattice']:.3g} | {p['hidden']:.3g} "
              f"| {p['die']} | {at} |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
