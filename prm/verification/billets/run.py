#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Gradients of a forging by the shape of the ring, against tangent and differences: run.py BUILD"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402


def main():
    # A failed verdict is no reason to keep the figures back.
    summary, _ = case_tools.run(sys.argv[1], "check", os.path.join(HERE, "case.prm"), may_fail=True)
    rows = {name: row for name, row in check_tools.check_rows(summary).items() if name.startswith("billet/")}
    print(f"{summary['mesh']['nodes']} nodes, energy {case_tools.energy(summary):.9g} mJ")
    print(check_tools.table(rows))
    tangent = {name: abs(row["tangent"] / row["adjoint"] - 1.0) for name, row in rows.items()}
    for name, row in rows.items():
        print(f"{name}: adjoint {row['adjoint']:.9g} mJ/mm, tangent {tangent[name]:.1e}, "
              f"Taylor order {row['taylor_orders'][-1]:.3f}")
    case_tools.figure("tangent", max(tangent.values()))
    case_tools.figure("replayed", max(check_tools.worst_over_decades(row, decades=2) for row in rows.values()))


if __name__ == "__main__":
    main()
