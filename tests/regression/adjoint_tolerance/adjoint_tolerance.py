# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What gradients lose by the default of Adjoint/tolerance, against one of 1e-12: what a parameter that changes by a per cent changes of
an objective, in its per cent. Contact forces are penalties times small velocities, and so their derivatives are large where a die holds;
they must not be worse than others. For both elements, with each solver. Usage: adjoint_tolerance.py RETROFORGE"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import changed, judge, main, prm, run, summary_of, upsetting  # noqa: E402

LARGEST_LOSS = 1e-6
CASE = changed(upsetting("cylinder", {"radius": 20}, 7, 30, 5, 5),
               {"Billet": {"height": 30}, "Remeshing": {"when": "never"},
                "Objectives": {"names": "energy, mean effort, by force, contact pressure"},
                "Objective by force": {"type": "mean effort", "by": "force"},
                "Design": {"parameters": "billet/radius, material/K, die upper/speed, dies/friction"}})


def derivatives(output):
    """{objective: {parameter: derivative times the parameter, over the objective}}"""
    summary = summary_of(output)
    sizes = {objective["name"]: abs(objective["value"]) for objective in summary["objectives"]}
    return {name: {parameter["name"]: parameter["gradient"][name] * parameter["value"] / size for parameter in summary["parameters"]}
            for name, size in sizes.items()}


def compare(output, *settings):
    found = []
    for tolerance in ((), ("Adjoint/tolerance=1e-12",)):
        done = run("gradient", output, "--overwrite", *tolerance, *settings)
        judge(f"{output}: ends", done.returncode == 0, done.stderr)
        found.append(derivatives(output))
    for name, exact in found[1].items():
        loss = max(abs(found[0][name][parameter] - value) for parameter, value in exact.items())
        judge(f"{output}: {name}", loss < LARGEST_LOSS, loss)


def mini():
    for method in ("ilu", "multigrid"):
        compare(f"mini by {method}", f"Linear solver/method={method}")


def quadratic():
    compare("P2-P1", "Discretization/element=P2-P1", "Billet/element size=10")


if __name__ == "__main__":
    main({"case.prm": prm(CASE)}, (mini, quadratic))
