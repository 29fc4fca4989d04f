# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Energy and its derivative with respect to the stretch of a cube, against the recurrence and the formula in time."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PRM = os.path.join(HERE, "..", "..", "..")
sys.path[:0] = [PRM, os.path.join(PRM, "verification", "homogeneous_upsetting")]
from case_tools import energy, figure, gradient, run  # noqa: E402
from recurrence import continuous, discrete  # noqa: E402

BUILD = sys.argv[1]
WIDTH = 50.
CASES = (("10mm", 10., 15), ("40mm", 40., 65))


def program(scheme, stroke, increments, penetration=None):
    """(E, dE/dmu) of the whole cube; a penetration asks for the tightest solve that rounding allows."""
    settings = {"Press/scheme": scheme, "Press/stroke": stroke, "Press/increments": increments, "Output/record": "false"}
    if penetration is not None:
        # The rounding of v, times rho, is a force of 1e-16/penetration of the whole: the floor of the residual.
        settings.update({"Contact/penetration": penetration, "Newton/tolerance": max(1e-13, 1e-19 / penetration),
                         "Adjoint/tolerance": 1e-13})
    summary, _ = run(BUILD, "gradient", os.path.join(HERE, "case.prm"), settings)
    return 4. * energy(summary), 4. * gradient(summary)["billet/stretch"]


def with_derivative(function):
    """(E, dE/dmu) of a formula for E(base area), by a complex step in mu."""
    step = 1e-100
    E = function(WIDTH ** 2 * (1. + 2. * step * 1j / WIDTH) ** 2)
    return E.real, E.imag / step


def recurrence(scheme, stroke, increments):
    return with_derivative(lambda area: discrete(scheme, increments, stroke, area, WIDTH)[-1][0])


def formula(stroke):
    return with_derivative(lambda area: continuous(stroke, area, WIDTH))


def errors(found, exact):
    print("found", *("%.10g" % x for x in found), "expected", *("%.10g" % x for x in exact))
    return [abs(a / b - 1.) for a, b in zip(found, exact)]


def report(name, pair):
    for what, error in zip(("energy", "gradient"), pair):
        figure(f"{what}_{name}", error)


def main():
    for name, stroke, increments in CASES:
        exact = recurrence("euler", stroke, increments)
        report(f"{name}_default", errors(program("euler", stroke, increments), exact))
        report(f"{name}_limit", errors(program("euler", stroke, increments, 1e-9), exact))
        report(f"{name}_midpoint_default", errors(program("midpoint", stroke, increments),
                                                  recurrence("midpoint", stroke, increments)))
        coarse, fine = (errors(program("midpoint", stroke, n, 1e-9), formula(stroke)) for n in (increments, 2 * increments))
        report(f"{name}_midpoint_formula", coarse)
        figure(f"order_{name}", min(math.log2(a / b) for a, b in zip(coarse, fine)))


if __name__ == "__main__":
    main()
