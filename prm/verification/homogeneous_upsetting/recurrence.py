# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Upsetting of a box without friction, exactly as the time schemes do it, and exactly in time.

Between flat dies without friction the velocity is  (r x/2, r y/2, -r z)  with r = v/h, and any mesh holds it. What the
program adds to that is the time scheme alone, so a recurrence in the height h and the lateral stretch s tells its numbers
to rounding, if the dies were rigid walls instead of penalties. Everything also works on complex numbers.
"""
import math


def dissipation(r, K, m, e0):
    """s:eps of the strain rates (r/2, r/2, -r), with q = 2 eps:eps + 3 e0^2 = 3 (r^2 + e0^2)  [MPa/s]."""
    return 2. * K * (3. * (r * r + e0 * e0)) ** ((m - 1.) / 2.) * 1.5 * r * r


def discrete(scheme, increments, stroke, base_area, height, v=100., K=1.693, m=1., e0=1e-3):
    """[(energy so far, force on the die, volume)] after each increment."""
    dt = stroke / increments / v
    h, s, energy, rows = height, 1., 0., []
    for _ in range(increments):
        # Y and W_2 are where the increment takes its power: the start for euler, the middle for midpoint.
        h_y, s_y = (h, s) if scheme == "euler" else (h - dt / 2. * v, s * (1. + dt / 2. * (v / h) / 2.))
        power = dissipation(v / h_y, K, m, e0) * base_area * s_y * s_y * h_y
        energy += dt * power
        h -= dt * v
        s += dt * (v / h_y) / 2. * s_y
        rows.append((energy, power / v, base_area * s * s * h))
    return rows


def continuous(stroke, base_area, height, v=100., K=1.693, m=1., e0=1e-3):
    """Energy of the flow exact in time: the integral of the power over the height, volume constant (eq. 133 for m = 1)."""
    volume = base_area * height
    # Substitute u = log h: a smooth integrand, Gauss-Legendre of three points on many panels reaches rounding.
    low, high, panels = math.log(height - stroke), math.log(height), 200
    width = (high - low) / panels
    node = math.sqrt(0.6)
    energy = 0.
    for i in range(panels):
        for x, w in ((-node, 5. / 18.), (0., 8. / 18.), (node, 5. / 18.)):
            h = math.exp(low + width * (i + 0.5 + x / 2.))
            energy += w * width * h * dissipation(v / h, K, m, e0) / v
    return volume * energy
