#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The unfilled volume of a bell over the stroke, by both projections, their mean, that of free nodes, and itself:  run.py BUILD [approach]

`approach`: only the first contact, by a bell that starts at a distance: does the metal rest until then?

The true one is what lies between the two dies within the region, minus the workpiece, as long as that has not left the
region: the height of the die above a fine grid of points. Figure figure_18.png."""
import csv
import os
import struct
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402

WIDTH = 62.0  # of the region, from both planes of symmetry [mm]


def heights_above_grid(stl, n=400):
    """z of the die above n x n points of the region, at the start of the stroke: a function of x and y."""
    with open(stl, "rb") as file:
        data = file.read()
    facets = np.array([struct.unpack_from("<12f", data, 84 + 50 * i)[3:] for i in range(struct.unpack_from("<I", data, 80)[0])],
                      dtype=float).reshape(-1, 3, 3)
    at = (np.arange(n) + 0.5) * WIDTH / n
    z = np.full((n, n), np.nan)
    for a, b, c in facets:
        low, high = np.min([a, b, c], axis=0), np.max([a, b, c], axis=0)
        i = np.flatnonzero((at >= low[0]) & (at <= high[0]))
        j = np.flatnonzero((at >= low[1]) & (at <= high[1]))
        det = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if not len(i) or not len(j) or det == 0.0:
            continue
        x, y = np.meshgrid(at[i] - a[0], at[j] - a[1], indexing="ij")
        s = (x * (c[1] - a[1]) - y * (c[0] - a[0])) / det
        t = (y * (b[0] - a[0]) - x * (b[1] - a[1])) / det
        inside = (s >= -1e-12) & (t >= -1e-12) & (s + t <= 1 + 1e-12)
        block = z[np.ix_(i, j)]
        block[inside] = (a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]))[inside]
        z[np.ix_(i, j)] = block
    assert not np.isnan(z).any(), "the die does not cover the region"
    return z


def approach(build):
    settings = {"Die bell/point": "0, 0, 56.5", "Press/stroke": 9, "Press/increments": 18, "Output/fields every": 0,
                "Objectives/names": "filling, filling of free nodes, unfilled volume, energy", "Objectives/history every": 0}
    summary, text = case_tools.run(build, "simulate", os.path.join(HERE, "case.prm"), settings, "approach", may_fail=True)
    print(text[-2000:])
    energy = next((o["value"] for o in summary["objectives"] if o["name"] == "energy"), 0.0) if summary else 0.0
    case_tools.figure("first_contact", 1 if energy > 0 else 0)


def main():
    if sys.argv[2:] == ["approach"]:
        return approach(sys.argv[1])
    summary, _ = case_tools.run(sys.argv[1], "simulate", os.path.join(HERE, "case.prm"), {}, "run")
    with open(os.path.join("run", "objectives.csv")) as file:
        rows = [{name.split(" [")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    z = heights_above_grid(os.path.join("run", "die_bell.stl"))
    print("| stroke [mm] | half piece onto die | half die onto piece | mean (109) | its free nodes only | unfilled volume | true | mean / true | "
          "free / true | volume / true |\n" + "| --- " * 10 + "|")
    table = []
    for row in rows:
        true = np.clip(z - row["stroke"], 0.0, None).sum() * (WIDTH / len(z))**2 - summary["volume_initial"]
        line = [row["stroke"], row["filling: workpiece onto target"], row["filling: target onto workpiece"], row["filling"],
                row["filling of free nodes"], row["unfilled volume"], true]
        table.append(line)
        print("| {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |".format(*line)
              + f" {line[3] / true:.2f} | {line[4] / true:.2f} | {line[5] / true:.3f} |", flush=True)
    table = np.array(table)
    draw(table)
    case_tools.figure("steps_up_of_the_mean", int((np.diff(table[:, 3]) >= 0).sum()))
    case_tools.figure("steps_up_of_free_nodes", int((np.diff(table[:, 4]) >= 0).sum()))
    case_tools.figure("steps_up_of_the_volume", int((np.diff(table[:, 5]) >= 0).sum()))
    # The last few rows compare small differences; the cavity is then nearly full.
    case_tools.figure("volume_against_true", np.abs(table[:, 5] - table[:, 6]).max() / table[0, 5])


def draw(table):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7, 4))
    for column, style, label in ((1, "-", "half piece onto die"), (2, "-", "half die onto piece"), (3, "-", "mean (109)"),
                                 (4, "--", "mean, free nodes only"), (5, "o", "unfilled volume"), (6, "k-", "true")):
        axes.plot(table[:, 0], table[:, column], style, markersize=4, label=label)
    axes.set_xlabel("stroke [mm]")
    axes.set_ylabel("unfilled volume of a quarter [mm³]")
    axes.legend()
    figure.tight_layout()
    figure.savefig("figure_18.png", dpi=90)


if __name__ == "__main__":
    main()
