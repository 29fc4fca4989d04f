# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What the verification cases share: run the program on a parameter file, read its summary, print figures."""
import csv
import json
import math
import os
import statistics
import subprocess
import sys


ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def leave_root():
    """Cases that are run by hand from the project's root write below results/by_hand."""
    if os.path.samefile(os.getcwd(), ROOT):
        sys.argv[1:] = [os.path.abspath(word) if os.path.exists(word) else word for word in sys.argv[1:]]
        folder = os.path.join(ROOT, "results", "by_hand")
        os.makedirs(folder, exist_ok=True)
        os.chdir(folder)


leave_root()


def run(build, command, case, settings=None, output="run", ranks=1, may_fail=False):
    """Run `retroforge COMMAND CASE` with overrides {"Section/name": value} and return (summary, what it printed)."""
    arguments = [os.path.join(build, "retroforge"), command, case, "--output", output, "--overwrite"]
    for name, value in (settings or {}).items():
        arguments += ["--set", f"{name}={value}"]
    if ranks > 1:
        arguments = ["mpirun", "-np", str(ranks)] + arguments
    summary_file = os.path.join(output, "summary.json")
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode != 0 and not may_fail:
        sys.stderr.write(done.stdout[-4000:] + done.stderr)
        raise SystemExit(f"failed: {' '.join(arguments)}")
    if not os.path.exists(summary_file):
        return None, done.stdout + done.stderr
    with open(summary_file) as file:
        return json.load(file), done.stdout + done.stderr


def energy(summary):
    return summary["objectives"][0]["value"]


def gradient(summary):
    """{parameter: d(energy)/d(parameter)}"""
    return {p["name"]: p["gradient"]["energy"] for p in summary["parameters"]}


def figure(name, value):
    print(f"FIGURE {name} {value:.6g}", flush=True)


class Trend:
    """What a scan found of one objective: its slopes beside those of the polynomial through its values."""

    def __init__(self, folder, objective):
        with open(os.path.join(folder, "scan.csv"), encoding="utf-8", newline="") as table:
            rows = [row for row in csv.DictReader(table) if not row["failure"]]
        column = next(name for name in rows[0] if name.startswith(f"{objective} [") or name == objective)
        columns = ("value", column, f"{objective}: gradient", f"{objective}: fit", f"{objective}: slope of the fit")
        self.at, self.values, self.slopes, fit, fitted = ([float(row[name]) for row in rows] for name in columns)
        self.mean, self.slope = statistics.mean(self.slopes), statistics.mean(fitted)  # of a parabola: its slope at the middle
        middle = statistics.mean(self.at)
        # Of the values about the parabola, and of its slope.
        self.scatter = math.sqrt(sum((y - on_it) ** 2 for y, on_it in zip(self.values, fit)) / (len(rows) - 3))
        self.uncertainty = self.scatter / math.sqrt(sum((x - middle) ** 2 for x in self.at))
        self.bias = self.mean / self.slope - 1
        self.rms = math.sqrt(statistics.mean((s - f) ** 2 for s, f in zip(self.slopes, fitted))) / abs(self.slope)


def scan_of_trend(build, case, parameter, points, part, settings, output):
    """Scans a parameter by a part of it to both sides, everything decided anew, in one process."""
    _, text = run(build, "scan", case, {"Scan/parameter": parameter, "Scan/range": part, "Scan/points": points, "Scan/fit degree": 2, "Design/parameters": parameter,
                                        "Scan/processes": 1, "Output/fields every": 0, **settings}, output, may_fail=True)
    if not os.path.exists(os.path.join(output, "scan.csv")):
        sys.exit(text)


def judge_check(build, case, settings, label):
    """Run `check`, print a table of what it finds of each objective, and the figures failed_LABEL and derivatives_LABEL."""
    summary, text = run(build, "check", case, settings, f"run_{label}", may_fail=True)
    if summary is None:
        sys.exit(text)
    with open(f"check_{label}.txt", "w") as file:
        file.write(text)
    rows, scale = summary["check"], {o["name"]: abs(o["value"]) for o in summary["objectives"]}
    failed = [f"{r['objective']} by {r['parameter']}" for r in rows if r["verdict"] == "failed"]
    print(f"{label}: {summary['mesh']['nodes']} nodes, {summary['remeshings']} remeshings, {len(scale)} objectives, "
          f"{len(rows)} derivatives, of which {sum(r['verdict'] == 'zero' for r in rows)} zero, {len(failed)} failed\n" + "".join(f"  {f}\n" for f in failed))
    print("| objective | value | adjoint/tangent - 1 | best replayed difference | median Taylor order |\n" + "| --- " * 5 + "|")
    for name in scale:
        # Random directions cancel: the program measures them against their terms.
        of = [r for r in rows if r["objective"] == name and "random" not in r["parameter"] and r["verdict"] == "passed"]
        if not of:
            print(f"| {name} | {scale[name]:.6g} | - | - | - |")
            continue
        tangent = max(abs(r["tangent"] / r["adjoint"] - 1.0) for r in of)
        replayed = max(min(abs(s["replayed_central"] / r["adjoint"] - 1.0) for s in r["steps"]) for r in of)
        # Where the remainder is rounding its order means nothing: the least is the program's to judge.
        orders = [r["taylor_orders"][-1] for r in of if r["taylor_orders"][-1] is not None]
        print(f"| {name} | {scale[name]:.6g} | {tangent:.1e} | {replayed:.1e} | {sorted(orders)[len(orders) // 2]:.3f} |")
    figure(f"failed_{label}", len(failed))
    figure(f"derivatives_{label}", len(rows))
