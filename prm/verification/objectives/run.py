#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Every objective by every parameter:  run.py BUILD flat | curved | turned | quick | ranks | several | many | methods

flat: a tilted plane, nodes that arrive. curved: the tripod, contact that changes, two remeshings. turned: the least temperature, no node of
a plane of symmetry over an edge of a die. quick: the same with
fewer parameters and steps. ranks: on one, two and three. several: what three objectives at once cost. many: what many
parameters cost. methods: adjoint against direct method by the number of parameters."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

FLAT = os.path.join(HERE, "..", "tilted_die", "case.prm")
CURVED = os.path.join(HERE, "..", "..", "reproduction", "laroussi_2003", "tripod", "case.prm")
PATH = ["energy", "mean effort", "late force", "maximum effort", "fold", "dimensionless fold", "contact pressure",
        "largest hydrostatic pressure", "largest shear", "die wear", "largest wear"]
END = ["mean strain", "strain variance", "maximum strain", "damage", "largest temperature", "least temperature",
       "temperature spread", "die temperature", "volume", "filling", "unfilled volume", "shape distance", "cylinder distance",
       "mean radius"]
NAMED = {"Objective late force/type": "mean effort", "Objective late force/by": "force",
         "Objective largest wear/type": "die wear", "Objective largest wear/wear": "largest"}
# Heat that the mechanics does not see: what other objectives are is as without it.
HOT = {"Material/damage": "Latham-Cockcroft", "Material/temperature": 1000, "Heat/heating": "conduction", "Heat/heat capacity": 0.1,
       "Heat/conductivity": 1, "Heat/contact film": 0.3, "Heat/die effusivity": 0.5, "Heat/contact gap": 1,
       "Die lower/temperature": 200, "Die upper/temperature": 300}
# Pressing times sliding is a penalty times a small difference, twice.
TIGHT = {"Newton/tolerance": 1e-13, "Adjoint/tolerance": 1e-13}
HOT_PARAMETERS = ["billet/temperature", "heat/contact film", "heat/heat capacity", "die upper/temperature"]
COARSE = {"Billet/element size": 8, "Press/increments": 5, "Press/stroke": 5, "Remeshing/when": "increments",
          "Remeshing/every": 2, "Contact/penetration": 1e-3, "Contact/slip regularisation": 0.1,
          "Material/regularising strain rate": 0.1, "Output/fields every": 0, "Output/record": "false",
          "Check/free differences": "false", "Check/taylor start": 3e-4, "Check/taylor halvings": 4}
FLAT_PARAMETERS = ["material/K", "material/m", "material/e0", "contact/rho", "contact/v0", "dies/friction", "die upper/speed",
                   "die upper/offset", "billet/stretch"]
CURVED_PARAMETERS = ["billet/radius", "material/K", "material/m", "dies/friction", "die upper/speed", "die upper/offset",
                     "die upper/depth", "die upper/draft angle", "die upper/edge radius", "die lower/fillet radius"]


def write_ball(name, radius, centre, n=24):
    """A closed sphere of triangles as an ASCII STL file."""
    from math import cos, pi, sin
    rings = [[tuple(centre[i] + radius * x[i] for i in range(3))
              for x in ((sin(pi * a / n) * cos(pi * b / n), sin(pi * a / n) * sin(pi * b / n), cos(pi * a / n))
                        for b in range(2 * n))] for a in range(1, n)]
    top, bottom = (tuple(centre[i] + (0, 0, s * radius)[i] for i in range(3)) for s in (1, -1))
    facets = []
    for b in range(2 * n):
        c = (b + 1) % (2 * n)
        facets += [(top, rings[0][b], rings[0][c]), (bottom, rings[-1][c], rings[-1][b])]
        for upper, lower in zip(rings, rings[1:]):
            facets += [(upper[b], lower[b], lower[c]), (upper[b], lower[c], upper[c])]
    with open(name, "w") as file:
        file.write("solid ball\n")
        for facet in facets:
            corners = "".join("vertex {:.17g} {:.17g} {:.17g}\n".format(*x) for x in facet)
            file.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        file.write("endsolid ball\n")


