# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What a run forged is the billet of another: with its patches, planes of symmetry and all digits. The metal has no memory, so that a
stroke forged in two cases takes the energy of the stroke forged in one, whose dies go on where the first ones stopped; remeshed or not, on
one rank or two. The surface is closed, and encloses the part's volume. Nobody removes the billet that it reads.
Usage: forged_billet.py RETROFORGE"""
import os
import struct
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import changed, command, contents, judge, main, prm, run, start, summary_of, text_of, upsetting  # noqa: E402

ROUND = {"Objectives": {"names": "energy, round"}, "Objective round": {"type": "cylinder distance", "patches": "side"}}
# The penalty follows from the height, which is another one in the second case.
WHOLE = changed(upsetting("cylinder", {"radius": 10, "height": 15}, 4, 15, 3, 6), {
    **ROUND, "Contact": {"penalty": 4}, "Newton": {"tolerance": 1e-12}, "Output": {"fields every": 0}})
BEGUN = changed(WHOLE, {"Press": {"stroke": 2, "increments": 4}})
FINISHED = changed(BEGUN, {
    "Die upper": {"point": "0, 0, 13"}, "Press": {"stroke": 1, "increments": 2}, "Output": {"record": "false"}})
FINISHED["Billet"] = {"shape": "file", "file name": "begun/forged.msh", "symmetry patches": "symmetry 1, symmetry 2"}


def values(output):
    return {objective["name"]: objective["value"] for objective in summary_of(output)["objectives"]}


def nodes_of(file):
    lines = text_of(file).splitlines()
    first = lines.index("$Nodes") + 2
    return lines[first:first + int(lines[first - 1])]


def in_two_cases(*settings, ranks=1):
    for name in ("whole", "begun", "finished"):
        words = command("simulate", name, "--overwrite", *settings, case=f"{name}.prm")
        done = start((["mpirun", "-np", str(ranks)] if ranks > 1 else []) + words)
        judge(f"{name} {settings} on {ranks}: ends", done.returncode == 0, done.stderr)
    whole, begun, finished = map(values, ("whole", "begun", "finished"))
    off = abs((begun["energy"] + finished["energy"]) / whole["energy"] - 1.0)
    judge(f"energies add up, {settings} on {ranks}", off < 1e-9, f"{off:.1e}")
    off = abs(finished["round"] / whole["round"] - 1.0)
    judge(f"and the shape is the same, {settings} on {ranks}", off < 1e-6, f"{off:.1e}")
    judge("the billet has the nodes of the part", nodes_of("finished/billet.msh") == nodes_of("begun/forged.msh"))
    judge("and its volume", abs(summary_of("finished")["volume_initial"] / summary_of("begun")["volume_final"] - 1.0) < 1e-14)


def kept():
    in_two_cases("Remeshing/when=never")


def remeshed():
    in_two_cases("Remeshing/when=increments", "Remeshing/every=3", "Discretization/element=P2-P1")
    judge("remeshed", [summary_of(name)["remeshings"] for name in ("whole", "begun", "finished")] == [1, 1, 0])


def on_two_ranks():
    in_two_cases("Remeshing/when=never", ranks=2)


def surface():
    with open("begun/forged.stl", "rb") as file:
        data = file.read()
    facets = np.frombuffer(data[84:], np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("end", "<u2")]))
    judge("facets", len(facets) == struct.unpack("<I", data[80:84])[0])
    x = facets["corners"].astype(float)
    edges = {}
    for triangle in facets["corners"]:
        points = [corner.tobytes() for corner in triangle]
        for a, b in zip(points, points[1:] + points[:1]):
            edges[a, b] = edges.get((a, b), 0) + 1
    judge("closed", all(n == 1 and edges.get((b, a)) == 1 for (a, b), n in edges.items()))
    volume = np.einsum("ij,ij->i", x[:, 0], np.cross(x[:, 1], x[:, 2])).sum() / 6
    judge("encloses the part", abs(volume / summary_of("begun")["volume_final"] - 1.0) < 1e-6, volume)


def is_not_removed():
    before = contents("begun")
    done = run("simulate", "begun", "--overwrite", case="finished.prm")
    judge("what a run reads is not removed", done.returncode == 1 and "Billet/file name: is begun/forged.msh" in done.stderr and
          done.stderr.count("\n") == 1 and contents("begun") == before, done.stderr)


main({"whole.prm": prm(WHOLE), "begun.prm": prm(BEGUN), "finished.prm": prm(FINISHED)},
     (kept, on_two_ranks, remeshed, surface, is_not_removed))
