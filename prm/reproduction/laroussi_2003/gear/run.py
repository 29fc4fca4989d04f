#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Half a tooth of a gear.  run.py BUILD PART [--size MM] [--walls straight|tapered]

start     mean effort at 5 mm of stroke by mu1 to mu3, adjoint against the direct method and replayed differences (table 13)
trend     the same over +- 1 %, everything decided anew
whole     the whole stroke, remeshed: adjoint against the direct method and replayed differences
optimum   the preform of least effort within 3 mm of the start (tables 14 and 15), for both materials
cost      the whole stroke, Newtonian, on a fine mesh in 280 increments: seconds and bytes (table 16)"""
import argparse
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402
import check_tools  # noqa: E402

CASES = {"straight": os.path.join(HERE, "case.prm"), "tapered": os.path.join(HERE, "tapered.prm")}
START = {"Press/stroke": 5, "Press/increments": 10, "Objective effort/window begin": 4.75, "Objective effort/window end": 5,
         "Remeshing/when": "never"}
NEWTONIAN = {"Material/strain rate sensitivity": 1}
STEPS = {"Check/steps": "1e-5, 1e-6", "Check/taylor halvings": 2}


def check(build, case, settings, prefix):
    summary, text = case_tools.run(build, "check", case, {**STEPS, **settings}, "checked", may_fail=True)
    if summary is None:
        sys.exit(text)
    rows = {name: row for name, row in check_tools.check_rows(summary).items() if name.startswith("billet/")}
    print(f"{summary['mesh']['nodes']} nodes, mean effort {summary['objectives'][0]['value']:.6g} N; by " +
          ", ".join(f"{name[7:]} {row['adjoint']:.5g}" for name, row in rows.items()) + " N/mm\n" + check_tools.table(rows))
    for name, row in rows.items():
        case_tools.figure(f"{prefix}_replayed_{name[7:]}", check_tools.worst_over_decades(row, decades=1))
        case_tools.figure(f"{prefix}_tangent_{name[7:]}", abs(row["tangent"] / row["adjoint"] - 1.0))


def trend(build, case, settings):
    words = [os.path.join(build, "retroforge"), "scan", case, "--output", "scanned", "--overwrite"]
    for name, value in settings.items():
        words += ["--set", f"{name}={value}"]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    with open("scanned/scan.json", encoding="utf-8") as file:
        print(json.dumps(json.load(file), indent=1)[:6000])


def optimum(build, case, settings):
    for name, material in (("newtonian", NEWTONIAN), ("hot", {})):
        words = [os.path.join(build, "retroforge"), "optimize", case, "--output", name, "--overwrite"]
        for key, value in {**settings, **material}.items():
            words += ["--set", f"{key}={value}"]
        subprocess.run(words, check=True)
        with open(f"{name}/optimisation.json", encoding="utf-8") as file:
            found = json.load(file)
        objective, confirmed = found["objective"], found["confirmation"]
        case_tools.figure(f"{name}_effort", objective["best"] / objective["start"])
        case_tools.figure(f"{name}_effort_confirmed", confirmed["best"] / confirmed["start"])


def cost(build, case, settings):
    summary, text = case_tools.run(build, "gradient", case, {**settings, **NEWTONIAN, "Press/increments": 280}, "fine")
    seconds = summary["wall_seconds"]
    print(text[-3000:])
    case_tools.figure("fine_adjoint_over_forward", seconds["adjoint"] / (seconds["total"] - seconds["adjoint"]))
    print(f"{summary['mesh']['nodes']} nodes at the start; record {os.path.getsize('fine/record.h5') / 1e6:.0f} MB")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("part", choices=("start", "trend", "whole", "optimum", "cost"))
    parser.add_argument("--size", type=float, default=3, help="of the elements [mm]")
    parser.add_argument("--walls", choices=CASES, default="straight", help="of the teeth, without or with a draft")
    options = parser.parse_args()
    size, case = {"Billet/element size": options.size}, CASES[options.walls]
    if options.part == "start":
        check(options.build, case, {**START, **size}, "start")
    elif options.part == "trend":
        trend(options.build, case, {**START, **size})
    elif options.part == "whole":
        check(options.build, case, size, "whole")
    else:
        {"optimum": optimum, "cost": cost}[options.part](options.build, case, size)


if __name__ == "__main__":
    main()
