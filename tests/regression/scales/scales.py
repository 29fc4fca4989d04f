# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The same forging in other units of length: all lengths and speeds times s, friction times s^(-m). Meshes have the same nodes, runs the
same increments and remeshings, and energies over s^3 are the same to rounding. Usage: scales.py RETROFORGE"""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import history_of, judge, main, prm, run, summary_of  # noqa: E402

EXPONENTS = (-6, -3, 4)
SENSITIVITY = 0.139  # the default m
TOLERANCE = 1e-9


def cone():
    """A blunt cone that opens upwards, as an STL file in millimetres."""
    n, low, high = 24, (10.0, 0.0), (40.0, 8.0)
    ring = [[(r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n), z) for i in range(n)] for r, z in (low, high)]
    facets = []
    for i in range(n):
        j = (i + 1) % n
        facets += [((0.0, 0.0, 0.0), ring[0][i], ring[0][j]), (ring[0][i], ring[1][i], ring[1][j]), (ring[0][i], ring[1][j], ring[0][j])]
    words = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex {!r} {!r} {!r}\n".format(*x) for x in facet) + "endloop\nendfacet\n"
                    for facet in facets)
    return f"solid cone\n{words}endsolid cone\n"


def case(exponent, billet, lower, upper, stroke, remeshing):
    """Numbers keep their decimals: 20e-3, not what 20 * 1e-3 is."""
    def length(*values):
        return ", ".join(f"{x}e{exponent}" if x else "0" for x in values)

    friction = {"friction": 0.3 * 10 ** (-SENSITIVITY * exponent)}
    return {"Billet": {**{name: length(*values) for name, values in billet.items() if name != "shape"}, "shape": billet["shape"],
                       "symmetry planes": "-1, 0, 0; 0, -1, 0"},
            "Dies": {"names": "lower, upper"},
            "Die lower": {**lower, **({"scale": 10.0 ** exponent} if lower else {}), "point": "0, 0, 0", "facing": "0, 0, 1", **friction},
            "Die upper": {"point": length(0, 0, upper), "facing": "0, 0, -1", "velocity": length(0, 0, -100), **friction},
            "Press": {"stroke": length(stroke), "increments": 4},
            "Remeshing": remeshing}


def compare(name, *scene):
    judged = []
    for exponent in (0, *EXPONENTS):
        folder = f"{name}_{exponent}"
        with open(f"{folder}.prm", "w", encoding="utf-8") as file:
            file.write(prm(case(exponent, *scene)))
        done = run("simulate", folder, case=f"{folder}.prm")
        judge(f"{folder}: ends", done.returncode == 0, done.stderr)
        if done.returncode != 0:
            return
        summary = summary_of(folder)
        judged.append((exponent, summary["objectives"][0]["value"] / 10.0 ** (3 * exponent), len(history_of(folder)), summary["mesh"]["nodes"],
                       summary["remeshings"]))
    _, energy, *counts = judged[0]
    for exponent, other, *others in judged[1:]:
        judge(f"{name}, 10^{exponent}: nodes, increments and remeshings", others == counts, (others, counts))
        judge(f"{name}, 10^{exponent}: energy", abs(other / energy - 1) < TOLERANCE, other / energy - 1)


def flat():
    compare("flat", {"shape": "box", "size": (30, 30, 30), "element size": (7.5,)}, {}, 30, 4, {"when": "never"})


def curved():
    compare("curved", {"shape": "cylinder", "radius": (15,), "height": (30,), "element size": (6,), "base centre": (0, 0, 1.4)},
            {"shape": "stl", "file": "cone.stl"}, 31.4, 6, {"when": "increments", "every": 2})


if __name__ == "__main__":
    main({"case.prm": "", "cone.stl": cone()}, (flat, curved))
