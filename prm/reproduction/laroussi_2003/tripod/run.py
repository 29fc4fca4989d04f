#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The tripod of tables 7 to 12:  run.py BUILD check | drift | cost | mesh

check: d(energy)/d(radius) at 10 mm against replayed and free differences (table 7). drift: energy, gradient and volume at
40 mm with 5 to 56 remeshings (tables 8, 9). cost: bytes, times and linear solves at 40 mm in 50 increments with 10
remeshings (tables 10 to 12). mesh: energy and gradient at 40 mm on three meshes."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402

CASE = os.path.join(HERE, "case.prm")
QUICK = {"Billet/element size": 5, "Press/increments": 5, "Press/stroke": 5, "Remeshing/when": "increments", "Remeshing/every": 2}


def check(build, settings, label):
    settings = {"Press/stroke": 10, "Press/increments": 15, "Output/fields every": 0, "Output/record": "false", **settings}
    summary, _ = case_tools.run(build, "check", CASE, settings, f"run_{label}", may_fail=True)
    rows = check_tools.check_rows(summary)
    print(f"{summary['mesh']['nodes']} nodes, {summary['remeshings']} remeshings, d(energy)/d(radius) "
          f"{rows['billet/radius']['adjoint']:.9g} mJ/mm\n{check_tools.table(rows)}")
    row = rows["billet/radius"]
    case_tools.figure(f"replayed_{label}", check_tools.worst_over_decades(row))
    case_tools.figure(f"free_{label}", check_tools.best(row, "free_central"))
    case_tools.figure(f"tangent_{label}", max(abs(r["tangent"] / r["adjoint"] - 1.0) for r in rows.values()))
    case_tools.figure(f"taylor_{label}", row["taylor_orders"][-1])


def forged(build, settings, label):
    summary, _ = case_tools.run(build, "gradient", CASE, {"Output/fields every": 0, **settings}, f"run_{label}")
    return summary, case_tools.energy(summary), case_tools.gradient(summary)["billet/radius"]


def drift(build):
    print("| remeshings | energy [mJ] | d/d radius [mJ/mm] | change of the energy | of the gradient | volume lost |\n" + "| --- " * 6 + "|")
    first, worst_volume = None, 0.
    for step in (40, 8, 4, 2):  # increments between remeshings, of 112; sooner where the quality asks for it
        settings = {"Press/increments": 112, "Remeshing/when": "increments", "Remeshing/every": step}
        summary, E, g = forged(build, settings, f"drift_{step}")
        lost = 1.0 - summary["volume_final"] / summary["volume_initial"]
        first = first or (E, g)
        changes = abs(E / first[0] - 1.0), abs(g / first[1] - 1.0)
        print(f"| {summary['remeshings']} | {E:.8g} | {g:.8g} | {changes[0]:.2%} | {changes[1]:.2%} | {lost:.1e} |", flush=True)
        worst_volume = max(worst_volume, lost)
    case_tools.figure("energy_drift", changes[0])
    case_tools.figure("gradient_drift", changes[1])
    case_tools.figure("volume_lost", worst_volume)


def cost(build):
    settings = {"Press/increments": 50, "Remeshing/when": "increments", "Remeshing/every": 5}
    summary, _, _ = forged(build, settings, "cost")
    solves = summary["linear_solves_forward"], summary["linear_solves_adjoint"]
    seconds = summary["wall_seconds"]
    forward = seconds["total"] - seconds["adjoint"]
    # 56 n per solve, n that of the first mesh, and 24 + 96 bytes for each of the dies' vertices and triangles per increment;
    # a triangulated surface has about half as many vertices as triangles.
    triangles = sum((os.path.getsize(f"run_cost/die_{die}.stl") - 84) // 50 for die in ("lower", "upper"))
    formula = 56.0 * summary["mesh"]["nodes"] * solves[1] + summary["increments"] * (12.0 + 96.0) * triangles
    print(f"{summary['increments']} increments, {summary['remeshings']} remeshings, record {summary['record_bytes'] / 1e6:.1f} MB; "
          f"forward {forward:.1f} s with {solves[0]} linear solves, adjoint {seconds['adjoint']:.1f} s with {solves[1]}; "
          f"remeshing {seconds['remeshing']:.2f} s")
    case_tools.figure("bytes_of_formula", summary["record_bytes"] / formula)
    case_tools.figure("adjoint_over_forward", seconds["adjoint"] / forward)
    case_tools.figure("remeshing_share", seconds["remeshing"] / forward)


def mesh(build):
    print("| element size [mm] | nodes at the start | energy [mJ] | d/d radius [mJ/mm] |\n" + "| --- " * 4 + "|")
    results = []
    sizes = (5.6, 4, 2.8)
    for size in sizes:
        summary, E, g = forged(build, {"Billet/element size": size}, f"mesh_{size}")
        results.append((E, g))
        print(f"| {size} | {summary['mesh']['nodes']} | {E:.8g} | {g:.8g} |", flush=True)
    for i, name in enumerate(("energy", "gradient")):
        coarse, fine = abs(results[0][i] - results[1][i]), abs(results[1][i] - results[2][i])
        case_tools.figure(f"{name}_step", fine / coarse)
        case_tools.figure(f"{name}_order", math.log(coarse / fine) / math.log(sizes[0] / sizes[1]))


def main():
    build, what = sys.argv[1:3]
    if what == "check":
        check(build, {}, "10mm")
    elif what == "quick":
        check(build, QUICK, "coarse")
    else:
        {"drift": drift, "cost": cost, "mesh": mesh}[what](build)


if __name__ == "__main__":
    main()
