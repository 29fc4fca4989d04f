# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Quadratic velocities: derivatives by four ways against each other, and the volume kept over a 50 % upsetting."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
from case_tools import figure, run  # noqa: E402

CASE = os.path.join(HERE, "case.prm")
CURVED = os.path.join(HERE, "curved.prm")


# A pressure is the penalty times small differences of velocities: at the default penetration differences of it are lost in rounding,
# and steps as small as the others' lose the friction's remainder in it.
# So are, to a lesser part, those of the energy, which has the forces in it where gaps close.
# At 1e-4 the nodes' remainder has its next term yet (1.94, 1.97, 1.99), at 3e-5 that of the friction is rounding (2.00, 1.97, 1.85).
ENERGY = {"Contact/penetration": 1e-5, "Check/taylor start": 6e-5}
PRESSURE = {"Objectives/names": "strain, contact pressure", "Contact/penetration": 1e-3, "Check/taylor start": 3e-4}


# Friction hardly bends the mean strain: with steps as small as those of the energy its remainder is rounding.
STRAIN = {"Objectives/names": "strain", "Contact/penetration": 1e-5, "Check/taylor start": 3e-4}
CURVED_STRAIN = {"Objectives/names": "strain", "Check/taylor start": 3e-3}


def derivatives(name, case, *runs):
    """@param runs  settings, and the objective that is looked at"""
    rows = [row for settings, objective in runs for row in run(sys.argv[1], "check", case, settings)[0]["check"] if row["objective"] == objective]
    figure(f"{name}adjoint_tangent", max(abs(row["adjoint"] / row["tangent"] - 1.) for row in rows))
    figure(f"{name}replayed", max(min(abs(step["replayed_central"] / row["adjoint"] - 1.) for step in row["steps"]) for row in rows))
    figure(f"{name}taylor_order", min(order for row in rows for order in row["taylor_orders"][:2]))


derivatives("", CASE, ({**ENERGY, "Objectives/names": "energy"}, "energy"), (STRAIN, "strain"))
derivatives("curved_", CURVED, ({"Objectives/names": "energy"}, "energy"), (CURVED_STRAIN, "strain"))
derivatives("pressure_", CASE, (PRESSURE, "contact pressure"))
derivatives("curved_pressure_", CURVED, ({**PRESSURE, "Contact/penetration": 3e-3}, "contact pressure"))

CRUSHED = run(sys.argv[1], "simulate", CASE, {
    "Die upper/facing": "0, 0, -1", "Press/stroke": 20, "Press/increments": 50, "Remeshing/when": "never", "Billet/element size": 7})[0]
figure("cuts", CRUSHED["cuts"])
figure("volume_lost", abs(1. - CRUSHED["volume_final"] / CRUSHED["volume_initial"]))
