# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The page: sections of text, tables, and pictures embedded as base64."""
import base64
import html
import io

import matplotlib.pyplot as plt

from retroforge_report import curves, shapes

STYLE = """body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:70rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem;border-bottom:1px solid #ddd}img{max-width:100%}
table{border-collapse:collapse;margin:.6rem 0}td,th{padding:.15rem .8rem;border-bottom:1px solid #e6e6e6;text-align:left}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}p.note{color:#666}.bad{color:#b03000;font-weight:bold}
code{font-size:.9em}"""


class Page:
    def __init__(self, run, use_vtk, notes):
        self.run, self.use_vtk, self.body = run, use_vtk, []
        self.pictures = run.directory / "pictures"
        self.pictures.mkdir(exist_ok=True)
        for old in self.pictures.glob("*.png"):
            old.unlink()
        for note in notes:
            self.note(note)

    def write(self):
        """Returns the path of the page."""
        for section in (self.results, self.shape, self.force, self.gradients, self.sensitivities, self.check,
                        self.conduct):
            section()
        title = f"{self.run.directory.resolve().name}: retroforge {self.run.summary.get('command', '')}"
        path = self.run.directory / "report.html"
        path.write_text(f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
                        f"<style>{STYLE}</style><h1>{html.escape(title)}</h1>\n" + "\n".join(self.body) + "</html>\n",
                        encoding="utf-8")
        return path

    # --- sections -------------------------------------------------------------------------------

    def results(self):
        self.heading("Results")
        rows = []
        for objective in self.run.objectives:
            parts = ", ".join(f"{name} {number(value)}" for name, value in objective.get("parts", {}).items())
            rows.append((objective["name"], number(objective["value"]), objective.get("unit", ""), parts))
        self.table(("objective", "#value", "unit", "of which"), rows)

    def shape(self):
        if self.run.initial is None:
            return
        self.heading("Shape")
        self.picture("shapes", shapes.forging(self.run, self.use_vtk))

    def force(self):
        if self.run.history is None:
            return
        self.heading("Force and energy")
        self.picture("force", curves.forging(self.run.history, self.run.unit("energy")))

    def gradients(self):
        if not any(p.get("gradient") for p in self.run.parameters):
            return
        self.heading("Gradient with respect to the parameters")
        figure = curves.gradients(self.run.objectives, self.run.parameters)
        if figure:
            self.picture("gradients", figure)
            self.note("Bars are relative, so that parameters of different units compare; a parameter at zero has no "
                      f"bar; at most {curves.MOST_BARS} are drawn. The table has the derivatives themselves.")
        names = [o["name"] for o in self.run.objectives]
        columns = [f"#d {name} / d parameter" for name in names]
        rows = [(p["name"], number(p["value"]), p.get("unit", ""), *(number(p["gradient"].get(n)) for n in names))
                for p in self.run.parameters if p.get("gradient")]
        self.table(("parameter", "#value", "unit", *columns), rows)

    def sensitivities(self):
        if self.run.sensitivity is None:
            return
        self.heading("Gradient with respect to the shape of the billet")
        for name, values in self.run.sensitivity.point_data.items():
            if name.startswith("d") and name.endswith("_dX0") and values.ndim == 2:
                objective = name[1:-len("_dX0")]
                self.picture(f"sensitivity_{objective}", shapes.sensitivity(
                    self.run.sensitivity, objective, self.run.unit(objective), self.use_vtk))
        self.note("Nodal derivatives divided by the area around the node: a property of the surface, not of the mesh. "
                  "The strongest 2 % (edges, corners) exceed the scale.")

    def check(self):
        if not self.run.checks:
            return
        self.heading("Check of the gradient")
        self.picture("check", curves.check(self.run.checks))
        self.note("Replayed: increments, contact and meshes as recorded, so the difference must converge to the "
                  "adjoint. Free: all decided anew; what remains is the size of the jumps.")
        rows = [(entry["objective"], entry["parameter"], number(entry["adjoint"], 10), number(entry.get("tangent"), 10),
                 ", ".join(number(order, 3) for order in entry.get("taylor_orders", [])), verdict(entry.get("verdict")))
                for entry in self.run.checks]
        self.table(("objective", "parameter", "#adjoint", "#tangent", "Taylor orders", "verdict"), rows)

    def conduct(self):
        self.heading("How the run went")
        summary, history = self.run.summary, self.run.history
        if history is not None and len(history["increment"]) > 1:
            self.picture("conduct", curves.health(history, summary.get("volume_initial")))
        rows = [(key.replace("_", " "), number(summary[key])) for key in
                ("increments", "cuts", "newton_iterations", "krylov_iterations", "linear_solves_forward",
                 "linear_solves_adjoint", "volume_initial", "volume_final", "record_bytes") if key in summary]
        before, after = summary.get("volume_initial"), summary.get("volume_final")
        if before and after is not None:
            rows.append(("relative change of volume", f"{after / before - 1:.2e}"))
        rows += [(key, number(value)) for key, value in summary.get("mesh", {}).items()]
        self.table(("", "#"), rows)
        seconds = summary.get("wall_seconds", {})
        seconds = {key: value for key, value in seconds.items() if value is not None}
        total = seconds.get("total") or sum(seconds.values()) or 1.0
        self.table(("wall time", "#seconds", "#share"),
                   [(key, f"{value:.2f}", f"{100 * value / total:.0f} %") for key, value in seconds.items()])
        self.note(", ".join(f"{key} {summary[key]}" for key in ("version", "commit", "ranks", "blas")
                            if summary.get(key) not in (None, "")))

    # --- parts ----------------------------------------------------------------------------------

    def heading(self, text):
        self.body.append(f"<h2>{html.escape(text)}</h2>")

    def note(self, text):
        if text:
            self.body.append(f'<p class="note">{html.escape(text)}</p>')

    def picture(self, name, figure):
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png")
        plt.close(figure)
        (self.pictures / f"{name}.png").write_bytes(buffer.getvalue())
        encoded = base64.b64encode(buffer.getvalue()).decode()
        self.body.append(f'<img alt="{html.escape(name)}" src="data:image/png;base64,{encoded}">')

    def table(self, header, rows):
        """A heading that starts with # is a column of numbers."""
        if not rows:
            return
        numeric = [title.startswith("#") for title in header]

        def line(tag, cells):
            return "<tr>" + "".join(f'<{tag} class="n">{c}</{tag}>' if n else f"<{tag}>{c}</{tag}>"
                                    for c, n in zip(cells, numeric)) + "</tr>"
        lines = [line("th", [html.escape(title.lstrip("#")) for title in header])] if any(
            title.strip("#") for title in header) else []
        lines += [line("td", [cell if isinstance(cell, Markup) else html.escape(str(cell)) for cell in row])
                  for row in rows]
        self.body.append("<table>" + "\n".join(lines) + "</table>")


class Markup(str):
    """Text that is HTML already."""


def verdict(text):
    return text if text in ("passed", "zero") else Markup(f'<span class="bad">{html.escape(str(text))}</span>')


def number(value, digits=6):
    if value is None:
        return "–"
    return f"{value:,}".replace(",", "\u2009") if isinstance(value, int) else f"{value:.{digits}g}"
