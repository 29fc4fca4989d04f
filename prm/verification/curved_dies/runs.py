# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What the cases of curved dies share: write a case, run it within a time, fit a line of energies and slopes, print figures."""
import argparse
import csv
import dataclasses
import functools
import json
import os
import shutil
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
import case_tools  # noqa: E402
import penetration  # noqa: E402

figure = case_tools.figure


# ---- scenes ----

def write_case(file, settings):
    """A parameter file of {"Die upper/point": "0, 0, 40"}; its path, absolute."""
    with open(file, "w", encoding="utf-8") as stream:
        for name, value in settings.items():
            *sections, last = name.split("/")
            begin = "".join(f"subsection {section}\n" for section in sections)
            stream.write(f"{begin}set {last} = {value}\n" + "end\n" * len(sections))
    return os.path.abspath(file)


def plane(name, z, facing=1, friction=0.3, velocity=0):
    """Settings of a flat die at a height, that faces up (1) or down (-1)."""
    return {f"Die {name}/shape": "plane", f"Die {name}/point": f"0, 0, {z}", f"Die {name}/facing": f"0, 0, {facing}",
            f"Die {name}/friction": friction, f"Die {name}/velocity": f"0, 0, {velocity}"}


def stl(name, file, point, facing="0, 0, -1", friction=0.3, velocity=-100):
    """Settings of a die from a file, moved to a point."""
    return {f"Die {name}/shape": "stl", f"Die {name}/file": file, f"Die {name}/point": ", ".join(f"{x!r}" for x in map(float, point)),
            f"Die {name}/facing": facing, f"Die {name}/friction": friction, f"Die {name}/velocity": f"0, 0, {velocity}"}


def cylinder(radius, height, size, **more):
    return {"Billet/shape": "cylinder", "Billet/radius": radius, "Billet/height": height, "Billet/element size": size,
            **{f"Billet/{name.replace('_', ' ')}": value for name, value in more.items()}}


# ---- runs ----

@dataclasses.dataclass
class Run:
    """What became of a run: `end`, `reason` (it stopped and said why), `crash` or `timeout`."""
    outcome: str
    code: int
    message: str
    seconds: float
    output: str
    summary: dict

    @property
    def ended(self):
        return self.outcome == "end"

    @property
    def energy(self):
        return self.summary["objectives"][0]["value"] if self.ended else float("nan")

    def slope(self, parameter):
        """d(energy)/d(parameter)"""
        return case_tools.gradient(self.summary)[parameter] if self.ended else float("nan")

    @property
    def nodes(self):
        return self.summary["mesh"]["nodes"] if self.ended else 0

    def depth(self):
        """The deepest point in a die [mm] at the last fields written; NaN if there are none."""
        if not os.path.exists(os.path.join(self.output, "fields.pvd")):
            return float("nan")
        return penetration.penetration(self.output)["deepest"]

    def history(self):
        """(increments done, part of the volume lost so far), also of a run that stopped."""
        file = os.path.join(self.output, "history.csv")
        if not os.path.exists(file):
            return 0, float("nan")
        with open(file, encoding="utf-8") as stream:
            rows = list(csv.reader(stream))
        volume = [i for i, name in enumerate(rows[0]) if name.startswith("volume")]
        if len(rows) < 2 or not volume:
            return 0, float("nan")
        return len(rows) - 1, 1.0 - float(rows[-1][volume[0]]) / float(rows[1][volume[0]])


@functools.lru_cache
def knows_at(build):
    """Whether the program can move a design parameter without meshing anew: `--at billet/radius=V`."""
    done = subprocess.run([os.path.join(build, "retroforge"), "--help"], capture_output=True, text=True, check=False)
    return "--at " in done.stdout + done.stderr


def at_words(build, at):
    """Options that run at other values of the design parameters; without --at the billet is meshed anew at each."""
    if knows_at(build):
        return [word for name, value in at.items() for word in ("--at", f"{name}={value!r}")]
    for name in at:
        if not name.startswith("billet/"):
            raise SystemExit(f"{build}/retroforge has no --at, and {name} cannot be set without")
    return [word for name, value in at.items() for word in ("--set", f"Billet/{name[7:]}={value!r}")]


