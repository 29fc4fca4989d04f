# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What an increment would take on many ranks, on paper, from parts measured on one:   model.py BUILD

Runs prm/verification/speed forward on two meshes and takes from them what each part costs per node, tetrahedron and Krylov
iteration, and what the ranks do not divide (search for contacts, record, what is read from the mesh by all). Parts are cubes of
nodes, with one layer of nodes of others around them. Messages cost latency and bytes over bandwidth; a sum over all ranks costs a
latency for each doubling of their number. Prints a line for each number of ranks: seconds of an increment, their parts, and the
share of what is not divided. Nothing here is measured on more than one rank: it says what limits, not how fast it would be."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
from case_tools import figure, run  # noqa: E402

CASE = os.path.join(HERE, "..", "speed", "case.prm")
SIZES = (1.36, 0.88)  # of elements [mm], 5k and 16k nodes
INCREMENTS = 2
TETRAHEDRA = 1e6  # of the mesh asked about
RANKS = (1, 8, 64, 1000)

LATENCY, BANDWIDTH = 2e-6, 5e9  # of a message [s]; of a rank [bytes/s]
NEIGHBOURS = 14  # ranks that a part has messages for: those a cube meets, without most corners
LEVELS, SWEEPS = 3, 4  # of multigrid, and products with its matrices on each: Chebyshev before and after
DOTS = 10  # sums over all ranks in a Krylov iteration: products with the vectors kept, on the mean
GATHERED = 24 + 8 + 8 * 5.5 / 2  # bytes per node that all ranks get of a stage: V, P, and half of the increment's strain
STAGES = 2


def measure(build, size):
    settings = {"Billet/element size": size, "Press/increments": INCREMENTS, "Press/stroke": 0.5 * INCREMENTS}
    summary, _ = run(build, "simulate", CASE, settings)
    seconds = summary["wall_seconds"]
    divided = sum(seconds.get(part, 0.0) for part in ("assembly", "preconditioner", "krylov", "checks"))
    serial = sum(seconds.get(part, 0.0) for part in ("contact", "record"))
    return {"nodes": summary["mesh"]["nodes"], "tetrahedra": summary["mesh"]["cells"], "divided": divided / INCREMENTS,
            "serial": serial / INCREMENTS, "krylov": summary["krylov_iterations"] / INCREMENTS, "newton": summary["newton_iterations"] / INCREMENTS}


def time_of(ranks, mesh, coarse):
    """Seconds of an increment by part: divided work, work on others' nodes, messages, sums, what is not divided."""
    nodes = TETRAHEDRA * mesh["nodes"] / mesh["tetrahedra"]
    own = nodes / ranks
    side = own ** (1.0 / 3.0)
    around = 0.0 if ranks == 1 else (side + 2.0) ** 3 - own  # nodes of others that a part reads
    divided = mesh["divided"] / mesh["nodes"] * own
    # A rank visits the cells between its part and the layer: half of what belongs to the layer, in assembly, a third of the work.
    doubled = mesh["divided"] / mesh["nodes"] * 0.5 * around / 3.0
    # What is not divided grows as it did between the two meshes, at least as a surface.
    power = max(2.0 / 3.0, math.log(mesh["serial"] / coarse["serial"]) / math.log(mesh["nodes"] / coarse["nodes"]))
    serial = mesh["serial"] * (nodes / mesh["nodes"]) ** power
    if ranks == 1:
        return [divided, 0.0, 0.0, 0.0, serial]
    exchanges = mesh["krylov"] * (2 + LEVELS * SWEEPS) + 4 * mesh["newton"]
    messages = exchanges * (NEIGHBOURS * LATENCY + 24.0 * around / BANDWIDTH) + STAGES * GATHERED * nodes / BANDWIDTH
    sums = mesh["krylov"] * DOTS * LATENCY * 2.0 * (ranks - 1).bit_length()
    return [divided, doubled, messages, sums, serial]


def main():
    build = sys.argv[1]
    coarse, mesh = (measure(build, size) for size in SIZES)
    print(f"{mesh['nodes']} nodes, {mesh['tetrahedra']} tetrahedra: {mesh['divided']:.3g} s of an increment are divided, {mesh['serial']:.3g} s are not; "
          f"{mesh['krylov']:.0f} Krylov iterations (of {coarse['nodes']} nodes: {coarse['divided']:.3g}, {coarse['serial']:.3g} s)")
    print("\n| ranks | s | divided | others' nodes | messages | sums | not divided | times faster |\n" + "| --- " * 8 + "|")
    one = sum(time_of(1, mesh, coarse))
    for ranks in RANKS:
        parts = time_of(ranks, mesh, coarse)
        print(f"| {ranks} | {sum(parts):.3g} | " + " | ".join(f"{part:.2g}" for part in parts) + f" | {one / sum(parts):.3g} |")
        figure(f"faster_on_{ranks}", one / sum(parts))
    figure("serial_share_of_work", time_of(1, mesh, coarse)[-1] / one)


if __name__ == "__main__":
    main()
