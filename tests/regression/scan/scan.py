# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A scan: its points are the runs a user would make by hand, its statistics what numpy makes of them; it goes on where it
was stopped, and past points that fail. Usage: scan.py RETROFORGE

By hand: the energy is proportional to the consistency K but for the penalty, so that its slope is the energy over K."""
import csv
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ENVIRONMENT, ROOT, changed, command, judge, main, prm, run, start, summary_of, text_of, upsetting  # noqa: E402

REPORT = str(ROOT / "contrib/report")
CASE = changed(upsetting("cylinder", {"radius": 10, "height": 15}, 5, 15, 3, 6), {
    "Objectives": {"names": "energy, volume"}, "Design": {"parameters": "material/K, die upper/offset"},
    "Scan": {"points": 5, "fit degree": 2}})


def scan(output, *more):
    done = run("scan", output, *more)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    with open(os.path.join(output, "scan.csv"), encoding="utf-8", newline="") as file:
        return json.loads(text_of(output, "scan.json")), list(csv.DictReader(file)), done.stdout


def near(name, found, expected, tolerance=1e-9):
    error = np.max(np.abs(np.asarray(found) - expected)) / np.max(np.abs(expected))
    judge(name, error <= tolerance, f"{error:.1e}")


def whole_scan():
    found, rows, printed = scan("whole")
    judge("it says how many runs", "10 runs" in printed)
    judge("a row per point", len(rows) == 10 and all(row["failure"] == "" for row in rows))
    judge("parameters", [line["parameter"] for line in found["scans"]] == ["material/K", "die upper/offset"])
    ranges = (1.693 * np.linspace(0.99, 1.01, 5), np.linspace(-0.2, 0.2, 5))
    for line, values in zip(found["scans"], ranges):
        judge_line(line, [row for row in rows if row["parameter"] == line["parameter"]], values)
    by_hand = start(["sh", "-c", text_of("whole/points/material_K_002/command.txt").replace("--output whole/points", "--output hand")])
    energy = summary_of("hand/material_K_002")["objectives"][0]["value"]
    judge("a point repeated by hand", by_hand.returncode == 0 and energy == float(rows[1]["energy [mJ]"]))
    judge("points repeat the increments of the nominal design", "--set Press/steps=" in text_of("whole/points/material_K_002/command.txt") and
          {row["increments"] for row in rows} == {str(summary_of("whole/points/nominal")["increments"])})
    judge("records are gone", not os.path.exists("whole/points/material_K_001/record.h5"))


def judge_line(line, rows, values):
    parameter, energy = line["parameter"], line["objectives"][0]
    x, y, slopes, fitted, fitted_slopes = (np.array([float(row[name]) for row in rows]) for name in (
        "value", "energy [mJ]", "energy: gradient", "energy: fit", "energy: slope of the fit"))
    fit = np.polynomial.Polynomial.fit(x, y, 2)
    mean, deviation = np.mean(fit.deriv()(x)), slopes - fit.deriv()(x)
    near(f"{parameter}: values", x, values)
    near(f"{parameter}: fit", fitted, fit(x))
    near(f"{parameter}: slope of the fit", fitted_slopes, fit.deriv()(x))
    for name, expected in (("mean_value", np.mean(y)), ("mean_slope", np.mean(slopes)), ("mean_fit_slope", mean)):
        near(f"{parameter}: {name}", energy[name], expected)
    for name, expected in (("noise_rms", np.sqrt(np.mean((y - fit(x))**2)) / np.mean(y)), ("bias", np.mean(slopes) / mean - 1.0),
                           ("roughness_rms", np.sqrt(np.mean(deviation**2)) / abs(mean)),
                           ("roughness_max", np.abs(deviation).max() / abs(mean))):
        judge(f"{parameter}: {name}", abs(energy[name] - expected) < 1e-9, f"{energy[name]:.1e}")
    if parameter == "material/K":
        near("slope in K by hand", slopes, y / x, 1e-2)
    judge("two objectives", [objective["name"] for objective in line["objectives"]] == ["energy", "volume"])


def resumed():
    os.remove("whole/points/material_K_003/summary.json")
    before = text_of("whole/scan.csv")
    _, _, printed = scan("whole", "--resume")
    judge("resumed: the same bits", text_of("whole/scan.csv") == before)
    judge("resumed: it says what is reused", "9 of them are finished" in printed)
    _, _, printed = scan("whole", "--resume", "Scan/fit degree=3", "Check/steps=1e-3")
    judge("resumed with another fit", "10 of them are finished" in printed)
    _, _, printed = scan("whole", "--resume", "Die lower/friction=0.2", "Scan/parameter=material/K")
    judge("resumed with another case", "0 of them are finished" in printed)


def failing_points():
    """The upper offsets of seven push the die into the billet by 0.53, 1.07 and 1.6 mm; up to 5 % of the cube root of
    the whole billet's volume, 0.84 mm, contact pushes it out."""
    found, rows, printed = scan("failing", "Scan/parameter=die upper/offset", "Scan/points=7",
                                "Scan/range=0.08", "Scan/gradients=false")
    objective = found["scans"][0]["objectives"][0]
    judge("failed points are counted", len(found["failed"]) == 2 and "7 points, 2 failed" in printed)
    judge("and say why", all("inside it" in entry["reason"] for entry in found["failed"]) and "inside it" in rows[6]["failure"])
    judge("the others are fitted", objective["values"] == 5 and objective["noise_rms"] is not None)
    judge("without gradients no slopes", objective["slopes"] == 0 and objective["bias"] is None and rows[0]["energy: gradient"] == "")
    done = start([REPORT, "--no-vtk", "failing"])
    judge("reported", done.returncode == 0 and "inside it" in text_of("failing/report.html"), done.stderr)
    done = run("scan", "all", "Press/max cuts=0", "Press/largest move=0.01", "Scan/parameter=material/K")
    judge("all failed", done.returncode == 1 and "5 points, 5 failed" in done.stdout, done.stderr)


