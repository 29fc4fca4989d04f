#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Fold indicators of a notched and of a plain cube:  run.py BUILD

The notch runs along y across the side +x, half way up: 10 mm deep and 24 mm wide at its mouth. Both
cubes have the same mesh, a grid of 12 x 6 x 12 boxes of five tetrahedra each, whose layers are drawn into the notch."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402

CASE = os.path.join(HERE, "case.prm")
EDGE, DEPTH, HALF_WIDTH = 50.0, 10.0, 12.0
NUMBERS = (12, 6, 12)
PLAIN, DIMENSIONLESS = (1, 2, 3, 4), (1, 2, 3, 4, 5, 10)
THESIS = {"fold": {"notched": (1490, 3419, 9674, 35427), "plain": (2106, 4687, 10476, 23510)},
          "dimensionless fold": {"notched": (0.81949, 1.25271, 1.68913, 2.17967, 2.683107, 4.60895),
                                 "plain": (0.85696, 0.96465, 1.03408, 1.09916, 1.16615, 1.49538)}}
# Five tetrahedra of a box; the other way round in every second one, so that faces match.
EVEN = ((0, 1, 2, 4), (3, 2, 1, 7), (5, 4, 7, 1), (6, 7, 4, 2), (1, 2, 4, 7))
ODD = ((1, 3, 0, 5), (2, 0, 3, 6), (4, 6, 5, 0), (7, 5, 6, 3), (0, 3, 5, 6))


def write_mesh(name, notched):
    nx, ny, nz = NUMBERS

    def point(i, j, k):
        x, y, z = EDGE * i / nx - EDGE / 2, EDGE * j / ny - EDGE / 2, EDGE * k / nz
        if notched:
            # Layers gather about the notch; a column of nodes keeps its share of the width that is left.
            s = 2.0 * z / EDGE - 1.0
            z = EDGE / 2 * (1.0 + 0.6 * s + 0.4 * s**3)
            depth = DEPTH * max(0.0, 1.0 - abs(z - EDGE / 2) / HALF_WIDTH)
            x = -EDGE / 2 + (x + EDGE / 2) * (1.0 - depth / EDGE)
        return x, y, z

    def number(i, j, k):
        return 1 + i + (nx + 1) * (j + (ny + 1) * k)

    cells = []
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                corner = [number(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) for c in range(8)]
                cells += [[corner[c] for c in tet] for tet in (ODD if (i + j + k) % 2 else EVEN)]
    points = [point(i, j, k) for k in range(nz + 1) for j in range(ny + 1) for i in range(nx + 1)]

    def volume(tet):
        a, b, c, d = (points[n - 1] for n in tet)
        u, v, w = ([p[m] - a[m] for m in range(3)] for p in (b, c, d))
        return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6

    cells = [tet if volume(tet) > 0 else [tet[1], tet[0]] + tet[2:] for tet in cells]
    count = {}
    for tet in cells:
        for a in range(4):
            face = [tet[b] for b in range(4) if b != a]
            count.setdefault(tuple(sorted(face)), []).append(face)
    faces = [f[0] for f in count.values() if len(f) == 1]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '2 1 "surface"', '3 2 "billet"', "$EndPhysicalNames",
             "$Nodes", str(len(points))]
    lines += ["{} {:.17g} {:.17g} {:.17g}".format(n, *p) for n, p in enumerate(points, 1)]
    lines += ["$EndNodes", "$Elements", str(len(faces) + len(cells))]
    lines += [f"{n} 2 2 1 1 " + " ".join(map(str, f)) for n, f in enumerate(faces, 1)]
    lines += [f"{n} 4 2 2 2 " + " ".join(map(str, t)) for n, t in enumerate(cells, len(faces) + 1)]
    with open(name, "w") as file:
        file.write("\n".join(lines + ["$EndElements", ""]))


def indicators(build, cube):
    write_mesh(f"{cube}.msh", cube == "notched")
    names, settings = [], {"Billet/file name": f"{cube}.msh"}
    for kind, exponents in (("fold", PLAIN), ("dimensionless fold", DIMENSIONLESS)):
        for exponent in exponents:
            names.append(f"{kind} {exponent}")
            settings.update({f"Objective {names[-1]}/type": kind, f"Objective {names[-1]}/exponent": exponent})
    settings["Objectives/names"] = ", ".join(names)
    summary, _ = case_tools.run(build, "simulate", CASE, settings, f"run_{cube}")
    print(f"{cube}: {summary['mesh']['nodes']} nodes, {summary['mesh']['cells']} tetrahedra")
    return {o["name"]: o["value"] for o in summary["objectives"]}


def main():
    build = sys.argv[1]
    found = {cube: indicators(build, cube) for cube in ("notched", "plain")}
    print("| indicator | alpha | notched | plain | ratio | thesis: notched | plain | ratio |\n" + "| --- " * 8 + "|")
    ratios = {}
    for kind, exponents in (("fold", PLAIN), ("dimensionless fold", DIMENSIONLESS)):
        for i, exponent in enumerate(exponents):
            a, b = (found[cube][f"{kind} {exponent}"] for cube in ("notched", "plain"))
            c, d = (THESIS[kind][cube][i] for cube in ("notched", "plain"))
            ratios[kind, exponent] = a / b
            print(f"| {kind} | {exponent} | {a:.6g} | {b:.6g} | {a / b:.3f} | {c:g} | {d:g} | {c / d:.3f} |")
    case_tools.figure("fold_ratio_alpha_1", ratios["fold", 1])
    case_tools.figure("fold_ratio_alpha_4", ratios["fold", 4])
    for exponent in (1, 2, 4, 10):
        case_tools.figure(f"dimensionless_ratio_alpha_{exponent}", ratios["dimensionless fold", exponent])


if __name__ == "__main__":
    main()
