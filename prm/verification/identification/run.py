#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Numbers of metal and friction from made-up tests, again and again with other noise: how often the truth lies in the intervals, and whether
what is found scatters as much as it is said to.   run.py BUILD [SEEDS]"""
import argparse
import os
import pathlib
import shutil
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE.parents[1] / "tutorial/identification"
sys.path[:0] = [str(SCENE), str(HERE.parents[1]), str(HERE.parents[2] / "contrib/python")]
os.environ["RETROFORGE"] = str(pathlib.Path(sys.argv[1], "retroforge").resolve())
import case_tools  # noqa: E402
import identify  # noqa: E402
import make_measurements as made  # noqa: E402

OPTIONS = argparse.Namespace(windows=8, begin=0.05, finer=0.7)
# A start that is near, so that the search is short; what it finds does not depend on it.
START = """include {scene}
subsection Material
  set consistency             = 48
  set strain rate sensitivity = 0.125
  set further numbers         = n: 0.15, q0: 0.02, beta: 0.0025, T0: 950
end
subsection Die upper
  set friction = 0.23
end
subsection Optimisation
  set data          = {data}
  set uncertainties = {uncertainties}
  set noise runs    = 0
end
"""


def write_case(folder, name, bore):
    data = ("bore: %.6f" % bore, f"bore: {made.BORE_NOISE}") if bore is not None else ("", "")
    path = folder / f"{name}.prm"
    path.write_text(START.format(scene=SCENE / f"{name}.prm", data=data[0], uncertainties=data[1]), encoding="utf-8")
    return path


def identified(truth, seed):
    """The result with the noise of a seed."""
    folder = pathlib.Path(f"seed_{seed}")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    generator = np.random.default_rng(seed)
    cases = []
    for name, (strokes, forces, bore) in truth.items():
        made.write_curve(folder / f"{name}.csv", strokes, forces, generator)
        cases.append((write_case(folder, name, bore if bore is None else bore + made.BORE_NOISE * generator.standard_normal()), folder / f"{name}.csv"))
    result, _, _ = identify.identify(cases, folder / "results", OPTIONS)
    return result


def main():
    n_seeds = int(sys.argv[2]) if len(sys.argv) > 2 else 12
    truth = {name: made.forge(name) for name in made.SIZES}
    results = []
    print("| seed | " + " | ".join(made.TRUTH) + " | sum of squares |\n" + "| --- " * (len(made.TRUTH) + 2) + "|")
    for seed in range(1, n_seeds + 1):
        result = identified(truth, seed)
        results.append(result)
        print(f"| {seed} | " + " | ".join(f"{value:.4f} ± {width:.4f}" for value, width in zip(result.values, result.half_widths))
              + f" | {result.misfit:.0f} |", flush=True)
    exact = np.array([made.TRUTH[name] for name in results[0].names])
    values, widths, deviations = (np.array([getattr(result, key) for result in results]) for key in ("values", "half_widths", "deviations"))
    inside = np.abs(values - exact) <= widths
    scatter = values.std(axis=0, ddof=1) / deviations.mean(axis=0)
    offset = values.mean(axis=0) / exact - 1
    for name, *numbers in zip(results[0].names, inside.mean(axis=0), scatter, offset):
        print("{}: inside {:.0%}, scatter over deviation {:.2f}, mean off by {:+.2%}".format(name, *numbers))
    print(f"sum of squares over freedom {np.mean([result.misfit / result.freedom for result in results]):.2f}")
    case_tools.figure("coverage", inside.mean())
    case_tools.figure("scatter_over_deviation", float(np.sqrt(np.mean(scatter**2))))
    case_tools.figure("off_by", float(np.abs(offset).max()))


if __name__ == "__main__":
    main()