def changed_design():
    found, _, _ = scan("changed", ("billet/radius", 9.5), ("material/K", 2), "Scan/parameter=material/K")
    line = found["scans"][0]
    judge("around another design", line["nominal"] == 2 and abs(line["to"] - 2.02) < 1e-12)
    judge("which its points have", "billet/radius: 9.5, material/K: 2" in text_of("changed/points/material_K_003/parameters.prm"))


def refused():
    done = start(["mpirun", "-np", "2", *command("scan", "ranks")])
    judge("mpirun", done.returncode != 0 and "leave mpirun out" in done.stderr, done.stderr.strip()[:200])
    for what, setting, expected in (("unknown parameter", "Scan/parameter=billet/raduis", "did you mean 'billet/radius'"),
                                    ("too few points", "Scan/points=3", "at least 4 points"),
                                    ("a die in the billet", "Die upper/point=0, 0, 13", "stands 2 mm inside it")):
        done = run("scan", "wrong", setting)
        judge(what, done.returncode == 1 and expected in done.stderr and not os.path.exists("wrong"), done.stderr.strip())


def stopped():
    """Its runs end with it."""
    fine = ("Billet/element size=1", "Press/increments=1000")
    with subprocess.Popen(command("scan", "stopped", *fine), env=ENVIRONMENT, stdout=subprocess.DEVNULL) as scanning:
        history = "stopped/points/nominal/history.csv"
        for _ in range(300):
            if os.path.exists(history):
                break
            time.sleep(0.2)
        scanning.send_signal(signal.SIGTERM)
        judge("stopped", scanning.wait(60) == -signal.SIGTERM, scanning.returncode)
    left = [pid for pid in os.listdir("/proc") if pid.isdigit() and b"stopped/points" in words_of(pid)]
    judge("no run is left", os.path.exists(history) and not left, left)


def words_of(pid):
    try:
        with open(f"/proc/{pid}/cmdline", "rb") as file:
            return file.read()
    except OSError:
        return b""


def report():
    done = start([REPORT, "--no-vtk", "whole"])
    judge("report", done.returncode == 0, done.stderr)
    if done.returncode == 0:
        page = text_of("whole/report.html")
        judge("its pictures", page.count("data:image/png;base64") == 4 and "Roughness" in page)


main({"case.prm": prm(CASE)}, (whole_scan, report, resumed, failing_points, changed_design, refused, stopped))
