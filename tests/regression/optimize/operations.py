# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Several operations in one optimisation: each is what its case alone gives, bit for bit; their sum is differentiated right; limits, scatter
and groups of ranks count them all; what was killed goes on; operations that make no sense are refused.  Usage: operations.py RETROFORGE"""
import os
import signal
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from scene import SCENE, best_of, found_in, judge_same, lines_of, optimize, rows_of  # noqa: E402
from whole_runs import ENVIRONMENT, changed, command, judge, main, prm, run, start, summary_of, text_of, write  # noqa: E402

ENERGY, OTHER = "energy", "energy of small"
LARGE = changed(SCENE, {"Newton": {"tolerance": 1e-12}, "Adjoint": {"tolerance": 1e-12},
                        "Design": {"parameters": "billet/control point 1 r, dies/friction"},
                        "Optimisation": {"operations": "small.prm", "objective": "energy, energy of small", "noise runs": 1, "iterations": 4,
                                         "lower bounds": "billet/control point 1 r: 9, dies/friction: 0.1",
                                         "upper bounds": "billet/control point 1 r: 11, dies/friction: 0.5",
                                         "scales": "billet/control point 1 r: 0.5, dies/friction: 0.1"}})
# Its offset comes first, so that the numbers of the parameters are other ones; its consistency is not the nominal one.
SMALL = changed(SCENE, {"Newton": {"tolerance": 1e-12}, "Adjoint": {"tolerance": 1e-12},
                        "Billet": {"control points": "8, 0; 8, 4; 8, 8; 8, 12", "element size": 4},
                        "Die upper": {"point": "0, 0, 12", "friction": 0.2}, "Press": {"stroke": 4},
                        "Objectives": {"names": "energy, barrel"}, "Objective energy": {"weight": 3},
                        "Design": {"parameters": "die upper/offset, dies/friction", "at": "material/K: 2"}})
del SMALL["Optimisation"]


def groups(number):
    return f"Optimisation/side by side={number}"


def value_of(output, name="energy"):
    return next(objective["value"] for objective in summary_of(output)["objectives"] if objective["name"] == name)


def derivative_of(output, parameter):
    return next(of["gradient"]["energy"] for of in summary_of(output)["parameters"] if of["name"] == parameter)


def alone():
    """Start and best against runs of each case by itself."""
    found, printed = optimize("both")
    judge("it is told", "operation small, too, which has its dies/friction" in printed and found["operations"] == [
        {"name": "small", "parameters": ["dies/friction"]}], printed)
    values = found["trials"][0]["values"]
    run("simulate", "large_start")
    run("simulate", "small_start", ("dies/friction", 0.3), ("material/K", 2.0), case="small.prm")
    judge("each as alone, at the start", values[ENERGY] == value_of("large_start") and values[OTHER] == value_of("small_start"), values)
    judge("their sum", abs(found["objective"]["start"] / (values[ENERGY] + 3 * values[OTHER]) - 1) < 1e-15, found["objective"])
    for case, parameters in (("best", 2), ("best_small", 3)):
        done = run("gradient", case, case=f"both/{case}.prm")
        judge(f"{case}.prm runs", done.returncode == 0 and len(summary_of(case)["parameters"]) == parameters, done.stderr)
    best = found["objective"]["best"]
    judge("and at the best", abs(best / (value_of("best") + 3 * value_of("best_small")) - 1) < 1e-15 and best < found["objective"]["start"], best)
    radius, friction = (parameter["gradient"] for parameter in found["parameters"])
    judge("a parameter of one of them", radius == derivative_of("best", "billet/control point 1 r"), radius)
    both = derivative_of("best", "dies/friction") + 3 * derivative_of("best_small", "dies/friction")
    judge("a parameter of both", abs(friction / both - 1) < 1e-14, f"{friction} {both}")
    judge("shapes of both", all(os.path.exists(f"both/designs/best{name}_forged.stl") for name in ("", "_small")))


def taylor():
    """Along a direction of both parameters, differences of whole forgings: order two of the step."""
    _, printed = optimize("checked", "--check", "Optimisation/iterations=1", "Optimisation/noise runs=0")
    rows = [line.split() for line in printed.splitlines() if line.startswith(("  0.1 ", "  0.01 ", "  0.001 "))]
    errors = [float(row[3]) for row in rows]
    order = np.log10(errors[0] / errors[1])
    judge("order two", 1.8 < order < 2.2, f"{order} {errors}")
    judge("to the end", min(errors) < 1e-6, errors)


def limited():
    """The barrel of the other operation may not get smaller than where friction is half way to the optimum's."""
    settings = ("Optimisation/noise runs=0", "Optimisation/iterations=30")
    barrels = [trial["values"]["barrel of small"] for trial in found_in("both")["trials"] if trial["decision"] in ("start", "accepted")]
    bound = 0.5 * (barrels[0] + barrels[-1])
    found, _ = optimize("limited", f"Optimisation/at least=barrel of small: {bound!r}", *settings)
    limit = found["limits"][0]
    judge("a limit of the other operation", limit["objective"] == "barrel of small" and abs(limit["best"] / bound - 1) < 1e-3, limit)
    judge("holds friction", 0.1 < best_of(found)[1] < 0.3 and limit["by_relaxing"] < 0, best_of(found))


