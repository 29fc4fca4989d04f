# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Units as the page shows them."""
import re

LARGER = {"N": ((1e6, "MN"), (1e3, "kN")), "mJ": ((1e6, "kJ"), (1e3, "J")), "mW": ((1e6, "kW"), (1e3, "W"))}
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def pretty(unit):
    """mm^2 s^-3 becomes mm² s⁻³; nothing for a quantity without dimension."""
    if unit in (None, "", "none", "1"):
        return ""
    return re.sub(r"\^(-?\d+)", lambda power: power.group(1).translate(RAISED), unit)


def bracketed(name, unit):
    """For axes: the name alone when there is no unit."""
    return f"{name} [{pretty(unit)}]" if pretty(unit) else name


def readable(unit, largest):
    """A factor and the unit that it is of: forces, energies and powers in the largest one in which `largest` is at least one."""
    return next(((factor, larger) for factor, larger in LARGER.get(unit, ()) if abs(largest) >= factor), (1.0, unit))


def per_volume(unit):
    """Of a derivative by positions in mm, per mm² of surface."""
    return f"{pretty(unit) or 1}/mm³"
