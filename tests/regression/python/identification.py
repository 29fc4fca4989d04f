# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""contrib/python/identify.py: windows share no force and lose none; scatter and intervals of known numbers; the tutorial's tests, with larger
elements, give intervals in which the truth lies; tables and tests that make no sense are refused.
Usage: identification.py ROOT, with the program in the environment variable RETROFORGE"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
SCENE = ROOT / "prm/tutorial/identification"
SCRIPT = ROOT / "contrib/python/identify.py"
sys.path[:0] = [str(SCENE), str(SCRIPT.parent)]
import identify  # noqa: E402
import make_measurements  # noqa: E402

SIZES = {"slow": 2, "fast": 2, "ring": 1}
COARSER = """include {scene}
subsection Billet
  set element size = {size}
end
subsection Material
  set consistency = 50
end
subsection Optimisation
  set noise runs = 0
end
"""


class Curves(unittest.TestCase):
    def test_windows(self):
        """A straight line: each mean is the force in the window's middle; independent errors: the variance of a mean falls with the points."""
        stroke = np.linspace(0, 10, 401)
        curve = identify.Curve(stroke, 100 + 7 * stroke, np.full(401, 2.0))
        ends = np.array([0.3, 1, 2, 3.5, 5, 6, 8, 9, 10, 12])
        windows = identify.windows_of(curve, ends, 0.9, 3)
        self.assertEqual([window[:2] for window in windows], [(1.0, 3.5), (3.5, 6.0), (6.0, 10.0)])
        for low, high, force, deviation in windows:
            self.assertAlmostEqual(force, 100 + 7 * 0.5 * (low + high), delta=0.1)
            self.assertAlmostEqual(deviation / (2 / np.sqrt((high - low) / 0.025)), 1, delta=0.02)
        self.assertEqual(identify.windows_of(curve, ends, 11.0, 3), [])

    def test_scatter(self):
        generator = np.random.default_rng(3)
        x = np.cumsum(generator.uniform(0.5, 1.5, 4000))
        self.assertAlmostEqual(identify.scatter_of(x, 1e-3 * x + 5 * generator.standard_normal(4000)) / 5, 1, delta=0.04)

    def test_interval(self):
        """A straight line through points of deviation 1: closed form of least squares."""
        x = np.arange(5.0)
        jacobian = np.column_stack((np.ones(5), x))
        step, deviations, numerics, widths, correlations, misfit = identify.evaluate(jacobian, 3 - 2 * x, np.full(5, 0.7), np.zeros(5), 0.5)
        np.testing.assert_allclose(step, [-3.7, 2], atol=1e-12)
        np.testing.assert_allclose(numerics, [-0.7, 0], atol=1e-12)
        np.testing.assert_allclose(deviations, np.sqrt([0.6, 0.1]))
        np.testing.assert_allclose(widths, [np.hypot(1.959964 * np.sqrt(0.6), 0.7), 1.959964 * np.sqrt(0.1)], rtol=1e-6)
        self.assertAlmostEqual(correlations[0, 1], -0.2 / np.sqrt(0.06))
        self.assertAlmostEqual(misfit, 0)
        # Two sources whose errors cancel leave them nevertheless.
        mean = np.ones((4, 1))
        _, _, numerics, widths, _, _ = identify.evaluate(mean, np.zeros(4), np.array([0.4, 0.4, -0.4, -0.4]), np.array([0, 0, 1, 1]), 0.75)
        self.assertAlmostEqual(numerics[0], 0)
        self.assertAlmostEqual(widths[0], np.hypot(1.959963984540054 * 0.5, 3 * 0.4))
        with self.assertRaisesRegex(identify.Refused, "do not tell the parameters apart"):
            identify.evaluate(np.column_stack((x + 1, 2 * x + 2)), x, 0 * x, 0 * x, 0.5)


class Tests(unittest.TestCase):
    def test_tutorial(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            words = []
            for name, size in SIZES.items():
                (folder / f"{name}.prm").write_text(COARSER.format(scene=SCENE / f"{name}.prm", size=size), encoding="utf-8")
                words.append(f"{folder / name}.prm={SCENE / name}.csv")
            done = subprocess.run([sys.executable, "-B", SCRIPT, *words, "--windows", "6", "--output", folder / "results"],
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            print(done.stdout)
            found = json.loads((folder / "results/identification.json").read_text(encoding="utf-8"))
            self.assertTrue((folder / "results/identification.png").is_file())
            again = subprocess.run([sys.executable, "-B", SCRIPT, *words, "--output", folder / "results"], capture_output=True, text=True, check=False)
            self.assertRegex(again.stderr, "has results already")
        self.assertEqual([parameter["name"] for parameter in found["parameters"]], list(make_measurements.TRUTH))
        self.assertEqual(found["freedom"], 3 * 6 + 1 - 4)
        self.assertFalse(found["disagrees"])
        for parameter in found["parameters"]:
            truth, value, width = make_measurements.TRUTH[parameter["name"]], parameter["value"], parameter["half_width_95"]
            self.assertLessEqual(abs(value - truth), width, parameter)
            self.assertLess(width, 0.15 * truth, parameter)
            self.assertGreater(parameter["deviation"], 0)

    def test_refusals(self):
        options = argparse.Namespace(windows=4, begin=0.05, finer=0.0)
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            for text, message in (("stroke,load\n1,2\n", "has the columns stroke, load"), ("stroke,force\n1,2\n2,x\n", "no number"),
                                  ("stroke,force\n" + "1,2\n" * 6, "no stroke twice"), ("stroke,force\n1,2\n2,3\n", "five points"),
                                  ("stroke,force\n" + "".join(f"{i},{2 * i}\n" for i in range(9)), "no scatter")):
                (folder / "curve.csv").write_text(text, encoding="utf-8")
                with self.assertRaisesRegex(identify.Refused, message):
                    identify.read_curve(folder / "curve.csv")
            (folder / "far.csv").write_text("stroke,force\n" + "".join(f"{50 + i},{i * i % 7}\n" for i in range(9)), encoding="utf-8")
            for name, cases, message in (("a", [(SCENE / "slow.prm", folder / "far.csv")], "the curve|within the curve"),
                                         ("b", [(SCENE / "slow.prm", None)], "nothing of it is measured"),
                                         ("c", [(SCENE / "slow.prm", folder / "none.csv")], "No such file")):
                with self.assertRaisesRegex(identify.Refused, message):
                    identify.identify(cases, folder / name, options)


unittest.main()
