# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What a parameter does to an objective, in measures that compare parameters of different units."""
import dataclasses


@dataclasses.dataclass
class Effect:
    """`for_one_percent`: what one per cent of the parameter's size adds; None where that is zero or unknown."""
    parameter: dict
    derivative: float
    for_one_percent: float


def effects(objective, parameters):
    """Largest first; then, in the order of the run, parameters without a size."""
    result = []
    for parameter in parameters:
        derivative = parameter.get("gradient", {}).get(objective["name"])
        scale = parameter.get("scale", parameter["value"])
        if derivative is not None:
            result.append(Effect(parameter, derivative, 0.01 * abs(scale) * derivative if scale else None))
    return sorted(result, key=lambda e: -1.0 if e.for_one_percent is None else abs(e.for_one_percent), reverse=True)


def relative_gradient(objective, parameters):
    """(parameter, per cent of the objective's size per per cent of the parameter's), largest first.

    Without a value of either there is no number.
    """
    if not objective["value"]:
        return []
    return [(e.parameter["name"], 100 * e.for_one_percent / abs(objective["value"]))
            for e in effects(objective, parameters) if e.for_one_percent is not None]
