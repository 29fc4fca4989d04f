# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The sections of the page. With many objectives, the first few have pictures and all have numbers."""
from retroforge_report import curves, shapes
from retroforge_report.data import identifier
from retroforge_report.document import Document, bad, number
from retroforge_report.effects import effects
from retroforge_report.units import bracketed, pretty

MOST_PICTURED = 4  # objectives
SOUND = ("passed", "zero")  # verdicts of a derivative


def known(value):
    return number(None if value != value else value)


class Page:
    def __init__(self, run, use_vtk, notes):
        self.run, self.use_vtk, self.to = run, use_vtk, Document(run.directory)
        for note in notes:
            self.to.note(note)

    def write(self):
        """Returns the path of the page."""
        for section in (self.failure, self.results, self.shape, self.force, self.objectives, self.gradients, self.sensitivities,
                        self.dies, self.check, self.conduct):
            section()
        return self.to.save(f"{self.run.directory.resolve().name}: retroforge {self.run.summary.get('command', '')}")

    def failure(self):
        """What a reader must know first of a run that did not come to its end."""
        if self.run.failure:
            self.to.heading("The run failed")
            self.to.note(bad(self.run.failure))
        elif not self.run.finished:
            self.to.heading("The run was stopped, or goes on still")
            self.to.note("The same command with --resume goes on from its last increment.")
        for warning in self.run.summary.get("warnings", []):
            self.to.note(bad(f"Warning: {warning}"))
        if self.run.summary.get("check_remaining"):
            self.to.note(bad(f"{self.run.summary['check_remaining']} directions are not checked."))

    def results(self):
        if not self.run.finished:
            self.results_so_far()
            return
        self.to.heading("Results")
        rows = []
        for objective in self.run.objectives:
            beside = [", ".join(f"{name} {number(value)}" for name, value in objective.get(key, {}).items())
                      for key in ("parts", "details")]
            rows.append((objective["name"], number(objective["value"]), number(objective.get("whole")),
                         pretty(objective.get("unit")), *beside))
        header = ("objective", "#value", "#whole part", "unit", "of which", "beside it")
        filled = [j for j in range(len(header)) if j < 2 or any(row[j] not in ("", "–") for row in rows)]
        shown = [j for j in filled if self.run.copies != 1 or header[j] != "#whole part"]
        self.to.table([header[j] for j in shown], [[row[j] for j in shown] for row in rows])
        for objective in self.run.objectives:
            if objective.get("note"):
                self.to.note(f"Of {objective['name']}: {objective['note']}.")
        if self.run.copies is None:
            self.to.note("Forces, energies and volumes are of the model, whose symmetry planes bound no whole part.")
        elif self.run.copies != 1:
            self.to.note(f"The model is 1/{number(self.run.copies)} of the part: values are of the model, except where "
                         "the whole part is named.")

    def results_so_far(self):
        columns = [c for c in self.run.objective_columns if not c.of and len(c.values)]
        if columns:
            self.to.heading(f"Results until stroke {number(self.run.objective_strokes[-1])} mm, of the model")
            self.to.table(("objective", "#value", "unit"), [(c.name, known(c.values[-1]), pretty(c.unit)) for c in columns])

    def shape(self):
        if self.run.initial is None:
            return
        self.to.heading("Shape")
        self.to.picture("shapes", shapes.forging(self.run, self.use_vtk))
        if len(self.run.final.workpiece.symmetry_planes):
            self.to.note("Mirrored by the symmetry planes to the whole part, where they bound one, and cut open along them for "
                         "what is inside. Fields are those of the last equilibrium solved, those of cells as means over the cells around "
                         "each node; the contact pressure is evened out over the faces around each node. fields.pvd has them as "
                         "computed, and more of them.")

    def force(self):
        if self.run.history is None:
            return
        self.to.heading("Force and energy")
        self.to.picture("force", curves.forging(self.run.history, self.run.unit("energy")))
        self.to.note("The force of the leading die along its path, in the last equilibrium solved of each increment: its "
                     "middle with the midpoint scheme, its beginning with Euler's.")

    def objectives(self):
        figure = curves.objectives(self.run.objective_strokes, self.run.objective_columns)
        if figure is None:
            return
        self.to.heading("Objectives over the stroke")
        self.to.picture("objectives", figure)
        self.to.note("Each as if the forging had ended there. " + self.without_values())

    def without_values(self):
        """A sentence, or nothing."""
        names = [c.name for c in self.run.objective_columns if not c.of and (c.values != c.values).all()]
        return f"Without values: {', '.join(names)}." if names else ""

    def gradients(self):
        ranked = [(o, effects(o, self.run.parameters)) for o in self.run.objectives]
        ranked = [(objective, rows) for objective, rows in ranked if rows]
        if not ranked:
            return
        self.to.heading("Gradient with respect to the parameters")
        draw = curves.gradients if len(ranked) <= MOST_PICTURED else curves.gradient_matrix
        figure = draw(self.run.objectives, self.run.parameters)
        if figure:
            self.to.picture("gradients", figure)
            self.to.note("Relative numbers, so that parameters and objectives of different units compare; a parameter "
                         f"or an objective at zero has none; at most {curves.MOST_BARS} parameters are drawn.")
        self.to.tables([(objective["name"], *self.ranking(objective, rows)) for objective, rows in ranked])
        self.to.note("Derivatives in the objective's unit per unit of the parameter. For +1 %: what one per cent of the "
                     "parameter's size adds to the objective, to first order; the largest comes first.")

    @staticmethod
    def ranking(objective, rows):
        """Header and rows of a table."""
        header = ("parameter", "#value", "unit", "#derivative", "#" + bracketed("for +1 %", objective.get("unit")), "how far it holds")
        cells = [(e.parameter["name"], number(e.parameter["value"]), pretty(e.parameter.get("unit")),
                  number(e.derivative), number(e.for_one_percent, 4, sign="+"),
                  e.parameter.get("trust", {}).get(objective["name"], "–")) for e in rows]
        shown = len(header) if any(row[-1] != "–" for row in cells) else len(header) - 1
        return header[:shown], [row[:shown] for row in cells]

    def sensitivities(self):
        if self.run.sensitivity is None:
            return
        self.to.heading("Gradient with respect to the shape of the billet")
        self.surfaces("sensitivity", self.run.sensitivity, "X0", shapes.billet_sensitivity, "sensitivity.vtu")
        self.to.note("Nodal derivatives divided by the area around the node: a property of the surface, not of the "
                     "mesh. The strongest 2 % (edges, corners) exceed the scale.")

    def dies(self):
        for die, mesh in self.run.die_sensitivities.items():
            self.to.heading(f"Gradient with respect to the shape of die {die}")
            self.surfaces(f"sensitivity_die_{identifier(die)}", mesh, "Xdie", shapes.die_sensitivity,
                          f"sensitivity_die_{die}.vtu")
        if self.run.die_sensitivities:
            self.to.note("Derivatives by the vertices of the die's surface where the forging begins, divided by the "
                         "area around them; seen from the workpiece, around the part that matters.")

    def surfaces(self, picture, mesh, variable, draw, file):
        """Pictures for the first objectives, and a note on the others."""
        sensitivities = self.run.sensitivities(mesh, variable)
        for objective, field in sensitivities[:MOST_PICTURED]:
            figure = draw(mesh, field, objective, self.use_vtk)
            if figure:
                self.to.picture(f"{picture}_{identifier(objective['name'])}", figure)
            else:
                self.to.note(f"{objective['name']} does not depend on it.")
        if len(sensitivities) > MOST_PICTURED:
            self.to.note(f"Drawn for the first {MOST_PICTURED} of {len(sensitivities)} objectives; {file} has all of "
                         "them, for ParaView.")

    def check(self):
        if not self.run.checks:
            return
        self.to.heading("Check of the gradient")
        groups = {}
        for entry in self.run.checks:
            groups.setdefault(entry["objective"], []).append(entry)
        self.v_curves(groups)
        rows = []
        for objective, entries in groups.items():
            failed = sum(entry.get("verdict") not in SOUND for entry in entries)
            count = f"{objective}: {len(entries) - failed} of {len(entries)} passed"
            rows += [bad(count) if failed else count, *(self.judged(entry) for entry in entries)]
        self.to.table(("parameter", "#adjoint", "#tangent", "Taylor orders", "verdict"), rows)

    def v_curves(self, groups):
        """Of the first objectives, and of what did not pass."""
        for rank, (objective, entries) in enumerate(groups.items()):
            shown = entries if rank < MOST_PICTURED else [e for e in entries if e.get("verdict") not in SOUND]
            if shown:
                self.to.heading(objective, level=3)
                self.to.picture(f"check_{identifier(objective)}", curves.check(shown))
        if len(groups) > MOST_PICTURED:
            self.to.note(f"Drawn for the first {MOST_PICTURED} of {len(groups)} objectives, and for every derivative "
                         "that did not pass.")
        self.to.note("Replayed: increments, contact and meshes as recorded, so the difference must converge to the "
                     "adjoint. Free: all decided anew; what remains is the size of the jumps.")

    @staticmethod
    def judged(entry):
        """A row of the table."""
        verdict = entry.get("verdict")
        shown = verdict if verdict in SOUND else bad(verdict)
        if entry.get("free", {}).get("doubtful"):
            shown = bad(f"{verdict}, doubtful: decided anew, the slope is {number(entry['free']['slope'], 3)}; scan tells which holds")
        return (entry["parameter"], number(entry["adjoint"], 10), number(entry.get("tangent"), 10),
                ", ".join(number(order, 3) for order in entry.get("taylor_orders", [])),
                shown)

    def conduct(self):
        self.to.heading("How the run went")
        summary, history = self.run.summary, self.run.history
        if history is not None and len(history["increment"]) > 1:
            self.to.picture("conduct", curves.health(history, summary.get("volume_initial")))
        rows = [(key.replace("_", " "), number(summary[key])) for key in
                ("increments", "cuts", "newton_iterations", "krylov_iterations", "linear_solves_forward",
                 "linear_solves_adjoint", "volume_of_shape", "volume_initial", "volume_final", "record_bytes") if key in summary]
        before, after = summary.get("volume_initial"), summary.get("volume_final")
        if before and after is not None:
            rows.append(("relative change of volume", f"{after / before - 1:.2e}"))
        rows += [(key, number(value)) for key, value in summary.get("mesh", {}).items()]
        self.to.table(("", "#"), rows)
        seconds = summary.get("wall_seconds", {})
        seconds = {key: value for key, value in seconds.items() if value is not None}
        total = seconds.get("total") or sum(seconds.values()) or 1.0
        self.to.table(("wall time", "#seconds", "#share"),
                   [(key, f"{value:.2f}", f"{100 * value / total:.0f} %") for key, value in seconds.items()])
        self.to.note(", ".join(f"{key} {summary[key]}" for key in ("version", "commit", "ranks", "blas")
                            if summary.get(key) not in (None, "")))
