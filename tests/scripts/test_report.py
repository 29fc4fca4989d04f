# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The report reads what a run leaves (three encodings of VTU, also in pieces), and copes with what it does not leave.

By hand: the boundary of n^3 boxes of six tetrahedra has 12 n^2 triangles, and its area is 6 x side^2. A pressure p on a
surface is the nodal gradient p x area vector; per area, its normal part is p, at edges and corners too.
"""
import json
import os
import sys
import unittest

import numpy as np
import synthetic_run
import synthetic_scene
from scripts import CONTRIB, ScratchTest, call

sys.dont_write_bytecode = True
sys.path.insert(0, str(CONTRIB))
from retroforge_report import data, effects, refine, render, sections, shapes, units, vtu, whole  # noqa: E402

SIDE = synthetic_run.SIDE


class Report(ScratchTest):
    def test_vtu_encodings(self):
        points, cells = synthetic_run.cube(3)
        for encoding in ("ascii", "binary", "zlib"):
            with self.subTest(encoding=encoding):
                path = self.root / "a.vtu"
                synthetic_run.write_vtu(path, points, cells, {"x": points}, {"c": np.arange(len(cells)) * 1.0}, encoding)
                mesh = vtu.read(path)
                np.testing.assert_array_equal(mesh.points, points)
                np.testing.assert_array_equal(mesh.cells, cells)
                np.testing.assert_array_equal(mesh.point_data["x"], mesh.points)
                np.testing.assert_array_equal(mesh.cell_data["c"], np.arange(len(cells)))
                surface = mesh.surface()
                self.assertEqual(len(surface.triangles), 12 * 3**2)
                areas = surface.area_vectors()
                self.assertAlmostEqual(np.linalg.norm(areas, axis=1).sum(), 6 * synthetic_run.SIDE**2, 6)
                outward = np.einsum("ij,ij->i", areas, surface.to_triangles(surface.points) - synthetic_run.SIDE / 2)
                self.assertGreater(outward.min(), 0)

    def test_quadratic_cells(self):
        """The middles of the edges are points behind the corners, and left out."""
        points, cells = synthetic_run.cube(2)
        edges, of_cells = np.unique(np.sort(cells[:, [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]].reshape(-1, 2), axis=1), axis=0,
                                    return_inverse=True)
        places = np.concatenate([points, points[edges].mean(axis=1)])
        number = np.arange(len(cells)) * 1.0
        synthetic_run.write_vtu(self.root / "a.vtu", places, np.concatenate([cells, len(points) + of_cells.reshape(-1, 6)], axis=1),
                                {"x": places}, {"number": number, "tensor": number[:, None] * np.arange(9)}, "zlib")
        mesh = vtu.read(self.root / "a.vtu")
        self.assertEqual((list(mesh.point_data), list(mesh.cell_data)), (["x"], ["number", "tensor"]))
        for found, wanted in ((mesh.points, points), (mesh.cells, cells), (mesh.point_data["x"], points), (mesh.cell_data["number"], number),
                              (mesh.cell_data["tensor"], np.outer(number, np.arange(9)))):
            np.testing.assert_array_equal(found, wanted)
        self.assertEqual(len(mesh.surface().triangles), 12 * 2**2)

    def test_pieces(self):
        """Of several the nodes in between would be counted twice."""
        path = self.root / "a.vtu"
        synthetic_run.write_vtu(path, *synthetic_run.cube(1), {}, {}, "ascii")
        text = path.read_text()
        piece = text[text.index("<Piece"):text.index("</Piece>") + len("</Piece>")]
        path.write_text(text.replace(piece, piece + piece))
        with self.assertRaisesRegex(ValueError, "2 pieces"):
            vtu.read(path)

    def test_triangles(self):
        points, triangles = synthetic_run.dome(4, depth=0.0)
        for encoding in ("ascii", "binary", "zlib"):
            with self.subTest(encoding=encoding):
                path = self.root / "die.vtu"
                extra = np.vstack([points, [[0.0, 0.0, 0.0]]])  # of no triangle
                synthetic_run.write_vtu(path, extra, triangles, {"x": extra}, {}, encoding)
                mesh = vtu.read(path)
                np.testing.assert_array_equal(mesh.point_data["x"], mesh.points)
                surface = mesh.surface()
                self.assertEqual((len(surface.points), len(surface.triangles)), (25, 32))
                np.testing.assert_allclose(surface.area_vectors().sum(axis=0), [0, 0, -(2 * SIDE)**2], atol=1e-9)
                self.assertAlmostEqual(surface.nodal_areas().sum(), (2 * SIDE)**2, 8)

    def test_other_cells(self):
        path = self.root / "lines.vtu"
        synthetic_run.write_vtu(path, np.zeros((3, 3)), np.array([[0, 1, 2]]), {}, {}, "ascii")
        path.write_text(path.read_text().replace('format="ascii">5</DataArray>', 'format="ascii">7</DataArray>'))
        with self.assertRaisesRegex(ValueError, "neither tetrahedra nor triangles"):
            vtu.read(path)

    def test_pressure_on_surfaces(self):
        dome, cube = vtu.Mesh(*synthetic_run.dome(5), {}, {}), vtu.Mesh(*synthetic_run.cube(2), {}, {})
        for surface in (dome.surface(), cube.surface()):
            _, normal = shapes._per_area(surface, 3.5 * surface.nodal_area_vectors())
            np.testing.assert_allclose(normal, 3.5, rtol=1e-12)

    def test_refined(self):
        """Of a linear field: the same surface, the field's values at the middles, and no jump above the tolerance."""
        surface = vtu.Mesh(*synthetic_run.dome(2, depth=0.0), {}, {}).surface()
        field = surface.points @ [1.0, 2.0, 0.0]
        fine, values = refine.refined(surface, field, tolerance=20.0, finest=0.0)
        np.testing.assert_allclose(fine.area_vectors().sum(axis=0), surface.area_vectors().sum(axis=0), atol=1e-9)
        np.testing.assert_allclose(values, fine.to_triangles(fine.points) @ [1.0, 2.0, 0.0])
        corners = (fine.points @ [1.0, 2.0, 0.0])[fine.triangles]
        self.assertLessEqual(np.ptp(corners, axis=1).max(), 20.0)
        self.assertGreater(len(fine.triangles), 8 * (150 / 20))
        np.testing.assert_allclose(fine.area_vectors()[:, 2] < 0, True)
        self.assertEqual(len(refine.refined(surface, field, 1e3, 0.0)[1]), 8)
        self.assertEqual(len(refine.refined(surface, field, 0.0, 1e3)[1]), 8)

    def test_refined_with_holes(self):
        """Triangles of which a corner has no value stay whole, and have none."""
        surface = vtu.Mesh(*synthetic_run.dome(2, depth=0.0), {}, {}).surface()
        field = surface.points @ [1.0, 2.0, 0.0]
        field[0] = np.nan
        fine, values = refine.refined(surface, field, tolerance=20.0, finest=0.0)
        around = (surface.triangles == 0).any(axis=1).sum()
        self.assertEqual(np.isnan(values).sum(), around)
        np.testing.assert_allclose(fine.area_vectors().sum(axis=0), surface.area_vectors().sum(axis=0), atol=1e-9)

    def test_cells_to_nodes(self):
        """Of a constant the same; of two tetrahedra of volumes 1 and 2 with 0 and 3, a shared node has 2."""
        points, cells = synthetic_run.cube(2)
        np.testing.assert_allclose(vtu.Mesh(points, cells, {}, {}).to_nodes(np.full(len(cells), 7.0)), 7)
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -2.0]])
        mesh = vtu.Mesh(points, np.array([[0, 1, 2, 3], [0, 2, 1, 4]]), {}, {})
        np.testing.assert_allclose(mesh.to_nodes(np.array([0.0, 3.0])), [2, 2, 2, 0, 3])

    def test_even_pressure(self):
        """Nodal forces of an even pressure on part of a square, as a run writes them: smaller at the rim, where part of the area is free.
        The picture has the pressure everywhere it acts, and nothing beside. A force that nodes carry by turns is evened out, and kept."""
        surface = vtu.Mesh(*synthetic_run.dome(8, depth=0.0), {}, {}).surface()
        pressed = (surface.points[surface.triangles][:, :, 0] < SIDE / 2 + 1e-9).all(axis=1)
        areas = np.linalg.norm(surface.area_vectors(), axis=1)
        nodal = surface.nodal_sums(np.where(pressed, 5 * areas / 3, 0)) / surface.nodal_areas()
        even = shapes._even_pressure(surface, nodal)
        np.testing.assert_allclose(even[nodal > 0], 5)
        self.assertTrue(np.isnan(even[nodal == 0]).all())
        mottled = 5 + np.random.default_rng(1).uniform(-2, 2, len(surface.points))
        even = shapes._even_pressure(surface, mottled)
        self.assertLess(np.std(even), 0.6 * np.std(mottled))
        self.assertAlmostEqual(even @ surface.nodal_areas(), mottled @ surface.nodal_areas(), delta=1e-9 * 1e5)

    def test_sharp_edges(self):
        """A cube has 12 edges of n pieces; of a square that is clipped, with points of each triangle's own, the outline is left."""
        cube = vtu.Mesh(*synthetic_run.cube(3), {}, {}).surface()
        edges = render.sharp_edges(cube)
        self.assertEqual(len(edges), 12 * 3)
        self.assertAlmostEqual(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).sum(), 12 * SIDE, 9)
        square = vtu.Mesh(*synthetic_run.dome(3, depth=0.0), {}, {}).surface()
        part = whole.within(square, np.array([0.0, 0.0, 0.0]), np.array([40.0, 30.0, 100.0]))
        ends = render.sharp_edges(part)
        self.assertAlmostEqual(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum(), 140, 9)
        self.assertEqual(len(render.sharp_edges(whole.within(square, np.full(3, 1e3), np.full(3, 2e3)))), 0)

    def test_whole_part(self):
        """A cube between 1, 2 and 3 of its planes and its images is a box of 2, 4 and 8 of it; in a wedge of 60 degrees six.

        By hand: the surface of boxes 2 x 1 x 1, 2 x 2 x 1, 2 x 2 x 2 is 10, 16, 24 faces of the cube.
        """
        cube = vtu.Mesh(*synthetic_run.cube(2), {}, {}).surface()
        planes = [np.array([0.0, 0.0, 0.0, *-axis]) for axis in np.eye(3)]
        for n, faces in ((0, 6), (1, 10), (2, 16), (3, 24)):
            part = whole.whole(cube, planes[:n])
            self.assertEqual(len(whole.symmetries(planes[:n])), 2**n)
            self.assertAlmostEqual(np.linalg.norm(part.area_vectors(), axis=1).sum(), faces * SIDE**2, 6)
            np.testing.assert_allclose(part.points.min(axis=0), [-SIDE] * n + [0] * (3 - n), atol=1e-9)
            positions = vtu.Mesh(*synthetic_run.cube(2), {}, {}).points  # a vector field that all mirrors keep
            np.testing.assert_allclose(whole.whole_vectors(positions, cube, planes[:n]), part.points, atol=1e-9)
            volume = (part.area_vectors() * part.to_triangles(part.points)).sum() / 3  # all normals point outwards
            self.assertAlmostEqual(volume, 2**n * SIDE**3, 4)
        opened = whole.cut_open(cube, planes[:2], np.array([1.0, 2.0, 1.0]))  # three of four, with their faces inside
        self.assertAlmostEqual(np.linalg.norm(opened.area_vectors(), axis=1).sum(), 3 * 6 * SIDE**2, 6)
        self.assertFalse((opened.points > 1e-9)[:, :2].all(axis=1).any())
        wedge = [np.array([1.0, 2.0, 0.0, np.sin(a), -np.cos(a), 0.0]) for a in (0, np.pi / 3)]
        self.assertEqual(len(whole.symmetries(wedge)), 6)
        without_end = [np.array([x, 0.0, 0.0, 1.0, 0.0, 0.0]) for x in (0.0, 1.0)]
        self.assertIs(whole.whole(cube, without_end), cube)

    def test_clipped_die(self):
        """Of a flat square of side 100 about (25, 25), planes leave what is between them, turned as it was."""
        square = vtu.Mesh(*synthetic_run.dome(3, depth=0.0), {}, {}).surface()
        for planes, area in (([], 100**2), ([[0, 0, 0, -1, 0, 0]], 75 * 100), ([[0, 0, 0, -1, 0, 0], [0, 10, 0, 0, 1, 0]], 75 * 35),
                             ([[200, 0, 0, -1, 0, 0]], 0)):
            part = whole.clipped(square, np.array(planes, float).reshape(-1, 6))
            np.testing.assert_allclose(part.area_vectors().sum(axis=0), [0, 0, -area], atol=1e-9)
            self.assertAlmostEqual(np.linalg.norm(part.area_vectors(), axis=1).sum(), area, 8)

    def test_steps(self):
        """Parts of the first and the last time; the first of a time is the workpiece."""
        synthetic_run.write(self.root, n=2, increments=4)
        points, triangles = synthetic_run.dome(2)
        synthetic_run.write_vtu(self.root / "die.vtu", points, triangles, {}, {}, "ascii")
        self.write("fields.pvd", '<VTKFile><Collection><DataSet timestep="0" file="fields_000000.vtu"/>'
                   '<DataSet timestep="1" part="0" file="fields_000001.vtu"/><DataSet timestep="1" part="0" file="die.vtu"/>'
                   '</Collection></VTKFile>')
        run = data.Run(self.root)
        self.assertEqual([len(step.dies) for step in (run.initial, run.final)], [0, 1])
        self.assertEqual(run.final.workpiece.cells.shape[1], 4)
        np.testing.assert_array_equal(run.final.dies[0].points, points)
        self.assertEqual(call("report", "--no-vtk", self.root).returncode, 0)

    def test_view_onto_a_die(self):
        for direction in ([0, 0, -1], [0, 0, 2], [1, 0, 0], [0.3, -0.4, -0.5]):
            view = render.view_onto(np.array(direction, float))
            self.assertAlmostEqual(view.eye @ direction / np.linalg.norm(direction), np.cos(np.radians(40)), 12)
            self.assertAlmostEqual(np.linalg.det([view.right, view.up, view.eye]), 1, 12)
        self.assertIs(render.view_onto(np.zeros(3)), render.FROM_THE_SIDE)

    def test_units_and_identifiers(self):
        self.assertEqual([data.identifier(name) for name in ("fold (a=4)", "Größe 2", "x_1")],
                         ["fold__a_4_", "Gr____e_2", "x_1"])
        self.assertEqual([units.pretty(u) for u in ("mm^2 s^-3", "none", None, "mm^(-m)", "s^10")],
                         ["mm² s⁻³", "", "", "mm^(-m)", "s¹⁰"])
        self.assertEqual([units.readable(unit, largest) for unit, largest in (("N", 999.0), ("N", -1.5e5), ("N", 2e6), ("mJ", 2e4), ("mJ", 0.5),
                                                                              ("mm^3", 1e9), (None, 1e9))],
                         [(1, "N"), (1e3, "kN"), (1e6, "MN"), (1e3, "J"), (1, "mJ"), (1, "mm^3"), (1, None)])
        self.assertEqual([units.per_volume(u) for u in ("mJ", "none")], ["mJ/mm³", "1/mm³"])

    def test_ranking(self):
        parameters = [{"name": name, "value": value, "unit": "", "gradient": {"energy": derivative}}
                      for name, value, derivative in (("a", 2.0, 3.0), ("b", 0.0, 1e9), ("c", -10.0, 1.0), ("d", 5.0, -8.0),
                                                      ("e", None, 1.0))]
        ranked = effects.effects({"name": "energy", "value": 20.0}, parameters)
        self.assertEqual([e.parameter["name"] for e in ranked], ["d", "c", "a", "b", "e"])
        np.testing.assert_allclose([e.for_one_percent for e in ranked[:3]], [-0.4, 0.1, 0.06])
        self.assertEqual([e.for_one_percent for e in ranked[3:]], [None, None])
        relative = effects.relative_gradient({"name": "energy", "value": 20.0}, parameters)
        np.testing.assert_allclose([value for _, value in relative], [-2.0, 0.5, 0.3])
        self.assertEqual(effects.relative_gradient({"name": "energy", "value": 0.0}, parameters), [])
        self.assertEqual(effects.effects({"name": "volume", "value": 1.0}, parameters), [])
        offset = {"name": "f", "value": 0.0, "scale": 20.0, "unit": "mm", "gradient": {"energy": 3.0}}
        self.assertAlmostEqual(effects.effects({"name": "energy", "value": 1.0}, [offset])[0].for_one_percent, 0.6)

    def test_objectives_over_the_stroke(self):
        self.write("summary.json", '{"schema": 1, "objectives": [{"name": "a"}, {"name": "a: b"}]}')
        self.write("objectives.csv", "stroke [mm],a [mJ],a: part [mJ],a: b [N],c [x] [none]\n1,2,3,,\n2,4,5,6,\n3,1")
        run = data.Run(self.root)
        np.testing.assert_array_equal(run.objective_strokes, [1, 2])
        self.assertEqual([(c.name, c.unit, c.of) for c in run.objective_columns],
                         [("a", "mJ", ""), ("part", "mJ", "a"), ("a: b", "N", ""), ("c [x]", "none", "")])
        np.testing.assert_array_equal([c.values for c in run.objective_columns],
                                      [[2, 4], [3, 5], [np.nan, 6], [np.nan, np.nan]])

    def test_many_objectives(self):
        """The first four of six have pictures of their own, the first of them none on the die; all have numbers."""
        synthetic_run.write(self.root / "run", n=2, increments=4)
        result = call("report", "--no-vtk", self.root / "run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        page = (self.root / "run/report.html").read_text()
        pictures = sorted(path.stem for path in (self.root / "run/pictures").glob("*.png"))
        first = ["energy", "fold__a_4_", "late_force", "mean_strain"]
        self.assertEqual(pictures, sorted(
            ["shapes", "force", "objectives", "gradients", "conduct", "check_volume",
             *(f"check_{o}" for o in first), *(f"sensitivity_{o}" for o in first),
             *(f"sensitivity_die_upper_{o}" for o in first[1:])]))
        self.assertEqual(page.count("data:image/png;base64"), len(pictures))
        for text in ("1.98, 1.99, 2", "Drawn for the first 4 of 6 objectives; sensitivity_die_upper.vtu",
                     "Without values: volume.",
                     "energy: 4 of 4 passed", "volume: 3 of 4 passed", "energy does not depend on it.",
                     "for +1 % [mm² s⁻³]", "<h3>fold (a=4)</h3>", "<h3>volume</h3>"):
            self.assertIn(text, page)
        table = page[page.index("<h3>late force</h3>"):]
        places = [table.index(f"<td>{name}</td>") for name in ("material/K", "billet/stretch", "dies/offset")]
        self.assertEqual(places, sorted(places))
        self.assertIn('<td class="n">1.7</td><td>MPa s^m</td><td class="n">73529.4</td><td class="n">+1250</td>', table)
        self.assertIn('<td class="n">0</td><td>mm</td><td class="n">321</td><td class="n">–</td>', table)

    def test_unknown_numbers(self):
        """A number that a run did not find is null."""
        synthetic_run.write(self.root / "run", n=2, increments=4, n_objectives=1)
        path = self.root / "run/summary.json"
        summary = json.loads(path.read_text())
        summary["parameters"][0]["value"] = summary["volume_final"] = None
        summary["parameters"][1]["gradient"]["energy"] = summary["wall_seconds"]["krylov"] = None
        summary["check"][0]["adjoint"] = summary["check"][1]["taylor_orders"][0] = None
        summary["check"][0]["free"] = {"slope": 28.0, "uncertainty": 0.1, "jumps": 0.0, "doubtful": True}
        summary["check"][1]["steps"][0]["free_central"] = None
        del summary["check"][2]["steps"], summary["parameters"][2]["gradient"]
        for value in (summary["objectives"][0]["value"], None):
            summary["objectives"][0]["value"] = value
            path.write_text(json.dumps(summary))
            result = call("report", "--no-vtk", self.root / "run")
            self.assertEqual(result.returncode, 0, result.stderr)
            page = (self.root / "run/report.html").read_text()
            self.assertNotIn("nan", page.split("base64")[0])
            self.assertNotIn("Drawn for the first", page)
            self.assertIn("passed, doubtful: decided anew, the slope is 28; scan tells which holds", page)
            self.assertEqual((self.root / "run/pictures/gradients.png").is_file(), value is not None)

    def test_unfinished(self):
        """Without a summary the tables, shapes and the reason of a failure are left."""
        synthetic_run.write(self.root / "run", n=2, increments=4)
        (self.root / "run/summary.json").unlink()
        for failure, text in ((None, "goes on from its last increment"), ("Press/stroke: is < 0", "Press/stroke: is &lt; 0</span>")):
            if failure:
                self.write("run/failure.txt", failure + "\n")
            result = call("report", "--no-vtk", self.root / "run")
            self.assertEqual(result.returncode, 0, result.stderr)
            page = (self.root / "run/report.html").read_text()
            for expected in (text, "Results until stroke 25 mm", '<td>energy</td><td class="n">625</td>'):
                self.assertIn(expected, page)

    def test_values_of_the_whole_part(self):
        """Only what adds up has a value of the whole part."""
        synthetic_run.write(self.root / "run", n=2, increments=4)
        path = self.root / "run/summary.json"
        summary = json.loads(path.read_text())
        summary["objectives"][1]["whole"] = 1e6
        for copies, text in ((4.0, "The model is 1/4 of the part"), (None, "bound no whole part")):
            summary["whole"] = {"copies": copies, "force_factor": copies}
            path.write_text(json.dumps(summary))
            self.assertEqual(call("report", "--no-vtk", self.root / "run").returncode, 0)
            page = (self.root / "run/report.html").read_text()
            for expected in (text, '<th class="n">whole part</th>', '<td class="n">250000</td><td class="n">1e+06</td><td>N</td>'):
                self.assertIn(expected, page)

    def test_trust(self):
        """What a run says of its slopes stands beside them; without it there is no column."""
        synthetic_run.write(self.root / "run", n=2, increments=4)
        path = self.root / "run/summary.json"
        summary = json.loads(path.read_text())
        for says in (False, True):
            if says:
                summary["objectives"][1]["note"] = "2 remeshings lie within"
                summary["parameters"][0]["trust"] = {"energy": "within 5 %"}
                path.write_text(json.dumps(summary))
            self.assertEqual(call("report", "--no-vtk", self.root / "run").returncode, 0)
            page = (self.root / "run/report.html").read_text()
            for text, times in (("<th>how far it holds</th>", 1), ("<td>within 5 %</td>", 1), ("Of late force: 2 remeshings lie within.", 1)):
                self.assertEqual(page.count(text), times if says else 0, text)

    def test_bare_summary(self):
        self.write("run/summary.json", '{"schema": 1, "command": "simulate"}')
        result = call("report", "--no-vtk", self.root / "run")
        self.assertEqual(result.returncode, 0, result.stderr)

    def scene(self, **parts):
        synthetic_scene.write(self.root / "scene", **parts)
        result = call("report", "--no-vtk", self.root / "scene")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return (self.root / "scene/report.html").read_text(), sorted(path.stem for path in (self.root / "scene/pictures").glob("*.png"))

    def test_scene(self):
        """The message of a scene that is refused is the first thing of its page; what could be made is drawn and listed."""
        page, pictures = self.scene()
        self.assertEqual(pictures, ["gaps", "scene", "sections"])
        self.assertLess(page.index("The scene is refused"), page.index("<img"))
        self.assertLess(page.index("the billet stands &lt;1 mm&gt; inside it"), page.index("<img"))
        for text in ("Material/consistency = 200", "Cut through the deepest overlap", "Red: inside a die.",
                     "1 mm inside the die, at (50, 50, 0); free when the die moves by (0, 0, -1) mm",
                     "2 mm away, nearest to (25, 25, 50)", "after 2 mm, at stroke 2 mm, at (25, 25, 50)", "(0, 0, -100) mm/s, leads",
                     "126250; the mesh lacks 0.99 %", "4 times the model, 505000 mm³", "through (0, 0, 0), outward normal (-1, 0, 0)",
                     "20 of 0.5 mm, 0.005 s each", "first press, whole part [kN]", '<td class="n">125</td>', "slab method", "case box.prm"):
            self.assertIn(text, page)
        page, pictures = self.scene(refused=False)
        self.assertIn("The scene is sound: a run would begin", page)
        self.assertNotIn("Red:", page)
        self.assertIn("Cut through the first touch", page)

    def test_scene_in_part(self):
        """Without a billet the dies are drawn; without anything the message stands alone."""
        page, pictures = self.scene(with_billet=False)
        self.assertEqual(pictures, ["scene", "sections"])
        self.assertIn("The billet could not be made.", page)
        page, pictures = self.scene(with_dies=False)
        self.assertIn("The scene is refused", page)
        self.assertEqual(pictures, [])
        page, pictures = self.scene(with_billet=False, with_dies=False)
        self.assertIn("Neither billet nor dies could be made.", page)
        self.assertEqual(pictures, [])

    def test_sections(self):
        """By hand: a cut of the cube is a square, of its quarter's whole one of twice the width; a plane is cut in a line."""
        mesh = vtu.Mesh(*synthetic_run.cube(3), {}, {})
        across, along = sections.cuts([0, 0, -100], [10.0, 20.0, 30.0])
        for cut, normal, right in ((across, [1, 0, 0], [0, 1, 0]), (along, [0, 1, 0], [1, 0, 0])):
            np.testing.assert_allclose(np.abs(cut.normal), normal, atol=1e-12)
            np.testing.assert_allclose(cut.axes, [right, [0, 0, 1]], atol=1e-12)
        ends, normals = sections.lines(mesh.surface(), across)
        self.assertAlmostEqual(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum(), 4 * SIDE, 6)
        np.testing.assert_allclose(ends[:, :, 0], 10, atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1)
        for planes, width in ((np.zeros((0, 6)), SIDE), (synthetic_scene.PLANES, 2 * SIDE)):
            mesh.symmetry_planes = planes
            area = sum(abs(np.sum(flat[:, 0] * np.roll(flat[:, 1], -1) - np.roll(flat[:, 0], -1) * flat[:, 1])) / 2
                       for flat in (across.flat(polygon) for polygon in sections.cells(mesh, across)))
            self.assertAlmostEqual(area, width * SIDE, 6)
        # the plane x = y meets the cut x = 10 in y = 10; x = 0 is parallel to it
        for point in sections.trace(np.array([0, 0, 5, 0.5**0.5, -(0.5**0.5), 0]), across):
            self.assertAlmostEqual(point[0], 10, 9)
        self.assertIsNone(sections.trace(np.array([0, 0, 0, 1.0, 0, 0]), across))
        oblique, _ = sections.cuts([0, -3, -4], [0, 0, 0])
        self.assertAlmostEqual(oblique.normal @ [0, -3, -4], 0, 12)
        np.testing.assert_allclose(oblique.axes @ oblique.axes.T, np.eye(2), atol=1e-12)

    def test_a_python_without_packages(self):
        synthetic_run.write(self.root / "run", n=2, increments=2)
        (self.root / "matplotlib.py").write_text("raise ModuleNotFoundError(\"No module named 'matplotlib'\", name='matplotlib')\n", encoding="utf-8")
        result = call("report", "--no-vtk", self.root / "run", environment={**os.environ, "PYTHONPATH": str(self.root)})
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no matplotlib", result.stderr)
        self.assertNotIn("Traceback", result.stderr)

    def test_bad_input(self):
        self.assertIn("neither summary.json nor history.csv", call("report", "--no-vtk", self.root).stderr)
        self.write("summary.json", '{"schema": 99}')
        with self.assertRaisesRegex(ValueError, "schema is 99"):
            data.Run(self.root)


if __name__ == "__main__":
    unittest.main()
