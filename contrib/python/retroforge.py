# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Run Retroforge from Python: a forging and its gradients as a function of settings and design parameters.

    import retroforge
    forging = retroforge.run("prm/tutorial/upsetting/upsetting.prm", at={"billet/radius": 20.2})
    forging.objectives["energy"]                   # 20255.9 mJ
    forging.gradients["energy"]["billet/radius"]   # d energy / d radius

`settings` change the case, as --set does, and with it perhaps the mesh; `at` changes the design on the first mesh of the
case, as --at does, so that results are as smooth in the design as the gradient says: what an optimizer needs.
"""
import csv
import dataclasses
import json
import numbers
import os
import pathlib
import subprocess
import tempfile

import numpy as np

PROGRAM = os.environ.get("RETROFORGE", pathlib.Path(__file__).resolve().parents[2] / "build" / "retroforge")


class Error(RuntimeError):
    """What the program says of a run that failed: where, what was found, which rule it breaks, and the remedy."""


@dataclasses.dataclass
class Forging:
    """What a run found; doc/summary_schema.md describes the summary and the columns of the history."""
    summary: dict
    objectives: dict  # value of each objective
    gradients: dict  # of each objective: derivative by each design parameter
    history: dict  # column of history.csv: array over the increments

    def gradient(self, objective, parameters):
        """Derivatives of an objective by several parameters, as an array."""
        return np.array([self.gradients[objective][parameter] for parameter in parameters])


def run(case, settings={}, at={}, command="gradient", folder=None):  # pylint: disable=dangerous-default-value
    """Forge a case.

    settings: {"Section/name": value}; lists and booleans are written as parameter files have them
    at:       {"design parameter": value}, whether the case lists it or not
    command:  simulate, gradient or check
    folder:   where results are left, refused where there are some already; None: nowhere
    @throws Error  with the program's message
    """
    if folder is None:
        with tempfile.TemporaryDirectory() as scratch:
            return run(case, settings, at, command, scratch)
    start(command, case, settings, at, folder)
    return read(folder)


def optimize(case, settings={}, at={}, folder=None):  # pylint: disable=dangerous-default-value
    """The best design of a case by its section Optimisation; arguments as of run(). Returns what optimisation.json has,
    which doc/summary_schema.md describes, with `best`, {"design parameter": value}, beside;
    `limits_kept` says whether the best design keeps the limits.
    @throws Error  with the program's message
    """
    if folder is None:
        with tempfile.TemporaryDirectory() as scratch:
            return optimize(case, settings, at, scratch)
    start("optimize", case, settings, at, folder, accepted=(0, 2))
    found = json.loads((pathlib.Path(folder) / "optimisation.json").read_text(encoding="utf-8"))
    return {**found, "best": {parameter["name"]: parameter["best"] for parameter in found["parameters"]}}


def start(command, case, settings, at, folder, accepted=(0,)):
    """@param accepted  exit statuses with which results are there"""
    words = [str(PROGRAM), command, str(case), "--output", str(folder)]
    for option, values in (("--set", settings), ("--at", at)):
        for name, value in values.items():
            words += [option, f"{name}={as_text(value)}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False,
                          env={"OMP_NUM_THREADS": "1", **os.environ})
    if done.returncode not in accepted:
        raise Error(done.stderr.strip().removeprefix("retroforge: ") or f"{command} did not pass:\n{done.stdout}")


def read(folder):
    """The results of a run that is finished."""
    folder = pathlib.Path(folder)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    parameters = summary.get("parameters", [])
    objectives = {objective["name"]: objective["value"] for objective in summary["objectives"]}
    gradients = {objective: {p["name"]: p["gradient"][objective] for p in parameters if objective in p["gradient"]}
                 for objective in objectives}
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        titles, *rows = csv.reader(file)
    history = dict(zip(titles, np.array(rows, float).reshape(-1, len(titles)).T))
    return Forging(summary, objectives, gradients, history)


def as_text(value):
    """A value as parameter files have it; numbers read back to the same bits."""
    if isinstance(value, (bool, np.bool_)):
        return str(bool(value)).lower()
    if isinstance(value, numbers.Real) and not isinstance(value, numbers.Integral):
        return repr(float(value))
    if isinstance(value, (list, tuple, np.ndarray)):
        return ", ".join(as_text(entry) for entry in value)
    return str(value)
