# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The page of a scene: billet and dies before the first increment, why a run would be refused, and what to expect of it."""
import json
import pathlib

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import cm, colors

from retroforge_report import sections, vtu
from retroforge_report.document import Document, bad, number
from retroforge_report.refine import refined
from retroforge_report.render import METAL, Scene, View
from retroforge_report.units import readable
from retroforge_report.vtu import Surface
from retroforge_report.whole import clipped, symmetries, whole, within

SCHEMA = 1
FROM_ABOVE, FROM_BELOW = View([1.0, -1.6, 0.75]), View([1.0, -1.6, -0.75])
INSIDE = "#d00000"  # what lies in a die
BARE = (0.45, 0.52, 0.62, 1.0)  # dies without a billet
BESIDE = 0.01  # of the way from the middle of the whole part to that of the model
SHIFT = 0.02  # of the extent: sections pass so far inside of a place on the surface
TOUCHING = 1e-3  # of the extent: what is less deep in a die touches it
SMALL = 0.05  # of the extent: overlaps below it are magnified


def place(x):
    size = np.linalg.norm(x)
    return "(" + ", ".join(f"{c if abs(c) > 1e-9 * size else 0:.4g}" for c in x) + ")"


def millimetres(value):
    return "unknown" if value is None else f"{value:.4g} mm"


