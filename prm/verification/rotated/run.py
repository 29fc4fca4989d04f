# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The same forging upright and in odd frames: energy, gradients and solver effort must not know the difference."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
from case_tools import energy, figure, gradient, run  # noqa: E402

POINT, DOWN = (0., 0., 40.), (0., 0., -1.)
FRAMES = (((1., 2., 3.), 37., (0., 0., 0.)), ((-2., 1., 0.4), 143., (12., -7., 30.)))


def rotate(x, axis, angle):
    """Rodrigues' formula, angle in degrees."""
    length = math.sqrt(sum(a * a for a in axis))
    n = [a / length for a in axis]
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    along = sum(a * b for a, b in zip(n, x))
    cross = (n[1] * x[2] - n[2] * x[1], n[2] * x[0] - n[0] * x[2], n[0] * x[1] - n[1] * x[0])
    return [c * x[i] + s * cross[i] + (1. - c) * along * n[i] for i in range(3)]


def frame(axis, angle, shift):
    """The settings that put the whole scene into another frame."""
    def text(x):
        return ", ".join(f"{a:.17g}" for a in x)

    def direction(x, factor=1.):
        return text([factor * a for a in rotate(x, axis, angle)])
    return {"Billet/rotation axis": text(axis), "Billet/rotation angle": angle, "Billet/translation": text(shift),
            "Die lower/point": text(shift), "Die lower/facing": direction(DOWN, -1.),
            "Die upper/point": text([a + b for a, b in zip(rotate(POINT, axis, angle), shift)]),
            "Die upper/facing": direction(DOWN), "Die upper/velocity": direction(DOWN, 100.)}


def measure(case, settings):
    summary, _ = run(sys.argv[1], "gradient", os.path.join(HERE, case), settings)
    return energy(summary), gradient(summary), summary["krylov_iterations"]


def main():
    E, g, krylov = measure("case.prm", {})
    worst = {"energy": 0., "krylov": 0., **{name: 0. for name in g}}
    for where in FRAMES:
        E_r, g_r, krylov_r = measure("case.prm", frame(*where))
        worst["energy"] = max(worst["energy"], abs(E_r / E - 1.))
        worst["krylov"] = max(worst["krylov"], krylov_r / krylov)
        for name in g:
            worst[name] = max(worst[name], abs(g_r[name] / g[name] - 1.))
    figure("energy_change", worst.pop("energy"))
    figure("krylov_ratio", worst.pop("krylov"))
    for name, change in worst.items():
        print(f"{name:24} {g[name]:18.12g}   changes by {change:.2e}")
    figure("gradient_change", max(worst.values()))


if __name__ == "__main__":
    main()
