# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Energy and die force of the homogeneous upsetting against the exact recurrence, over penalty, scheme and increments."""
import csv
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
from case_tools import energy, figure, run  # noqa: E402
from recurrence import continuous, discrete  # noqa: E402

BUILD = sys.argv[1]
QUARTER, HEIGHT, STROKE = 2500. / 4., 50., 10.
DEFAULT, LIMIT = 1e-6, 1e-9


def solve(m, penetration=None, scheme="midpoint", increments=15, **settings):
    """(energy, forces per increment) of one run; a penetration asks for the tightest solve that rounding allows."""
    values = {"Material/strain rate sensitivity": m, "Press/scheme": scheme, "Press/increments": increments, **settings}
    if penetration is not None:
        # The rounding of v, times rho, is a force of 1e-16/penetration of the whole: the floor of the residual.
        values.update({"Contact/penetration": penetration, "Newton/tolerance": max(1e-13, 1e-19 / penetration)})
    summary, _ = run(BUILD, "simulate", os.path.join(HERE, "case.prm"), {**values, "Output/record": "false"})
    with open("run/history.csv") as file:
        return energy(summary), [float(row["force"]) for row in csv.DictReader(file)]


def errors(m, scheme, **settings):
    """Relative errors of the energy and of the worst increment's force against the recurrence."""
    E, forces = solve(m, scheme=scheme, **settings)
    exact = discrete(scheme, 15, STROKE, QUARTER, HEIGHT, m=m)
    return abs(E / exact[-1][0] - 1.), max(abs(f / row[1] - 1.) for f, row in zip(forces, exact))


def penalty_law(table):
    """The exponent of error ~ penetration, by least squares; 1 is the law of the penalty."""
    x = [math.log(p) for p, _ in table]
    y = [math.log(e) for _, e in table]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def order_in_time(scheme):
    """Observed orders of the energy against the flow that is exact in time, over 10/20/40/80 increments."""
    exact = continuous(STROKE, QUARTER, HEIGHT, m=0.139)
    defects = [abs(solve(0.139, LIMIT, scheme, n)[0] / exact - 1.) for n in (10, 20, 40, 80)]
    print(scheme, "against the continuous flow:", " ".join(f"{d:.3e}" for d in defects))
    return [math.log2(a / b) for a, b in zip(defects, defects[1:])]


def plot(laws):
    try:
        import matplotlib
    except ImportError:
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot
    for label, table in laws.items():
        pyplot.loglog(*zip(*table), "o-", label=label)
    pyplot.xlabel("Contact/penetration")
    pyplot.ylabel("relative error of the energy against the recurrence")
    pyplot.grid(True)
    pyplot.legend()
    pyplot.savefig("penalty_law.png", dpi=100)


def main():
    for m in (1, 0.5, 0.139):
        E, force = errors(m, "midpoint")
        figure(f"energy_error_default_m{m}", E)
        figure(f"force_error_default_m{m}", force)
        E, force = errors(m, "midpoint", penetration=LIMIT)
        figure(f"energy_error_limit_m{m}", E)
        figure(f"force_error_limit_m{m}", force)
    laws = {}
    for m, scheme in ((1, "euler"), (0.139, "midpoint")):
        penetrations = [10. ** -k for k in range(4, 10)]
        table = [(p, errors(m, scheme, penetration=p)[0]) for p in penetrations]
        laws[f"{scheme}, m = {m}"] = table
        print(f"{scheme}, m = {m}:", " ".join(f"{p:.0e}: {e:.3e}" for p, e in table))
        figure(f"penalty_exponent_defect_{scheme}", abs(penalty_law(table) - 1.))
        figure(f"energy_error_limit_{scheme}", table[-1][1])
    for scheme in ("midpoint", "euler"):
        orders = order_in_time(scheme)
        figure(f"order_{scheme}", min(orders))
        if scheme == "euler":
            figure("order_euler_defect", max(abs(order - 1.) for order in orders))
    smooth, sharp = (solve(0.139, DEFAULT, **{"Contact/law": law})[0] for law in ("smooth", "sharp"))
    figure("sharp_against_smooth", abs(sharp / smooth - 1.))
    plot(laws)


if __name__ == "__main__":
    main()