class ScenePage:
    def __init__(self, directory, use_vtk, notes):
        self.directory, self.use_vtk = pathlib.Path(directory), use_vtk
        path = self.directory / "scene.json"
        self.scene = json.loads(path.read_text(encoding="utf-8"))
        if self.scene.get("schema") != SCHEMA:
            raise ValueError(f"{path}: schema is {self.scene.get('schema')}; this report reads {SCHEMA}; look at the scene again")
        self.billet, self.dies = self.scene.get("billet"), self.scene["dies"]
        self.mesh = vtu.read(self.directory / "scene_billet.vtu") if self.billet else None
        self.planes = self.mesh.symmetry_planes if self.mesh else np.zeros((0, 6))
        self.surfaces = [vtu.read(self.directory / f"scene_die_{die['name']}.vtu").surface() for die in self.dies]
        self.to = Document(self.directory)
        for note in notes:
            self.to.note(note)

    def write(self):
        """Returns the path of the page."""
        for section in (self.verdict, self.shapes, self.sections, self.gaps, self.places, self.metal, self.course):
            section()
        self.to.note(", ".join([f"case {self.scene['case']}", *(f"{key} {self.scene[key]}" for key in ("version", "commit") if self.scene.get(key)),
                                f"looked at in {number(self.scene.get('wall_seconds'), 2)} s"]))
        return self.to.save(f"{self.directory.resolve().name}: retroforge scene")

    def verdict(self):
        refusals = self.scene["refusals"]
        self.to.heading("The scene is refused: a run would not begin" if refusals else "The scene is sound: a run would begin")
        for refusal in refusals:
            self.to.note(bad(refusal))
        if refusals:
            missing = "" if self.billet else " The billet could not be made." if self.dies else " Neither billet nor dies could be made."
            self.to.note("What could be made is drawn and listed all the same." + missing)
        for warning in self.scene["warnings"]:
            self.to.note(warning)

    def shapes(self):
        """As they stand, seen from above and from below."""
        if not self.surfaces:
            return
        self.to.heading("Billet and dies at the start")
        dies = [whole(clipped(surface, self.planes), self.planes) for surface in self.surfaces]
        body = whole(self.mesh.surface(), self.planes) if self.mesh else joined(dies)
        colour = METAL if self.mesh else BARE
        shown = np.concatenate([body.points, *(near(die.points, body.points) for die in dies)])
        dies = [within(die, shown.min(axis=0), shown.max(axis=0)) for die in dies]
        figure = plt.figure(figsize=(11, 5), layout="constrained")
        for position, (title, view) in enumerate((("from above", FROM_ABOVE), ("from below", FROM_BELOW)), 1):
            scene = Scene(shown, self.use_vtk, view, margin=1.1)
            axes = scene.draw(figure, (1, 2, position), body, np.tile(colour, (len(body.triangles), 1)), self.ways(scene, dies),
                              edges=body if self.mesh else None, dies=dies)
            axes.set_title(title, fontsize=11)
        self.to.picture("scene", figure)
        mirrored = "The model is mirrored by its symmetry planes to the whole part. " if len(symmetries(self.planes)) > 1 else ""
        self.to.note(mirrored + "Arrows show where dies move. Of a plane die a rectangle is drawn, which has no end in the model.")

    def ways(self, scene, dies):
        """Arrows to the middles of the dies that move, or None."""
        moving = [(middle(surface.points), np.array(die["velocity"], float)) for die, surface in zip(self.dies, dies)
                  if any(die["velocity"]) and len(surface.points)]
        if not moving:
            return None
        tips, ways = (np.array(x) for x in zip(*moving))
        ways *= 0.35 * scene.radius / np.linalg.norm(ways, axis=1).max()
        return tips - ways, ways

    def overlaps(self):
        """(die, overlap), the deepest first."""
        found = [(die, die["overlap"]) for die in self.dies if die.get("overlap")]
        return sorted(found, key=lambda pair: -pair[1]["distance"])

    def sections(self):
        if not self.surfaces:
            return
        low, high = self.extents()
        size = np.linalg.norm(high - low)
        centre = middle(whole(self.mesh.surface(), self.planes).points if self.mesh else np.array([low, high]))
        overlaps = self.overlaps()
        # A little beside the middle, where planes of symmetry may lie.
        marks, through = [], centre + BESIDE * ((low + high) / 2 - centre + 0.1 * (high - low))
        if overlaps:
            die, deepest = overlaps[0]
            marks.append((deepest["place"], f"{millimetres(deepest['distance'])} inside"))
        else:
            for die in self.dies:
                touch = die.get("first_touch") or {}
                if touch.get("place") and not die["touches"]:
                    marks.append((touch["place"], f"die {die['name']} touches here first, after {millimetres(touch['distance'])}"))
        if marks:
            mark = np.array(marks[0][0], float)
            inwards = centre - mark
            through = mark + SHIFT * size * inwards / max(np.linalg.norm(inwards), SHIFT * size)
        path = next((die["velocity"] for die in self.dies if die["leads"]), [0, 0, -1])
        planes = sections.cuts(path, through)
        shown = [(cut, f"cut {where(cut)}", None) for cut in planes]
        if overlaps and overlaps[0][1]["distance"] < SMALL * size:
            shown.append((planes[0], "where the overlap is deepest", (np.array(marks[0][0]), max(3 * overlaps[0][1]["distance"], 0.01 * size))))
        self.to.heading("Cut through the deepest overlap" if overlaps else "Cut through the first touch" if marks else "Cut through the middle")
        self.to.picture("sections", sections.Picture(self.mesh, [(in_short(die), surface, die["velocity"]) for die, surface in
                                                                 zip(self.dies, self.surfaces)], self.planes, marks).draw(shown))
        self.to.note("The band beside the line of a die is the die's side of its surface: metal must not lie there.")

    def extents(self):
        points = np.concatenate([self.mesh.points] if self.mesh else [surface.points for surface in self.surfaces])
        return points.min(axis=0), points.max(axis=0)

    def gaps(self):
        if self.mesh is None or "gap [mm]" not in self.mesh.point_data or not self.dies:
            return
        self.to.heading("How far the billet is from the dies")
        surface = whole(self.mesh.surface(), self.planes)
        at_nodes = self.mesh.point_data["gap [mm]"][surface.node]
        size = np.linalg.norm(np.subtract(*self.extents()))
        fine, gap = refined(surface, at_nodes, np.ptp(at_nodes) / 20, size / 150)
        norm = colors.Normalize(0, max(gap.max(), 1e-3 * size))
        mapping = cm.ScalarMappable(norm, "viridis")
        rgba = mapping.to_rgba(gap)
        rgba[gap < -TOUCHING * size] = colors.to_rgba(INSIDE)
        figure = plt.figure(figsize=(11, 5), layout="constrained")
        for position, (title, view) in enumerate((("from above", FROM_ABOVE), ("from below", FROM_BELOW)), 1):
            axes = Scene(surface.points, self.use_vtk, view).draw(figure, (1, 2, position), fine, rgba, edges=surface)
            axes.set_title(title, fontsize=11)
        figure.colorbar(mapping, ax=figure.axes, label="distance from the nearest die [mm]", shrink=0.8)
        self.to.picture("gaps", figure)
        self.to.note("Red: inside a die." if self.overlaps() else "")

    def places(self):
        if not self.dies:
            return
        self.to.heading("Dies")
        rows = []
        for die in self.dies:
            touch = die.get("first_touch") or {}
            overlap = die.get("overlap")
            if overlap:
                inside = "a point of it inside the billet" if overlap["of_the_die"] else "inside the die"
                frees = f"; free when the die moves by {place(overlap['frees'])} mm" if any(overlap["frees"]) else ""
                stands = bad(f"{millimetres(overlap['distance'])} {inside}, at {place(overlap['place'])}{frees}")
            elif die["touches"]:
                area = f" on {number(die['contact_area'], 4)} mm²" if die.get("contact_area") else ""
                stands = f"touches{area}, at {place(die['gap']['place'])}"
            elif die["gap"]["distance"] is None:
                stands = "sees no part of the billet" if self.billet else "unknown"
            else:
                stands = f"{millimetres(die['gap']['distance'])} away, nearest to {place(die['gap']['place'])}"
            moves = f"{place(die['velocity'])} mm/s" + (", leads" if die["leads"] else "") if any(die["velocity"]) else "stands still"
            if any(die.get("travel", ())):
                moves += f"; by {place(die['travel'])} mm over the stroke"
            if die["touches"]:
                first = "at the start"
            elif not any(die["velocity"]) or overlap:
                first = "–"
            elif touch.get("distance") is None:
                first = "unknown" if not self.billet else "moves away from it" if die.get("moves_away") else "does not within the stroke"
            else:
                first = f"after {millimetres(touch['distance'])}, at stroke {millimetres(touch['stroke'])}, at {place(touch['place'])}"
            rows.append((die["name"], die["shape"], where_it_is(die), stands, moves, first, number(die["friction"]),
                         number(die.get("smallest_size"), 3)))
        self.to.table(("die", "shape", "where", "billet", "moves", "touches the billet first", "#friction", "#smallest edges wanted [mm]"), rows)

    def metal(self):
        if not self.billet:
            return
        billet = self.billet
        self.to.heading("Billet")
        low, high = billet["extents"]
        rows = [("shape", billet["shape"]), ("extents [mm]", ", ".join(f"{axis} {a:.6g} to {b:.6g}" for axis, a, b in zip("xyz", low, high))),
                ("nodes, tetrahedra", f"{number(billet['nodes'])}, {number(billet['cells'])}"),
                ("edges of the surface [mm]", f"{number(billet['shortest_edge'], 3)} to {number(billet['longest_edge'], 3)}, wanted {number(billet['element_size'], 3)}"),
                ("smallest angle between faces [degrees]", number(billet["smallest_angle"], 3))]
        copies, shape = billet["whole"]["copies"], billet.get("volume_of_shape")
        if copies is None:
            rows.append(("whole part", "the symmetry planes bound none"))
        elif copies != 1:
            rows.append(("whole part", f"{number(copies)} times the model, {number(copies * (shape or billet['volume']))} mm³"))
        rows.append(("volume of the mesh [mm³]", number(billet["volume"])))
        if shape is not None:
            percent = 100 * (1 - billet["volume"] / shape)
            lacking = f"; the mesh {'lacks' if percent > 0 else 'has more by'} {abs(percent):.2g} %" if abs(percent) >= 0.005 else ""
            rows.append(("volume of the shape [mm³]", number(shape) + lacking))
        rows += [(f"patch {patch['name']} [mm²]", number(patch["area"])) for patch in billet["patches"]]
        rows += [(f"symmetry plane {plane['name']}", f"through {place(plane['point'])}, outward normal {place(plane['normal'])}")
                 for plane in billet["symmetry_planes"]]
        self.to.table(("", ""), rows)

    def course(self):
        press, estimate = self.scene.get("press"), self.scene.get("estimate")
        if press:
            self.to.heading("Press")
            n = press["increments"]
            rows = [("stroke", f"{millimetres(press['stroke'])} of die {press['leading_die']}, in {number(press['seconds'], 4)} s")]
            if n:
                chosen = " (chosen by the program)" if press.get("increments_chosen") else ""
                rows.append(("increments", f"{n} of {millimetres(press['stroke'] / n)}, {number(press['seconds'] / n, 3)} s each{chosen}"))
            self.to.table(("", ""), rows)
        if estimate:
            self.to.heading("What to expect")
            self.to.table(("", "#"), [("speed at which the dies close [mm/s]", number(estimate["speed"], 4)),
                                      ("strain rate [1/s]", number(estimate["strain_rate"], 4)),
                                      ("flow stress [MPa]", number(estimate["stress"], 4)),
                                      *((f"force of the press {when}, whole part [{unit}]", number(force / factor, 3))
                                        for when, force in (("where the dies first press", estimate["first_force"]),
                                                            ("after the stroke", estimate["final_force"])) if force is not None
                                        for factor, unit in [readable("N", force)])])
            self.to.note(f"By the {estimate['name']}, without any forging: to a factor of two in open upsetting. Metal that a bore or a cavity holds together, "
                         "and flash, take three times as much and more.")


