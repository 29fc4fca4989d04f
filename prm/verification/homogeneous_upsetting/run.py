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
DEFAULT, LIMIT = 3e-7, 1e-9


def solve(m, penetration=None, scheme="midpoint", increments=15, **settings):
    """(energy, forces per increment) of one run; a penetration asks for the tightest solve that rounding allows."""
    values = {"Material/strain rate sensitivity": m, "Press/scheme": scheme, "Press/increments": increments, **settings}
    if penetration is not None:
        # The rounding of v, times rho, is a force of 1e-16/penetration of the whole: the floor of the residual.
        values.update({"Contact/penetration": penetration, "Newton/tolerance": max(1e-13, 1e-19 / penetration)})
    summary, _ = run(BUILD, "simulate", os.path.join(HERE, "case.prm"), {**values, "Output/record": "false"})
    with open("run/history.csv") as file:
        return energy(summary), [float(row["force"]) for row in csv.DictReader(file)]


def compare(m, scheme, penetration=None):
    """Signed relative errors against the recurrence: of the energy, and of the force in each increment."""
    E, forces = solve(m, penetration, scheme)
    exact = discrete(scheme, 15, STROKE, QUARTER, HEIGHT, m=m)
    return E / exact[-1][0] - 1., [f / row[1] - 1. for f, row in zip(forces, exact)]


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


def measure_law(m, scheme):
    """Figures of the 1/rho law; returns the table of penetrations and energy errors."""
    runs = {10. ** -k: compare(m, scheme, 10. ** -k) for k in range(4, 10)}
    table = [(p, abs(E)) for p, (E, _) in runs.items()]
    print(f"{scheme}, m = {m}:", " ".join(f"{p:.0e}: {e:.3e}" for p, e in table))
    # The force feels the rounding of rho times the gap, so its limit is extrapolated from three soft penalties.
    force = [(100. * (10. * fine - middle) - (10. * middle - coarse)) / 9. / 99.
             for coarse, middle, fine in zip(*(runs[10. ** -k][1] for k in (4, 5, 6)))]
    figure(f"penalty_exponent_defect_{scheme}_m{m}", abs(penalty_law(table) - 1.))
    figure(f"energy_error_limit_{scheme}_m{m}", table[-1][1])
    figure(f"force_error_limit_{scheme}_m{m}", max(map(abs, force)))
    return table


def quick():
    for scheme, m in (("midpoint", 1), ("midpoint", 0.5), ("midpoint", 0.139), ("euler", 0.139)):
        E, force = compare(m, scheme)
        figure(f"energy_error_default_{scheme}_m{m}", abs(E))
        figure(f"force_error_default_{scheme}_m{m}", max(map(abs, force)))
    measure_law(0.139, "midpoint")


def slow():
    cases = (("midpoint", 1), ("midpoint", 0.5), ("euler", 1), ("euler", 0.5), ("euler", 0.139))
    plot({f"{scheme}, m = {m}": measure_law(m, scheme) for scheme, m in cases})
    for scheme in ("midpoint", "euler"):
        orders = order_in_time(scheme)
        figure(f"order_{scheme}", min(orders))
        figure(f"order_defect_{scheme}", max(abs(order - round(order)) for order in orders))
    smooth, sharp = (solve(0.139, DEFAULT, **{"Contact/law": law})[0] for law in ("smooth", "sharp"))
    figure("sharp_against_smooth", abs(sharp / smooth - 1.))


if __name__ == "__main__":
    {"quick": quick, "slow": slow}[sys.argv[2]]()
