# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Increments that are given (Press/steps) or repeated (Design/repeat steps). A run repeated by its own history gives the same bits; a list of a
user's own is followed, stretched, and bent where it is too coarse; the designs of a scan and of an optimisation all make those of the nominal one, and the best design by hand gives the same bits, from its folder, where a table of stresses has another name.  Usage: repeated_steps.py RETROFORGE"""
import csv
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import changed, history_of, judge, main, prm, run, summary_of, text_of, upsetting, write  # noqa: E402

QUIET = {"Output": {"fields every": 0}, "Objectives": {"names": "energy"}}
CYLINDER = changed(upsetting("cylinder", {"radius": 10, "height": 15}, 5, 15, 7.5, 0), {
    **QUIET, "Remeshing": {"when": "never"}, "Design": {"parameters": "billet/radius"},
    "Scan": {"parameter": "billet/radius", "points": 7, "range": 0.1, "gradients": "false"}})
BARREL = changed(CYLINDER, {
    "Billet": {"shape": "profile", "control points": "10, 0; 10, 5; 10, 10; 10, 15", "symmetry planes": "-1, 0, 0; 0, -1, 0; 0, 0, -1",
               "volume held by": "control point 4 r"},
    "Material": {"law": "table", "table": "stresses.csv"}, "Dies": {"names": "upper"}, "Press": {"stroke": 7, "accuracy": 2e-4}, "Objectives": {"names": "barrel"},
    "Objective barrel": {"type": "cylinder distance", "patches": "side outer"},
    "Design": {"parameters": "billet/control point 1 r, billet/control point 2 r"},
    "Scan": {"parameter": ""}, "Optimisation": {"objective": "barrel", "noise runs": 0, "confirmation": 0, "iterations": 5}})


def strokes_of(output):
    return [row["stroke"] for row in history_of(output)]


def value_of(output):
    return summary_of(output)["objectives"][0]["value"]


def same_bits():
    done = run("simulate", "own", case="cylinder.prm")
    judge("own: ends, and no increment was refused", done.returncode == 0 and summary_of("own")["cuts"] == 0, done.stderr)
    done = run("gradient", "again", "Press/steps=own/history.csv", case="cylinder.prm")
    judge("repeated: ends", done.returncode == 0, done.stderr)
    judge("repeated: the same bits", value_of("again") == value_of("own") and strokes_of("again") == strokes_of("own"),
          f"{value_of('again')!r} {value_of('own')!r}")
    done = run("simulate", "equal", "Press/increments=10", case="cylinder.prm")
    done = run("simulate", "equal_again", "Press/increments=10", "Press/steps=equal/history.csv", case="cylinder.prm")
    judge("equal increments: the same bits", done.returncode == 0 and value_of("equal_again") == value_of("equal"), done.stderr)


def own_list():
    ends = [0.25, 0.5, 1, 1.5, 2, 2.4, 2.8, 3]
    write("list.csv", "name,stroke\n" + "".join(f"{i},{end}\n" for i, end in enumerate(ends)))
    done = run("simulate", "list", "Press/steps=list.csv", "Press/stroke=3", case="cylinder.prm")
    judge("a list is followed", done.returncode == 0 and [float(stroke) for stroke in strokes_of("list")] == ends, done.stderr)
    done = run("simulate", "stretched", "Press/steps=list.csv", "Press/stroke=3.6", case="cylinder.prm")
    off = max(abs(float(stroke) - 1.2 * end) for stroke, end in zip(strokes_of("stretched"), ends))
    judge("and stretched, which is told", len(strokes_of("stretched")) == len(ends) and off < 1e-9 and
          "end at 3 mm and are stretched to 3.6 mm" in done.stdout, done.stdout + done.stderr)
    # A step of 2 mm strains by about 0.15, twice what the accuracy asks is 0.063.
    write("coarse.csv", "stroke\n0.4\n0.8\n2.8\n3\n")
    done = run("simulate", "coarse", "Press/steps=coarse.csv", "Press/stroke=3", case="cylinder.prm")
    found = [float(stroke) for stroke in strokes_of("coarse")]
    judge("one that is too long is divided, which is told", found[:2] == [0.4, 0.8] and 2.8 in found and found[-1] == 3 and
          4 < len(found) < 12 and done.stdout.count("not kept whole") == 1, f"{found} {done.stdout}")
    judge("what is not too long is kept", "not kept whole" not in run("simulate", "fine", "Press/steps=list.csv", "Press/stroke=3",
                                                                    case="cylinder.prm").stdout)


def increments_of(output):
    with open(os.path.join(output, "scan.csv"), encoding="utf-8", newline="") as file:
        return [int(row["increments"]) for row in csv.DictReader(file)]


def scanned():
    for output, repeats in (("scan", "true"), ("scan_own", "false")):
        done = run("scan", output, f"Design/repeat steps={repeats}", case="cylinder.prm")
        judge(f"{output}: ends", done.returncode == 0, done.stderr)
    words = [text_of(output, "points", "billet_radius_001", "command.txt") for output in ("scan", "scan_own")]
    judge("points of a scan are given its steps", "Press/steps=" in words[0] and "Press/steps=" not in words[1], words)
    judge("a scan repeats the increments of the nominal design", set(increments_of("scan")) == {len(strokes_of("own"))}, increments_of("scan"))


def optimised():
    # With a table, of which best.prm tells from its own folder.
    write("stresses.csv", "strain,strain rate,temperature,flow stress\n" + "".join(f"{q},{rate},1000,{60 * (3 ** 0.5 * rate) ** 0.139 * (1 + 0.2 * q)}\n"
                                                                      for q in (0.01, 1, 3) for rate in (0.01, 1, 100)))
    for output, repeats in (("best", "true"), ("best_own", "false")):
        done = run("optimize", output, f"Design/repeat steps={repeats}", case="barrel.prm")
        judge(f"{output}: ends", done.returncode in (0, 2), done.stderr)
    trials = {output: json.loads(text_of(output, "optimisation.json"))["trials"] for output in ("best", "best_own")}
    number = {output: [trial["increments"] for trial in trials[output]] for output in trials}
    judge("an optimisation repeats the increments of its start", len(number["best"]) > 2 and len(set(number["best"])) == 1, number["best"])
    judge("best.prm names them", "set steps" in text_of("best", "best.prm") and "steps.csv" in text_of("best", "best.prm") and
          "steps.csv" not in text_of("best_own", "best.prm"))
    judge("and the table", "set table = ../stresses.csv" in text_of("best", "best.prm"))
    hand = run("simulate", "hand", case="best/best.prm")
    best = json.loads(text_of("best", "optimisation.json"))["objective"]["best"]
    judge("the best by hand: the same bits", hand.returncode == 0 and value_of("hand") == best, f"{hand.stderr} {best}")
    lines = text_of("best", "journal.jsonl").splitlines(keepends=True)
    write(os.path.join("best", "journal.jsonl"), "".join(lines[:len(lines) // 2]))
    again = run("optimize", "best", "--resume", case="barrel.prm")
    values = [trial["values"] for trial in json.loads(text_of("best", "optimisation.json"))["trials"]]
    judge("resumed: the same designs", again.returncode in (0, 2) and values == [trial["values"] for trial in trials["best"]], again.stderr)


main({"cylinder.prm": prm(CYLINDER), "barrel.prm": prm(BARREL)}, (same_bits, own_list, scanned, optimised))
