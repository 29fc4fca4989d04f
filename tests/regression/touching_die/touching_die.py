# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The whole hub of the tutorial, coarse, whose die begins on the metal: edges of the billet stand on flats of the die, at a gap of zero, where
contact has a kink. Proved: adjoint and direct method take it on the same side, and agree through all remeshings to 1e-6, whether increments
are held or follow the state.
Usage: touching_die.py RETROFORGE"""
import os
import shutil
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, judge, main, run, summary_of  # noqa: E402

PARAMETERS = ("die upper/offset", "billet/radius")
SCENE = ("Billet/element size=5", "Newton/tolerance=1e-12", "Adjoint/tolerance=1e-10", "Objectives/names=energy", "Output/fields every=0",
         "Design/parameters=" + ", ".join(PARAMETERS))


def slopes(increments, method):
    done = run("gradient", "hub", *SCENE, f"Adjoint/remeshings={increments}", f"Adjoint/method={method}", "--resume", case="hub.prm")
    judge(f"{increments}, {method}", done.returncode == 0, done.stderr)
    found = {parameter["name"]: parameter["gradient"]["energy"] for parameter in summary_of("hub")["parameters"]}
    return [found[name] for name in PARAMETERS]


def both_methods():
    shutil.copytree(ROOT / "prm/tutorial/hub", ".", dirs_exist_ok=True)
    done = run("simulate", "hub", *SCENE, case="hub.prm")
    judge("simulate", done.returncode == 0, done.stderr)
    judge("remeshed on the way", summary_of("hub")["remeshings"] > 10)
    for increments in ("hold", "follow"):
        adjoint, direct = slopes(increments, "adjoint"), slopes(increments, "direct")
        judge(f"{increments}: the same", max(abs(a / b - 1) for a, b in zip(adjoint, direct)) < 1e-6, (adjoint, direct))


main({}, [both_methods])
