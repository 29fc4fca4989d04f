#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A run killed at random moments and resumed each time must end with the bits of one that was left alone:  run.py BUILD KILLS"""
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
import case_tools  # noqa: E402

CASE = os.path.join(HERE, "case.prm")
SAME = ("history.csv", "fields.pvd", "sensitivity.vtu", "fields_000020.vtu")


def command(build, output, resume):
    return [os.path.join(build, "retroforge"), "gradient", CASE, "--output", output] + ["--resume" if resume else "--overwrite"]


def finish(build, output, resume):
    """Objectives and gradients of the run, to all digits."""
    done = subprocess.run(command(build, output, resume), capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout[-2000:] + done.stderr)
    with open(os.path.join(output, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    return summary["objectives"], summary["parameters"]


def kill_and_resume(build, output, seconds):
    """Kills a new run after so many seconds, and resumes it; its results."""
    shutil.rmtree(output, ignore_errors=True)
    with subprocess.Popen(command(build, output, False), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        time.sleep(seconds)
        process.send_signal(signal.SIGKILL)
        process.wait()
    started = os.path.exists(os.path.join(output, "record", "header.h5")) or os.path.exists(os.path.join(output, "record.h5"))
    return finish(build, output, started)


def main():
    build, kills = sys.argv[1], int(sys.argv[2])
    begin = time.monotonic()
    expected = finish(build, "whole", False)
    duration = time.monotonic() - begin
    generator, same = random.Random(1), 0
    for i in range(kills):
        moment = duration * generator.uniform(0.05, 1.0)
        found = kill_and_resume(build, "killed", moment)
        differs = [f for f in SAME if open(os.path.join("whole", f), "rb").read() != open(os.path.join("killed", f), "rb").read()]
        print(f"killed after {moment:.2f} s of {duration:.2f} s: {'same' if found == expected else 'other'} results, "
              f"{', '.join(differs) or 'no file'} differs", flush=True)
        same += found == expected and not differs
    case_tools.figure("same_bits" if kills < 20 else "same_bits_20", same / kills)


if __name__ == "__main__":
    main()
