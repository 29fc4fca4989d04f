#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Derivatives by zones of friction against tangent and differences: run.py BUILD"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402


def main():
    summary, _ = case_tools.run(sys.argv[1], "check", os.path.join(HERE, "zones.prm"), output="zones", may_fail=True)
    rows = check_tools.check_rows(summary)
    print(check_tools.table(rows))
    case_tools.figure("zones_tangent", max(abs(row["tangent"] / row["adjoint"] - 1.0) for row in rows.values()))
    case_tools.figure("zones_replayed", max(check_tools.best(row, "replayed_central") for row in rows.values()))


if __name__ == "__main__":
    main()
