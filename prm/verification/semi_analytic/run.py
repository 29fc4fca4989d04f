#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The gradient by differences inside the elements against the exact one, over the perturbation: run.py BUILD"""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

CASE = os.path.join(HERE, "..", "..", "tutorial", "upsetting", "upsetting.prm")
SETTINGS = {"Billet/element size": 5, "Press/stroke": 2, "Press/increments": 3, "Output/fields every": 0,
            "Design/parameters": "billet/radius", "Adjoint/tolerance": 1e-10}
PERTURBATIONS = ("1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9", "1e-10")


def radius_gradient(build, settings):
    summary, _ = case_tools.run(build, "gradient", CASE, {**SETTINGS, **settings}, "run")
    return case_tools.gradient(summary)["billet/radius"]


def main():
    build = sys.argv[1]
    exact = radius_gradient(build, {})
    best = {}
    print(f"d(energy)/d(radius) = {exact:.12g} mJ/mm\n\n| perturbation | forward | central |\n| --- | --- | --- |")
    for step in PERTURBATIONS:
        errors = {method: abs(radius_gradient(build, {"Adjoint/derivatives": method, "Adjoint/perturbation": step}) / exact - 1)
                  for method in ("semi-analytic", "semi-analytic central")}
        for method, error in errors.items():
            best[method] = min(best.get(method, 1.0), error)
        print(f"| {step} | {errors['semi-analytic']:.1e} | {errors['semi-analytic central']:.1e} |", flush=True)
    case_tools.figure("forward_best", best["semi-analytic"])
    case_tools.figure("central_best", best["semi-analytic central"])


if __name__ == "__main__":
    main()
