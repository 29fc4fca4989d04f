#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The ring test at several frictions: the bore after 50 % against a published calibration, and against the upper bound
for a ring that stays straight.  run.py BUILD  prints a table, and the figures of the scorecard for three frictions;
run.py BUILD all  the table for all frictions of the calibration."""
import os
import sys

import numpy as np
from scipy.integrate import trapezoid
from scipy.optimize import minimize_scalar

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

# Bore diameter [mm] of a ring 60:30:20 mm after 50 %, by Tresca's m; simulated, good to about 1 %.
CALIBRATION = {0.05: 38.2, 0.1: 34.6, 0.15: 31.6, 0.2: 29.7, 0.3: 26.0, 0.4: 23.2, 0.5: 21.1, 0.6: 19.5}
SCORED = (0.05, 0.1, 0.3)


def bore(build, m):
    """Mean bore diameter [mm] of the simulation; m is alpha, see the README."""
    summary, _ = case_tools.run(build, "simulate", os.path.join(HERE, "ring_test.prm"),
                                {"Die upper/friction": m, "Output/fields every": 0}, f"m_{m:g}")
    found = next(objective for objective in summary["objectives"] if objective["name"] == "bore")
    return 2 * found["details"]["radius [mm]"]


def straight_ring(m, n=200):
    """Bore diameter [mm] by the velocities  u_r = (r - c/r)/(2h),  u_z = -z/h  per unit of speed, c of least power: Avitzur's
    upper bound without bulging, for a rigid, perfectly plastic ring. The power is over the flow stress."""
    inner, outer, height = 15.0, 30.0, 20.0
    step = 10.0 / n
    for _ in range(n):
        r = np.linspace(inner, outer, 400)

        def power(c):
            strain_rate = np.sqrt(1.0 + c**2 / (3.0 * r**4)) / height
            slip = np.abs(r - c / r) / (2.0 * height)
            return trapezoid(r * (strain_rate * height + 2.0 * m / np.sqrt(3.0) * slip), r)
        c = minimize_scalar(power, bounds=(-4.0 * outer**2, outer**2), method="bounded", options={"xatol": 1e-6}).x
        inner, outer = (radius + step * (radius - c / radius) / (2.0 * height) for radius in (inner, outer))
        height -= step
    return 2.0 * inner


def main():
    build = sys.argv[1]
    print("| Tresca m = alpha | bore [mm] | calibration [mm] | difference | straight ring [mm] | difference |")
    print("| --- | --- | --- | --- | --- | --- |")
    errors = {}
    for m in CALIBRATION if "all" in sys.argv[2:] else SCORED:
        found, straight = bore(build, m), straight_ring(m)
        errors[m] = abs(found / CALIBRATION[m] - 1.0), abs(found / straight - 1.0)
        print(f"| {m:g} | {found:.2f} | {CALIBRATION[m]:g} | {100 * (found / CALIBRATION[m] - 1):+.1f} % "
              f"| {straight:.2f} | {100 * (found / straight - 1):+.1f} % |", flush=True)
    for m in SCORED:
        case_tools.figure(f"bore_at_m_{m:g}", errors[m][0])
    case_tools.figure("bore_of_straight_ring", errors[0.1][1])


if __name__ == "__main__":
    main()
