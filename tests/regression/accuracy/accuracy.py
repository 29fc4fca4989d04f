# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Increments that the program chooses (Press/increments = 0). A cylinder is upset without friction, in which the energy and the strain of
each increment are known by hand: increments bear the strain that the accuracy allows, follow the height, and are short at the end. Where a
die meets a part of the billet, the first increment follows from what it finds. Cylinder and bar go on to the same bits after a
stop, and derivatives hold. Usage: accuracy.py RETROFORGE"""
import glob
import math
import os
import shutil
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, changed, history_of, judge, main, prm, run, summary_of, upsetting  # noqa: E402

HEIGHT, STROKE, SPEED, K, M = 15.0, 7.5, 100.0, 50.0, 0.15
QUIET = {"Output": {"fields every": 0}, "Objectives": {"names": "energy"}, "Material": {"consistency": K, "strain rate sensitivity": M}}
CYLINDER = changed(upsetting("cylinder", {"radius": 10, "height": HEIGHT}, 5, HEIGHT, STROKE, 0), {
    **QUIET, "Die lower": {"friction": 0}, "Die upper": {"friction": 0}, "Remeshing": {"when": "never"},
    "Design": {"parameters": "material/m, billet/height"},
    "Check": {"free differences": "false", "steps": "1e-5, 1e-6", "taylor start": 1e-5, "taylor halvings": 2}})
BAR = changed(upsetting("cylinder", {"radius": 10, "height": 40}, 5, 20, 4, 0), {
    **QUIET, "Billet": {"rotation axis": "0, 1, 0", "rotation angle": 90, "translation": "0, 0, 10", "symmetry planes": "0, -1, 0"}})


def steps_of(output):
    strokes = [0.0] + [float(row["stroke"]) for row in history_of(output)]
    return strokes, [b - a for a, b in zip(strokes, strokes[1:])]


def by_hand(volume):
    """Of a flow whose equivalent strain rate is v/h everywhere."""
    heights = HEIGHT, HEIGHT - STROKE
    return volume * K * math.sqrt(3) ** (M + 1) * SPEED**M * (heights[1] ** -M - heights[0] ** -M) / M


def uniform():
    number = {}
    for accuracy in (1e-3, 2.5e-4):
        output = f"cylinder_{accuracy}"
        done = run("simulate", output, f"Press/accuracy={accuracy}", case="cylinder.prm")
        judge(f"{accuracy}: ends", done.returncode == 0, done.stderr)
        summary = summary_of(output)
        off = summary["objectives"][0]["value"] / by_hand(summary["volume_initial"]) - 1
        judge(f"{accuracy}: energy within it", abs(off) < accuracy, off)
        strokes, steps = steps_of(output)
        strains = [step / (HEIGHT - 0.5 * (a + b)) for step, a, b in zip(steps, strokes, strokes[1:])]
        judge(f"{accuracy}: strains are borne", max(strains) < 1.1 * math.sqrt(accuracy), max(strains))
        judge(f"{accuracy}: and not much less", max(strains) > 0.8 * math.sqrt(accuracy), max(strains))
        judge(f"{accuracy}: shorter where the cylinder is low", max(steps[len(steps) // 2:]) < 0.6 * steps[0], steps)
        judge(f"{accuracy}: short at the end", steps[-1] < 0.2 * max(steps) and strains[-1] < 0.15 * math.sqrt(accuracy), steps[-5:])
        number[accuracy] = len(steps)
    judge("a quarter of the error takes about twice the increments", 1.6 < number[2.5e-4] / number[1e-3] < 2.4, number)
    equal = run("simulate", "equal", "Press/increments=30", case="cylinder.prm")
    judge("a number that is given is kept", equal.returncode == 0 and max(steps_of("equal")[1]) < STROKE / 30 * (1 + 1e-9) and
          len(history_of("equal")) == 30, len(history_of("equal")))


def first_contact():
    energies = []
    for accuracy in (1e-3, 2e-4):
        done = run("simulate", f"bar_{accuracy}", f"Press/accuracy={accuracy}", case="bar.prm")
        judge(f"bar, {accuracy}: ends", done.returncode == 0, done.stderr)
        energies.append(summary_of(f"bar_{accuracy}")["objectives"][0]["value"])
    judge("bar: as the finer run finds", abs(energies[0] / energies[1] - 1) < 1e-2, energies)

    # The face of a die with a cavity strains what is beside the cavity only, and that more than the billet's height tells.
    done = run("simulate", "hub", "Press/stroke=2", "Objectives/names=energy", "Design/parameters=", case=os.path.join(ROOT, "prm", "tutorial", "hub", "hub.prm"))
    judge("hub: ends", done.returncode == 0, done.stderr)
    steps, longest = steps_of("hub")[1], 40 * math.sqrt(1e-3)
    judge("hub: the first increment was too long", steps[0] < 0.3 * longest and summary_of("hub")["cuts"] > 0, steps)
    judge("hub: longer ones follow", max(steps) > 1.5 * steps[0], steps)


def rollers():
    """Beside the lines on which a bar lies, gaps do not close: what does not touch does not rub, however long the increments are."""
    bending = os.path.join(ROOT, "prm", "tutorial", "bar_bending", "bar_bending.prm")
    energies = []
    for increments in (0, 90):
        done = run("simulate", f"bent_{increments}", "Press/stroke=12", f"Press/increments={increments}", "Billet/element size=6",
                   "Objectives/names=energy", "Output/fields every=0", case=bending)
        judge(f"bent bar, {increments}: ends", done.returncode == 0, done.stderr)
        energies.append(summary_of(f"bent_{increments}")["objectives"][0]["value"])
    judge("bent bar: as the finer run finds", abs(energies[0] / energies[1] - 1) < 1e-2, energies)


def resumed():
    for name in ("cylinder", "bar"):
        output = f"{name}_0.001"
        records = sorted(glob.glob(f"{output}/record/increment_*"))
        shutil.copytree(output, "stopped")
        for record in records[len(records) // 2:]:
            os.remove(record.replace(output, "stopped"))
        done = run("simulate", "stopped", "--resume", "Press/accuracy=0.001", case=f"{name}.prm")
        judge(f"{name} resumed: ends", done.returncode == 0, done.stderr)
        judge(f"{name} resumed: the same bits", summary_of("stopped")["objectives"] == summary_of(output)["objectives"] and
              steps_of("stopped") == steps_of(output))
        shutil.rmtree("stopped")


def differentiated():
    done = run("check", "check", "Press/stroke=3", "Die upper/friction=0.3", case="cylinder.prm")
    judge("derivatives pass", done.returncode == 0 and " failed" not in done.stdout, done.stdout[-2000:] + done.stderr)


main({"cylinder.prm": prm(CYLINDER), "bar.prm": prm(BAR)}, (uniform, first_contact, rollers, resumed, differentiated))
