# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The page of a scan: each objective along each parameter, with its smooth fit, and the local slopes beside the fit's."""
import csv
import json
import pathlib

import matplotlib.pyplot as plt
import numpy as np

from retroforge_report.curves import BLUE, INK, ORANGE
from retroforge_report.data import identifier
from retroforge_report.document import Document, number
from retroforge_report.units import bracketed, pretty

SCHEMA = 1


class ScanPage:
    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        path = self.directory / "scan.json"
        self.summary = json.loads(path.read_text(encoding="utf-8"))
        if self.summary.get("schema") != SCHEMA:
            raise ValueError(f"{path}: schema is {self.summary.get('schema')}; this report reads {SCHEMA}; scan again")
        with (self.directory / "scan.csv").open(newline="", encoding="utf-8") as file:
            self.rows = list(csv.DictReader(file))
        self.to = Document(self.directory)

    def write(self):
        """Returns the path of the page."""
        self.statistics()
        for line in self.summary["scans"]:
            self.line(line)
        self.failures()
        self.to.note(", ".join(f"{key} {self.summary[key]}" for key in ("version", "commit") if self.summary.get(key)))
        return self.to.save(f"{self.directory.resolve().name}: retroforge scan")

    def statistics(self):
        self.to.heading("How smooth, and how true the gradients")
        rows = []
        for line in self.summary["scans"]:
            rows.append(f"{line['parameter']} from {number(line['from'])} to {number(line['to'])} {pretty(line['unit'])}")
            rows += [(o["name"], number(o["mean_value"]), pretty(o["unit"]), number(o["mean_fit_slope"]),
                      *(percent(o[key]) for key in ("noise_rms", "noise_max", "bias", "roughness_rms", "roughness_max")))
                     for o in line["objectives"]]
        self.to.table(("objective", "#mean", "unit", "#slope of the fit", "#noise, rms", "#largest", "#bias", "#roughness, rms",
                       "#largest"), rows)
        self.to.note(f"Fits are polynomials of degree {self.summary['fit_degree']}. Noise: values off the fit, relative to their "
                     "mean. Bias: the mean of the local slopes against that of the fit's. Roughness: local slopes off the "
                     "fit's, relative to its mean slope. Each point is a run that decided increments, contact and meshes anew.")

    def line(self, line):
        rows = [row for row in self.rows if row["parameter"] == line["parameter"]]
        self.to.heading(line["parameter"])
        for objective in line["objectives"]:
            name = objective["name"]
            x, y, slope, fit, fit_slope = (np.array([float(row[column] or "nan") for row in rows]) for column in (
                "value", f"{name} [{objective['unit']}]", f"{name}: gradient", f"{name}: fit", f"{name}: slope of the fit"))
            figure, axes = plt.subplots(1, 2 if np.isfinite(slope).any() else 1, figsize=(11, 3.6), squeeze=False,
                                        layout="constrained")
            draw(axes[0, 0], x, y, fit, bracketed(name, objective["unit"]))
            if axes.shape[1] > 1:
                draw(axes[0, 1], x, slope, fit_slope, "derivative", "by the gradient of each run", "slope of the fit")
            for panel in axes.flat:
                panel.axvline(line["nominal"], color=INK, linewidth=0.8, linestyle=":")
                panel.set_xlabel(bracketed(line["parameter"], line["unit"]))
            self.to.picture(f"scan_{identifier(line['parameter'])}_{identifier(name)}", figure)

    def failures(self):
        if self.summary["failed"]:
            self.to.heading("Runs that failed")
            self.to.table(("parameter", "#value", "reason"),
                          [(f["parameter"], number(f["value"], 9), f["reason"]) for f in self.summary["failed"]])


def draw(axes, x, values, fit, label, of_points="runs", of_fit="fit"):
    axes.plot(x, values, "o", color=BLUE, markersize=4, label=of_points)
    if np.isfinite(fit).any():
        axes.plot(x, fit, "-", color=ORANGE, linewidth=1.4, label=of_fit)
    axes.set_ylabel(label)
    axes.ticklabel_format(axis="y", useOffset=False)
    axes.legend(fontsize=9)


def percent(ratio):
    return "–" if ratio is None else f"{100 * ratio:.3g} %"
