# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Pictures of what depends on stroke, on a parameter, or on the step of a difference."""
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (after the choice of the backend)
import numpy as np  # noqa: E402

INK, BLUE, ORANGE, GREEN, PURPLE = "#333333", "#0072b2", "#d55e00", "#009e73", "#8e5aa8"  # colour-blind safe
MOST_BARS = 30

plt.rcParams.update({
    "font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": INK,
    "axes.grid": True, "grid.color": "#e3e3e3", "axes.axisbelow": True, "lines.linewidth": 2,
    "figure.dpi": 130, "legend.frameon": False})


def forging(history, energy_unit):
    """Force and energy over the stroke."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8), layout="constrained")
    _over_stroke(left, history, history["force"], "press force [N]", BLUE)
    _over_stroke(right, history, history["energy"], f"energy [{energy_unit or 'mJ'}]", ORANGE)
    for axes in (left, right):
        axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
        axes.ticklabel_format(axis="y", style="sci", scilimits=(-2, 4), useMathText=True)
    return figure


def health(history, volume_initial):
    """What the forger did not ask for but must know: volume lost, element quality, iterations."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.4), layout="constrained")
    change = history["volume"] / (volume_initial or history["volume"][0]) - 1
    _over_stroke(left, history, change, "relative change of volume", GREEN)
    left.ticklabel_format(axis="y", style="sci", scilimits=(-2, 3), useMathText=True)
    _over_stroke(middle, history, history["min_quality"], "worst element quality", PURPLE)
    middle.set_ylim(bottom=0)
    right.plot(history["increment"], history["newton"], ".-", color=BLUE, label="Newton steps")
    right.plot(history["increment"], history["krylov"], ".-", color=ORANGE, label="Krylov steps")
    right.set(xlabel="increment", ylabel="per increment", yscale="log")
    right.legend()
    return figure


def _over_stroke(axes, history, values, label, color):
    axes.plot(history["stroke"], values, ".-", color=color)
    axes.set(xlabel="stroke [mm]", ylabel=label)


def relative_gradient(objective, parameters):
    """Per cent of the objective per per cent of the parameter; parameters at zero, or unknown, have none."""
    name, value = objective["name"], objective["value"]
    rows = [(p["name"], p["gradient"][name] * p["value"] / value) for p in parameters
            if value and p["value"] and p.get("gradient", {}).get(name) is not None]
    return sorted(rows, key=lambda row: abs(row[1]), reverse=True)[:MOST_BARS]


def gradients(objectives, parameters):
    """One panel of bars per objective, or None when nothing was differentiated."""
    panels = [(o["name"], relative_gradient(o, parameters)) for o in objectives]
    panels = [(name, rows) for name, rows in panels if rows]
    if not panels:
        return None
    heights = [len(rows) + 2 for _, rows in panels]
    figure, axes = plt.subplots(len(panels), 1, figsize=(9, 0.34 * sum(heights) + 0.6), squeeze=False,
                                layout="constrained", gridspec_kw={"height_ratios": heights})
    for panel, (name, rows) in zip(axes[:, 0], panels):
        _bars(panel, name, rows[::-1])
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
PANELS_PER_ROW = 3
LEGEND_HEIGHT = 0.4  # inches


def check(entries):
    """The V of each derivative: truncation error on the right, rounding error on the left."""
    columns = min(PANELS_PER_ROW, len(entries))
    rows = -(-len(entries) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(3.7 * columns, 3.1 * rows + LEGEND_HEIGHT),
                                squeeze=False, layout="constrained", sharey=True)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - LEGEND_HEIGHT / figure.get_figheight()))
    for panel, entry in zip(axes.flat, entries):
        _v_curve(panel, entry)
    for panel in axes.flat[len(entries):]:
        panel.set_visible(False)
    for panel in axes[:, 0]:
        panel.set_ylabel("|difference - adjoint| / |adjoint|")
    handles = {h.get_label(): h for panel in axes.flat for h in panel.get_lines()}
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
    axes.set(xscale="log", yscale="log", xlabel="step", title=f"{entry['objective']} / {entry['parameter']}")
    axes.title.set_fontsize(10)
