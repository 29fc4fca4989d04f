#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A sector with symmetry planes against the whole body, its mesh made of mirror images:   run.py BUILD

What a run of the sector tells of the whole part, objectives and derivatives by process and nodes, must be what a run of the whole body
finds: the discrete problems are the same but for rounding. Sectors of 90 and of 60 degrees, whose second plane lies along no axis."""
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

sys.path.insert(0, os.path.join(HERE, "..", "..", "..", "contrib", "python"))
import retroforge  # noqa: E402

HEIGHT, WIDTH, DEPTH = 20.0, 16.0, 6.0


# ---- a sector, and its images ----

def rotation(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def images(angle):
    """The group that reflections in the planes at 0 and `angle` degrees generate; their determinants alternate."""
    flip = np.diag([1.0, -1.0, 1.0])
    turns = [rotation(2 * angle * i) for i in range(round(180 / angle))]
    return [turn @ m for turn in turns for m in (np.eye(3), flip)]


def triangles_of_sector(angle, n, radius):
    """Points (x, y) of a triangular lattice between the two planes, and counter-clockwise triangles."""
    number = {ij: k for k, ij in enumerate((i, j) for i in range(n + 1) for j in range(n + 1 - i))}
    ends = radius * np.array([[1.0, 0.0], [np.cos(np.radians(angle)), np.sin(np.radians(angle))]])
    points = np.array([i / n * ends[0] + j / n * ends[1] for i, j in number])
    triangles = []
    for i, j in number:
        if i + j < n:
            triangles.append((number[i, j], number[i + 1, j], number[i, j + 1]))
        if i + j < n - 1:
            triangles.append((number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]))
    return points, triangles


def sector_mesh(angle, n=4, layers=4):
    """Nodes and positive tetrahedra of a prism over the sector, the nodes moved at random within planes and sides."""
    points, triangles = triangles_of_sector(angle, n, WIDTH)
    random = np.random.default_rng(7)
    cell = WIDTH / n
    inside = {"on 0": points[:, 1] < 1e-9, "on angle": np.abs(np.cross(points, [np.cos(np.radians(angle)), np.sin(np.radians(angle))])) < 1e-9}
    outer = [i for i, _ in enumerate(points) if i in {t[c] for t in triangles for c in range(3)} and is_outer(points[i], angle)]
    nodes = []
    for layer in range(layers + 1):
        shift = 0.15 * cell * random.uniform(-1.0, 1.0, (len(points), 3))
        shift[inside["on 0"], 1] = 0.0
        along = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        shift[inside["on angle"], :2] = np.outer(shift[inside["on angle"], :2] @ along, along)
        shift[inside["on 0"] & inside["on angle"], :2] = 0.0
        shift[outer, :2] = 0.0
        if layer in (0, layers):
            shift[:, 2] = 0.0
        nodes.append(np.column_stack([points, np.full(len(points), HEIGHT * layer / layers)]) + shift)
    tetrahedra = []
    for layer in range(layers):
        for triangle in triangles:
            bottom = sorted(k + layer * len(points) for k in triangle)
            top = [k + len(points) for k in bottom]
            tetrahedra += [(*bottom, top[2]), (bottom[0], bottom[1], top[1], top[2]), (bottom[0], *top)]
    return oriented(np.vstack(nodes), tetrahedra)


def is_outer(point, angle):
    """Whether it lies on the chord between the ends of the two planes."""
    half = np.radians(angle / 2)
    return point @ [np.cos(half), np.sin(half)] > WIDTH * np.cos(half) - 1e-9


def oriented(nodes, tetrahedra):
    edges = lambda t: [nodes[t[k]] - nodes[t[0]] for k in (1, 2, 3)]  # noqa: E731
    return nodes, [t if np.linalg.det(edges(t)) > 0 else (t[1], t[0], t[2], t[3]) for t in tetrahedra]


def united(pieces):
    """Of [(points, simplices)]: equal points become one."""
    known, points, simplices = {}, [], []
    for piece, parts in pieces:
        number = []
        for x in piece:
            key = tuple(np.round(x, 7) + 0.0)
            if key not in known:
                known[key] = len(points)
                points.append(x)
            number.append(known[key])
        simplices += [tuple(number[k] for k in part) for part in parts]
    return np.array(points), simplices


def boundary(tetrahedra):
    seen = {}
    for a, b, c, d in tetrahedra:
        for face in ((b, c, d), (a, d, c), (a, b, d), (a, c, b)):
            key = tuple(sorted(face))
            seen[key] = None if key in seen else face
    return [face for face in seen.values() if face]


def write_mesh(file, nodes, tetrahedra, planes):
    """A Gmsh file whose faces in the planes at the given angles are the surfaces `plane ANGLE`, the others `skin`."""
    faces = []
    for face in boundary(tetrahedra):
        x = nodes[list(face)]
        of = [p for p, angle in enumerate(planes) if np.all(np.abs(x @ [-np.sin(np.radians(angle)), np.cos(np.radians(angle)), 0.0]) < 1e-9)]
        faces.append((of[0] + 2 if of else 1, face))
    names = ["skin"] + [f"plane {angle}" for angle in planes]
    with open(file, "w", encoding="utf-8") as out:
        out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % (len(names) + 1))
        out.writelines(f'2 {k + 1} "{name}"\n' for k, name in enumerate(names))
        out.write('3 9 "billet"\n$EndPhysicalNames\n$Nodes\n%d\n' % len(nodes))
        out.writelines(f"{k + 1} {x[0]!r} {x[1]!r} {x[2]!r}\n" for k, x in enumerate(nodes.tolist()))
        out.write("$EndNodes\n$Elements\n%d\n" % (len(faces) + len(tetrahedra)))
        rows = [(2, tag, face) for tag, face in faces] + [(4, 9, t) for t in tetrahedra]
        out.writelines(f"{k + 1} {kind} 2 {tag} {tag} {' '.join(str(v + 1) for v in s)}\n" for k, (kind, tag, s) in enumerate(rows))
        out.write("$EndElements\n")


def write_die(file, angle, n=24):
    """A flat die that faces down, with a round cavity in its middle; its facets are mirror images too."""
    points, triangles = triangles_of_sector(angle, n, 4 * WIDTH)
    r = np.linalg.norm(points, axis=1)
    sector = np.column_stack([points, HEIGHT + DEPTH * np.exp(-((r / 9.0) ** 2))])
    with open(file, "w", encoding="utf-8") as out:
        out.write("solid upper\n")
        for m in images(angle):
            for t in triangles:
                # downwards: clockwise seen from above, which a reflection turns round
                corners = (sector @ m.T)[list(t[::-1] if np.linalg.det(m) > 0 else t)]
                out.write("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x[0]!r} {x[1]!r} {x[2]!r}\n" for x in corners.tolist()))
                out.write("endloop\nendfacet\n")
        out.write("endsolid\n")


# ---- the two runs ----

CAVITY = {"Die upper/shape": "stl", "Die upper/point": "0, 0, 0",
          "Objectives/names": "energy, mean effort, maximum effort, mean strain, strain variance, maximum strain, contact pressure, volume, "
                              "unfilled volume, filling",
          "Objective unfilled volume/target": "die upper", "Objective filling/target": "die upper",
          # Its sides stand where the die is plane: what a curved facet has behind it is cut by its share only.
          "Objective unfilled volume/region to": "30, 30, 21"}


# Flat dies with another law of friction, which follows the strain rate of the metal behind a point.
LAWS = {"Tresca": "material/K, material/m, die lower/friction, die upper/friction, die upper/speed, die upper/offset",
        "Coulomb": "material/K, die lower/friction, die lower/shear limit, die upper/friction, die upper/speed, die upper/offset"}


def run(build, name, angle, die, whole):
    """The summary."""
    settings = {"Billet/file name": os.path.abspath(f"{name}_whole.msh" if whole else f"{name}.msh"),
                "Billet/symmetry patches": "" if whole else f"plane 0, plane {angle}"}
    if die == "cavity":
        quarter = angle == 90 and not whole
        settings |= {**CAVITY, "Die upper/file": os.path.abspath(f"{name}.stl"),
                     "Objective unfilled volume/region from": "0, 0, 14" if quarter else "-30, -30, 14"}
    if die in LAWS:
        settings |= {f"Die {d}/friction law": die for d in ("lower", "upper")} | {"Design/parameters": LAWS[die]}
    output = f"{name}_{die}_whole" if whole else f"{name}_{die}"
    return case_tools.run(build, "gradient", os.path.join(HERE, "case.prm"), settings, output)[0]


def by_nodes(folder):
    """{objective: gradient by the first mesh's nodes}, and the nodes"""
    _, points, gradients = retroforge.read_nodal(os.path.join(folder, "sensitivity_nodes.csv"))
    return gradients, points


def write_scene(angle):
    """The files of a sector and of its whole; the number of images."""
    nodes, tetrahedra = sector_mesh(angle)
    pieces = [oriented(nodes @ m.T, tetrahedra) for m in images(angle)]
    write_mesh(f"sector_{angle}.msh", nodes, tetrahedra, [0, angle])
    write_mesh(f"sector_{angle}_whole.msh", *united(pieces), [])
    write_die(f"sector_{angle}.stl", angle)
    return len(pieces)


FILLING = ("unfilled volume", "filling")
PRESSURE = "contact pressure"


def compare(build, angle, die, copies):
    """Values and derivatives by the process; {objective: whole over sector}"""
    part, whole = (run(build, f"sector_{angle}", angle, die, is_whole) for is_whole in (False, True))
    assert part["whole"]["copies"] == copies, part["whole"]
    # A box is mirrored by planes along their axes only.
    names = [o["name"] for o in part["objectives"] if angle == 90 or o["name"] not in FILLING]
    factors, worst = {}, {"value": 0.0, "gradient": 0.0}
    print(f"| {angle} degrees, {die}: objective | of the sector | whole by the sector | whole body | off |\n" + "| --- " * 5 + "|")
    for a, b in zip(part["objectives"], whole["objectives"]):
        told = a.get("whole", a["value"])
        factors[a["name"]] = told / a["value"]
        off = abs(told / b["value"] - 1.0)
        worst["value"] = max(worst["value"], off if a["name"] in names else 0.0)
        print(f"| {a['name']} | {a['value']:.12g} | {told:.12g} | {b['value']:.12g} | {off:.1e} |")
    print("| d/d | " + " | ".join(names) + " |\n" + "| --- " * (1 + len(names)) + "|")
    # Of the largest change that one per cent of a parameter makes: an objective hardly depends on some.
    largest = {o: max(abs(b["scale"] * b["gradient"][o]) for b in whole["parameters"]) for o in names}
    for a, b in zip(part["parameters"], whole["parameters"]):
        offs = [abs(b["scale"] * (factors[o] * a["gradient"][o] - b["gradient"][o])) / largest[o] for o in names]
        for name, off in zip(names, offs):
            # On a penalty, the contact pressure's derivatives keep half of the digits.
            kind = "filling_gradient" if name in FILLING else "pressure_gradient" if name == PRESSURE and die == "cavity" else "gradient"
            worst[kind] = max(worst.get(kind, 0.0), off)
        print(f"| {a['name']} | " + " | ".join(f"{off:.1e}" for off in offs) + " |")
    for key, value in worst.items():
        case_tools.figure(f"{die}_{key}_{angle}", value)
    return factors


def compare_nodes(angle, die, copies, factors):
    """One node of the whole body moves, not all its images. Of smooth objectives: on a facet's edge, where the images of a curved die's
    facets meet in the planes, the slope of the normal jumps."""
    gradients, x = by_nodes(f"sector_{angle}_{die}")
    of_whole, all_x = by_nodes(f"sector_{angle}_{die}_whole")
    at = {tuple(np.round(p, 4) + 0.0): k for k, p in enumerate(all_x)}
    inside = [k for k, p in enumerate(x) if p[1] > 1e-4 and p @ [np.sin(np.radians(angle)), -np.cos(np.radians(angle)), 0.0] > 1e-4]
    same = [at[tuple(np.round(x[k], 4) + 0.0)] for k in inside]
    worst = 0.0
    for objective, factor in factors.items():
        expected = factor / copies * gradients[objective][inside]
        off = np.abs(expected - of_whole[objective][same]).max() / np.abs(expected).max()
        worst = max(worst, off)
        print(f"d {objective}/d node, {len(inside)} nodes: {off:.1e}")
    case_tools.figure(f"{die}_nodes_{angle}", worst)


def main():
    for angle in (90, 60):
        copies = write_scene(angle)
        compare(sys.argv[1], angle, "cavity", copies)
        for die in ("flat", *LAWS):
            compare_nodes(angle, die, copies, compare(sys.argv[1], angle, die, copies))


if __name__ == "__main__":
    main()
