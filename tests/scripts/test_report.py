# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The report reads what a run leaves (three encodings of VTU), and copes with what it does not leave.

By hand: the boundary of n^3 boxes of six tetrahedra has 12 n^2 triangles, and its area is 6 x side^2.
"""
import json
import sys
import unittest

import numpy as np
import synthetic_run
from scripts import CONTRIB, ScratchTest, call

sys.dont_write_bytecode = True
sys.path.insert(0, str(CONTRIB))
from retroforge_report import data, vtu  # noqa: E402


class Report(ScratchTest):
    def test_vtu_encodings(self):
        points, cells = synthetic_run.cube(3)
        for encoding in ("ascii", "binary", "zlib"):
            with self.subTest(encoding=encoding):
                path = self.root / "a.vtu"
                # each cell with nodes of its own, as deal.II's DataOut writes
                synthetic_run.write_vtu(path, points[cells].reshape(-1, 3), np.arange(cells.size).reshape(-1, 4),
                                        {"x": points[cells].reshape(-1, 3)}, {"c": np.arange(len(cells)) * 1.0}, encoding)
                mesh = vtu.read(path)
                self.assertEqual(len(mesh.points), len(points))
                np.testing.assert_array_equal(mesh.point_data["x"], mesh.points)
                np.testing.assert_array_equal(mesh.cell_data["c"], np.arange(len(cells)))
                surface = mesh.surface()
                self.assertEqual(len(surface.triangles), 12 * 3**2)
                areas = surface.area_vectors()
                self.assertAlmostEqual(np.linalg.norm(areas, axis=1).sum(), 6 * synthetic_run.SIDE**2, 6)
                outward = np.einsum("ij,ij->i", areas, surface.to_triangles(surface.points) - synthetic_run.SIDE / 2)
                self.assertGreater(outward.min(), 0)

    def test_whole_page(self):
        synthetic_run.write(self.root / "run", n=3, increments=4)
        result = call("report", "--no-vtk", self.root / "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        page = (self.root / "run/report.html").read_text()
        self.assertEqual(page.count("data:image/png;base64"), 6)
        self.assertEqual(len(list((self.root / "run/pictures").glob("*.png"))), 6)
        self.assertIn("1.98, 1.99, 2", page)

    def test_unknown_numbers(self):
        """A number that a run did not find is null."""
        synthetic_run.write(self.root / "run", n=3, increments=4)
        path = self.root / "run/summary.json"
        summary = json.loads(path.read_text())
        summary["objectives"][0]["value"] = summary["parameters"][0]["value"] = summary["volume_final"] = None
        summary["parameters"][1]["gradient"]["energy"] = summary["wall_seconds"]["krylov"] = None
        summary["check"][0]["adjoint"] = summary["check"][1]["taylor_orders"][0] = None
        summary["check"][1]["steps"][0]["free_central"] = None
        del summary["check"][2]["steps"], summary["parameters"][2]["gradient"]
        path.write_text(json.dumps(summary))
        result = call("report", "--no-vtk", self.root / "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("nan", (self.root / "run/report.html").read_text().split("base64")[0])

    def test_bare_summary(self):
        self.write("run/summary.json", '{"schema": 1, "command": "simulate"}')
        result = call("report", "--no-vtk", self.root / "run")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_bad_input(self):
        self.assertIn("summary.json was not found", call("report", "--no-vtk", self.root).stderr)
        self.write("summary.json", '{"schema": 99}')
        with self.assertRaisesRegex(ValueError, "schema is 99"):
            data.Run(self.root)


if __name__ == "__main__":
    unittest.main()
