# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The page of an optimisation: what was gained, along which designs, within which bounds and limits; shapes before and after."""
import csv
import json
import pathlib

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from retroforge_report.curves import BLUE, GREEN, INK, ORANGE
from retroforge_report.document import Document, number
from retroforge_report.units import bracketed, pretty

SCHEMA = 1
COLORS = {"start": INK, "noise": "#999999", "accepted": BLUE, "refused": ORANGE, "failed": "#b00020", "new mesh": GREEN}
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])


class OptimisationPage:
    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        path = self.directory / "optimisation.json"
        self.found = json.loads(path.read_text(encoding="utf-8"))
        if self.found.get("schema") != SCHEMA:
            raise ValueError(f"{path}: schema is {self.found.get('schema')}; this report reads {SCHEMA}; optimize again")
        with (self.directory / "optimisation.csv").open(newline="", encoding="utf-8") as file:
            self.rows = list(csv.DictReader(file))
        self.to = Document(self.directory)

    def write(self):
        """Returns the path of the page."""
        self.infeasible()
        self.gain()
        self.parameters()
        self.limits()
        self.identification()
        self.path()
        self.shapes()
        self.failures()
        self.to.note(", ".join(f"{key} {self.found[key]}" for key in ("version", "commit") if self.found.get(key)))
        return self.to.save(f"{self.directory.resolve().name}: retroforge optimize")

    def infeasible(self):
        """Before anything else: limits that no design keeps."""
        missed = [limit for limit in self.found["limits"] if limit.get("missed_by")]
        if self.found["finished"] and missed:
            self.to.heading("NOT FEASIBLE")
            self.to.note("No design that was forged keeps all limits; this one comes closest: "
                         + "; ".join(f"{limit['objective']} {number(limit['best'])}{self.correction(limit)}, {limit['kind']} {number(limit['bound'])}: "
                                     f"{number(limit['missed_by'])} too {'little' if limit['kind'] == 'at least' else 'much'}"
                                     for limit in missed) + ".")

    @staticmethod
    def correction(limit):
        return f" {limit['correction']:+.4g} for the finer mesh" if limit.get("correction") else ""

    def gain(self):
        objective, confirmed = self.found["objective"], self.found.get("confirmation")
        self.to.heading(f"{objective['name']}, start and best")
        rows = [("on the mesh of the optimisation", *self.pair(objective), number(objective["noise"]))]
        if confirmed:
            rows.append((f"confirmed: {confirmed['nodes']} nodes, {confirmed['increments']} increments", *self.pair(confirmed), ""))
        self.to.table(("", f"#start {pretty(objective['unit'])}", "#best", "#change", "#noise"), rows)
        if objective.get("counted_as"):
            self.to.note(f"All values are {objective['counted_as']}.")
        self.to.note(f"Ended because {self.found['stop']}. {self.found['simulations']} forgings, {self.found['sweeps']} swept back, "
                     f"{self.found['failed']} failed." + self.meshes() + ("" if self.found["finished"] else " The search is not finished."))

    def meshes(self):
        made = self.found.get("new_meshes")
        if not made:
            return ""
        change = sum(mesh["objective"] - mesh["objective_before"] for mesh in made)
        return (f" The billet's mesh was made anew, {len(made)} time(s), so start and best were forged on meshes of their own; at the "
                f"changes from one to the next the objective changed by {number(change)} in all.")

    @staticmethod
    def pair(values):
        start, best = values["start"], values["best"]
        change = "" if not start or best is None else f"{100 * (best / start - 1):+.3g} %"
        return *("failed" if value is None else number(value) for value in (start, best)), change

    def parameters(self):
        self.to.heading("Design")
        shown = list(self.found["parameters"])
        if "follows" in self.found:
            shown.append({**self.found["follows"], "gradient": None, "at": "follows from the volume"})
        self.to.table(("parameter", "unit", "#start", "#best", "#lower bound", "#upper bound", "#gradient there", ""),
                      [(p["name"], pretty(p["unit"]), *("" if p[key] is None else number(p[key])
                                                       for key in ("start", "best", "lower", "upper", "gradient")), p["at"])
                       for p in shown])

    def limits(self):
        confirmed = self.found.get("confirmation", {}).get("values") or {}
        if self.found["limits"]:
            self.to.heading("Limits")
            self.to.table(("objective", "", "#bound", "#start", "#best", "#confirmed", "#noise", "#objective by relaxing it by 1"),
                          [(limit["objective"], limit["kind"],
                            *("" if value is None else number(value) for value in
                              (limit["bound"], limit["start"], limit["best"], confirmed.get(limit["objective"]), limit.get("noise"), limit["by_relaxing"])))
                           for limit in self.found["limits"]])
        if not self.found.get("confirmation", {}).get("limits_kept", True):
            self.to.note(f"Limits are not kept on the finer mesh. The search did not go on for that: {self.found['confirmation']['not_corrected']}.")
        corrected = [limit for limit in self.found["limits"] if limit.get("correction")]
        if corrected:
            self.to.note("Limits that the finer mesh missed count what it added to the value: "
                         + "; ".join(f"{limit['objective']} {limit['correction']:+.4g}" for limit in corrected) + ".")
        for objective, details in self.found.get("details", {}).items():
            self.to.note("; ".join(f"{what} of {objective} at the best design: {number(value)}" for what, value in details.items()) + ".")

    def identification(self):
        found = self.found.get("identification")
        if not found:
            return
        self.to.heading("Data")
        self.to.table(("objective", "unit", "#measured", "#standard deviation", "#best"),
                      [(d["objective"], pretty(d["unit"]), *(number(d[key]) for key in ("measured", "deviation", "best")))
                       for d in found["data"]])
        best = {p["name"]: p["best"] for p in self.found["parameters"]}
        if found["converged"]:
            self.to.table(("parameter", "#found", "#95 %"), [(name, number(best[name]), f"± {number(1.96 * deviation)}")
                                                            for name, deviation in zip(found["parameters"], found["deviations"])])
        self.to.note(f"Sum of squares in deviations {number(found['misfit'])}" +
                     (f", about {found['freedom']} where model and deviations are right." if found["freedom"] > 0 else ".") +
                     ("" if found["converged"] else " No intervals: the search has not come to an end by itself.") +
                     (" Data and model do not agree within the deviations: intervals are not to be trusted." if found["disagrees"] else "") +
                     (" The data do not see all changes of the parameters." if found["unseen"] else ""))

    def path(self):
        objective = self.found["objective"]
        names = [f"{p['name']} [{p['unit']}]" for p in self.found["parameters"] if p["at"] != "not varied"]
        scales = [p["scale"] for p in self.found["parameters"] if p["at"] != "not varied"]
        tried = [row for row in self.rows if row["decision"] != "noise"]
        figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8), layout="constrained")
        # A sum of objectives has no column of its own.
        column = f"{objective['name']} [{objective['unit']}]"
        column = column if column in tried[0] else "merit"
        for decision, color in COLORS.items():
            points = [(i, float(row[column])) for i, row in enumerate(tried) if row["decision"] == decision and row[column]]
            if points:
                left.plot(*zip(*points), "o", color=color, markersize=5, label=decision)
        values = [float(row[column]) for row in tried if row[column]]
        if min(values) > 0 and max(values) > 20 * min(values):
            left.set_yscale("log")
        left.set_xlabel("design")
        left.set_ylabel("merit: gain in scaled units" if column == "merit" else bracketed(objective["name"], objective["unit"]))
        left.legend(fontsize=9)
        taken = [(i, row) for i, row in enumerate(tried) if row["decision"] in ("start", "accepted", "new mesh")]
        for name, scale in zip(names[:12], scales):
            start = float(tried[0][name])
            right.plot([i for i, _ in taken], [(float(row[name]) - start) / scale for _, row in taken], "-o", markersize=3,
                       label=bracketed(*name.rstrip("]").rsplit(" [", 1)))
        right.set_xlabel("design")
        right.set_ylabel("change, in scales")
        right.legend(fontsize=8)
        self.to.picture("optimisation", figure)

    def shapes(self):
        files = {(name, kind): self.directory / "designs" / f"{name}_{kind}.stl" for name in ("start", "best")
                 for kind in ("billet", "forged")}
        if not all(file.is_file() for file in files.values()):
            return
        self.to.heading("Shapes")
        figure = plt.figure(figsize=(11, 5.5), layout="constrained")
        corners = {key: read_stl(file) for key, file in files.items()}
        everything = np.concatenate([c.reshape(-1, 3) for c in corners.values()])
        low, high = everything.min(axis=0), everything.max(axis=0)
        for i, ((name, kind), triangles) in enumerate(corners.items()):
            panel = figure.add_subplot(1, 4, 1 + i, projection="3d")
            panel.add_collection3d(Poly3DCollection(triangles, facecolor="#c8d4e3", edgecolor=INK, linewidth=0.15))
            panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]), title=f"{name}: {kind}")
            panel.set_box_aspect(high - low)
            panel.set_axis_off()
        self.to.picture("shapes", figure)

    def failures(self):
        failed = [(str(i), row["failure"]) for i, row in enumerate(self.rows) if row["failure"]]
        if failed:
            self.to.heading("Designs that failed")
            self.to.table(("#design", "reason"), failed)


def read_stl(file):
    """Corners of the facets of a binary file, (n, 3, 3) [mm]."""
    return np.frombuffer(file.read_bytes(), FACET, offset=84)["corners"]
