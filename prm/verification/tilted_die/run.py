#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Gradients under a tilted die against differences, replayed and free: run.py BUILD [quick]"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402

QUICK = {"Design/parameters": "die upper/speed, die upper/offset, billet/stretch", "Press/increments": 4, "Press/stroke": 3,
         "Check/steps": "1e-5, 1e-6, 1e-7"}
DECADES = 2
SIZE = 30.0


def free_error(row, increment):
    """Smallest error of free differences among steps below a thousandth of the increment's stroke."""
    length = 1e-3 * increment / SIZE
    return min(e for step, e in check_tools.errors(row, "free_central") if step < length)


def main():
    build, quick = sys.argv[1], "quick" in sys.argv[2:]
    settings = QUICK if quick else {}
    label = "quick" if quick else "all"
    # A failed verdict is no reason to keep the figures back.
    summary, _ = case_tools.run(build, "check", os.path.join(HERE, "case.prm"), settings, f"run_{label}", may_fail=True)
    rows = check_tools.check_rows(summary)
    increment = float(settings.get("Press/stroke", 6)) / summary["increments"]
    print(f"{summary['mesh']['nodes']} nodes, {summary['increments']} increments, energy {case_tools.energy(summary):.9g} mJ")
    print(check_tools.table(rows))
    print("| parameter | adjoint | tangent | replayed, two decades | free | Taylor order |\n" + "| --- " * 6 + "|")
    worst = {"replayed": 0.0, "free": 0.0, "tangent": 0.0, "taylor": 9.0}
    for name, row in rows.items():
        found = {"replayed": check_tools.worst_over_decades(row, decades=DECADES),
                 "free": free_error(row, increment),
                 "tangent": abs(row["tangent"] / row["adjoint"] - 1.0), "taylor": row["taylor_orders"][-1]}
        print(f"| {name} | {row['adjoint']:.9g} | {found['tangent']:.1e} | {found['replayed']:.1e} "
              f"| {found['free']:.1e} | {found['taylor']:.3f} |")
        for key, value in found.items():
            worst[key] = min(worst[key], value) if key == "taylor" else max(worst[key], value)
    for key, value in worst.items():
        case_tools.figure(f"{key}_{label}", value)


if __name__ == "__main__":
    main()