def objectives(names, target, patches, more=None):
    settings = {"Objectives/names": ", ".join(names), "Objectives/history every": 0}
    for name in names:
        if name in ("filling", "unfilled volume", "shape distance"):
            settings[f"Objective {name}/target"] = target
        if name == "filling":
            settings[f"Objective {name}/rounding"] = 0.05
        if name in ("cylinder distance", "mean radius"):
            # Beside the billet's axis: of the side that is nearly a cylinder about it nothing is left but rounding.
            settings.update({f"Objective {name}/patches": patches, f"Objective {name}/axis point": "4, 3, 0"})
        if "temperature" in name:
            settings[f"Objective {name}/temperature smoothing"] = 20
    settings.update({setting: value for setting, value in NAMED.items() if setting.split("/")[0][len("Objective "):] in names})
    if "die temperature" in names:
        settings.update(HOT)
    if "die wear" in names or "largest wear" in names:
        settings.update(TIGHT)
    return {**settings, **(more or {})}


def flat(build):
    write_ball("ball.stl", 24.0, (1.0, 2.0, 14.0))
    settings = objectives(PATH + END, "ball.stl", "side -x, side +x, side -y, side +y", {"Check/free differences": "false", "Check/taylor start": 1e-4, "Check/taylor halvings": 4})
    settings["Objective late force/window begin"] = 3.1
    settings["Design/parameters"] = ", ".join(FLAT_PARAMETERS + HOT_PARAMETERS)
    case_tools.judge_check(build, FLAT, settings, "flat")


def curved(build, label, names, parameters, steps, more):
    settings = {**COARSE, **objectives(names, "die upper", "side"), "Check/steps": steps, "Design/parameters": ", ".join(parameters), **more}
    if "late force" in names:
        settings["Objective late force/window begin"] = 2.6
    case_tools.judge_check(build, CURVED, settings, label)


def ranks(build):
    """Values and gradients of all objectives on two and three ranks against one, by parameters, curved dies, 2 remeshings."""
    settings = {**COARSE, **objectives(PATH + END, "die upper", "side"), "Design/parameters": ", ".join(CURVED_PARAMETERS + HOT_PARAMETERS),
                "Objective late force/window begin": 2.6}
    found = [case_tools.run(build, "gradient", CURVED, settings, f"run_ranks_{n}", ranks=n)[0] for n in (1, 2, 3)]
    for n, other in zip((2, 3), found[1:]):
        value = max(abs(a["value"] / b["value"] - 1.0) for a, b in zip(other["objectives"], found[0]["objectives"]))
        # A derivative is measured against what it does to the objective: those that are zero but for rounding are zero.
        scale = {o["name"]: abs(o["value"]) for o in found[0]["objectives"]}
        worst = 0.0
        for a, b in zip(other["parameters"], found[0]["parameters"]):
            size = abs(b["value"]) or 40.0
            for name, g in b["gradient"].items():
                worst = max(worst, abs(a["gradient"][name] - g) / max(abs(g), 1e-3 * scale[name] / size))
        case_tools.figure(f"value_change_{n}_ranks", value)
        case_tools.figure(f"gradient_change_{n}_ranks", worst)


def several(build):
    """Seconds of the backward sweep and of the whole gradient, for one objective and for three."""
    case = os.path.join(HERE, "..", "speed", "case.prm")
    base = {"Billet/element size": 1.8, "Press/increments": 6, "Press/stroke": 3, "Output/fields every": 0}
    seconds = {}
    for repeat in range(3):
        for names in (["energy"], ["energy", "mean effort", "mean strain"]):
            summary, _ = case_tools.run(build, "gradient", case, {**base, "Objectives/names": ", ".join(names)}, "run_several")
            of = seconds.setdefault(len(names), [])
            of.append((summary["wall_seconds"]["adjoint"], summary["wall_seconds"]["total"]))
    best = {n: [min(column) for column in zip(*of)] for n, of in seconds.items()}
    print(f"{summary['mesh']['nodes']} nodes; seconds backward and in all: one objective {best[1]}, three {best[3]}")
    case_tools.figure("three_over_one_backward", best[3][0] / best[1][0])
    case_tools.figure("three_over_one", best[3][1] / best[1][1])


