# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Speeds of dies. Two dies that close at 100 mm/s do the same work, however their motion is shared between them and whichever leads: what
the metal feels is the speed at which they close. Without friction the law of a slow press is that of a fast one, F ~ v^m, unless a
regularising strain rate is asked for that the press does not reach. Usage: speeds.py RETROFORGE"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import whole_runs  # noqa: E402
from whole_runs import history_of, judge, prm, run, summary_of  # noqa: E402

CLOSING, INCREMENTS, SENSITIVITY = 18.0, 16, 0.139
SHARED = {"Output": {"fields every": 0, "record": "false"}, "Newton": {"tolerance": "1e-10"}}
CASE = prm(whole_runs.changed(whole_runs.cube(40, 5, CLOSING, INCREMENTS), SHARED))
SLOW = prm(whole_runs.changed(whole_runs.cube(40, 20, 4, 4), {**SHARED, "Die lower": {"friction": 0}, "Die upper": {"friction": 0}}))


def shared(lower, leading):
    """Settings of dies of which the lower one takes part of the closing speed, 100 mm/s."""
    upper = 100 - lower
    path = CLOSING * (lower if leading == "lower" else upper) / 100
    return (f"Die lower/velocity=0, 0, {lower}", f"Die upper/velocity=0, 0, {-upper}", f"Press/leading die={leading}", f"Press/stroke={path!r}")


def work_of(name, *settings, case="case.prm"):
    done = run("simulate", name, *settings, case=case)
    if done.returncode:
        raise ValueError(done.stderr)
    return summary_of(name)["objectives"][0]["value"], abs(float(history_of(name)[-1]["force"]))


def parts_of_one_motion():
    energy, force = work_of("one")
    for lower in (10, 30, 40, 50, 70):
        for leading in ("lower", "upper"):
            e, f = work_of(f"{lower}_{leading}", *shared(lower, leading))
            judge(f"{lower} % of the motion by the lower die, {leading} die leads: energy {e / energy - 1:.1e}, force {f / force - 1:.1e} off",
                  abs(e / energy - 1) < 1e-6 and abs(f / force - 1) < 1e-4)
    apart = (*shared(40, "lower"), "Die upper/point=0, 0, 40.5")  # so that nodes arrive through the layer
    soft, sharp = work_of("layer", *apart)[0], work_of("no_layer", *apart, "Contact/layer=0")[0]
    judge(f"the layer counts where nodes arrive: energy {soft / sharp - 1:.1e} off", 1e-6 < abs(soft / sharp - 1) < 0.02)


def derivatives():
    """Adjoint, tangent and replayed differences agree where the slower die leads."""
    done = run("check", "checked", *shared(40, "lower"), "Design/parameters=die upper/speed, die lower/speed, dies/friction, material/K",
               "Press/increments=3")
    judge("check of two dies that move", done.returncode == 0, done.stdout + done.stderr)


def slow_press():
    _, fast = work_of("fast", case="slow.prm")
    for speed in (1.0, 0.01, 1e-4):
        _, force = work_of(f"at_{speed}", f"Die upper/velocity=0, 0, {-speed}", case="slow.prm")
        law = fast * (speed / 100) ** SENSITIVITY
        judge(f"press at {speed} mm/s: force {force / law - 1:.1e} off the law", abs(force / law - 1) < 1e-3)
    done = run("simulate", "regularised", "Die upper/velocity=0, 0, -0.01", "Material/regularising strain rate=1e-3", case="slow.prm")
    judge("a regularising rate beyond the scene's is told", "warning: Material/regularising strain rate = 0.001" in done.stdout, done.stdout)


whole_runs.main({"case.prm": CASE, "slow.prm": SLOW}, (parts_of_one_motion, derivatives, slow_press))
