# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Derivatives by nodes, used as the manual says: multiplied by a motion of the nodes and added up. Proved:
- of a billet from a Gmsh file and of a die from an STL file, whole and as a sector, with both pairs of elements: what the tables predict of a
  smooth motion is the central difference of runs of the moved files, to 1e-6;
- the lines of the manual's pages, run as they stand on the tutorial's scenes, predict it too;
- two ranks find the same; of a billet of another height, but for the penalties that follow from it;
- rows stand in the order of the file's nodes, with their numbers there, and nodes of no tetrahedron have zeros.
Usage: nodal_gradients.py RETROFORGE"""
import os
import re
import shutil
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from block_meshes import block, msh  # noqa: E402
from whole_runs import ROOT, changed, command, judge, main, prm, run, start, summary_of, text_of, write  # noqa: E402

SIDE, N = 20.0, 4
STEP = 6e-5  # of motions of some mm; no contact is decided otherwise within it
OBJECTIVES = ("energy", "mean strain")
TIGHT = {"Newton": {"tolerance": 1e-13}, "Adjoint": {"tolerance": 1e-14}, "Remeshing": {"when": "never"}, "Output": {"fields every": 0}}
SCENE = changed(TIGHT, {
    "Billet": {"shape": "file", "file name": "billet.msh"},
    "Dies": {"names": "lower, upper"},
    "Die lower": {"point": "0, 0, 0", "facing": "0, 0, 1", "friction": 0.3},
    "Die upper": {"shape": "stl", "file": "die.stl", "facing": "0, 0, -1", "velocity": "0, 0, -100", "friction": 0.3},
    "Press": {"stroke": 2, "increments": 4},
    # Forces are the penalty times differences of speeds: a softer one leaves energies the digits that differences ask for.
    "Contact": {"penetration": 1e-5},
    "Objectives": {"names": ", ".join(OBJECTIVES)}})
PLANES = {"Billet": {"symmetry patches": "plane x, plane y"}}


# ---- a billet and a die ----

def billet_of(is_sector):
    """Points, and elements with the groups of msh(): a block of cubes on z = 0 that generic shifts deform; patches on x = 0 and y = 0."""
    low = 0.0 if is_sector else -SIDE / 2
    points, cells = block((N, N, N), lambda corner: tuple(SIDE / N * x for x in corner))
    x = np.array(points)
    shift = 0.2 * np.random.default_rng(3).uniform(-1, 1, x.shape)
    shift[(x < 1e-9) | (x > SIDE - 1e-9)] = 0.0
    x = x + shift + [low, low, 0.0]
    faces = [(axis, face) for cell in cells for face in faces_of(cell) for axis in (0, 1) if np.all(x[list(face), axis] == low)]
    return x, [(2, axis + 1, face) for axis, face in faces] + [(4, 3, cell) for cell in cells]


def faces_of(cell):
    return [tuple(cell[i] for i in range(4) if i != left) for left in range(4)]


def write_billet(file, x, elements):
    """Nodes that no tetrahedron has, and numbers with gaps, as files of others have them."""
    text = msh([tuple(map(repr, row)) for row in x.tolist()], elements, [(2, 1, "plane x"), (2, 2, "plane y"), (3, 3, "billet")])
    head, nodes, end = re.split(r"\$Nodes\n|\$EndNodes", text)
    rows = [f"{7 * int(number) + 3} {place}" for number, place in (row.split(" ", 1) for row in nodes.splitlines()[1:])]
    rows.insert(5, "2 1.0 2.0 3.0")
    elements_text = re.sub(r"(?m)^(\d+ [24] 2 \d+ \d+)((?: \d+)+)$",
                           lambda row: row[1] + "".join(f" {7 * int(k) + 3}" for k in row[2].split()), end)
    write(file, f"{head}$Nodes\n{len(rows)}\n" + "\n".join(rows) + "\n$EndNodes" + elements_text)


def die_points(n=14, width=31.0):
    """Of a grid that faces down, bulging and turned so that nothing of it is in line with the billet's mesh."""
    a = (np.arange(n + 1) / n - 0.5) * width
    u, v = (grid.ravel() for grid in np.meshgrid(a, a, indexing="ij"))
    turn = 0.3
    x, y = np.cos(turn) * u - np.sin(turn) * v + 3.3, np.sin(turn) * u + np.cos(turn) * v + 2.9
    z = SIDE + 0.3 + 0.8 * np.cos(0.17 * x + 0.3) * np.cos(0.13 * y - 0.2) - 0.9 + 0.02 * x
    z += SIDE + 0.2 - z[(x > -SIDE) & (x < SIDE)].min()
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = [(number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i in range(n) for j in range(n)]
    return np.column_stack([x, y, z]), [t for a, b, c, d in quads for t in ((a, c, b), (a, d, c))]


def write_die(file, points, triangles):
    corners = lambda t: "".join(f"vertex {x[0]!r} {x[1]!r} {x[2]!r}\n" for x in points[list(t)].tolist())  # noqa: E731
    write(file, "solid die\n" + "".join(f"facet normal 0 0 0\nouter loop\n{corners(t)}endloop\nendfacet\n" for t in triangles) + "endsolid\n")


# ---- motions, and what they change ----

def motion_of_billet(x):
    """Smooth, in the planes x = 0 and y = 0, and in those of bottom and top, so that no height follows from it."""
    rise = np.sin(np.pi * x[:, 2] / SIDE)
    return np.column_stack([x[:, 0] * (0.04 + 0.03 * np.cos(0.2 * x[:, 2])), -0.02 * x[:, 1] * np.sin(0.1 * x[:, 0] + 0.5), 0.5 * rise * np.cos(0.1 * x[:, 0])])


def motion_of_die(x):
    return np.column_stack([0.2 * np.sin(0.1 * x[:, 1]), 0.1 * np.cos(0.15 * x[:, 0]), np.cos(0.12 * x[:, 0]) + 0.3 * np.sin(0.2 * x[:, 1])])


def values_of(output):
    return np.array([objective["value"] for objective in summary_of(output)["objectives"]])


def differences(case, step, move, *settings):
    """Of all objectives, per unit of the motion; `move(t)` writes the files moved by t times it."""
    ends = []
    for t in (step, -step):
        move(t)
        done = run("simulate", "moved", "--overwrite", *settings, case=case)
        judge(f"{case}, moved by {t}", done.returncode == 0, done.stderr)
        ends.append(values_of("moved"))
    move(0.0)
    return (ends[0] - ends[1]) / (2 * step)


def nearest(prediction, sizes, case, move):
    """The nearest of differences over steps twice apart, and of what two of them tell of none, until one is near enough: rounding is
    some 1e-6 of a difference over the shortest, a contact may be decided otherwise within the longest, and what follows from friction
    that sets in bends with the cube of a step."""
    found = []
    for step in (STEP, 0.5 * STEP, 2 * STEP):
        found.append(differences(case, step, move))
        if len(found) == 2:
            found.append((4 * found[1] - found[0]) / 3)
        if min(off_by(prediction, difference, sizes).max() for difference in found) < 1e-6:
            break
    return np.array([min(column, key=lambda d: abs(d - p)) for p, column in zip(prediction, np.array(found).T)])


def off_by(prediction, difference, sizes=0.0):
    """Relative; of a sum whose terms cancel, to a hundredth of their sizes."""
    return np.abs(prediction - difference) / np.maximum(np.abs(difference), 0.01 * sizes)


def predicted(table, motion):
    """Of all objectives, as the manual has it for the first."""
    return np.array([(table[:, 4 + 3 * j:7 + 3 * j] * motion).sum() for j in range((table.shape[1] - 4) // 3)])


def sizes_of(table, motion):
    """Of the terms of predicted()."""
    return predicted(np.abs(table), np.abs(motion))


def compare(name, prediction, difference, bar, sizes=0.0):
    off = off_by(prediction, difference, sizes).max()
    judge(f"{name}: predicted {off:.1e} off the difference", off < bar, f"{prediction} {difference}")


def part(case, is_sector):
    x, elements = billet_of(is_sector)
    points, triangles = die_points()
    write_billet("billet.msh", x, elements)
    write_die("die.stl", points, triangles)
    done = run("gradient", case, case=f"{case}.prm")
    judge(f"{case}: ends", done.returncode == 0, done.stderr)
    nodes, vertices = (np.loadtxt(f"{case}/{file}", delimiter=",", skiprows=1)
                       for file in ("sensitivity_nodes.csv", "sensitivity_die_upper_nodes.csv"))
    numbers = np.insert(7 * np.arange(1, len(x) + 1) + 3, 5, 2)
    judge(f"{case}: numbers and order of the file", np.array_equal(nodes[:, 0], numbers))
    judge(f"{case}: zeros beside the mesh", np.array_equal(nodes[5, 1:4], [1, 2, 3]) and not nodes[5, 4:].any())
    of_mesh = np.delete(nodes, 5, axis=0)
    judge(f"{case}: positions of the file", np.array_equal(of_mesh[:, 1:4], x))
    first = list(dict.fromkeys(k for t in triangles for k in t))
    judge(f"{case}: vertices as the file names them first", np.array_equal(vertices[:, 1:4], points[first]))
    move = motion_of_billet(x)
    for name, table, motion, write_moved in (
            ("nodes of the billet", of_mesh, move, lambda t: write_billet("billet.msh", x + t * move, elements)),
            ("vertices of the die", vertices, motion_of_die(vertices[:, 1:4]),
             lambda t: write_die("die.stl", points + t * motion_of_die(points), triangles))):
        prediction, sizes = predicted(table, motion), sizes_of(table, motion)
        compare(f"{case}, {name}", prediction, nearest(prediction, sizes, f"{case}.prm", write_moved), 1e-6, sizes)


CASES = {f"{part_name} {element}": changed(SCENE, {"Discretization": {"element": element}, **(PLANES if part_name == "sector" else {})})
         for part_name in ("whole", "sector") for element in ("mini", "P2-P1")}


def parts():
    for case in CASES:
        part(case, case.startswith("sector"))


def higher():
    """Another height, from which other penalties follow."""
    x, elements = billet_of(False)
    write_billet("billet.msh", x, elements)
    flat = ("Die upper/shape=plane", "Die upper/file=", f"Die upper/point=0, 0, {SIDE}")
    for name, bar, settings in (("flat", 1e-7, flat), ("curved", 1e-4, ())):
        done = run("gradient", name, *settings, case="whole mini.prm")
        judge(f"lower under a {name} die: ends", done.returncode == 0, done.stderr)
        nodes = np.delete(np.loadtxt(f"{name}/sensitivity_nodes.csv", delimiter=",", skiprows=1), 5, axis=0)
        lower = -0.02 * x * [0, 0, 1]
        compare(f"lower under a {name} die", predicted(nodes, lower),
                differences("whole mini.prm", STEP, lambda t: write_billet("billet.msh", x + t * lower, elements), *settings), bar)


def on_two_ranks():
    """Of the last part."""
    case = list(CASES)[-1]
    done = start(["mpirun", "-np", "2", *command("gradient", "ranks", case=f"{case}.prm")])
    judge("two ranks end", done.returncode == 0, done.stderr)
    for file in ("sensitivity_nodes.csv", "sensitivity_die_upper_nodes.csv"):
        one, two = (np.loadtxt(f"{folder}/{file}", delimiter=",", skiprows=1) for folder in (case, "ranks"))
        off = np.abs(two - one)[:, 4:].max(axis=0) / np.abs(one)[:, 4:].max(axis=0)
        judge(f"two ranks, {file}: {off.max():.1e}", np.array_equal(one[:, :4], two[:, :4]) and off.max() < 1e-6)


# ---- the lines of the manual ----

QUICK = [f"{section}/{name}={value}" for section, entries in TIGHT.items() for name, value in entries.items()]


def of_the_page(page, output, case, files, *settings):
    """The variables of the page's lines, after a run of the scene that they are about; its first lines say where the results are."""
    for file in (f"{case}.prm", *files):
        shutil.copy(ROOT / "prm/tutorial" / case / file, ".")
    text = text_of(ROOT, "doc/manual", page)
    lines = re.search(r"```python\n(.*?)```", text, re.S)[1]
    judge(f"{page} runs that scene", f"gradient prm/tutorial/{case}/{case}.prm --output {output}\n" in text)
    done = run("gradient", output, *QUICK, *settings, case=f"{case}.prm")
    judge(f"{page}: the scene runs", done.returncode == 0, done.stderr)
    found = {}
    exec(lines, found)  # pylint: disable=exec-used
    return found, lines


def own_mesh():
    short = ("Press/stroke=0.4", "Press/increments=2")
    found, _ = of_the_page("own_mesh.md", "results/rod", "own_mesh", ["rod.msh"], *short)
    head, nodes, end = re.split(r"\$Nodes\n|\$EndNodes", text_of("rod.msh"))
    rows = [row.split() for row in nodes.splitlines()[1:]]
    x = np.array([row[1:] for row in rows], float)

    def move(t):
        moved = (x + t * found["motion"]).tolist()
        write("rod.msh", f"{head}$Nodes\n{len(rows)}\n" + "".join(f"{row[0]} {y[0]!r} {y[1]!r} {y[2]!r}\n" for row, y in zip(rows, moved)) + f"$EndNodes{end}")
    compare("own_mesh.md", found["change"], differences("own_mesh.prm", 0.01, move, *short, *QUICK)[0], 1e-6)


def own_die():
    short = ("Press/stroke=0.4", "Press/increments=2", "Billet/element size=7")
    found, lines = of_the_page("own_die.md", "results/hub", "hub", ["hub_die.stl"], *short)
    with open("hub_die.stl", "rb") as file:
        data = file.read()
    corners = np.frombuffer(data[84:], np.dtype([("floats", "<f4", 12), ("end", "<u2")]))["floats"][:, 3:].reshape(-1, 3).astype(float)
    # The same motion at all corners of the file, which `point` moves along z.
    at_corners = {"np": np, "x": corners}
    exec("".join(line + "\n" for line in lines.splitlines() if re.match("depth|motion", line)), at_corners)  # pylint: disable=exec-used

    def move(t):
        write_die("hub_die.stl", corners + t * at_corners["motion"], np.arange(len(corners)).reshape(-1, 3))
    compare("own_die.md", found["change"], differences("hub.prm", 0.01, move, *short, *QUICK)[0], 1e-6)


if __name__ == "__main__":
    main({f"{case}.prm": prm(sections) for case, sections in CASES.items()}, (own_mesh, own_die, parts, on_two_ranks, higher))
