#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Which billet is forged to a straight side? An example of optimization with exact gradients, by scipy.

Under friction a cylinder barrels. Two radii of the billet's contour are free, the third keeps the volume, and the mean square
distance of the forged side from a cylinder is minimised: prm/tutorial/preform/preform.prm. A few runs of a second each.
"""
import pathlib
import sys

from scipy.optimize import minimize

import retroforge

CASE = pathlib.Path(__file__).resolve().parents[2] / "prm" / "tutorial" / "preform" / "preform.prm"
RADII = ["billet/control point 1 r", "billet/control point 2 r"]


def barrel(radii):
    """Mean square distance from a cylinder [mm^2], and its gradient [mm]; the mesh is always that of the case."""
    forging = retroforge.run(CASE, at=dict(zip(RADII, radii)))
    print(f"  radii {radii[0]:.4f} {radii[1]:.4f} mm: off the cylinder by {forging.objectives['barrel']**0.5:.4f} mm rms")
    return forging.objectives["barrel"], forging.gradient("barrel", RADII)


def optimize():
    """scipy's result: x the radii, fun the mean square distance, nfev the number of runs."""
    return minimize(barrel, [10.0, 10.0], jac=True, method="L-BFGS-B", bounds=[(8.0, 12.0)] * 2, options={"ftol": 1e-4})


def main():
    try:
        found = optimize()
    except retroforge.Error as error:
        sys.exit(f"straight_side: {error}")
    print(f"after {found.nfev} runs: radii {found.x[0]:.4f} and {found.x[1]:.4f} mm, {found.fun**0.5:.4f} mm rms")


if __name__ == "__main__":
    main()
