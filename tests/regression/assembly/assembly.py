# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Whole runs by quadrature (Discretization/assembly = quadrature) and in closed form, which share no code in the cells. Proved, of both pairs:
- a cylinder between a plane and a tilted one, with friction, a power law and a remeshing in the middle, and a coarse billet between tripods: energies
  agree to 1e-10, and so do a mean strain and a fold; gradients by billet, dies, friction and metal to 1e-8;
- on the cylinder, quadratic geometry (Discretization/geometry degree = 2), whose nodes in the middles of edges lie halfway, changes none of that;
- pictures of its end show the same strain rates and stresses, whichever way cells are computed;
- by quadrature alone, adjoint and direct method agree to 1e-10, replayed differences to 1e-6, and remainders fall with order two;
- on two ranks, energies agree to nine digits. Usage: assembly.py RETROFORGE"""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import ROOT, changed, command, judge, main, prm, run, start, summary_of, upsetting  # noqa: E402

sys.path.insert(0, str(ROOT / "contrib"))
from retroforge_report import vtu  # noqa: E402

# Equilibria are compared, not where iterations stopped.
TIGHT = {"Newton": {"tolerance": 1e-12}, "Output": {"fields every": 0}}
CYLINDER = changed(upsetting("cylinder", {"radius": 12, "height": 20}, 9, 20, 4, 4), {
    **TIGHT, "Die upper": {"facing": "0.04, 0.03, -1"}, "Remeshing": {"when": "increments", "every": 2}, "Output": {"fields every": 4},
    "Contact": {"penetration": 3e-6},  # a penalty that leaves forces their digits
    "Objectives": {"names": "energy, strain, fold"}, "Objective strain": {"type": "mean strain"}, "Objective fold": {"type": "fold"},
    "Design": {"parameters": "billet/radius, dies/friction, material/m"},
    "Check": {"free differences": "false", "steps": "1e-5, 1e-6, 1e-7", "taylor start": 1e-4}})
TRIPOD = changed(
    {"Billet": {"shape": "cylinder", "radius": 20, "height": 60, "element size": 9, "sector angle": 60},
     "Dies": {"names": "lower, upper"},
     **{f"Die {name}": {"shape": "tripod", "point": f"0, 0, {z}", "facing": f"0, 0, {facing}", "friction": 0.4, "Tripod": {"depth": 8.5}}
        for name, z, facing in (("lower", 8.5, 1), ("upper", 51.5, -1))},
     "Material": {"consistency": 47, "strain rate sensitivity": 0.139}, "Press": {"stroke": 8, "increments": 4},
     "Design": {"parameters": "billet/radius, dies/friction, die upper/depth"}},
    {**TIGHT, "Die upper": {"velocity": "0, 0, -100"}})


WAYS = {"closed form": ("Discretization/assembly=closed form",), "quadrature": ("Discretization/assembly=quadrature",),
        "quadratic geometry": ("Discretization/assembly=quadrature", "Discretization/geometry degree=2")}


def furthest(one, two):
    """Largest relative difference of objectives, and of their gradients."""
    values = [abs(b["value"] / a["value"] - 1) for a, b in zip(one["objectives"], two["objectives"])]
    gradients = [abs(b["gradient"][name] / value - 1) for a, b in zip(one["parameters"], two["parameters"])
                 for name, value in a["gradient"].items()]
    return max(values), max(gradients), len(values), len(gradients)


def agree(case, element, n_values, n_gradients, ways=("closed form", "quadrature")):
    name = f"{case} {element}"
    runs = [run("gradient", f"{name} {way}", f"Discretization/element={element}", *WAYS[way], case=f"{case}.prm") for way in ways]
    judge(f"{name} ends", all(done.returncode == 0 for done in runs), "".join(done.stdout[-500:] + done.stderr for done in runs))
    summaries = [summary_of(f"{name} {way}") for way in ways]
    for way, summary in zip(ways[1:], summaries[1:]):
        value, gradient, values, gradients = furthest(summaries[0], summary)
        judge(f"{name} {way}: all of it is compared", (values, gradients) == (n_values, n_gradients), (values, gradients))
        judge(f"{name} {way}: values to 1e-10", value < 1e-10, value)
        judge(f"{name} {way}: gradients to 1e-8", gradient < 1e-8, gradient)
    return summaries


def alike(name):
    """Whether the last pictures of a case show the same in their cells, in single precision."""
    expected, *found = (vtu.read(os.path.join(f"{name} {way}", "fields_000004.vtu")).cell_data for way in WAYS)
    furthest = max(np.abs(fields[field] - expected[field]).max() / np.abs(expected[field]).max() for fields in found for field in expected)
    judge(f"{name}: pictures of cells", len(expected) == 4 and furthest < 1e-6, (list(expected), furthest))


def cylinder():
    for element in ("mini", "P2-P1"):
        summaries = agree("cylinder", element, 3, 9, tuple(WAYS))
        judge(f"cylinder {element}: remeshed", all(s["remeshings"] == 1 for s in summaries), [s["remeshings"] for s in summaries])
        alike(f"cylinder {element}")


def tripod():
    for element in ("mini", "P2-P1"):
        agree("tripod", element, 1, 3)


def derivatives():
    for element in ("mini", "P2-P1"):
        done = run("check", f"checked {element}", "Discretization/assembly=quadrature", f"Discretization/element={element}", case="cylinder.prm")
        judge(f"{element}: adjoint, tangent, replayed differences and orders", done.returncode == 0, done.stdout[-3000:] + done.stderr)


def on_two_ranks():
    for element in ("mini", "P2-P1"):
        words = ["mpirun", "-np", "2", *command("simulate", f"ranks {element}", "Discretization/assembly=quadrature",
                                                f"Discretization/element={element}", case="cylinder.prm")]
        done = start(words)
        judge(f"{element}: two ranks end", done.returncode == 0, done.stdout[-500:] + done.stderr)
        one, two = (summary_of(name)["objectives"][0]["value"] for name in (f"cylinder {element} quadrature", f"ranks {element}"))
        judge(f"{element}: two ranks agree", abs(two / one - 1) < 1e-9, two / one - 1)


main({"cylinder.prm": prm(CYLINDER), "tripod.prm": prm(TRIPOD)}, (cylinder, tripod, derivatives, on_two_ranks))
