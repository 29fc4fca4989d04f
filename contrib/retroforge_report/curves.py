# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Pictures of what depends on stroke, on a parameter, or on the step of a difference."""
import math

import matplotlib
import matplotlib.colors

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (after the choice of the backend)
import numpy as np  # noqa: E402

from retroforge_report.effects import relative_gradient  # noqa: E402
from retroforge_report.units import bracketed, pretty, readable  # noqa: E402

INK, BLUE, ORANGE, GREEN, PURPLE = "#333333", "#0072b2", "#d55e00", "#009e73", "#8e5aa8"  # colour-blind safe
MOST_BARS = 30
PANELS_PER_ROW = 3
ROUNDING = 1e-12  # relative derivatives below this are printed as zero

plt.rcParams.update({
    "font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": INK,
    "axes.grid": True, "grid.color": "#e3e3e3", "axes.axisbelow": True, "lines.linewidth": 2,
    "figure.dpi": 130, "legend.frameon": False})


def forging(history, energy_unit):
    """Force and energy over the stroke: of the model, and where symmetry cut it, of the whole part on a second scale."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8), layout="constrained")
    for axes, name, label, unit, color in ((left, "force", "press force", "N", BLUE),
                                           (right, "energy", "energy", energy_unit or "mJ", ORANGE)):
        factor, readable_unit = readable(unit, np.nanmax(np.abs(history[name])))
        _over_stroke(axes, history, history[name] / factor, bracketed(label, readable_unit), color)
        _add_whole(axes, history, name, label, unit, factor)
        axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
        axes.ticklabel_format(axis="y", style="sci", scilimits=(-2, 4), useMathText=True)
    return figure


def _add_whole(axes, history, name, label, unit, model_factor):
    whole, model = history.get(f"whole_{name}"), history[name]
    if whole is None or not np.all(np.isfinite(whole)) or np.array_equal(whole, model):
        return
    factor, readable_unit = readable(unit, np.abs(whole).max())
    ratio = whole[-1] / model[-1] * model_factor / factor
    axes.set_ylabel(axes.get_ylabel() + " of the model")
    second = axes.secondary_yaxis("right", functions=(lambda y: ratio * y, lambda y: y / ratio))
    second.set_ylabel(bracketed(label, readable_unit) + " of the whole part")
    second.ticklabel_format(axis="y", style="sci", scilimits=(-2, 4), useMathText=True)


def health(history, volume_initial):
    """What the forger did not ask for but must know: volume lost, element quality, iterations."""
    figure, panels = plt.subplots(1, 4 if "depth" in history else 3, figsize=(13, 3.2), layout="constrained")
    left, middle, right = panels[:3]
    change = history["volume"] / (volume_initial or history["volume"][0]) - 1
    _over_stroke(left, history, change, "relative change of volume", GREEN)
    left.ticklabel_format(axis="y", style="sci", scilimits=(-2, 3), useMathText=True)
    _over_stroke(middle, history, history["min_quality"], "worst element quality", PURPLE)
    middle.set_ylim(bottom=0)
    right.plot(history["increment"], history["newton"], ".-", color=BLUE, label="Newton steps")
    right.plot(history["increment"], history["krylov"], ".-", color=ORANGE, label="Krylov steps")
    right.set(xlabel="increment", ylabel="per increment", yscale="log")
    right.legend()
    if "depth" in history:
        _over_stroke(panels[3], history, history["depth"], "deepest point in a die [mm]", ORANGE)
        panels[3].set_ylim(bottom=0)
    return figure


def _over_stroke(axes, history, values, label, color):
    axes.plot(history["stroke"], values, ".-", color=color)
    axes.set(xlabel="stroke [mm]", ylabel=label)


def objectives(strokes, columns):
    """A panel for each objective that was known before the end, with its parts; None when there is none."""
    shown = [c for c in columns if not c.of and np.isfinite(c.values).any()]
    if not shown:
        return None
    figure, panels = _grid(len(shown), height=2.6)
    for axes, column in zip(panels, shown):
        parts = [c for c in columns if c.of == column.name and np.isfinite(c.values).any()]
        factor, unit = readable(column.unit, np.nanmax(np.abs(column.values)))
        for part, color in zip(parts, (ORANGE, GREEN, PURPLE)):
            axes.plot(strokes, part.values / factor, ".-", color=color, linewidth=1.2, markersize=4, label=part.name)
        axes.plot(strokes, column.values / factor, ".-", color=BLUE)
        axes.set(xlabel="stroke [mm]", ylabel=pretty(unit))
        axes.set_title(column.name, fontsize=11)
        axes.set_xlim(0, 1.02 * strokes.max())
        axes.ticklabel_format(axis="y", style="sci", scilimits=(-2, 4), useMathText=True)
        if parts:
            axes.margins(y=0.3)
            axes.legend(fontsize=8)
    return figure


def _grid(n_panels, height, sharey=False):
    """A figure of rows of panels, those that are not used removed."""
    columns = min(PANELS_PER_ROW, n_panels)
    rows = -(-n_panels // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(3.7 * columns, height * rows), squeeze=False, sharey=sharey,
                                layout="constrained")
    for panel in axes.flat[n_panels:]:
        panel.remove()
    return figure, list(axes.flat[:n_panels])


def gradients(objectives, parameters):
    """A panel of bars per objective, or None when nothing was differentiated."""
    panels = [(o["name"], relative_gradient(o, parameters)) for o in objectives]
    panels = [(name, rows[:MOST_BARS]) for name, rows in panels if rows]
    if not panels:
        return None
    heights = [len(rows) + 2 for _, rows in panels]
    figure, axes = plt.subplots(len(panels), 1, figsize=(9, 0.34 * sum(heights) + 0.6), squeeze=False,
                                layout="constrained", gridspec_kw={"height_ratios": heights})
    for panel, (name, rows) in zip(axes[:, 0], panels):
        _bars(panel, name, rows[::-1])
    return figure


def gradient_matrix(objectives, parameters):
    """The same numbers for many objectives: a field for each parameter and objective; or None."""
    columns = {o["name"]: dict(relative_gradient(o, parameters)) for o in objectives}
    columns = {name: column for name, column in columns.items() if column}
    rows = [p["name"] for p in parameters if any(p["name"] in column for column in columns.values())]
    rows = rows[:MOST_BARS]
    if not rows:
        return None
    values = np.array([[column.get(row, np.nan) for column in columns.values()] for row in rows])
    figure, axes = plt.subplots(figsize=(2.4 + 0.86 * len(columns), 1.6 + 0.36 * len(rows)), layout="constrained")
    image = axes.imshow(values, cmap="PuOr_r", aspect="auto",
                        norm=matplotlib.colors.SymLogNorm(0.03, vmin=-3, vmax=3))
    for i, j in np.argwhere(np.isfinite(values)):
        text = f"{values[i, j]:+.2g}" if abs(values[i, j]) > ROUNDING else "0"
        dark = np.mean(image.to_rgba(values[i, j])[:3]) < 0.5
        axes.text(j, i, text, ha="center", va="center", fontsize=9, color="white" if dark else INK)
    axes.set_xticks(range(len(columns)), columns, rotation=35, ha="left", rotation_mode="anchor")
    axes.set_yticks(range(len(rows)), rows)
    axes.tick_params(top=True, bottom=False, labeltop=True, labelbottom=False, length=0)
    axes.grid(False)
    axes.spines[:].set_visible(False)
    figure.colorbar(image, label="% per % of the parameter", ticks=[-1, -0.1, 0, 0.1, 1], format="%g", shrink=0.9)
    return figure


def _bars(axes, name, rows):
    values = np.array([value for _, value in rows])
    bars = axes.barh([parameter for parameter, _ in rows], values,
                     color=[ORANGE if value > 0 else BLUE for value in values])
    axes.bar_label(bars, labels=[f"{value:+.3g}" for value in values], padding=4, color=INK)
    axes.axvline(0, color=INK, linewidth=1)
    axes.margins(x=0.18)
    axes.grid(False, axis="y")
    axes.set_xlabel(f"% of {name} per % of the parameter")


FLAVOURS = (("replayed_central", "replayed, central", BLUE, "o-"), ("replayed_forward", "replayed, forward", GREEN, "^-"),
            ("replayed_backward", "replayed, backward", PURPLE, "v:"), ("free_central", "free, central", ORANGE, "s--"))
LEGEND_HEIGHT = 0.4  # inches


def check(entries):
    """The V of each derivative: truncation error on the right, rounding error on the left."""
    figure, panels = _grid(len(entries), height=3.1, sharey=True)
    figure.set_figheight(figure.get_figheight() + LEGEND_HEIGHT)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - LEGEND_HEIGHT / figure.get_figheight()))
    for panel, entry in zip(panels, entries):
        _v_curve(panel, entry)
    for panel in panels[::PANELS_PER_ROW]:
        panel.set_ylabel("|difference - adjoint| / |adjoint|")
    handles = {h.get_label(): h for panel in panels for h in panel.get_lines()}
    figure.legend(handles.values(), handles.keys(), loc="upper center", ncols=max(1, len(handles)))
    return figure


def _v_curve(axes, entry):
    adjoint = math.nan if entry["adjoint"] is None else entry["adjoint"]
    scale = abs(adjoint) or 1.0
    for key, label, color, style in FLAVOURS:
        points = sorted((abs(s["step"]), abs(s[key] - adjoint) / scale) for s in entry.get("steps", [])
                        if s.get(key) is not None)
        if points:
            steps, errors = np.array(points).T
            axes.plot(steps, np.maximum(errors, 1e-17), style, color=color, label=label, markersize=4,
                      linewidth=1.4)
    axes.set(xscale="log", yscale="log", xlabel="step", title=entry["parameter"])
    axes.title.set_fontsize(10)
