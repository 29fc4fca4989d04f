# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Energies and gradients on one, two and three ranks, the adjoint against the tangent derivative of each parameter, and what a rank needs
of memory:   run.py BUILD tight | default | remeshed | soft | stiff | memory"""
import os
import resource
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SPEED = os.path.join(HERE, "..", "speed", "case.prm")
sys.path.insert(0, os.path.join(HERE, "..", ".."))
from case_tools import energy, figure, gradient, run  # noqa: E402

BUILD, CASE = sys.argv[1], os.path.join(HERE, "case.prm")
TIGHT = {"Newton/tolerance": 1e-12, "Adjoint/tolerance": 1e-14}
SHORT = {"Billet/element size": 7, "Press/stroke": 2, "Press/increments": 3}
# The tangent runs once per parameter whatever the differences: as few of those as can be asked for.
CHECK = {"Check/steps": "1e-5", "Check/free differences": "false", "Check/taylor halvings": 2}


def defect(a, b):
    return abs(a - b) / max(abs(a), abs(b), 1e-300)


def compare_ranks(name, settings):
    """Change of the energy and worst change of a gradient from one rank to two and three."""
    one, _ = run(BUILD, "gradient", CASE, settings)
    g = gradient(one)
    for n in (2, 3):
        other, printed = run(BUILD, "gradient", CASE, settings, ranks=n, may_fail=True)
        if other is None:
            print(f"{n} ranks failed:\n{printed[-2000:]}")
            continue
        changes = {parameter: defect(gradient(other)[parameter], g[parameter]) for parameter in g}
        for parameter, change in changes.items():
            print(f"{name:8} {n} ranks {parameter:24} {g[parameter]:18.12g}   changes by {change:.2e}")
        figure(f"energy_change_{name}_{n}", defect(energy(other), energy(one)))
        figure(f"gradient_change_{name}_{n}", max(changes.values()))


def adjoint_against_tangent(settings):
    """{parameter: worst relative difference} over both schemes, on one and two ranks."""
    worst = {}
    for scheme in ("midpoint", "euler"):
        for ranks in (1, 2):
            # Exit status 1 says that some difference missed its bar; only adjoint and tangent count here.
            summary, printed = run(BUILD, "check", CASE, {**TIGHT, **SHORT, **CHECK, **settings, "Press/scheme": scheme},
                                   ranks=ranks, may_fail=True)
            if summary is None:
                sys.exit(printed)
            for row in summary["check"]:
                difference = defect(row["adjoint"], row["tangent"])
                worst[row["parameter"]] = max(worst.get(row["parameter"], 0.), difference)
                print(f"{scheme:8} {ranks} rank(s)  {row['parameter']:24} {difference:.1e}")
    return worst


def tight():
    compare_ranks("tight", TIGHT)


def remeshed():
    """Through remeshings: they are decided on one rank from numbers that differ by rounding."""
    compare_ranks("remeshed", {**TIGHT, "Remeshing/when": "increments", "Remeshing/every": 4})


def default():
    compare_ranks("default", {})


def soft():
    worst = adjoint_against_tangent({"Contact/penetration": 1e-4})
    figure("adjoint_tangent_soft", max(worst.values()))


def stiff():
    worst = adjoint_against_tangent({})
    figure("adjoint_tangent_stiff_rho", worst.pop("contact/rho"))
    figure("adjoint_tangent_stiff", max(worst.values()))


def megabytes(ranks, words):
    """Of each rank, at its largest, ascending: it is the only child of a process of its own."""
    asked = ["mpirun", "--oversubscribe", "-np", str(ranks), sys.executable, "-B", os.path.abspath(__file__), BUILD, "one_rank", *words]
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    return sorted(float(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("MEGABYTES"))


def one_rank():
    subprocess.run([os.path.join(BUILD, "retroforge"), *sys.argv[3:]], stdout=subprocess.DEVNULL, check=True)
    print(f"MEGABYTES {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.1f}", flush=True)


def memory():
    """Of a rank, over that of a run whose mesh is as good as none; forward and backward, 36k nodes."""
    def words(size, kind):
        return ["gradient", SPEED, "--output", "memory", "--overwrite", "--set", f"Billet/element size={size}", "--set", "Press/increments=1",
                "--set", "Press/stroke=0.5", "--set", f"Discretization/triangulation={kind}"]
    for kind, name in (("shared", "memory"), ("fully distributed", "memory_distributed")):
        before = None
        for ranks in (1, 2, 4):
            start, largest = megabytes(ranks, words(6, kind))[-1], megabytes(ranks, words(0.663, kind))
            fields = [own - start for own in largest]
            print(f"{kind}, {ranks} ranks: {fields[0]:.0f} to {fields[-1]:.0f} MB over the {start:.0f} MB of the program", flush=True)
            if before:
                figure(f"{name}_{ranks}_over_{ranks // 2}", fields[-1] / before)
            before = fields[-1]


if __name__ == "__main__":
    {"tight": tight, "default": default, "remeshed": remeshed, "soft": soft, "stiff": stiff, "memory": memory, "one_rank": one_rank}[sys.argv[2]]()
