# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A rod of radius 10 and height 20 mm is forged upright under a bell, until 2.5 mm of flash are left around its mouth, where 4 mm long elements
are wanted. Friction is so high that metal sticks to both dies: it flows as between plates, fastest in the middle. One element over the thickness
has no nodes in the middle, and the flash resists too much. With `Remeshing/gap elements` = 2.5 the flash has that many over its thickness, and the
energy comes nearer to that of many: here at least twice as near.

The thickness over the mean height of the cells is the number of layers, if all cells reach from one boundary of a layer to the next.
Usage: flash.py RETROFORGE"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import changed, judge, main, prm, run, summary_of, text_of, upsetting  # noqa: E402

THICKNESS, MOUTH, ELEMENTS = 2.5, 12.0, 2.5  # of the flash; radius beyond which there is nothing but flash
# Energy [mJ] with 5 elements over gaps (12715 tetrahedra at the end), else as here but for edges that sink by 1 %
FINE = 433135.0

DIE = {"friction": 2}
CASE = prm(changed(upsetting("cylinder", {"radius": 10, "height": 20}, 4, 20, 20 - THICKNESS, 40), {
    "Billet": {"symmetry planes": "", "sector angle": 45},
    "Die lower": DIE,
    "Die upper": {**DIE, "shape": "bell", "Bell": {"mouth radius": 8, "depth": 8, "edge radius": 2, "fillet radius": 2}},
    "Material": {"consistency": 47, "strain rate sensitivity": 0.139}, "Objectives": {"names": "energy"},
    "Design": {"parameters": "material/K"}, "Output": {"fields every": 0, "record": "false"}}))


def read_mesh(name):
    """Nodes {number: place} and tetrahedra of a Gmsh file of version 2."""
    lines = text_of(name).splitlines()

    def section(title):
        begin = lines.index("$" + title)
        return (line.split() for line in lines[begin + 2:begin + 2 + int(lines[begin + 1])])

    nodes = {int(words[0]): tuple(map(float, words[1:4])) for words in section("Nodes")}
    return nodes, [[int(k) for k in words[-4:]] for words in section("Elements") if words[1] == "4"]


def layers(output):
    nodes, cells = read_mesh(os.path.join(output, "forged.msh"))
    places = [[nodes[k] for k in cell] for cell in cells]
    heights = [max(x[2] for x in cell) - min(x[2] for x in cell) for cell in places if all(math.hypot(x[0], x[1]) > MOUTH for x in cell)]
    return THICKNESS * len(heights) / sum(heights)


def forge(output, elements):
    """@return the number of layers in the flash, and the relative error of the energy"""
    done = run("simulate", output, f"Remeshing/gap elements={elements}")
    judge(f"{output} ends", done.returncode == 0, done.stderr)
    energy = next(one["value"] for one in summary_of(output)["objectives"] if one["name"] == "energy")
    found = layers(output), energy / FINE - 1
    print(f"         {found[0]:.2f} layers, energy {100 * found[1]:+.2f} %", flush=True)
    return found


def flash():
    coarse, fine = forge("without", 0), forge("with", ELEMENTS)
    judge("the flash has the elements asked for", fine[0] >= ELEMENTS)
    judge("it has them because they are asked for", coarse[0] < ELEMENTS - 0.5)
    judge("the energy is twice as near", abs(fine[1]) < 0.5 * abs(coarse[1]))


main({"case.prm": CASE}, [flash])
