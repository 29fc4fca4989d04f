#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The ring test with Tresca's friction, for metals of two rate sensitivities: the bore after 50 % against a published
calibration, and against a ring that stays straight; and the shear factor found again from the bore of the straight ring.
run.py BUILD forward | backward"""
import json
import os
import sys

import numpy as np
from scipy.integrate import trapezoid
from scipy.optimize import minimize_scalar

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

BUILD = sys.argv[1]
CASE = os.path.join(HERE, "ring.prm")
# Bore diameter [mm] of a ring 60:30:20 mm after 50 %, by Tresca's factor; simulated by others, good to about 1 %.
CALIBRATION = {0.05: 38.2, 0.1: 34.6, 0.2: 29.7, 0.3: 26.0, 0.4: 23.2, 0.6: 19.5}
SENSITIVITIES = (0.05, 0.2)
IDENTIFIED = (0.1, 0.2)


def bore(factor, m):
    """Mean bore diameter [mm] of the simulation."""
    summary, _ = case_tools.run(BUILD, "simulate", CASE, {"Die upper/friction": factor,
                                                          "Material/strain rate sensitivity": m}, f"f_{factor:g}_{m:g}")
    return 2 * summary["objectives"][0]["value"]


def straight_ring(factor, m, n=200):
    """Bore diameter [mm] by the velocities  u_r = (r - c/r)/(2h),  u_z = -z/h  per unit of speed, that is Avitzur's field
    without bulging, for a metal of flow stress e^m: c is that of the least
        integral of r (E^(m+1)/(m+1) + 2 factor/sqrt3 E_0^m |r - c/r|/(2h)),   E = h e = sqrt(1 + c^2/(3 r^4)),
    E_0 the E of the step before, whose flow stress friction follows: at m = 0 the least power, an upper bound."""
    inner, outer, height, c = 15.0, 30.0, 20.0, 0.0
    step = 10.0 / n

    def rate(r, c):
        return np.sqrt(1.0 + c**2 / (3.0 * r**4))
    for _ in range(n):
        r = np.linspace(inner, outer, 400)
        shear = rate(r, c)**m / np.sqrt(3.0)

        def functional(c, r=r, shear=shear, height=height):
            slip = np.abs(r - c / r) / (2.0 * height)
            return trapezoid(r * (rate(r, c)**(m + 1) / (m + 1) + 2.0 * factor * shear * slip), r)
        c = minimize_scalar(functional, bounds=(-4.0 * outer**2, outer**2), method="bounded", options={"xatol": 1e-6}).x
        inner, outer = (radius + step * (radius - c / radius) / (2.0 * height) for radius in (inner, outer))
        height -= step
    return 2.0 * inner


def forward():
    print("| m | Tresca's factor | bore [mm] | calibration [mm] | difference | straight ring [mm] | difference |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for m in SENSITIVITIES:
        errors, straight_errors = [], []
        for factor, published in CALIBRATION.items():
            found, straight = bore(factor, m), straight_ring(factor, m)
            errors.append(abs(found / published - 1.0))
            straight_errors.append(abs(found / straight - 1.0))
            print(f"| {m:g} | {factor:g} | {found:.2f} | {published:g} | {100 * (found / published - 1):+.1f} % | {straight:.2f} "
                  f"| {100 * (found / straight - 1):+.1f} % |", flush=True)
        case_tools.figure(f"bore_m_{m:g}", max(errors))
        case_tools.figure(f"bore_of_straight_ring_m_{m:g}", max(straight_errors))


def backward():
    m = SENSITIVITIES[0]
    errors = []
    for factor in IDENTIFIED:
        output = f"identify_{factor:g}"
        case_tools.run(BUILD, "optimize", CASE, {"Optimisation/data": f"bore: {0.5 * straight_ring(factor, m):.4f}",
                                                 "Die upper/friction": 0.15}, output, may_fail=True)
        with open(os.path.join(output, "optimisation.json"), encoding="utf-8") as file:
            found = json.load(file)["parameters"][0]["best"]
        errors.append(abs(found / factor - 1.0))
        print(f"factor {factor:g}: found {found:.4f}, {100 * (found / factor - 1):+.1f} %", flush=True)
    case_tools.figure("identified_factor", max(errors))


if __name__ == "__main__":
    {"forward": forward, "backward": backward}[sys.argv[2]]()
