# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Runs with quadratic velocities (Discretization/element = P2-P1). Proved:
- between a plane and a tilted one, with friction, a power law and a remeshing in the middle, adjoint and direct method agree to
  1e-10 for objectives that see the velocity in different ways (energy, mean strain, fold), replayed differences to 1e-6,
  by the positions of all nodes, the billet, friction and material; remainders fall with order two; dies are felt by the
  middles of edges (the force differs from that of the mini element by far more than tolerances);
- stopped and resumed, by the same bits; on two ranks, energies to nine digits and gradients to 2e-5: nodes of the mesh carry hardly any load,
  and whether one of them counts as pressed is a matter of the last digits;
- a cube crushed by half in 50 increments keeps its volume to 5e-5;
- on a mesh of 98 cells the energy of the cube is nearer to that of a fine mesh than the mini element's on one of eight times as many;
- the contact pressure, on a penalty that leaves its digits, has these derivatives, too, between planes and in a round mouth; on a fine
  mesh it is the mini element's to 1 %. Usage: taylor_hood.py RETROFORGE"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from block_meshes import msh_of_cube  # noqa: E402
from whole_runs import changed, command, cube, judge, main, prm, run, start, summary_of, upsetting  # noqa: E402

QUADRATIC = {"Discretization": {"element": "P2-P1"}}
CYLINDER = changed(upsetting("cylinder", {"radius": 12, "height": 20}, 9, 20, 4, 4), {
    **QUADRATIC, "Die upper": {"facing": "0.04, 0.03, -1"}, "Remeshing": {"when": "increments", "every": 2},
    "Objectives": {"names": "energy, strain, fold"}, "Objective strain": {"type": "mean strain"}, "Objective fold": {"type": "fold"},
    "Design": {"parameters": "billet/radius, dies/friction, material/m"}, "Output": {"fields every": 2},
    # Forces are the penalty times differences of speeds: a softer one leaves energies the digits that differences ask for.
    "Contact": {"penetration": 1e-5},
    "Check": {"free differences": "false", "steps": "1e-5, 1e-6, 1e-7", "taylor start": 1e-4}})
PRESSED = changed(CYLINDER, {"Objectives": {"names": "strain, fold, contact pressure"}, "Contact": {"penetration": 1e-3}})
IN_MOUTH = changed(PRESSED, {
    "Billet": {"element size": 6}, "Press": {"stroke": 2.1, "increments": 3}, "Design": {"parameters": "billet/radius, dies/friction"},
    "Die upper": {"shape": "bell", "point": "0, 0, 20.2", "facing": "0, 0, -1", "Bell": {
        "mouth radius": 9, "outer radius": 30, "depth": 5, "draft angle": 40, "edge radius": 6, "fillet radius": 4}}})
CUBE = changed(cube(20, 5, 10, 50), {"Remeshing": {"when": "never"}, "Output": {"fields every": 0}})


def of_file(file, element):
    """The cube whole, on a mesh made here: elements are compared on meshes that no other program chooses."""
    whole = changed(cube(20, 0, 6, 10), {"Discretization": {"element": element}, "Remeshing": {"when": "never"}, "Output": {"fields every": 0}})
    return {**whole, "Billet": {"shape": "file", "file name": file}}


def energy_of(output):
    return next(row["value"] for row in summary_of(output)["objectives"] if row["name"] == "energy")


def pressure_of(element):
    name = f"pressure {element}"
    settings = ("Objectives/names=contact pressure", "Objective contact pressure/sharpness=8", f"Discretization/element={element}")
    judge(name, run("simulate", name, *settings, case="fine mini.prm").returncode == 0)
    return summary_of(name)["objectives"][0]["value"]


def derivatives():
    done = run("check", "checked", case="cylinder.prm")
    judge("adjoint, tangent, replayed differences and orders", done.returncode == 0, done.stdout[-3000:] + done.stderr)
    summary = summary_of("checked")
    judge("three objectives by nodes and three parameters", len(summary["check"]) == 12, len(summary["check"]))
    judge("remeshed", summary["remeshings"] == 1, summary["remeshings"])