def forge(build, command, case, output, settings=None, at=None, timeout=None):
    """Run `retroforge COMMAND CASE` and say what became of it; results of an earlier run in the same folder are removed."""
    shutil.rmtree(output, ignore_errors=True)
    words = [os.path.join(build, "retroforge"), command, case, "--output", output]
    words += [word for name, value in (settings or {}).items() for word in ("--set", f"{name}={value}")]
    words += at_words(build, at or {})
    environment = {"OMP_NUM_THREADS": "1", **os.environ}
    start = time.monotonic()
    try:
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=timeout, env=environment, check=False)
    except subprocess.TimeoutExpired:
        return Run("timeout", -1, f"stopped after {timeout:g} s", time.monotonic() - start, output, None)
    seconds = time.monotonic() - start
    message = " ".join(done.stderr.split())
    message = message[max(0, message.find("retroforge: ")):]
    if done.returncode == 0:
        with open(os.path.join(output, "summary.json"), encoding="utf-8") as file:
            return Run("end", 0, message, seconds, output, json.load(file))
    said_why = message.startswith("retroforge: ") and "An error occurred in line" not in message
    return Run("reason" if said_why else "crash", done.returncode, message, seconds, output, None)


# ---- lines ----

@dataclasses.dataclass
class Trend:
    """Local slopes against the slope of a polynomial through the energies, and the energies against the polynomial."""
    bias: float  # of the mean of the slopes
    rms: float  # of single slopes, relative to the mean slope
    off: float  # root mean square of the energies off the polynomial, relative to their mean
    worst: float  # the largest of these
    slope: float  # mean slope of the polynomial

    def __str__(self):
        return f"{self.bias:+.2%} | {self.rms:.2%} | {self.off:.1e} | {self.worst:.1e}"


def trend(values, energies, slopes=None, degree=3):
    """The Trend of a line; runs that did not end (NaN) are left out."""
    x, E = np.asarray(values, float), np.asarray(energies, float)
    g = np.full(len(x), np.nan) if slopes is None else np.asarray(slopes, float)
    ended = np.isfinite(E)
    if ended.sum() < degree + 2:
        return Trend(*[float("nan")] * 5)
    x, E, g = x[ended], E[ended], g[ended]
    fit = np.polynomial.Polynomial.fit(x, E, degree)
    off, of_fit = (E - fit(x)) / E.mean(), fit.deriv()(x)
    mean = of_fit.mean()
    return Trend(g.mean() / mean - 1.0, float(np.sqrt(np.mean(((g - of_fit) / mean) ** 2))),
                 float(np.sqrt(np.mean(off**2))), float(np.abs(off).max()), mean)


def report_trend(name, values, energies, slopes):
    """Prints a line's trends and their figures: slopes against a parabola, whose mean slope noise moves least; energies off a cubic."""
    print(f"\n| {name} | mean of the slopes against the trend | rms of single ones | energies off, rms | worst |\n" + "| --- " * 5 + "|")
    parabola, cubic = (trend(values, energies, slopes, degree) for degree in (2, 3))
    for degree, one in ((2, parabola), (3, cubic)):
        print(f"| degree {degree}, slope {one.slope:.6g} | {one} |", flush=True)
    figure(f"{name}_missing", np.isnan(energies).sum())
    figure(f"{name}_bias", abs(parabola.bias))
    figure(f"{name}_rms", parabola.rms)
    figure(f"{name}_off", cubic.off)


def scan(build, case, parameter, values, name, settings=None, timeout=None, move=None):
    """Energies and slopes along a design parameter. `move(value)` gives settings that move it; by default it is moved by --at."""
    print(f"\n| {parameter} | energy [mJ] | slope | nodes | increments | remeshings | s |\n" + "| --- " * 7 + "|")
    energies, slopes = [], []
    for i, value in enumerate(values):
        moved = {} if move is None else move(value)
        run = forge(build, "gradient", case, f"{name}_{i:02d}", {**(settings or {}), **moved},
                    {parameter: float(value)} if move is None else None, timeout)
        energies.append(run.energy)
        slopes.append(run.slope(parameter))
        counts = " | ".join(str(run.summary[key]) for key in ("increments", "remeshings")) if run.ended else f"{run.message[:150]} |"
        print(f"| {value:.6g} | {run.energy:.9g} | {slopes[-1]:.6g} | {run.nodes} | {counts} | {run.seconds:.1f} |", flush=True)
    return np.array(energies), np.array(slopes)


# ---- the command line ----

def arguments(description, *parts, extra=None):
    """Options that all the cases have: BUILD, one of the parts, --set and --timeout."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=os.path.abspath, help="build folder, with the program retroforge")
    if parts:
        parser.add_argument("part", choices=parts)
    parser.add_argument("--set", action="append", default=[], metavar="Section/name=value", help="in every run; may be repeated")
    parser.add_argument("--timeout", type=float, default=7200.0, help="seconds one run may take")
    if extra:
        extra(parser)
    options = parser.parse_args()
    options.settings = dict(setting.split("=", 1) for setting in options.set)
    return options
