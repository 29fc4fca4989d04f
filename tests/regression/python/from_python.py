# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""contrib/python: results of a run as Python has them; designs on one mesh, whose differences are the gradient; mistakes as
exceptions with the program's message; the example ends where the gradient vanishes, with less than a third of the barrel.
Usage: from_python.py FOLDER, with the program in the environment variable RETROFORGE"""
import os
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(FOLDER))
import retroforge  # noqa: E402
import straight_side  # noqa: E402

CASE, RADII = straight_side.CASE, straight_side.RADII
QUICK = {"Press/increments": 4, "Newton/tolerance": 1e-12}
BLUNT = {"Die upper/shape": "punch", "Die upper/Punch/radius": 14}


class FromPython(unittest.TestCase):
    def test_results(self):
        with tempfile.TemporaryDirectory() as folder:
            forging = retroforge.run(CASE, QUICK, folder=folder)
            self.assertTrue((pathlib.Path(folder) / "parameters.prm").is_file())
            with self.assertRaisesRegex(retroforge.Error, "--overwrite"):
                retroforge.run(CASE, QUICK, folder=folder)
        self.assertEqual(list(forging.objectives), ["barrel", "energy"])
        self.assertEqual(list(forging.gradients["energy"]), RADII)
        self.assertEqual(forging.summary["increments"], 4)
        np.testing.assert_array_equal(forging.history["increment"], [1, 2, 3, 4])
        np.testing.assert_allclose(forging.history["stroke"], [1.25, 2.5, 3.75, 5.0])
        np.testing.assert_allclose(forging.history["energy"][-1], forging.objectives["energy"], rtol=1e-14)
        np.testing.assert_array_equal(forging.gradient("barrel", RADII), list(forging.gradients["barrel"].values()))

    def test_program(self):
        """Without the program it says where that is looked for; one in PATH is found by its name."""
        built = os.environ["RETROFORGE"]
        with unittest.mock.patch.dict(os.environ, RETROFORGE="nowhere"):
            with self.assertRaisesRegex(retroforge.Error, "nor named by the environment variable RETROFORGE"):
                retroforge.run(CASE, QUICK)
        with unittest.mock.patch.dict(os.environ, RETROFORGE="retroforge", PATH=str(pathlib.Path(built).resolve().parent)):
            self.assertEqual(pathlib.Path(retroforge.program()).resolve(), pathlib.Path(built).resolve())

    def test_designs(self):
        """On one mesh: differences over 2 um are the gradient but for the decisions that it freezes."""
        nominal = retroforge.run(CASE, QUICK)
        for name in RADII:
            plus, minus = (retroforge.run(CASE, QUICK, {name: radius}, "simulate") for radius in (10.001, 9.999))
            for objective, values in nominal.gradients.items():
                difference = (plus.objectives[objective] - minus.objectives[objective]) / 0.002
                self.assertAlmostEqual(difference / values[name], 1.0, delta=1e-4)
            self.assertEqual(plus.gradients, {"barrel": {}, "energy": {}})

    def test_nodes(self):
        """Derivatives by the nodes, along what a parameter moves them, add up to that by the parameter."""
        nominal = retroforge.run(CASE, QUICK)
        self.assertEqual(nominal.nodes.shape, (nominal.summary["mesh"]["nodes"], 3))
        np.testing.assert_array_equal(nominal.nodes, nominal.billet.points)
        np.testing.assert_array_equal(nominal.node_numbers, nominal.billet.numbers)
        for name in RADII:
            ends = [retroforge.run(CASE, QUICK, {name: radius}, "simulate").billet.points for radius in (10.001, 9.999)]
            for objective, gradient in nominal.gradients_nodes.items():
                change = (gradient * (ends[0] - ends[1])).sum() / 0.002
                self.assertAlmostEqual(change / nominal.gradients[objective][name], 1.0, delta=1e-6)
        self.assertEqual(nominal.vertices, {})

    def test_vertices(self):
        """A die that moves up as a whole: the derivatives by its vertices add up to that by its offset."""
        forging = retroforge.run(CASE, {**QUICK, **BLUNT, "Design/parameters": "die upper/offset"})
        self.assertEqual(list(forging.vertices), ["upper"])
        for objective, gradient in forging.gradients_vertices["upper"].items():
            self.assertEqual(gradient.shape, forging.vertices["upper"].shape)
            down = -gradient[:, 2].sum()
            self.assertAlmostEqual(down / forging.gradients[objective]["die upper/offset"], 1.0, delta=1e-8)

    def test_fields(self):
        """In the order of the forged part's nodes and cells: the displacement is where they went, the mean of the strain is the objective."""
        told = {"Output/fields every": 1, "Objectives/names": "barrel, energy, mean strain"}
        forging = retroforge.run(CASE, {**QUICK, **told}, command="simulate")
        went = forging.forged.points - forging.billet.points
        np.testing.assert_allclose(forging.fields["displacement [mm]"], went, atol=1e-5)
        self.assertGreater(np.abs(went).max(), 1.0)
        a, b, c, d = (forging.forged.points[forging.forged.cells[:, i]] for i in range(4))
        volumes = np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)) / 6
        self.assertAlmostEqual(volumes.sum() / forging.summary["volume_final"], 1.0, delta=1e-12)
        mean = (volumes * forging.fields["equivalent_strain"]).sum() / volumes.sum()
        self.assertAlmostEqual(mean / forging.objectives["mean strain"], 1.0, delta=1e-6)
        self.assertEqual(forging.gradients_nodes, {})
        self.assertEqual(retroforge.run(CASE, QUICK, command="simulate").fields, {})

    def test_progress(self):
        rows = []
        with tempfile.TemporaryDirectory() as folder:
            forging = retroforge.run(CASE, QUICK, folder=folder, progress=rows.append)
            with self.assertRaisesRegex(retroforge.Error, "--overwrite"):
                retroforge.run(CASE, QUICK, folder=folder, progress=rows.append)
        self.assertEqual(rows, [{name: values[i] for name, values in forging.history.items()} for i in range(4)])

        def enough(row):
            if row["stroke"] > 0.2:
                raise StopIteration(row["increment"])
        with self.assertRaises(StopIteration):
            retroforge.run(CASE, {"Press/increments": 200}, progress=enough)

    def test_mistakes(self):
        for settings, at, message in (({"Press/strok": 1}, {}, "unknown parameter 'Press/strok'"),
                                      ({}, {"billet/control point 9 r": 1.0}, "billet/control point 9 r"),
                                      ({"Press/stroke": 14.9, "Press/max cuts": 0, "Press/increments": 3}, {}, "Press/stroke")):
            with self.assertRaisesRegex(retroforge.Error, message) as caught:
                retroforge.run(CASE, settings, at)
            self.assertFalse(str(caught.exception).startswith("retroforge:"))
        with self.assertRaisesRegex(retroforge.Error, "no_case.prm"):
            retroforge.run("no_case.prm")

    def test_values(self):
        for value, text in ((True, "true"), (np.bool_(False), "false"), (3, "3"), (np.int64(4), "4"), (0.1, "0.1"),
                            (np.float64(1 / 3), repr(1 / 3)), ((1, 2.5), "1, 2.5"), (np.zeros(2), "0.0, 0.0"), ("never", "never")):
            self.assertEqual(retroforge.as_text(value), text)

    def test_example(self):
        start, _ = straight_side.barrel([10.0, 10.0])
        found = straight_side.optimize()
        self.assertTrue(found.success)
        self.assertLess(found.nfev, 12)
        self.assertLess(found.fun**0.5, 0.3 * start**0.5)
        self.assertLess(np.abs(found.jac).max(), 0.01)
        ours = retroforge.optimize(CASE, {"Optimisation/confirmation": 0, "Optimisation/noise runs": 0})
        np.testing.assert_allclose([ours["best"][name] for name in RADII], found.x, atol=0.1)
        self.assertLess(ours["objective"]["best"], 1.001 * found.fun)


if __name__ == "__main__":
    unittest.main()
