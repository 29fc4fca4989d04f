#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Scenes with dies that are hard on contact and remeshing:   run.py BUILD scenes | fold

scenes: each must run to its end, or stop with a reason and a record that can be read. fold: a notch closes, the surface folds
onto itself; the run must stop and say so, and the record must lead back to the same point and the same message."""
import itertools
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

CASE = os.path.join(HERE, "case.prm")


def extrusion(name, points):
    """An STL file of a profile in x and z, extruded along y from -100 to 100; it faces the side to the left of its path."""
    facets = []
    for (x, z), (u, w) in zip(points, points[1:]):
        a, b, c, d = (x, -100, z), (u, -100, w), (u, 100, w), (x, 100, z)
        facets += [(a, b, c), (a, c, d)]
    with open(name, "w", encoding="utf-8") as file:
        file.write("solid profile\n")
        for facet in facets:
            file.write("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {p[0]} {p[1]} {p[2]}\n" for p in facet) + "endloop\nendfacet\n")
        file.write("endsolid profile\n")
    return os.path.abspath(name)


def stl(die, file, facing):
    return {f"Die {die}/shape": "stl", f"Die {die}/file": file, f"Die {die}/facing": facing, f"Die {die}/point": "0, 0, 0"}


def notched_block(name, size=5.0):
    """A Gmsh file of a quarter of the block 30 x 30 x 30 with a V-notch around its middle, 6 deep and 10 wide, in the side +x."""
    n, nz = round(15 / size), round(30 / size)
    nodes, number = [], {}
    for k in range(nz + 1):
        z = 30.0 * k / nz
        width = 15.0 - max(0.0, 6.0 - 1.2 * abs(z - 15.0))
        for j in range(n + 1):
            for i in range(n + 1):
                number[i, j, k] = len(nodes) + 1
                nodes.append((width * i / n, 15.0 * j / n, z))
    cells, faces = [], {}
    for i, j, k in ((i, j, k) for k in range(nz) for j in range(n) for i in range(n)):
        for steps in itertools.permutations(range(3)):  # the six tetrahedra of a cube along its diagonal
            path = [(i, j, k)]
            for axis in steps:
                path.append(tuple(c + (a == axis) for a, c in enumerate(path[-1])))
            even = sum(a > b for a, b in itertools.combinations(steps, 2)) % 2 == 0
            a, b, c, d = (path[m] for m in ((0, 1, 2, 3) if even else (0, 2, 1, 3)))
            cells.append((a, b, c, d))
            for face in ((a, c, b), (a, b, d), (b, c, d), (a, d, c)):
                faces[frozenset(face)] = None if frozenset(face) in faces else face
    planes = {"symmetry x": (0, 0), "side x": (0, n), "symmetry y": (1, 0), "side y": (1, n), "bottom": (2, 0), "top": (2, nz)}
    triangles = [(p, face) for face in faces.values() if face for p, (axis, at) in enumerate(planes.values(), 1)
                 if all(corner[axis] == at for corner in face)]
    with open(name, "w", encoding="utf-8") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" + f"{len(planes) + 1}\n")
        file.write("".join(f'2 {p} "{plane}"\n' for p, plane in enumerate(planes, 1)) + f'3 {len(planes) + 1} "block"\n$EndPhysicalNames\n')
        file.write(f"$Nodes\n{len(nodes)}\n" + "".join(f"{i} {x:.17g} {y:.17g} {z:.17g}\n" for i, (x, y, z) in enumerate(nodes, 1)))
        file.write(f"$EndNodes\n$Elements\n{len(triangles) + len(cells)}\n")
        elements = [(2, p, face) for p, face in triangles] + [(4, len(planes) + 1, cell) for cell in cells]
        file.write("".join(f"{e} {kind} 2 {p} {p} " + " ".join(str(number[corner]) for corner in corners) + "\n"
                           for e, (kind, p, corners) in enumerate(elements, 1)) + "$EndElements\n")
    return os.path.abspath(name)


def scenes():
    # A punch narrower than the block, with sharp edges: the block's surface meets the die's edge.
    punch = extrusion("punch.stl", [(9, 60), (9, 30), (-9, 30), (-9, 60)])
    # A ridge with a radius of 1 mm under elements of 5 mm.
    ridge = extrusion("ridge.stl", [(-60, -6), (-1, -0.4), (-0.7, -0.1), (0, 0), (0.7, -0.1), (1, -0.4), (60, -6)])
    # A box without a lid: metal runs along vertical walls.
    trough = extrusion("trough.stl", [(-18, 60), (-18, 0), (18, 0), (18, 60)])
    step = extrusion("step.stl", [(-60, 0), (10, 0), (10, -5), (60, -5)])
    return {
        "punch with sharp edges": stl("upper", punch, "0, 0, -1"),
        "radius below an element": stl("lower", ridge, "0, 0, 1"),
        "along vertical walls": stl("lower", trough, "0, 0, 1"),
        "corner over a step": stl("lower", step, "0, 0, 1"),
        "thin flash": {"Press/stroke": 27, "Press/increments": 54},
        "fold between sticking dies": {"Die lower/friction": 1, "Die upper/friction": 1, "Press/stroke": 22, "Press/increments": 44},
    }


def retroforge(build, command, output, settings, *options):
    words = [os.path.join(build, "retroforge"), command, CASE, "--output", output, *(options or ("--overwrite",))]
    for key, value in settings.items():
        words += ["--set", f"{key}={value}"]
    return subprocess.run(words, capture_output=True, text=True, timeout=1800)


def increments_recorded(output):
    """Files of the record but the one that is not of an increment."""
    record = os.path.join(output, "record")
    return len(os.listdir(record)) - 1 if os.path.isdir(record) else 0


def run(build, name, settings):
    output = name.replace(" ", "_")
    done = retroforge(build, "gradient", output, settings)
    if done.returncode == 0:
        with open(os.path.join(output, "summary.json"), encoding="utf-8") as file:
            s = json.load(file)
        print(f"| {name} | to the end | {s['increments']} | {s['cuts']} | {s['remeshings']} | {s['newton_iterations'] / s['increments']:.1f} "
              f"| {1 - s['volume_final'] / s['volume_initial']:.1e} |", flush=True)
        return "end"
    message = done.stderr.strip()
    steps = increments_recorded(output)
    print(f"| {name} | {message[:300]} | {steps} | | | | |", flush=True)
    return "reason" if message.startswith("retroforge: ") and message.count(";") >= 2 and steps > 0 else "failed"


def fold(build):
    settings = {"Billet/shape": "file", "Billet/file name": notched_block("notched.msh"), "Billet/symmetry planes": "",
                "Billet/symmetry patches": "symmetry x, symmetry y",
                "Press/stroke": 20, "Press/increments": 40}
    first = retroforge(build, "simulate", "fold", settings)
    steps = increments_recorded("fold")
    again = retroforge(build, "simulate", "fold", settings, "--resume")
    print(f"{first.stderr.strip()}\nafter {steps} increments; resumed:\n{again.stderr.strip()}\nafter {increments_recorded('fold')}")
    case_tools.figure("fold_detected", float(any(words in first.stderr for words in ("the boundary crosses itself", "its surface crosses itself"))))
    case_tools.figure("fold_increments", steps)
    # The advice to go on names the option that takes the place of the one given.
    expected = first.stderr.replace(" in place of --overwrite", "")
    case_tools.figure("fold_resumed", float(again.stderr == expected and increments_recorded("fold") == steps))


def main():
    build, what = sys.argv[1:3]
    if what == "fold":
        fold(build)
        return
    print("| scene | ran | increments | cuts | remeshings | Newton per increment | volume lost |\n" + "| --- " * 7 + "|")
    ends = [run(build, name, settings) for name, settings in scenes().items()]
    case_tools.figure("failed", ends.count("failed"))
    case_tools.figure("to_the_end", ends.count("end"))


if __name__ == "__main__":
    main()
