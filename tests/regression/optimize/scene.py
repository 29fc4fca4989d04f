# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The scene that tests of optimisations change, and what an optimisation leaves behind."""
import csv
import json
import sys

from whole_runs import command, judge, start, text_of

SCENE = {
    "Billet": {"shape": "profile", "control points": "10, 0; 10, 5; 10, 10; 10, 15", "element size": 5,
               "symmetry planes": "-1, 0, 0; 0, -1, 0; 0, 0, -1", "volume held by": "control point 4 r"},
    "Dies": {"names": "upper"},
    "Die upper": {"point": "0, 0, 15", "facing": "0, 0, -1", "velocity": "0, 0, -100", "friction": 0.3},
    "Press": {"stroke": 5, "increments": 5},
    "Objectives": {"names": "barrel, energy"},
    "Objective barrel": {"type": "cylinder distance", "patches": "side outer"},
    "Design": {"parameters": "billet/control point 1 r, billet/control point 2 r"},
    "Optimisation": {"objective": "barrel", "noise runs": 2, "confirmation": 0},
    "Output": {"fields every": 0}}


def optimize(output, *more, ranks=1, status=0, **where):
    """@param status  the exit status there is to be"""
    words = command("optimize", output, *more, **where)
    done = start(words if ranks == 1 else ["mpirun", "-np", str(ranks), *words])
    if done.returncode != status:
        sys.exit(done.stdout + done.stderr)
    return found_in(output), done.stdout


def found_in(output):
    return json.loads(text_of(output, "optimisation.json"))


def rows_of(output):
    """Without what differs from run to run: the seconds."""
    return [{name: text for name, text in row.items() if name != "seconds"}
            for row in csv.DictReader(text_of(output, "optimisation.csv").splitlines())]


def best_of(found):
    return [parameter["best"] for parameter in found["parameters"]]


def lines_of(output):
    try:
        return len(text_of(output, "journal.jsonl").splitlines())
    except OSError:
        return 0


def journal_of(output):
    """The program, and the lines after the header without what differs from run to run: the seconds."""
    header, *lines = (json.loads(line) for line in text_of(output, "journal.jsonl").splitlines())
    return [header["retroforge"], *({name: value for name, value in line.items() if name != "seconds"} for line in lines)]


def judge_same(what, output, reference, is_resumed=False):
    """@param is_resumed  the journal has been written anew, with gradients right after their values"""
    order = (lambda lines: sorted(map(str, lines))) if is_resumed else list
    judge(f"{what}: the same journal", order(journal_of(output)) == order(journal_of(reference)))
    judge(f"{what}: the same path", rows_of(output) == rows_of(reference))
    judge(f"{what}: the same optimum", best_of(found_in(output)) == best_of(found_in(reference)))
