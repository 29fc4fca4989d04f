#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The fold indicator of the cube of table 4 and its derivative with respect to the stretch, alpha 1 to 4, against the
formula of its uniform flow:  run.py BUILD

Between flat dies without friction e = v/h everywhere and the free surface is 4 a h, so that (140) is a sum over the
increments; here with the a and h of the time scheme, at which program and formula agree to the penalty."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PRM = os.path.join(HERE, "..", "..", "..")
sys.path.insert(0, PRM)
from case_tools import figure, run  # noqa: E402

CASE = os.path.join(HERE, "..", "table_4", "case.prm")
EDGE, SPEED, STROKE, INCREMENTS = 50.0, 100.0, 10.0, 15
ALPHAS = (1, 2, 3, 4)


def formula(scheme, alpha, base_edge):
    """Sum over the increments of (v/h)^alpha 4 a h dt; base_edge may be complex."""
    dt = STROKE / INCREMENTS / SPEED
    h, a, total = EDGE, base_edge, 0.0
    for _ in range(INCREMENTS):
        # Where the increment takes its rates: the start for euler, the middle for midpoint.
        h_y, a_y = (h, a) if scheme == "euler" else (h - dt / 2 * SPEED, a * (1 + dt / 4 * SPEED / h))
        total += dt * (SPEED / h_y)**alpha * 4 * a_y * h_y
        h, a = h - dt * SPEED, a + dt / 2 * SPEED / h_y * a_y
    return total


def program(build, scheme, penetration):
    settings = {"Press/scheme": scheme, "Press/stroke": STROKE, "Press/increments": INCREMENTS, "Output/record": "false",
                "Objectives/names": ", ".join(f"fold {alpha}" for alpha in ALPHAS), "Contact/penetration": penetration,
                "Newton/tolerance": 1e-10, "Adjoint/tolerance": 1e-13}
    for alpha in ALPHAS:
        settings.update({f"Objective fold {alpha}/type": "fold", f"Objective fold {alpha}/exponent": alpha})
    summary, _ = run(build, "gradient", CASE, settings)
    values = {o["name"]: 4 * o["value"] for o in summary["objectives"]}
    derivatives = {name: 4 * d for name, d in summary["parameters"][0]["gradient"].items()}
    return values, derivatives


def main():
    print("| scheme | alpha | fold | formula | by the stretch | formula |\n" + "| --- " * 6 + "|")
    for scheme in ("euler", "midpoint"):
        values, derivatives = program(sys.argv[1], scheme, 1e-9)
        worst = [0.0, 0.0]
        for alpha in ALPHAS:
            # Stretching by mu makes the edge a + 2 mu.
            exact = formula(scheme, alpha, EDGE + 2e-100j)
            exact = exact.real, exact.imag / 1e-100
            found = values[f"fold {alpha}"], derivatives[f"fold {alpha}"]
            print(f"| {scheme} | {alpha} | {found[0]:.10g} | {exact[0]:.10g} | {found[1]:.10g} | {exact[1]:.10g} |")
            worst = [max(w, abs(f / e - 1)) for w, f, e in zip(worst, found, exact)]
        figure(f"fold_{scheme}", worst[0])
        figure(f"gradient_{scheme}", worst[1])


if __name__ == "__main__":
    main()