def middle(points):
    return (points.min(axis=0) + points.max(axis=0)) / 2


def where(cut):
    """In words."""
    axis = int(np.argmax(np.abs(cut.normal)))
    if abs(cut.normal[axis]) > 1 - 1e-9:
        return f"at {'xyz'[axis]} = {cut.point[axis]:.4g} mm"
    return f"normal to {place(cut.normal)}"


def in_short(die):
    """For the legend of a picture."""
    if die.get("overlap"):
        return f"die {die['name']}: {millimetres(die['overlap']['distance'])} inside"
    if die["touches"]:
        return f"die {die['name']}: touches"
    return f"die {die['name']}" + ("" if die["gap"]["distance"] is None else f": {millimetres(die['gap']['distance'])} away")


def where_it_is(die):
    if die["extents"] is None:
        return f"through {place(die['point'])}, facing {place(die['facing'])}"
    return ", ".join(f"{axis} {a:.5g} to {b:.5g}" for axis, a, b in zip("xyz", *die["extents"])) + f" mm, {number(die['facets'])} facets"


def joined(surfaces):
    """One surface of several."""
    offsets = np.cumsum([0, *(len(surface.points) for surface in surfaces[:-1])])
    return Surface(np.concatenate([s.points for s in surfaces]), np.concatenate([s.triangles + n for s, n in zip(surfaces, offsets)]),
                   np.concatenate([s.cell for s in surfaces]), np.concatenate([s.node for s in surfaces]))


def near(points, body):
    """Those within half the body's extent of the box around it, and the one that is next to it."""
    low, high = body.min(axis=0), body.max(axis=0)
    away = np.linalg.norm(np.maximum(np.maximum(low - points, points - high), 0), axis=1)
    return points[(away < 0.5 * np.linalg.norm(high - low)) | (away == away.min())]
