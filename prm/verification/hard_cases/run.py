#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Newton and Krylov iterations at the hard corners of the model: run.py BUILD [fine]"""
import csv
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

M, V0, RHO = "Material/strain rate sensitivity", "Contact/slip regularisation", "Contact/penetration"
RATE = "Material/regularising strain rate"


def friction(value):
    return {"Die lower/friction": value, "Die upper/friction": value}


THIN = {"Billet/size": "40, 40, 4", "Billet/element size": 2, "Die upper/point": "0, 0, 4", "Press/stroke": 0.4}
TILTED = {"Die upper/facing": "0, -0.3420, -0.9397", "Die upper/point": "0, 20, 40"}
CASES = {
    "base": {},
    "m = 1": {M: 1},
    "m = 0.1": {M: 0.1},
    "m = 0.05": {M: 0.05},
    "friction 1": friction(1),
    "friction 0": friction(0),
    "v0 = 1e-1": {V0: 1e-1},
    "v0 = 1e-3": {V0: 1e-3},
    "v0 = 1e-3, friction 1": {V0: 1e-3, **friction(1)},
    "m = 0.05, v0 = 1e-3, friction 1": {M: 0.05, V0: 1e-3, **friction(1)},
    "thin, 1/10": THIN,
    "thin, friction 1, v0 = 1e-3": {**THIN, V0: 1e-3, **friction(1)},
    "thin, m = 0.05, friction 1, v0 = 1e-3": {**THIN, M: 0.05, V0: 1e-3, **friction(1)},
    "low rho (penetration 1e-2)": {RHO: 1e-2},
    "high rho (penetration 1e-10)": {RHO: 1e-10},
    "high rho, m = 0.05, friction 1": {RHO: 1e-10, M: 0.05, **friction(1)},
    "barely a strain rate (e0 = 1e-8)": {RATE: 1e-8},
    "tiny start (0.004 mm increments)": {"Press/stroke": 0.016},
    "long increments (2 x 8 mm)": {"Press/stroke": 16, "Press/increments": 2},
    "tilted die, 20 degrees": TILTED,
    "tilted die, friction 1, v0 = 1e-3": {**TILTED, V0: 1e-3, **friction(1)},
    "tilted die, high rho": {**TILTED, RHO: 1e-8},
    "multigrid": {"Linear solver/method": "multigrid"},
    "multigrid, tilted, high rho": {"Linear solver/method": "multigrid", **TILTED, RHO: 1e-8},
    "multigrid, m = 0.05, v0 = 1e-3, friction 1": {"Linear solver/method": "multigrid", M: 0.05, V0: 1e-3, **friction(1)},
    "multigrid, thin, friction 1": {"Linear solver/method": "multigrid", **THIN, **friction(1)},
}


def history(folder):
    with open(os.path.join(folder, "history.csv"), encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def column(row, word):
    return int(float(next(value for key, value in row.items() if word in key.lower())))


def main():
    build = sys.argv[1]
    fine = "fine" in sys.argv[2:]
    label = "fine" if fine else "coarse"
    failures, worst = 0, 0
    print("| case | nodes | Newton: first increment | later, at most | Krylov: first | later, at most | cuts | seconds |")
    print("| --- " * 8 + "|")
    for number, (name, settings) in enumerate(CASES.items()):
        if fine:
            settings = {**settings, "Billet/element size": 0.5 * settings.get("Billet/element size", 5)}
        summary, said = case_tools.run(build, "simulate", os.path.join(HERE, "case.prm"), settings, f"run_{label}_{number}",
                                       may_fail=True)
        if summary is None:
            failures += 1
            print(f"| {name} | FAILED: {said.strip().splitlines()[-1][:200]} |")
            continue
        if not summary["krylov_iterations"]:
            raise SystemExit(f"{name}: nothing was forged")
        rows = history(f"run_{label}_{number}")
        newton, krylov = [column(r, "newton") for r in rows], [column(r, "krylov") for r in rows]
        worst = max(worst, *newton[1:])
        print(f"| {name} | {summary['mesh']['nodes']} | {newton[0]} | {max(newton[1:])} | {krylov[0]} | {max(krylov[1:])} "
              f"| {summary['cuts']} | {summary['wall_seconds']['total']:.1f} |", flush=True)
    print("(both stages of the midpoint rule together)")
    case_tools.figure(f"hard_cases_failures_{label}", failures)
    case_tools.figure(f"newton_in_a_warm_increment_{label}", worst)


if __name__ == "__main__":
    main()
