# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Run Retroforge from Python: a forging and its gradients as a function of settings and design parameters.

    import retroforge
    forging = retroforge.run("prm/tutorial/upsetting/upsetting.prm", at={"billet/radius": 20.2})
    forging.objectives["energy"]                   # 20255.9 mJ
    forging.gradients["energy"]["billet/radius"]   # d energy / d radius

    forging.nodes, forging.gradients_nodes["energy"]     # positions of the billet's nodes, d energy / d each of them
    forging.forged.points, forging.fields["equivalent_strain"]   # the part: its nodes, and what is known of its cells

`settings` change the case, as --set does, and with it perhaps the mesh; `at` changes the design on the first mesh of the
case, as --at does, so that results are as smooth in the design as the gradient says: what an optimizer needs.
"""
import csv
import dataclasses
import json
import numbers
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from retroforge_report import vtu  # noqa: E402

BUILT = pathlib.Path(__file__).resolve().parents[2] / "build" / "retroforge"


class Error(RuntimeError):
    """What the program says of a run that failed: where, what was found, which rule it breaks, and the remedy."""


def program():
    """The program: that of the environment variable RETROFORGE, the one built beside this file, or one in PATH."""
    found = shutil.which(os.environ.get("RETROFORGE") or (BUILT if BUILT.exists() else "retroforge"))
    if found is None:
        raise Error(f"retroforge: is neither {BUILT} nor in PATH, nor named by the environment variable RETROFORGE; "
                    "build it, or set RETROFORGE to the program")
    return found


@dataclasses.dataclass
class Mesh:
    """Tetrahedra: positions of the nodes (n, 3) in mm, their numbers in the Gmsh file, and four nodes of each cell, from 0."""
    points: np.ndarray
    numbers: np.ndarray
    cells: np.ndarray


@dataclasses.dataclass
class Forging:
    """What a run found; doc/summary_schema.md describes the summary and the columns of the history, doc/fields.md the fields.

    Arrays by nodes are in the order of sensitivity_nodes.csv: that of the file, where the billet comes from one."""
    summary: dict
    objectives: dict  # value of each objective
    gradients: dict  # of each objective: derivative by each design parameter
    history: dict  # column of history.csv: array over the increments
    nodes: np.ndarray = None  # positions of the billet's nodes at the start (n, 3) [mm]; None without gradients, as what follows
    node_numbers: np.ndarray = None  # of the Gmsh file, or of billet.msh
    gradients_nodes: dict = dataclasses.field(default_factory=dict)  # of each objective: derivatives by these nodes (n, 3)
    vertices: dict = dataclasses.field(default_factory=dict)  # of each die with a surface: positions at the start (n, 3) [mm]
    gradients_vertices: dict = dataclasses.field(default_factory=dict)  # of each such die and objective: derivatives by them
    billet: Mesh = None  # at the start
    forged: Mesh = None  # at the end of the stroke
    fields: dict = dataclasses.field(default_factory=dict)  # at the end: array over the nodes, or the cells, of `forged`

    def gradient(self, objective, parameters):
        """Derivatives of an objective by several parameters, as an array."""
        return np.array([self.gradients[objective][parameter] for parameter in parameters])


def run(case, settings={}, at={}, command="gradient", folder=None, progress=None):  # pylint: disable=dangerous-default-value
    """Forge a case.

    settings: {"Section/name": value}; lists and booleans are written as parameter files have them
    at:       {"design parameter": value}, whether the case lists it or not
    command:  simulate, gradient or check
    folder:   where results are left, refused where there are some already; None: nowhere
    progress: called after each increment with its row of history.csv, {"column": value}; what it raises ends the run
    @throws Error  with the program's message
    """
    if folder is None:
        with tempfile.TemporaryDirectory() as scratch:
            return run(case, settings, at, command, scratch, progress)
    start(command, case, settings, at, folder, progress)
    return read(folder)


def optimize(case, settings={}, at={}, folder=None):  # pylint: disable=dangerous-default-value
    """The best design of a case by its section Optimisation; arguments as of run(). Returns what optimisation.json has,
    which doc/summary_schema.md describes, with `best`, {"design parameter": value}, beside;
    `limits_kept` says whether the best design keeps the limits.
    @throws Error  with the program's message
    """
    if folder is None:
        with tempfile.TemporaryDirectory() as scratch:
            return optimize(case, settings, at, scratch)
    start("optimize", case, settings, at, folder, accepted=(0, 2))
    found = json.loads((pathlib.Path(folder) / "optimisation.json").read_text(encoding="utf-8"))
    return {**found, "best": {parameter["name"]: parameter["best"] for parameter in found["parameters"]}}


def start(command, case, settings, at, folder, progress=None, accepted=(0,)):
    """@param accepted  exit statuses with which results are there"""
    words = [program(), command, str(case), "--output", str(folder)]
    for option, values in (("--set", settings), ("--at", at)):
        for name, value in values.items():
            words += [option, f"{name}={as_text(value)}"]
    history = pathlib.Path(folder) / "history.csv"
    before = state_of(history)
    with tempfile.TemporaryFile("w+") as told, tempfile.TemporaryFile("w+") as complaint:
        with subprocess.Popen(words, stdout=told, stderr=complaint, env={"OMP_NUM_THREADS": "1", **os.environ}) as running:
            try:
                if progress is not None:
                    follow(running, history, before, progress)
                running.wait()
            except BaseException:
                running.terminate()
                raise
        if running.returncode not in accepted:
            told.seek(0)
            complaint.seek(0)
            raise Error(complaint.read().strip().removeprefix("retroforge: ") or f"{command} did not pass:\n{told.read()}")


def follow(program, history, before, progress):
    """Until the program ends. Each increment is told once its row stands in the history, those of an earlier run never.
    @param before  the state in which that left the file"""
    n_told, running = 0, True
    while running:
        try:
            program.wait(0.05)
            running = False
        except subprocess.TimeoutExpired:
            pass
        now = state_of(history)
        if now in (before, None):
            continue
        before = now
        whole_lines = history.read_text(encoding="utf-8").split("\n")[:-1]
        titles, *rows = csv.reader(whole_lines or [""])
        for row in rows[n_told:]:
            progress(dict(zip(titles, map(float, row))))
        n_told = max(n_told, len(rows))


def state_of(file):
    """What changes when the file is written; None where there is none."""
    try:
        return file.stat().st_mtime_ns, file.stat().st_size
    except FileNotFoundError:
        return None


def read(folder):
    """The results of a run that is finished."""
    folder = pathlib.Path(folder)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    parameters = summary.get("parameters", [])
    objectives = {objective["name"]: objective["value"] for objective in summary["objectives"]}
    gradients = {objective: {p["name"]: p["gradient"][objective] for p in parameters if objective in p["gradient"]}
                 for objective in objectives}
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        titles, *rows = csv.reader(file)
    history = dict(zip(titles, np.array(rows, float).reshape(-1, len(titles)).T))
    forging = Forging(summary, objectives, gradients, history)
    read_meshes(folder, forging)
    read_nodal_gradients(folder, forging)
    return forging


def read_meshes(folder, forging):
    """The billet and the forged part, and the fields at the end, unless none were written."""
    forging.billet, forging.forged = (read_msh(folder / name) for name in ("billet.msh", "forged.msh"))
    pictures = [entry.get("file") for entry in xml.parse(folder / "fields.pvd").iter("DataSet")] if (folder / "fields.pvd").is_file() else []
    pictures = [name for name in pictures if re.fullmatch(r"fields_\d+\.vtu", name)]
    if pictures:
        forging.fields = fields_on(forging.forged, vtu.read(folder / pictures[-1]))


def read_msh(path):
    """The tetrahedra of a Gmsh file as the program writes it (version 2.2, ASCII)."""
    lines = path.read_text(encoding="utf-8").splitlines()
    begin = {name: lines.index(name) + 2 for name in ("$Nodes", "$Elements")}
    rows = {name: [line.split() for line in lines[first:first + int(lines[first - 1])]] for name, first in begin.items()}
    numbers = np.array([int(row[0]) for row in rows["$Nodes"]])
    points = np.array([row[1:] for row in rows["$Nodes"]], float)
    cells = np.array([row[-4:] for row in rows["$Elements"] if row[1] == "4"], int)
    order = np.argsort(numbers)
    return Mesh(points, numbers, order[np.searchsorted(numbers, cells, sorter=order)])


def fields_on(mesh, picture):
    """{name: array over the mesh's nodes or cells} of a picture of it, in single precision. Both have the cells, and the corners of each,
    in the same order; a mesh of a file of one's own has the nodes in the order there.
    @throws ValueError  where it is a picture of another mesh"""
    if mesh.cells.shape != picture.cells.shape or not np.allclose(picture.points[picture.cells], mesh.points[mesh.cells], rtol=1e-6):
        raise ValueError("the last picture of fields.pvd is not one of forged.msh")
    node = np.empty(len(mesh.points), int)  # of the picture
    node[mesh.cells] = picture.cells
    return {**{name: values[node] for name, values in picture.point_data.items()}, **picture.cell_data}


def read_nodal_gradients(folder, forging):
    """The tables by the nodes of the billet and by the vertices of the dies, where gradients were made."""
    billet = folder / "sensitivity_nodes.csv"
    if billet.is_file():
        forging.node_numbers, forging.nodes, forging.gradients_nodes = read_nodal(billet)
    for path in sorted(folder.glob("sensitivity_die_*_nodes.csv")):
        die = path.name[len("sensitivity_die_"):-len("_nodes.csv")]
        _, forging.vertices[die], forging.gradients_vertices[die] = read_nodal(path)


def read_nodal(path):
    """Numbers (n), positions (n, 3), and {objective: derivatives (n, 3)} of a table with one row per node."""
    with open(path, encoding="utf-8") as file:
        titles = file.readline().rstrip("\n").split(",")
    table = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    return (table[:, 0].astype(int), table[:, 1:4],
            {title.removesuffix(" dx"): table[:, j:j + 3] for j, title in enumerate(titles) if title.endswith(" dx")})


def as_text(value):
    """A value as parameter files have it; numbers read back to the same bits."""
    if isinstance(value, (bool, np.bool_)):
        return str(bool(value)).lower()
    if isinstance(value, numbers.Real) and not isinstance(value, numbers.Integral):
        return repr(float(value))
    if isinstance(value, (list, tuple, np.ndarray)):
        return ", ".join(as_text(entry) for entry in value)
    return str(value)