def methods(build):
    """Seconds of the gradient by both methods for 1, 2, 4 and 8 parameters."""
    case = os.path.join(HERE, "..", "speed", "case.prm")
    names = ["material/K", "billet/radius", "material/m", "material/e0", "contact/rho", "contact/v0", "dies/friction",
             "die upper/offset"]
    base = {"Billet/element size": 2.55, "Press/increments": 6, "Press/stroke": 3, "Output/fields every": 0}
    print("| parameters | adjoint [s] | direct [s] | largest difference |\n| --- | --- | --- | --- |")
    for n in (1, 2, 4, 8):
        seconds, gradients = [], []
        for method in ("adjoint", "direct"):
            settings = {**base, "Design/parameters": ", ".join(names[:n]), "Adjoint/method": method}
            runs = [case_tools.run(build, "gradient", case, settings, "run_methods")[0] for _ in range(3)]
            seconds.append(min(s["wall_seconds"]["adjoint"] for s in runs))
            gradients.append(case_tools.gradient(runs[0]))
        worst = max(abs(gradients[1][name] / g - 1.0) for name, g in gradients[0].items())
        print(f"| {n} | {seconds[0]:.2f} | {seconds[1]:.2f} | {worst:.1e} |", flush=True)
    case_tools.figure("direct_over_adjoint_of_8", seconds[1] / seconds[0])


def many(build):
    """What parameters cost beyond the sweep: seconds from nodes and process to 1, 10 and 196 control coordinates of the
    billet's contour, every node and every vertex of both curved dies included, over those of the whole gradient."""
    n = 99
    points = "; ".join(f"{20 if 0 < i < n - 1 else 19.9}, {60.0 * i / (n - 1):.6g}" for i in range(n))
    names = [f"billet/control point {i} r" for i in range(1, n + 1)] + [f"billet/control point {i} z" for i in range(2, n)]
    base = {"Billet/shape": "profile", "Billet/control points": points, "Billet/element size": 3.5, "Press/increments": 8,
            "Press/stroke": 4, "Output/fields every": 0, "Output/record": "false", "Remeshing/first mesh": "false"}
    print("| parameters | nodes | gradient [s] | of that beyond the sweep [s] |\n| --- | --- | --- | --- |")
    for count in (1, 10, len(names)):
        settings = {**base, "Design/parameters": ", ".join(names[::len(names) // count][:count])}
        summary, _ = case_tools.run(build, "gradient", CURVED, settings, "run_many")
        seconds, found = summary["wall_seconds"], len(summary["parameters"])
        print(f"| {found} | {summary['mesh']['nodes']} | {seconds['adjoint']:.3f} | {seconds['design']:.6f} |", flush=True)
    case_tools.figure("thousand_beyond_the_sweep", seconds["design"] * 1000 / found / (seconds["adjoint"] - seconds["design"]))


def main():
    build, what = sys.argv[1:3]
    if what == "curved":
        curved(build, "curved", PATH + END, CURVED_PARAMETERS + HOT_PARAMETERS, "1e-3, 1e-4, 3e-5, 1e-5, 1e-6",
               {"Press/stroke": 18, "Press/increments": 18, "Remeshing/every": 7})
    elif what == "turned":
        curved(build, "turned", ["least temperature"], HOT_PARAMETERS, "1e-5, 3e-6, 1e-6",
               {**HOT, **TIGHT, "Press/stroke": 18, "Press/increments": 18, "Remeshing/when": "never", "Die upper/rotation angle": 2.3,
                "Die lower/rotation angle": 2.3})
    elif what == "quick":
        curved(build, "quick", ["energy", "late force", "dimensionless fold", "mean strain", "filling"],
               ["billet/radius", "die upper/depth"], "1e-4, 1e-5, 1e-6", {})
    else:
        {"flat": flat, "ranks": ranks, "several": several, "many": many, "methods": methods}[what](build)


if __name__ == "__main__":
    main()
