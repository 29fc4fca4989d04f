# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The page of the tutorial's scenes: of each its picture, key numbers and cost."""
import html
import json
import os
import shutil

from retroforge_report import shapes
from retroforge_report.data import Run
from retroforge_report.document import Document, Markup, bad, number
from retroforge_report.effects import effects
from retroforge_report.units import pretty

DPI = 76  # a picture is looked at beside a README


def write(scenes, output, use_vtk, notes, renew_pictures):
    """Returns the path of the page. `scenes` have a folder, name, results and state()."""
    page = Document(output, "index.html")
    for note in notes:
        page.note(note)
    for scene in scenes:
        title, text = _introduction(scene.folder / "README.md")
        page.heading(title)
        page.note(text)
        _scene(page, scene, use_vtk)
        readme = os.path.relpath(scene.folder / "README.md", output)
        page.note(Markup(f'<a href="{html.escape(readme)}">{html.escape(scene.name)}: how it is made, what to look at</a>'))
        if renew_pictures and (page.pictures / f"{scene.name}.png").is_file():
            shutil.copy(page.pictures / f"{scene.name}.png", scene.folder / "picture.png")
    return page.save("Scenes of the tutorial")


def _introduction(readme):
    """Title and first paragraph of a README, as text."""
    title, paragraph = readme.read_text(encoding="utf-8").split("\n\n")[:2]
    return title.lstrip("# ").strip(), " ".join(paragraph.split()).replace("`", "")


def _scene(page, scene, use_vtk):
    run = Run(scene.results)
    if run.failure or not run.finished:
        page.note(bad(run.failure or "The run was stopped: contrib/gallery goes on with it."))
        return
    shows = json.loads((scene.folder / "scene.json").read_text(encoding="utf-8"))["picture"]
    page.picture(scene.name, shapes.overview(run, shows, use_vtk), DPI)
    page.tables([("results", *_results(run)), ("what matters most", *_gradients(run)), ("the run", *_cost(run, scene.state()))])


def _results(run):
    rows = [(o["name"], number(o["value"]), number(o.get("whole")), pretty(o.get("unit"))) for o in run.objectives]
    return ("objective", "#value", "#whole part", "unit"), rows


def _gradients(run):
    """Of each objective the parameter that one per cent of changes it most."""
    rows = []
    for objective in run.objectives:
        ranked = effects(objective, run.parameters)
        if ranked and ranked[0].for_one_percent is not None:
            rows.append((objective["name"], ranked[0].parameter["name"], number(ranked[0].for_one_percent, 3, sign="+"),
                         pretty(objective.get("unit"))))
    return ("objective", "parameter", "#for +1 %", "unit"), rows


def _cost(run, state):
    summary = run.summary
    seconds = number(round(state["seconds"]))
    return ("", "#"), [
        ("nodes at the start", number(summary["mesh"]["nodes"])),
        ("increments", number(summary["increments"])),
        ("remeshings", number(summary["remeshings"])),
        ("deepest point in a die [mm]", number(summary.get("deepest", {}).get("depth", 0.0), 2)),
        ("change of volume", f"{summary['volume_final'] / summary['volume_initial'] - 1:.1e}"),
        ("seconds of one core" + (", resumed" if state["resumed"] else ""), seconds)]
