#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Mean effort of a ring by mu2 and mu3, adjoint against differences:  run.py BUILD"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402


def main():
    summary, text = case_tools.run(sys.argv[1], "check", os.path.join(HERE, "case.prm"), {}, "run", may_fail=True)
    if summary is None:
        sys.exit(text)
    rows = check_tools.check_rows(summary)
    print(f"{summary['mesh']['nodes']} nodes, mean effort {summary['objectives'][0]['value']:.8g} N; by mu2 "
          f"{rows['billet/mu2']['adjoint']:.8g}, by mu3 {rows['billet/mu3']['adjoint']:.8g} N/mm\n{check_tools.table(rows)}")
    for name in ("mu2", "mu3"):
        row = rows[f"billet/{name}"]
        case_tools.figure(f"replayed_{name}", check_tools.worst_over_decades(row, decades=2))
        case_tools.figure(f"free_{name}", check_tools.best(row, "free_central"))
        case_tools.figure(f"tangent_{name}", abs(row["tangent"] / row["adjoint"] - 1.0))


if __name__ == "__main__":
    main()
