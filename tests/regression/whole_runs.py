# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What tests of whole runs share: a small scene, the program and what it leaves behind, and a verdict for each thing that is asked.

The first argument of a test is the program; without one it is that of the folder build."""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/retroforge")
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}

failures = []


def judge(name, good, detail=""):
    print(f"passed {name}" if good else f"FAILED {name} {detail}", flush=True)
    if not good:
        failures.append(name)


def judge_message(name, done, pattern):
    """Whether the program ended with one message, of four parts."""
    message = done.stderr.strip()
    faults = []
    if done.returncode <= 0:
        faults.append(f"exit status {done.returncode}")
    if len(message.splitlines()) != 1:
        faults.append(f"{len(message.splitlines())} lines on the error stream")
    if not re.match(r"retroforge: [^;]+: [^;]+;[^;]+;[^;]+", message):
        faults.append("not of the form where: what; rule; remedy")
    if not re.search(pattern, message, re.DOTALL):
        faults.append(f"does not say {pattern}")
    judge(name, not faults, "; ".join(faults))
    print(f"         {message}")


def upsetting(shape, size, element_size, height, stroke, increments, **press):
    """{section: {parameter: value}} of a quarter of a billet that a die presses at 100 mm/s against another; lengths in mm.
    @param size  the parameters that the billet's shape reads"""
    dies = {"friction": 0.3}
    return {"Billet": {"shape": shape, **size, "element size": element_size, "symmetry planes": "-1, 0, 0; 0, -1, 0"},
            "Dies": {"names": "lower, upper"},
            "Die lower": {"point": "0, 0, 0", "facing": "0, 0, 1", **dies},
            "Die upper": {"point": f"0, 0, {height}", "facing": "0, 0, -1", "velocity": "0, 0, -100", **dies},
            "Press": {"stroke": stroke, "increments": increments, **press}}


def cube(side, element_size, stroke, increments, **press):
    return upsetting("box", {"size": f"{side}, {side}, {side}"}, element_size, side, stroke, increments, **press)


def changed(sections, more):
    """The sections with more parameters, or other values of them."""
    return {name: {**sections.get(name, {}), **more.get(name, {})} for name in {**sections, **more}}


def prm(sections):
    """The text of a parameter file; a parameter that is a dictionary is a section itself."""
    lines = []
    for name, value in sections.items():
        lines += ["subsection " + name, prm(value) + "end"] if isinstance(value, dict) else [f"set {name} = {value}"]
    return "".join(line + "\n" for line in lines)


def write(name, text):
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)


def text_of(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


def settings(*pairs):
    return [word for pair in pairs for word in ("--set", pair)]


def command(word, output, *settings, case="case.prm"):
    """The words that run the program. @param settings  "Section/name=value", ("design parameter", value), or "--option" """
    words = [PROGRAM, word, case, "--output", output]
    for setting in settings:
        if isinstance(setting, tuple):
            words += ["--at", f"{setting[0]}={setting[1]!r}"]
        else:
            words += [setting] if setting.startswith("--") else ["--set", setting]
    return words


def start(words):
    return subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=600, check=False)


def run(word, output, *settings, **more):
    return start(command(word, output, *settings, **more))


def summary_of(output):
    return json.loads(text_of(output, "summary.json"))


def history_of(output):
    """Its rows, as text."""
    return list(csv.DictReader(text_of(output, "history.csv").splitlines()))


def contents(folder):
    """File -> bytes and time of change."""
    found = {}
    for place, _, names in os.walk(folder):
        for path in (os.path.join(place, name) for name in names):
            with open(path, "rb") as file:
                found[path] = (file.read(), os.stat(path).st_mtime_ns)
    return found


def main(files, tests):
    """Runs the tests, one after the other, in a folder of their own with these files {name: text}; ends the program."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, text in files.items():
            write(name, text)
        for test in tests:
            begun = time.monotonic()
            try:
                test()
            except (KeyError, IndexError, OSError, StopIteration, ValueError, subprocess.SubprocessError) as error:
                judge(test.__name__, False, repr(error))
            print(f"{test.__name__}: {time.monotonic() - begun:.1f} s", flush=True)
        os.chdir("/")
    print(f"{len(failures)} failed")
    sys.exit(1 if failures else 0)
