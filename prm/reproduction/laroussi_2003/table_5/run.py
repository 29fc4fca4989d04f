#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""d(energy)/d(stretch) of a cube under friction: the adjoint against replayed and free central differences.

run.py BUILD quick | run.py BUILD STROKE LAW     STROKE 8, 12 or 16 mm, LAW sharp (the thesis') or smooth (the default)
"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402

LAWS = {"sharp": {"Contact/law": "sharp", "Contact/approach": 1}, "smooth": {}}
COARSE = {"Billet/element size": 15, "Press/increments": 8, "Check/steps": "1e-3, 1e-4, 1e-5, 1e-6"}


def measure(build, stroke, law, settings, label):
    settings = {**LAWS[law], "Press/stroke": stroke, **settings}
    # A failed verdict (of the random direction, say) is no reason to keep the figures back.
    summary, _ = case_tools.run(build, "check", os.path.join(HERE, "case.prm"), settings, f"run_{label}", may_fail=True)
    rows = check_tools.check_rows(summary)
    row = rows["billet/stretch"]
    print(f"{law}, {stroke} mm: {summary['mesh']['nodes']} nodes, {summary['increments']} increments, "
          f"energy {case_tools.energy(summary):.9g} mJ, d/dmu {row['adjoint']:.9g} N")
    print(check_tools.table(rows))
    case_tools.figure(f"replayed_{label}", check_tools.worst_over_decades(row))
    case_tools.figure(f"free_{label}", check_tools.best(row, "free_central"))
    case_tools.figure(f"taylor_{label}", min(row["taylor_orders"]))
    case_tools.figure(f"tangent_{label}", abs(row["tangent"] / row["adjoint"] - 1.0))


def main():
    build = sys.argv[1]
    if sys.argv[2] == "quick":
        for law in LAWS:
            measure(build, 16, law, COARSE, f"coarse_{law}")
    else:
        measure(build, int(sys.argv[2]), sys.argv[3], {}, f"{sys.argv[2]}_{sys.argv[3]}")


if __name__ == "__main__":
    main()
