# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Homogeneous upsetting of metal that hardens and warms, against the exact recurrence of each law and exactly in time."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PRM = os.path.join(HERE, "..", "..")
sys.path[:0] = [PRM, os.path.join(PRM, "..", "contrib", "python")]
from case_tools import energy, figure, run  # noqa: E402
from flow_curves import flow_stress, read_material  # noqa: E402

BUILD = sys.argv[1]
QUARTER, HEIGHT, STROKE, SPEED, E0 = 2500. / 4., 50., 20., 100., 1e-3
STEELS = ("C22", "C45", "S355J2", "11SMn30")
CAPACITY, FRACTION = 5., 0.9
POWER = {"law": "power", "consistency": "40", "strain rate sensitivity": "0.15",
         "further numbers": "n: 0.25, q0: 0.01, beta: 0.0025, m1: 1e-4, T0: 1000"}
TEMPERATURE = 1100.


def table_file(name, n_strains):
    """Writes a table of C45 at 0 and so many strains, three rates and three temperatures; returns the steel."""
    steel = read_material(os.path.join(PRM, "materials", "C45.prm"))
    strains = [0.02 * 1.6**i for i in range(n_strains)]
    with open(name, "w", encoding="utf-8") as out:
        out.write("strain,strain rate,temperature,flow stress\n")
        for q in [0.] + strains:
            for rate in (0.5, 3., 20.):
                for T in (1000., 1100., 1200.):
                    out.write(f"{q!r},{rate},{T},{flow_stress(steel, q, rate, T)!r}\n")
    return steel


def power(settings, strain, rate, temperature=TEMPERATURE):
    """s:eps at an equivalent strain rate, regularised as the program does:  e sigma(e) (1 + (e0/e)^2)^((m-1)/2)."""
    low, high = (flow_stress(settings, strain, r, temperature) for r in (1., math.e))
    m = math.log(high / low)
    return rate * low * rate**m * (1. + (E0 / rate)**2)**((m - 1.) / 2.)


def recurrence(settings, increments, warming=0.):
    """Energy and temperature of the midpoint scheme: what is at the middle follows from the rate at the start.

    `warming` is in K per work and volume.
    """
    dt, h, s, q, T, total = STROKE / increments / SPEED, HEIGHT, 1., 0., TEMPERATURE, 0.
    for _ in range(increments):
        r = SPEED / h
        h_y, s_y, q_y = h - dt / 2. * SPEED, s * (1. + dt / 4. * r), q + dt / 2. * r
        T_y = T + dt / 2. * warming * power(settings, q, r, T)
        r_y = SPEED / h_y
        work = power(settings, q_y, r_y, T_y)
        total += dt * work * QUARTER * s_y * s_y * h_y
        h, s, q, T = h - dt * SPEED, s + dt / 2. * r_y * s_y, q + dt * r_y, T + dt * warming * work
    return total, T


def in_the_limit(settings, warming=0., panels=2000):
    """Volume times the integral of the flow stress over the strain, and the temperature: dT/dq = warming sigma."""
    width, total, T = math.log(HEIGHT / (HEIGHT - STROKE)) / panels, 0., TEMPERATURE

    def stress(q, T):
        rate = SPEED / HEIGHT * math.exp(q)
        return power(settings, q, rate, T) / rate

    for i in range(panels):  # classical Runge-Kutta of order four
        q = i * width
        k1 = stress(q, T)
        k2 = stress(q + width / 2., T + width / 2. * warming * k1)
        k3 = stress(q + width / 2., T + width / 2. * warming * k2)
        k4 = stress(q + width, T + width * warming * k3)
        mean = (k1 + 2. * k2 + 2. * k3 + k4) / 6.
        total, T = total + width * mean, T + width * warming * mean
    return QUARTER * HEIGHT * total, T


def solve(settings, increments, **more):
    """Energy of one run, and its largest temperature where it is an objective. A table is known to the program alone."""
    values = {f"Material/{name}": value for name, value in settings.items()}
    values.update({"Material/temperature": TEMPERATURE, "Press/stroke": STROKE, "Press/increments": increments,
                   "Material/regularising strain rate": E0})
    values.update({"Contact/penetration": 1e-9, "Newton/tolerance": 1e-10, **more})
    case = os.path.join(PRM, "verification", "homogeneous_upsetting", "case.prm")
    summary, _ = run(BUILD, "simulate", case, {**values, "Output/record": "false"})
    warmest = [o["value"] for o in summary["objectives"] if o["name"] == "largest temperature"]
    beyond = any("beyond, stresses are those at its edge" in warning for warning in summary.get("warnings", []))
    if beyond != settings.get("table", "").endswith("short.csv"):
        raise SystemExit("that metal is strained beyond its table must be told there, and nowhere else")
    return energy(summary), warmest[0] if warmest else TEMPERATURE


def adiabatic():
    """Energy and temperature of metal that warms by its work and softens by its temperature."""
    heat = {"Heat/heating": "adiabatic", "Heat/heat capacity": CAPACITY, "Heat/fraction of work": FRACTION,
            "Objectives/names": "energy, largest temperature"}
    warming = FRACTION / CAPACITY
    E_exact, T_exact = in_the_limit(POWER, warming)
    worst, errors = 0., []
    for n in (15, 30, 240):
        E, T = solve(POWER, n, **heat)
        E_n, T_n = recurrence(POWER, n, warming)
        worst = max(worst, abs(E / E_n - 1.), abs((T - T_n) / (T_n - TEMPERATURE)))
        errors.append(max(abs(E / E_exact - 1.), abs((T - T_exact) / (T_exact - TEMPERATURE))))
    order = math.log2(errors[0] / errors[1])
    print(f"adiabatic: warming {T_exact - TEMPERATURE:.3f} K; in time", " ".join(f"{e:.1e}" for e in errors), f"order {order:.2f}")
    figure("adiabatic_recurrence", worst)
    figure("adiabatic_order", order)
    figure("adiabatic_in_time", errors[-1])


def main():
    worst, least_order = 0., math.inf
    laws = {name: read_material(os.path.join(PRM, "materials", name + ".prm")) for name in STEELS}
    for name, settings in {"power": POWER, **laws}.items():
        errors = []
        for n in (15, 30):
            E = solve(settings, n)[0]
            worst = max(worst, abs(E / recurrence(settings, n)[0] - 1.))
            errors.append(abs(E / in_the_limit(settings)[0] - 1.))
        order = math.log2(errors[0] / errors[1])
        print(f"{name}: against the recurrence {worst:.1e} so far; in time {errors[0]:.1e} {errors[1]:.1e}, order {order:.2f}")
        least_order = min(least_order, order)
    figure("flow_stress_recurrence", worst)
    figure("flow_stress_order", least_order)
    steel = table_file("c45.csv", 9)
    E = solve({"law": "table", "table": os.path.abspath("c45.csv")}, 30)[0]
    figure("flow_stress_table", abs(E / recurrence(steel, 30)[0] - 1.))
    table_file("short.csv", 6)
    solve({"law": "table", "table": os.path.abspath("short.csv")}, 15)
    adiabatic()


if __name__ == "__main__":
    main()
