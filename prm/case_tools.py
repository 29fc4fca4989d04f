# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What the verification cases share: run the program on a parameter file, read its summary, print figures."""
import json
import os
import subprocess
import sys


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
