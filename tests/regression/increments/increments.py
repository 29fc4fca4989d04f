# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""`Adjoint/remeshings`, used as the manual says, on the hub of the tutorial with coarse elements, whose quality has meshes made anew. Proved:
- the forging is the same with both values: its history to the last digit;
- slopes by the offset of the die and the radius differ by more than 1 %, and what is left out is `follow`;
- with `follow` adjoint and direct method agree to 1e-6, and a finished record, resumed, has the slope of the value it is resumed with;
- where meshes are made anew at prescribed strokes, these are held, and with `follow` meshes follow the shape all the same: slopes
  of their own, which the direct method has, too;
- `check` with `follow` says which slope the adjoint is, and that with `hold` does not.
Usage: increments.py RETROFORGE"""
import os
import shutil
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, judge, main, run, summary_of, text_of  # noqa: E402

PARAMETERS = ("die upper/offset", "billet/radius")
SCENE = ("Billet/element size=6", "Press/stroke=4", "Objectives/names=energy", "Output/fields every=0",
         "Design/parameters=" + ", ".join(PARAMETERS))
SAYS = "the adjoint is that of the trend"


def forged(word, output, *settings):
    done = run(word, output, *SCENE, *settings, case="hub.prm")
    judge(f"{word} {output}", done.returncode == 0, done.stderr)
    return done


def slopes(output):
    found = {parameter["name"]: parameter["gradient"]["energy"] for parameter in summary_of(output)["parameters"]}
    return [found[name] for name in PARAMETERS]


def apart(a, b):
    return max(abs(x / y - 1) for x, y in zip(a, b))


def increments():
    shutil.copytree(ROOT / "prm/tutorial/hub", ".", dirs_exist_ok=True)
    forged("gradient", "plain")
    forged("gradient", "hold", "Adjoint/remeshings=hold")
    forged("gradient", "follow", "Adjoint/remeshings=follow")
    forged("gradient", "direct", "Adjoint/remeshings=follow", "Adjoint/method=direct")
    judge("remeshed on the way", summary_of("follow")["remeshings"] > 1)
    judge("the same forging", text_of("hold", "history.csv") == text_of("follow", "history.csv"))
    hold, follow = slopes("hold"), slopes("follow")
    judge("left out, follow", slopes("plain") == follow)
    judge("slopes of their own", min(abs(x / y - 1) for x, y in zip(hold, follow)) > 0.01, (hold, follow))
    judge("direct method", apart(follow, slopes("direct")) < 1e-6, (follow, slopes("direct")))
    forged("gradient", "hold", "Adjoint/remeshings=follow", "--resume")
    judge("resumed", apart(follow, slopes("hold")) < 1e-9, (follow, slopes("hold")))
    at_strokes = ("Remeshing/when=increments", "Remeshing/every=3")
    for value in ("hold", "follow"):
        forged("gradient", "every " + value, f"Adjoint/remeshings={value}", *at_strokes)
    forged("gradient", "every direct", "Adjoint/method=direct", *at_strokes)
    judge("prescribed strokes, the same forging", text_of("every hold", "history.csv") == text_of("every follow", "history.csv"))
    judge("their slopes", apart(slopes("every hold"), slopes("every follow")) > 1e-3, (slopes("every hold"), slopes("every follow")))
    judge("direct method at prescribed strokes", apart(slopes("every follow"), slopes("every direct")) < 1e-6)


def said_by_check():
    few = ("Press/stroke=2", "Check/steps=1e-6", "Check/taylor halvings=2")
    for value in ("hold", "follow"):
        done = run("check", "check " + value, *SCENE, f"Adjoint/remeshings={value}", *few, case="hub.prm")
        judge(f"check, {value}", "check of" in done.stdout and (SAYS in done.stdout) == (value == "follow"),
              done.stdout[-2000:] + done.stderr)


main({}, [increments, said_by_check])
