#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Runs that stop and go on:   run.py BUILD kills N | restart

kills: N signals, KILL, TERM and INT, at random moments of a run with remeshings, its backward sweep included, on one rank and on
two. Each run is stopped twice in a row, the second time after it was resumed, and must end with the bits of one that was left
alone. restart: a run that fails on a curved die goes on with remeshing and shorter increments, and is checked across the
change, on one rank and on two."""
import itertools
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
INCREMENTS, PHASES = 20, 28  # moments are drawn from: the start, after each increment, and for the rest the backward sweep
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)


def command(build, output, ranks, *options):
    words = [os.path.join(build, "retroforge"), "gradient", CASE, "--output", output, *options]
    return words if ranks == 1 else ["mpirun", "-np", str(ranks)] + words


def finish(build, output, ranks, option):
    done = subprocess.run(command(build, output, ranks, option), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stdout[-2000:] + done.stderr)
    return results(output)


def results(output):
    """Objectives and gradients, and the bytes of all files that do not tell how long it took."""
    with open(os.path.join(output, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    found = {"objectives": summary["objectives"], "parameters": summary["parameters"], "wall_seconds": summary["wall_seconds"]}
    for name in sorted(os.listdir(output)):
        if name.endswith((".csv", ".pvd", ".vtu", ".h5", ".stl", ".prm")) or os.path.isdir(os.path.join(output, name)):
            path = os.path.join(output, name)
            found[name] = os.listdir(path) if os.path.isdir(path) else open(path, "rb").read()
    return found


def descendants(pid):
    """A process and all it started that still run."""
    parents = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                state, parent = file.read().rpartition(")")[2].split()[:2]
        except OSError:
            continue
        if state != "Z":
            parents[int(name)] = int(parent)
    family = {pid}
    while True:
        more = {child for child, parent in parents.items() if parent in family} - family
        if not more:
            return family & set(parents)
        family |= more


def wait_for(process, ready):
    while process.poll() is None and not ready():
        time.sleep(0.002)


def stop(build, output, ranks, option, number, moment, backward):
    """Starts or resumes a run, and sends it a signal at a moment; what it was doing then."""
    phase, later = moment
    if option == "--overwrite":
        shutil.rmtree(output, ignore_errors=True)
    path = os.path.join(output, "record", f"increment_{max(phase - 1, 0):06}.h5")
    finished = os.path.join(output, "record.h5")
    with subprocess.Popen(command(build, output, ranks, option), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        if phase > INCREMENTS:
            wait_for(process, lambda: os.path.exists(finished))
            time.sleep(1.1 * backward * later)
        elif phase > 0:
            wait_for(process, lambda: os.path.exists(path) or os.path.exists(finished))
            time.sleep(0.1 * later)
        else:
            time.sleep(0.5 * later)
        family = descendants(process.pid)
        # A machine that stops takes all; mpirun passes the others on.
        for pid in family if number == signal.SIGKILL else [process.pid]:
            try:
                os.kill(pid, number)
            except ProcessLookupError:
                pass
        process.wait()
        while any(os.path.exists(f"/proc/{pid}") for pid in family):
            time.sleep(0.01)
    if os.path.exists(os.path.join(output, "summary.json")):
        return "finished"
    if os.path.exists(finished):
        return "backward sweep"
    return "forging" if os.path.exists(path if phase > 0 else finished) else "start"


def has_record(output):
    return any(os.path.exists(os.path.join(output, name)) for name in ("record.h5", "record/header.h5"))


def kills(build, n):
    whole = {ranks: finish(build, f"whole_{ranks}", ranks, "--overwrite") for ranks in (1, 2)}
    generator, numbers, runs, same, backward = random.Random(1), itertools.cycle(SIGNALS), 0, 0, 0
    while runs < n // 2:
        ranks, told = 1 + runs % 2, []
        output, seconds = f"killed_{ranks}", whole[ranks]["wall_seconds"]["adjoint"]
        phases = sorted(generator.randrange(PHASES) for _ in range(2))
        for i, phase in enumerate(phases):
            option = "--resume" if i == 1 and has_record(output) else "--overwrite"
            number = next(numbers)
            doing = stop(build, output, ranks, option, number, (phase, generator.random()), seconds)
            told.append(f"{number.name} in {doing}")
            backward += doing == "backward sweep"
        found = finish(build, output, ranks, "--resume" if has_record(output) else "--overwrite")
        differs = [key for key in whole[ranks] if key != "wall_seconds" and found.get(key) != whole[ranks][key]]
        differs += [key for key in found if key not in whole[ranks]]
        print(f"{ranks} rank(s): {', then '.join(told)}: {', '.join(differs) or 'nothing'} differs", flush=True)
        same += not differs
        runs += 1
    print(f"{n} signals, {backward} of them in the backward sweep")
    case_tools.figure("same_bits" if n < 20 else "same_bits_20", same / runs)


def restart(build):
    case, tangents, replayed = os.path.join(HERE, "restart.prm"), [], []
    for ranks in (1, 2):
        output = f"restart_{ranks}"
        _, printed = case_tools.run(build, "simulate", case, output=output, ranks=ranks, may_fail=True)
        words = ["--resume", "--set", "Press/increments=24", "--set", "Remeshing/when=quality"]
        hinted = all(word in printed for word in ("halved 8 times", "--resume", "--set Remeshing/when=quality"))
        arguments = [os.path.join(build, "retroforge"), "check", case, "--output", output, *words]
        done = subprocess.run((["mpirun", "-np", str(ranks)] if ranks > 1 else []) + arguments, capture_output=True, text=True, check=False)
        print(done.stdout + done.stderr, flush=True)
        with open(os.path.join(output, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        if not hinted or done.returncode != 0 or len(summary["restarts"]) != 1 or summary["remeshings"] == 0:
            sys.exit(f"{ranks} rank(s): no failure, no restart, or a check that fails: {printed}")
        for row in summary["check"]:
            tangents.append(abs(row["tangent"] / row["adjoint"] - 1))
            replayed.append(min(abs(step["replayed_central"] / row["adjoint"] - 1) for step in row["steps"]))
    case_tools.figure("restart_tangent", max(tangents))
    case_tools.figure("restart_replayed", max(replayed))


def main():
    build, what = sys.argv[1:3]
    restart(build) if what == "restart" else kills(build, int(sys.argv[3]))


if __name__ == "__main__":
    main()
