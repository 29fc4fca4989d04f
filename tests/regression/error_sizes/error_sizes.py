# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Runs with Remeshing/sizes = error: the bar of the tutorial, bent in its middle, its ends at rest. Proved:
- the mesh is remade after the first increment, with about as many nodes as a uniform one has (0.6 to 1.5 times);
- with these the energy, which is too large with any mesh, is below that of a uniform mesh with 1.7 times the nodes;
- adjoint and direct method agree, and replayed differences across that remeshing, by all nodes and m;
- stopped in the middle and resumed, by the same bits; on two ranks as many nodes, and energies to seven digits;
- a largest size below the element size, and a kind of sizes that is none, are refused in one sentence each.
Usage: error_sizes.py RETROFORGE"""
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, command, judge, main, run, start, summary_of  # noqa: E402

BAR = str(ROOT / "prm" / "tutorial" / "bar_bending" / "bar_bending.prm")
COMMON = ("Billet/element size=6", "Press/stroke=0.75", "Press/increments=3", "Remeshing/chord error=2",
          "Objectives/names=energy, force, largest strain",
          "Design/parameters=material/m", "Output/fields every=0")  # rollers ask for no refinement
ERROR = (*COMMON, "Remeshing/sizes=error")
SOFT = ("Material/regularising strain rate=0.05", "Contact/slip regularisation=0.1")  # can be solved to the last digits


def energy_of(output):
    return next(row["value"] for row in summary_of(output)["objectives"] if row["name"] == "energy")


def remeshed(log):
    """(increment before, nodes) of each remeshing that a run told."""
    found, last = [], 0
    for line in log.split("\n"):
        increment, mesh = re.match(r"\s+(\d+)\s+[\d.]+\s", line), re.search(r"remeshed: (\d+) nodes", line)
        last = int(increment.group(1)) if increment else last
        if mesh:
            found.append((last, int(mesh.group(1))))
    return found


def sizes():
    runs = {name: run("gradient", name, *words, case=BAR)
            for name, words in {"whole": ERROR, "uniform": (*COMMON, "Remeshing/sizes=uniform"),
                                "finer": (*COMMON, "Remeshing/sizes=uniform", "Billet/element size=4")}.items()}
    judge("runs end", all(done.returncode == 0 for done in runs.values()), [done.stdout[-300:] + done.stderr for done in runs.values()])
    meshes, uniform = remeshed(runs["whole"].stdout), summary_of("uniform")["mesh"]["nodes"]
    judge("remeshed after the first increment", meshes and meshes[0][0] == 1, meshes)
    judge("about as many nodes", 0.6 * uniform < meshes[0][1] < 1.5 * uniform, (uniform, meshes))
    judge("uniform: with more nodes", summary_of("finer")["mesh"]["nodes"] > 1.7 * meshes[0][1], summary_of("finer")["mesh"]["nodes"])
    energies = [energy_of(name) for name in ("whole", "finer", "uniform")]
    judge("energies: nearer than 1.7 times as many uniform ones", energies[0] < energies[1] < energies[2], energies)


def derivatives():
    done = run("check", "checked", *ERROR, "Check/free differences=false", "Check/steps=1e-6", *SOFT, "Check/taylor start=1e-4", "Check/taylor halvings=2", case=BAR)
    judge("adjoint, tangent, replayed differences and orders", done.returncode == 0, done.stdout[-3000:] + done.stderr)
    judge("across a remeshing", summary_of("checked")["remeshings"] >= 1, summary_of("checked")["remeshings"])


def resumed():
    cut = run("gradient", "cut", *ERROR, "Press/stroke=0.5", "Press/increments=2", case=BAR)
    resumed_run = run("gradient", "cut", *ERROR, "--resume", case=BAR)
    results = [(s["objectives"], s["parameters"]) for s in (summary_of("whole"), summary_of("cut"))]
    judge("resumed: the same bits", cut.returncode == resumed_run.returncode == 0 and results[0] == results[1], resumed_run.stderr + str(results))


def stopped_before():
    """After the first increment, so that the sizes follow from what the record holds."""
    cut = run("gradient", "early", *ERROR, "Press/stroke=0.25", "Press/increments=1", case=BAR)
    resumed_run = run("gradient", "early", *ERROR, "--resume", case=BAR)
    results = [(s["objectives"], s["parameters"]) for s in (summary_of("whole"), summary_of("early"))]
    judge("resumed before the remeshing: the same bits", cut.returncode == resumed_run.returncode == 0 and results[0] == results[1],
          resumed_run.stderr + str(results))


def on_two_ranks():
    done = start(["mpirun", "-np", "2", *command("simulate", "ranks", *ERROR, case=BAR)])
    judge("two ranks end", done.returncode == 0, done.stdout[-500:] + done.stderr)
    far = abs(energy_of("ranks") / energy_of("whole") - 1)
    judge("two ranks agree", far < 1e-7, far)


def refused():
    for setting, words in (("Remeshing/largest size=0.5", ("largest size", "1")), ("Remeshing/sizes=objective", ("sizes", "uniform, dies, error"))):
        done = run("simulate", "refused", *ERROR, setting, case=BAR)
        judge(f"refused: {setting}", done.returncode != 0 and all(word in done.stderr for word in words) and not os.path.exists("refused"), done.stderr)


if __name__ == "__main__":
    main({}, (sizes, derivatives, resumed, stopped_before, on_two_ranks, refused))