def side_by_side():
    optimize("spread", groups(2), ranks=2)
    judge_same("two operations in two groups", "spread", "both")
    scattered = ("Optimisation/scattered=dies/friction", "Optimisation/scatter range=0.2, 0.6", "Optimisation/samples=2",
                 "Optimisation/iterations=1", "Optimisation/noise runs=0", "Optimisation/scales=", "Optimisation/lower bounds=",
                 "Optimisation/upper bounds=")
    optimize("samples", *scattered)
    found, _ = optimize("samples3", *scattered, groups(3), ranks=3)
    judge_same("two operations with two samples, in three groups", "samples3", "samples")
    judge("each is forged for each sample, and not again where a design does not change it", found["simulations"] == 6, found["simulations"])
    own = ("Design/parameters=billet/control point 1 r, dies/friction", "Optimisation/scattered=billet/control point 1 r",
           "Optimisation/scatter range=9.8, 10.2", *scattered[2:])
    found, _ = optimize("own", *own)
    judge("without the scattered parameter once", found["simulations"] % 3 == 0, found["simulations"])
    judge("where it has no deviation", found["trials"][0]["values"][OTHER] == value_of("small_start"), found["trials"][0])


def killed():
    n_lines = len(text_of("both", "journal.jsonl").splitlines())
    with subprocess.Popen(["mpirun", "-np", "2", *command("optimize", "killed", groups(2))], env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as running:
        while running.poll() is None and lines_of("killed") < n_lines // 2:
            time.sleep(0.002)
        running.send_signal(signal.SIGTERM)
    optimize("killed", "--resume")
    judge_same("killed in two groups, resumed by one rank", "killed", "both", is_resumed=True)


def failing():
    """A friction with which only the other operation cannot go on: its increments may not be cut."""
    write("fragile.prm", prm(changed(SMALL, {"Press": {"max cuts": 0, "largest move": 0.001}})))
    done = run("optimize", "failing", "Optimisation/operations=fragile.prm", "Optimisation/objective=energy")
    judge("it says in which", done.returncode == 1 and "in fragile: " in done.stderr, done.stderr)


def refused():
    write("strange.prm", prm(changed(SMALL, {"Design": {"parameters": "die upper/offset"}})))
    os.makedirs("folder")
    write("folder/small.prm", prm(SMALL))
    for what, settings, expected in (
            ("a file that is missing", ["Optimisation/operations=smal.prm"], "names 'smal.prm', which is a file neither in this folder nor in that of the case"),
            ("no parameter of the design", ["Optimisation/operations=strange.prm"], "has no parameter of the design"),
            ("the same name twice", ["Optimisation/operations=small.prm, folder/small.prm"], "another file is called small"),
            ("the case itself", ["Optimisation/operations=case.prm"], "another file is called case"),
            ("objectives of the same name", ["Objectives/names=energy of small, energy, barrel", "Objective energy of small/type=energy"],
             "the name of two objectives"),
            ("an objective that is not there", ["Optimisation/objective=energy of smal"], "did you mean 'energy of small'"),
            ("more groups than forgings", [groups(3)], "each design is forged 2 times")):
        words = command("optimize", "wrong", *settings)
        done = start(["mpirun", "-np", "3", *words] if groups(3) in settings else words)
        judge(what, done.returncode == 1 and expected in done.stderr and not os.path.exists("wrong"), done.stderr.strip())
    before = text_of("both", "journal.jsonl")
    write("small.prm", prm(changed(SMALL, {"Press": {"stroke": 3}})))
    done = run("optimize", "both", "--resume")
    judge("another operation small", done.returncode == 1 and "forgings of another operation small" in done.stderr, done.stderr.strip())
    judge("nothing was touched", text_of("both", "journal.jsonl") == before and rows_of("both") == rows_of("spread"))


main({"case.prm": prm(LARGE), "small.prm": prm(SMALL)}, (alone, taylor, limited, side_by_side, killed, failing, refused))
