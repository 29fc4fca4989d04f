#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Energy and gradient of a cube crushed by 12 mm with 0, 3 and 10 remeshings it does not need, and the gradient through
ten of them against replayed differences:   run.py BUILD change | run.py BUILD check"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402

CASE = os.path.join(HERE, "case.prm")
EVERY = {3: 9, 10: 3}  # increments between remeshings, of 33
COARSE = {"Billet/element size": 12}


def remeshed(times, method="local"):
    return {"Remeshing/when": "increments", "Remeshing/every": EVERY[times], "Remeshing/method": method} if times else {"Remeshing/when": "never"}


def change(build):
    plain = None
    print("| remeshings | method | nodes | energy [mJ] | d/dmu [N] | change of the energy | of the gradient |\n" + "| --- " * 7 + "|")
    for times, method in ((0, "-"), (3, "local"), (10, "local"), (3, "rebuild"), (10, "rebuild")):
        summary, _ = case_tools.run(build, "gradient", CASE, remeshed(times, method), f"run_{times}_{method}")
        assert summary["remeshings"] == times, summary["remeshings"]
        E, g = case_tools.energy(summary), case_tools.gradient(summary)["billet/stretch"]
        plain = plain or (E, g)
        changes = abs(E / plain[0] - 1.0), abs(g / plain[1] - 1.0)
        print(f"| {times} | {method} | {summary['mesh']['nodes']} | {E:.9g} | {g:.9g} | {changes[0]:.1e} | {changes[1]:.1e} |", flush=True)
        if method == "local":
            case_tools.figure(f"energy_{times}", changes[0])
            case_tools.figure(f"gradient_{times}", changes[1])


def check(build):
    summary, _ = case_tools.run(build, "check", CASE, {**COARSE, **remeshed(10)}, "run_check", may_fail=True)
    rows = check_tools.check_rows(summary)
    print(check_tools.table(rows, ("replayed_central",)))
    row = rows["billet/stretch"]
    case_tools.figure("replayed", check_tools.worst_over_decades(row))
    case_tools.figure("taylor", min(row["taylor_orders"]))
    random = rows["X_0 (random direction)"]
    case_tools.figure("taylor_random", random["taylor_orders"][-1])
    case_tools.figure("tangent", max(abs(r["tangent"] / r["adjoint"] - 1.0) for r in rows.values()))


if __name__ == "__main__":
    {"change": change, "check": check}[sys.argv[2]](sys.argv[1])