def felt_by_middles():
    mini = run("simulate", "mini", "Discretization/element=mini", case="cylinder.prm")
    energies = [energy_of(name) for name in ("checked", "mini")]
    judge("another element, another energy", mini.returncode == 0 and 0.002 < abs(energies[0] / energies[1] - 1) < 0.1, energies)


def resumed():
    whole = run("gradient", "whole", case="cylinder.prm")
    cut = run("gradient", "cut", "Press/stroke=3", "Press/increments=3", case="cylinder.prm")
    resumed_run = run("gradient", "cut", "--resume", case="cylinder.prm")
    results = [(s["objectives"], s["parameters"]) for s in (summary_of("whole"), summary_of("cut"))]
    judge("resumed: the same bits", whole.returncode == cut.returncode == resumed_run.returncode == 0 and results[0] == results[1],
          resumed_run.stderr + str(results))


def on_two_ranks():
    # Equilibria are compared, not where Newton's method stopped.
    tight = "Newton/tolerance=1e-11"
    run("gradient", "one", tight, case="cylinder.prm")
    words = ["mpirun", "-np", "2", *command("gradient", "ranks", tight, case="cylinder.prm")]
    done = start(words)
    judge("two ranks end", done.returncode == 0, done.stdout[-500:] + done.stderr)
    far = abs(energy_of("ranks") / energy_of("one") - 1)
    judge("two ranks agree: energy", far < 1e-9, far)
    for one, two in zip(summary_of("one")["parameters"], summary_of("ranks")["parameters"]):
        for objective, value in one["gradient"].items():
            far = abs(two["gradient"][objective] / value - 1)
            judge(f"two ranks agree: d {objective} / d {one['name']}", far < 2e-5, far)


def volume():
    done = run("simulate", "crushed", case="cube.prm")
    summary = summary_of("crushed")
    lost = abs(1 - summary["volume_final"] / summary["volume_initial"])
    judge("crushed by half, the volume stays", done.returncode == 0 and summary["increments"] == 50 and lost < 5e-5, lost)


def accuracy():
    energy = {}
    for name in ("coarse P2-P1", "fine mini", "finest mini"):
        judge(name, run("simulate", name, case=f"{name}.prm").returncode == 0)
        energy[name] = energy_of(name)
    # The mini element's error falls with the square of the mesh size or slower: at most this far below its finest value is the limit.
    limit = energy["finest mini"] - (energy["fine mini"] - energy["finest mini"])
    errors = {name: energy[name] / limit - 1 for name in energy}
    judge("nearer with an eighth of the cells", abs(errors["coarse P2-P1"]) < abs(errors["fine mini"]), errors)


def pressure():
    for name in ("pressed", "pressed in a mouth"):
        done = run("check", name, case=f"{name}.prm")
        judge(f"{name}: adjoint, tangent, replayed differences and orders", done.returncode == 0, done.stdout[-3000:] + done.stderr)
        judge(f"{name}: remeshed", summary_of(name)["remeshings"] > 0, summary_of(name)["remeshings"])
    values = [pressure_of(element) for element in ("mini", "P2-P1")]
    judge("the same pressure as of the mini element", abs(values[1] / values[0] - 1) < 0.01, values)


main({"cylinder.prm": prm(CYLINDER), "pressed.prm": prm(PRESSED), "pressed in a mouth.prm": prm(IN_MOUTH), "cube.prm": prm(changed(CUBE, QUADRATIC)),
      "coarse P2-P1.prm": prm(of_file("coarse.msh", "P2-P1")), "fine mini.prm": prm(of_file("fine.msh", "mini")),
      "finest mini.prm": prm(of_file("finest.msh", "mini")), "coarse.msh": msh_of_cube(3, 20.0), "fine.msh": msh_of_cube(6, 20.0),
      "finest.msh": msh_of_cube(12, 20.0)},
     (derivatives, felt_by_middles, resumed, on_two_ranks, volume, accuracy, pressure))
