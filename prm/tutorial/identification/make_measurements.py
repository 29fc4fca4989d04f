#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Makes the measurements of this scene: forgings of a metal that is known, with elements half as large, shorter increments and
other meshes than the scene's, and noise.

    make_measurements.py [--seed 1] [--folder FOLDER]

writes slow.csv, fast.csv and ring.csv, and prints the bore of the ring for ring.prm.
"""
import argparse
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "contrib/python"))
import retroforge  # noqa: E402

TRUTH = {"material/K": 47.0, "material/n": 0.16, "material/m": 0.13, "dies/friction": 0.22}
SIZES = {"slow": 0.75, "fast": 0.75, "ring": 0.45}  # of elements [mm]
NOISE, BORE_NOISE, POINTS = 0.01, 0.005, 150  # of the mean force; [mm], of the bore's radius; of a curve


def forge(name):
    """The test with the true numbers: strokes of the whole part [mm], its forces [N], and the bore [mm]."""
    forging = retroforge.run(HERE / f"{name}.prm", {"Billet/element size": SIZES[name], "Press/accuracy": 2e-4}, at=TRUTH, command="simulate")
    end, whole = forging.history["stroke"], forging.summary["whole"]
    closing = whole["copies"] / whole["force_factor"] * (end - 0.5 * np.diff(end, prepend=0))
    return closing, whole["force_factor"] * forging.history["force"], forging.objectives.get("bore")


def write_curve(path, strokes, forces, generator):
    """Noisy forces, at strokes that are evenly spaced."""
    at = np.linspace(strokes[0], strokes[-1], POINTS)
    exact = np.interp(at, strokes, forces)
    noisy = exact + NOISE * exact.mean() * generator.standard_normal(POINTS)
    np.savetxt(path, np.column_stack((at, noisy)), fmt=["%.4f", "%.1f"], delimiter=",", header="stroke,force", comments="")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=pathlib.Path, default=HERE)
    options = parser.parse_args()
    generator = np.random.default_rng(options.seed)
    for name in SIZES:
        strokes, forces, bore = forge(name)
        write_curve(options.folder / f"{name}.csv", strokes, forces, generator)
        if bore is not None:
            print(f"bore {bore + BORE_NOISE * generator.standard_normal():.4f} +- {BORE_NOISE} mm (without noise {bore:.4f})")


if __name__ == "__main__":
    main()
