# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""How many linear solves an increment takes. While no node arrives, the velocity of the next stage is known from how it changed
between those before, but for a second difference: one solve of a stage is enough. What a start is
made of is recorded: a run that is resumed has the same bits, solves included. A metal that hardly feels its rate is forged on a
curved die, whether systems are solved to a part or directly. Usage: newton_steps.py RETROFORGE"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, changed, cube, history_of, judge, main, prm, run, summary_of  # noqa: E402

CASE = changed(cube(20, 6, 2, 8), {"Remeshing": {"when": "never"}, "Contact": {"penetration": 1e-5}})
TIP = changed(cube(20, 6, 0.2, 1), {"Remeshing": {"when": "never"}, "Press": {"max cuts": 0},
                                    "Die lower": {"shape": "punch", "Punch": {"radius": 6, "edge radius": 5.9}}})
WHOLE = ("Press/stroke=2", "Press/increments=8")


def solves(output):
    return [int(row["newton"]) for row in history_of(output)]


def steady():
    for scheme, stages in (("midpoint", 2), ("euler", 1)):
        done = run("simulate", scheme, f"Press/scheme={scheme}")
        judge(f"{scheme}: ends", done.returncode == 0, done.stderr)
        taken = solves(scheme)[3:]
        most = 1 if stages == 2 else 2  # without a second stage there is nothing to tell how the first one changes
        judge(f"{scheme}: linear solves per stage", max(taken) <= most * stages, taken)


def resumed():
    """From the record of the first half of the stroke."""
    run("gradient", "whole")
    run("gradient", "half", "Press/stroke=1", "Press/increments=4")
    done = run("gradient", "half", "--resume", *WHOLE)
    judge("resumed: ends", done.returncode == 0, done.stderr)
    judge("resumed: energy", summary_of("half")["objectives"][0]["value"] == summary_of("whole")["objectives"][0]["value"])
    judge("resumed: solves", solves("half") == solves("whole"), (solves("half"), solves("whole")))


def remeshed():
    """The start is carried to a new mesh with its change; the run resumes there with the same bits, too."""
    settings = ("Remeshing/when=increments", "Remeshing/every=3")
    run("gradient", "whole_remeshed", *settings)
    run("gradient", "half_remeshed", *settings, "Press/stroke=1", "Press/increments=4")
    done = run("gradient", "half_remeshed", *settings, *WHOLE, "--resume")
    judge("remeshed: ends", done.returncode == 0, done.stderr)
    judge("remeshed: some", summary_of("whole_remeshed")["remeshings"] >= 2)
    judge("remeshed: solves", solves("half_remeshed") == solves("whole_remeshed"))
    judge("remeshed: energy", summary_of("half_remeshed")["objectives"][0]["value"] ==
          summary_of("whole_remeshed")["objectives"][0]["value"])


def nearly_plastic():
    """m = 0.01 on the tutorial's hub: on the way to the first equilibrium cells bear loads that only endless bubbles would balance."""
    settings = ("Material/strain rate sensitivity=0.01", "Press/stroke=1.35", "Press/increments=2", "Objectives/names=energy", "Output/fields every=0")
    energies = {}
    for method in ("auto", "direct"):
        done = run("simulate", method, *settings, f"Linear solver/method={method}", case=str(ROOT / "prm/tutorial/hub/hub.prm"))
        judge(f"m = 0.01, {method}: ends", done.returncode == 0, done.stderr)
        energies[method] = summary_of(method)["objectives"][0]["value"]
    judge("m = 0.01: the same energy", abs(energies["auto"] / energies["direct"] - 1) < 1e-7, energies)


def rounding():
    """A billet that rests on a tip, with one node: rounding leaves more of the residual than the tolerance, 8e-13."""
    energies = []
    for tolerance in (1e-11, 1e-13):
        done = run("simulate", "tip", f"Newton/tolerance={tolerance}", "--overwrite", case="tip.prm")
        judge(f"on a tip, tolerance {tolerance}: ends", done.returncode == 0, done.stderr)
        energies.append(summary_of("tip")["objectives"][0]["value"])
    judge("on a tip: energy", abs(energies[1] / energies[0] - 1) < 1e-9, energies)


if __name__ == "__main__":
    main({"case.prm": prm(CASE), "tip.prm": prm(TIP)}, (steady, resumed, remeshed, nearly_plastic, rounding))
