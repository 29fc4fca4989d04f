# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What the verification cases share: run the program on a parameter file, read its summary, print figures."""
import json
import math
import os
import statistics
import subprocess
import sys


ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def leave_root():
    """Cases that are run by hand from the project's root write below results/by_hand."""
    if os.path.samefile(os.getcwd(), ROOT):
        sys.argv[1:] = [os.path.abspath(word) if os.path.exists(word) else word for word in sys.argv[1:]]
        folder = os.path.join(ROOT, "results", "by_hand")
        os.makedirs(folder, exist_ok=True)
        os.chdir(folder)


leave_root()


def run(build, command, case, settings=None, output="run", ranks=1, may_fail=False):
    """Run `retroforge COMMAND CASE` with overrides {"Section/name": value} and return (summary, what it printed)."""
    arguments = [os.path.join(build, "retroforge"), command, case, "--output", output, "--overwrite"]
    for name, value in (settings or {}).items():
        arguments += ["--set", f"{name}={value}"]
    if ranks > 1:
        arguments = ["mpirun", "-np", str(ranks)] + arguments
    summary_file = os.path.join(output, "summary.json")
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode != 0 and not may_fail:
        sys.stderr.write(done.stdout[-4000:] + done.stderr)
        raise SystemExit(f"failed: {' '.join(arguments)}")
    if not os.path.exists(summary_file):
        return None, done.stdout + done.stderr
    with open(summary_file) as file:
        return json.load(file), done.stdout + done.stderr


def energy(summary):
    return summary["objectives"][0]["value"]


def gradient(summary):
    """{parameter: d(energy)/d(parameter)}"""
    return {p["name"]: p["gradient"]["energy"] for p in summary["parameters"]}


def figure(name, value):
    print(f"FIGURE {name} {value:.6g}", flush=True)


class Trends:
    """Slopes of forgings that are remeshed, beside the trend of what is decided anew: of each parameter and objective the mean of the gradients over an interval, by
    Simpson's rule, and the secant, from several first meshes. Of one first mesh a secant has that mesh's scatter."""

    def __init__(self, build, case, settings, parts, sizes, prefix):
        """@param parts  {parameter: part of it, to both sides}  @param sizes  elements of the first meshes [mm]"""
        self.pairs = {name: {} for name in parts}
        for size in sizes:
            def forged(at, word):
                with_these = {**settings, "Billet/element size": size, "Design/parameters": ", ".join(parts), "Design/at": at, "Output/fields every": 0,
                              "Output/record": "false"}
                return run(build, "gradient", case, with_these, f"{prefix}_{size}_{word}")[0]

            middle = forged("", "nominal")
            nominal = {parameter["name"]: parameter["value"] for parameter in middle["parameters"]}
            for name, part in parts.items():
                ends = [(1 + side * part) * nominal[name] for side in (-1, 1)]
                low, high = (forged(f"{name}: {value!r}", f"{name}_{value:.4g}".replace("/", "_").replace(" ", "_")) for value in ends)
                for objective in gradient_of(middle, name):
                    slopes = [gradient_of(summary, name)[objective] for summary in (low, middle, high)]
                    rise = value_of(high, objective) - value_of(low, objective)
                    self.pairs[name].setdefault(objective, []).append(((slopes[0] + 4 * slopes[1] + slopes[2]) / 6, rise / (ends[1] - ends[0]), slopes[1]))

    def beside(self, parameter, objective):
        """How far the mean gradient is beside the mean secant, its standard error, and single gradients in the middle beside it, rms."""
        pairs = self.pairs[parameter][objective]
        secant = statistics.mean(of for _, of, _ in pairs)
        mean = statistics.mean(slope for slope, _, _ in pairs) / secant - 1
        error = statistics.stdev((slope - (1 + mean) * of) / secant for slope, of, _ in pairs) / math.sqrt(len(pairs))
        return mean, error, math.sqrt(statistics.mean((single / secant - 1) ** 2 for _, _, single in pairs))


def value_of(summary, objective):
    return next(of["value"] for of in summary["objectives"] if of["name"] == objective)


def gradient_of(summary, parameter):
    """{objective: its derivative by the parameter}"""
    return next(of["gradient"] for of in summary["parameters"] if of["name"] == parameter)


def judge_check(build, case, settings, label):
    """Run `check`, print a table of what it finds of each objective, and the figures failed_LABEL and derivatives_LABEL."""
    summary, text = run(build, "check", case, settings, f"run_{label}", may_fail=True)
    if summary is None:
        sys.exit(text)
    with open(f"check_{label}.txt", "w") as file:
        file.write(text)
    rows, scale = summary["check"], {o["name"]: abs(o["value"]) for o in summary["objectives"]}
    failed = [f"{r['objective']} by {r['parameter']}" for r in rows if r["verdict"] == "failed"]
    print(f"{label}: {summary['mesh']['nodes']} nodes, {summary['remeshings']} remeshings, {len(scale)} objectives, "
          f"{len(rows)} derivatives, of which {sum(r['verdict'] == 'zero' for r in rows)} zero, {len(failed)} failed\n" + "".join(f"  {f}\n" for f in failed))
    print("| objective | value | adjoint/tangent - 1 | best replayed difference | median Taylor order |\n" + "| --- " * 5 + "|")
    for name in scale:
        # Random directions cancel: the program measures them against their terms.
        of = [r for r in rows if r["objective"] == name and "random" not in r["parameter"] and r["verdict"] == "passed"]
        if not of:
            print(f"| {name} | {scale[name]:.6g} | - | - | - |")
            continue
        tangent = max(abs(r["tangent"] / r["adjoint"] - 1.0) for r in of)
        replayed = max(min(abs(s["replayed_central"] / r["adjoint"] - 1.0) for s in r["steps"]) for r in of)
        # Where the remainder is rounding its order means nothing: the least is the program's to judge.
        orders = [r["taylor_orders"][-1] for r in of if r["taylor_orders"][-1] is not None]
        print(f"| {name} | {scale[name]:.6g} | {tangent:.1e} | {replayed:.1e} | {sorted(orders)[len(orders) // 2]:.3f} |")
    figure(f"failed_{label}", len(failed))
    figure(f"derivatives_{label}", len(rows))
