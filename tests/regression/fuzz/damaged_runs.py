#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Whole runs with damaged input:   damaged_runs.py PROGRAM FORK_SERVER [--trials parameters=2000,meshes=300,dies=300,records=200]
                                                     [--seed 1] [--only KIND:NUMBER] [--jobs 2] [--keep FOLDER] [--told]

A trial is a small scene of which a parameter file, a mesh, an STL file or a record was damaged; a third of the trials meet the results
of an earlier run in their folder. Most trials are of one run; some are a check, a scan, an optimisation, made short, or a look at the
scene. A trial ends (exit status 0, or 2 of an optimisation without a design to use; results finite), or is refused or stopped with one
message of the form `retroforge: where: what; rule; remedy`; results of the earlier run are left alone, but by `--overwrite` of a command
that was accepted, as a look at a scene always is.
A run that is still going on after a minute is stopped: input may well ask for a long one; but it must have printed something in the last
half of that minute, unless its mesh is large, or was announced to be. Each trial depends on seed, kind and number alone. The exit
status is zero when no trial is a defect."""
import argparse
import collections
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from block_meshes import msh_of_cube  # noqa: E402
from whole_runs import ENVIRONMENT, changed, cube, prm, upsetting  # noqa: E402

LONGEST, SILENT = 60, 30  # seconds
LARGE = 2000  # nodes, of which one increment may take that long
MEMORY = 6 << 30  # bytes a trial may ask for
NASTY = ("0", "-0", "1", "-1", "2", "3", "7", "1.5", "0.5", "100", "1000000", "2147483647", "2147483648", "-2147483649", "4294967296",
         "9223372036854775807", "99999999999999999999999", "1e-320", "1e-30", "1e-9", "1e9", "1e30", "1e154", "1e308", "-1e308", "1e999",
         "nan", "-inf", "inf", "0x10", "1e", "--1", "1,5", "\"", "", "é", "true", "false", "a", "lower", "upper", "energy", "0, 0, 1",
         "1, 1, 1", "0, 0, 0", "nan, 0, 1", "lower, lower", "none", "../x", "/", ".", "case.prm", "billet/radius", "#", "$", "{}")
RAW = re.compile(r"terminate called|An error occurred in|what\(\)|std::|dealii::|MPI_ABORT|HDF5-DIAG|[Aa]ssert|PETSC|Teuchos|Epetra|"
                 r"^(Error|Info|Warning) +: |Traceback|bad_alloc|basic_string|vector::|segmentation", re.MULTILINE)
MESSAGE = re.compile(r"retroforge: [^\n]+?: [^\n]+; [^\n]+; [^\n]+\n")
CYLINDER = upsetting("cylinder", {"radius": 12, "height": 20}, 6, 20, 4, 2)
WITH_STL = changed(CYLINDER, {"Die upper": {"shape": "stl", "file": "die.stl"}})
SCENES = {name: prm(sections) for name, sections in {
    "box": changed(cube(20, 10, 4, 2), {"Design": {"parameters": "billet/height, material/K, dies/friction"}}),
    "stl": changed(WITH_STL, {"Objectives": {"names": "energy, effort"}, "Objective effort": {"type": "maximum effort"},
                              "Design": {"parameters": "billet/radius, die upper/offset"}}),
    "bell": changed(CYLINDER, {"Die upper": {"shape": "bell", "Bell": {
        "mouth radius": 9, "outer radius": 40, "depth": 3, "edge radius": 1, "fillet radius": 1}}}),
    "mesh": {**CYLINDER, "Billet": {"shape": "file", "file name": "billet.msh"}},
    "remeshed": changed(WITH_STL, {"Remeshing": {"when": "increments", "every": 1}})}.items()}


# What is made of them, and settings with which it is short.
COMMANDS = ("gradient",) * 6 + ("simulate",) * 3 + ("check", "scan", "optimize", "scene")
SHORT = {"check": ("Check/steps=1e-3", "Check/free differences=false", "Check/taylor halvings=2"),
         "scan": ("Scan/points=3", "Scan/fit degree=1", "Scan/processes=1"),
         "optimize": ("Optimisation/iterations=2", "Optimisation/simulations=6", "Optimisation/noise runs=1", "Optimisation/confirmation=0")}
# They end with status 1 and without a message where this is said.
CAN_FAIL = {"check": "FAILED", "scan": r"(\d+) points, \1 failed"}
# Results of an earlier run may be gone once one of these lines is printed; a scene that is refused is listed and drawn.
ACCEPTED = re.compile(r"^ +1 +\d|^Retroforge .*, scan of |^optimisation of |^  REFUSED: ", re.MULTILINE)


def die_stl():
    """A plate of 60 mm with a shallow conical hollow, 12 per turn: [facet][corner][axis]."""
    rings = [(0, 2.0), (6, 1.0), (9, 0.0), (40, 0.0)]
    facets = []
    for (r0, z0), (r1, z1) in zip(rings, rings[1:]):
        for s in range(12):
            a, b = (2 * math.pi * ((s + t) % 12) / 12 for t in (0, 1))
            p, q = ([r0 * math.cos(t), r0 * math.sin(t), z0] for t in (a, b))
            u, v = ([r1 * math.cos(t), r1 * math.sin(t), z1] for t in (a, b))
            facets += [[q, v, u]] + ([[q, u, p]] if r0 > 0 else [])
    return facets


def stl_text(facets):
    return "solid die\n" + "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex " + " ".join(map(repr, x)) + "\n" for x in facet)
                                   + "endloop\nendfacet\n" for facet in facets) + "endsolid die\n"


def stl_binary(facets):
    return b"\0" * 80 + struct.pack("<I", len(facets)) + b"".join(struct.pack("<12fH", 0, 0, 0, *sum(facet, []), 0) for facet in facets)


class Tools:
    """The program, and what it makes once for all trials."""

    def __init__(self, program, server, folder, told):
        self.program, self.server_program, self.folder, self.told = program, server, folder, told
        self.of_thread = threading.local()
        self.mesh, self.facets = msh_of_cube(2, 20.0), die_stl()
        done = subprocess.run([program, "--print-parameters"], capture_output=True, text=True, check=True)
        self.settings = self.known_settings(done.stdout)
        base = folder / "base"
        for scene in SCENES:
            self.write_scene(folder / scene, scene)
            done = self.start(folder / scene, ["gradient", "case.prm", "--output", "out"])
            if done.returncode != 0:
                sys.exit(f"damaged_runs.py: the undamaged scene {scene} does not end:\n{done.stderr}")
        self.write_scene(base, "remeshed")
        # A finished run; and one that stops after its first increment, so that a resume has something to do. Where it stops depends on the mesh.
        first = self.start(base, ["gradient", "case.prm", "--output", "former"])
        if first.returncode != 0:
            sys.exit("damaged_runs.py: the undamaged run does not end:\n" + first.stderr)
        for largest_move in range(90, 140, 4):
            self.record_case = ["--set", "Press/increments=4", "--set", "Press/max cuts=0", "--set", f"Press/largest move=0.{largest_move:03}"]
            second = self.start(base, ["gradient", "case.prm", "--output", "begun", "--overwrite"] + self.record_case)
            if second.returncode == 1 and (base / "begun/record/increment_000000.h5").exists():
                break
        else:
            sys.exit("damaged_runs.py: no bound on the moves stops the undamaged run after its first increment:\n" + second.stderr)
        self.former, self.begun = base / "former", base / "begun"

    @staticmethod
    def known_settings(text):
        """[(section/name, value, choices)] of all parameters."""
        found, place, choices = [], [], []
        for line in map(str.strip, text.splitlines()):
            if line.startswith("subsection "):
                place.append(line[11:])
            elif line == "end":
                place.pop()
            elif line.startswith("# Allowed: one of"):
                choices = re.sub(r"\. Default.*", "", line[17:]).replace(",", " ").split()
            elif line.startswith("set "):
                name, _, value = line[4:].partition("=")
                found.append(("/".join(place + [name.strip()]), value.strip(), choices))
                choices = []
        return found

    @staticmethod
    def environment(folder):
        return {**ENVIRONMENT, "OMPI_MCA_mpi_warn_on_fork": "0", "TMPDIR": str(folder)}

    def start(self, folder, arguments):
        return subprocess.run([self.program] + arguments, cwd=folder, env=self.environment(folder), capture_output=True, text=True,
                              errors="replace", check=False)

    def server(self):
        if not hasattr(self.of_thread, "server"):
            self.of_thread.server = Server(self.server_program, self.environment(self.folder))
        return self.of_thread.server

    def write_scene(self, folder, scene):
        folder.mkdir()
        (folder / "case.prm").write_text(SCENES[scene], encoding="utf-8")
        (folder / "billet.msh").write_text(self.mesh, encoding="utf-8")
        (folder / "die.stl").write_text(stl_text(self.facets), encoding="utf-8")


def changed_number(rng, text, plausible=False):
    """A number of another size, sign or kind in the place of one in the text; a plausible one differs in its size alone."""
    numbers = list(re.finditer(r"[-+]?\d+\.?\d*(e[-+]?\d+)?", text))
    if not numbers or (not plausible and rng.random() < 0.4):
        return rng.choice(NASTY)
    at = rng.choice(numbers)
    value = float(at.group())
    whole = "." not in at.group() and "e" not in at.group()
    if plausible:
        new = value * rng.choice((0.5, 2, 10**rng.uniform(-2, 2))) if value else rng.choice((1, 0.1, 10, -1, 0.01))
        new = round(new) if whole and rng.random() < 0.5 else new
    else:
        new = rng.choice((value * 10**rng.uniform(-3, 3), -value, value * rng.uniform(0.5, 2), value + rng.uniform(-1, 1), 0.0,
                          float(round(value * rng.uniform(0.2, 5)))))
    return text[:at.start()] + (str(int(new)) if new == int(new) and abs(new) < 1e15 else repr(new)) + text[at.end():]


def damaged_bytes(rng, data):
    """Bytes replaced, lost, added, moved or cut off."""
    data = bytearray(data)
    for _ in range(rng.randint(1, 4)):
        if not data:
            break
        at = rng.randrange(len(data))
        size = rng.choice((1, 1, 2, 4, 8, 16, 64, 512))
        kind = rng.randrange(6)
        if kind == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[at:at + size] = bytes(rng.randrange(256) for _ in data[at:at + size])
        elif kind == 2:
            del data[at:at + size]
        elif kind == 3:
            data[at:at] = data[(other := rng.randrange(len(data))):other + size]
        elif kind == 4:
            data[at:at + size] = rng.choice((b"\0", b"\xff")) * len(data[at:at + size])
        elif rng.random() < 0.2:
            del data[at:]
    return bytes(data)


def damaged_lines(rng, text):
    lines = text.split("\n")
    for _ in range(rng.randint(1, 3)):
        i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
        kind = rng.randrange(5)
        if kind == 0 and len(lines) > 1:
            del lines[i]
        elif kind == 1:
            lines.insert(j, lines[i])
        elif kind == 2:
            lines[i], lines[j] = lines[j], lines[i]
        else:
            words = lines[i].split(" ")
            w = rng.randrange(len(words))
            words[w] = changed_number(rng, words[w])
            lines[i] = " ".join(words)
    return "\n".join(lines)


def damage_parameters(rng, tools, folder):
    tools.write_scene(folder, rng.choice(list(SCENES)))
    case = folder / "case.prm"
    text = case.read_text(encoding="utf-8")
    arguments = []
    if rng.random() < 0.1:
        case.write_bytes(damaged_bytes(rng, text.encode()))
    elif rng.random() < 0.2:
        case.write_text(damaged_lines(rng, text), encoding="utf-8")
    else:
        # Most are values that a run may try, so that what comes after the reading is met, too.
        plausible = rng.random() < 0.75
        scene = [setting for setting in tools.settings if not setting[0].startswith(("Scan", "Output", "Die lower/Tripod", "Die upper/Tripod"))]
        for _ in range(rng.choice((1, 1, 2, 3, 4))):
            name, value, choices = rng.choice(scene if plausible else tools.settings)
            new = rng.choice(choices) if choices and rng.random() < 0.8 else changed_number(rng, value, plausible)
            arguments += ["--set", f"{name}={new}"]
    return arguments


def damage_mesh(rng, tools, folder):
    tools.write_scene(folder, "mesh")
    file = folder / "billet.msh"
    if rng.random() < 0.3:
        file.write_bytes(damaged_bytes(rng, tools.mesh.encode()))
        return []
    lines = tools.mesh.split("\n")
    n_nodes = int(lines[4])
    nodes, cells = range(5, 5 + n_nodes), range(8 + n_nodes, len(lines) - 2)
    if rng.random() < 0.4:  # a mesh that may be run
        for i in nodes:
            words = lines[i].split()
            reach = rng.choice((0, 0, 0.5, 2, 4))
            lines[i] = " ".join(words[:1] + [repr(float(x) + rng.uniform(-reach, reach) * (float(x) in (10, 20))) for x in words[1:]])
    for _ in range(rng.choice((0, 1, 1, 2, 3))):
        kind = rng.randrange(7)
        i = rng.choice(nodes if kind < 4 else cells)
        words = lines[i].split()
        if kind == 0:  # moved: onto a plane of others, far
            words[1 + rng.randrange(3)] = repr(float(rng.choice((0, 5, 10, 20, 100))) + rng.choice((0, 0, rng.uniform(-8, 8))))
        elif kind == 1:
            words[1:] = lines[rng.choice(nodes)].split()[1:]
        elif kind in (2, 5):
            words[rng.randrange(len(words))] = rng.choice(NASTY)
        elif kind == 3:
            words[1:] = [repr(float(x) * rng.choice((1e-3, 1e3, 0.5))) if re.fullmatch(r"[\d.]+", x) else x for x in words[1:]]
        elif kind == 4 and len(words) > 8:
            words[5], words[6] = words[6], words[5]
        elif kind == 6 and len(words) > 8:
            words[5 + rng.randrange(4)] = str(rng.randint(0, n_nodes + 1))
        lines[i] = " ".join(words)
    if rng.random() < 0.3:
        del lines[rng.choice(cells)]
        lines[7 + n_nodes] = str(int(lines[7 + n_nodes]) - 1)
    file.write_text("\n".join(lines), encoding="utf-8")
    return []


def damage_die(rng, tools, folder):
    tools.write_scene(folder, rng.choice(("stl", "remeshed")))
    facets = [[list(x) for x in facet] for facet in tools.facets]
    if rng.random() < 0.4:  # a die that may be run: its vertices moved alike in all facets
        shift = {tuple(x): [x[0] + rng.uniform(-1, 1), x[1] + rng.uniform(-1, 1), x[2] + rng.choice((0, 0, rng.uniform(-2, 2)))]
                 for facet in facets for x in facet}
        facets = [[list(shift[tuple(x)]) for x in facet] for facet in facets]
    for _ in range(rng.choice((0, 1, 1, 2))):
        facet = rng.choice(facets)
        kind = rng.randrange(8)
        if kind == 0:
            facet.reverse()
        elif kind == 1:
            facets.remove(facet)
        elif kind == 2:
            facets.append([list(x) for x in facet])
        elif kind == 3:
            rng.choice(facet)[rng.randrange(3)] += rng.uniform(-10, 10) * rng.choice((1e-6, 1e-2, 1, 100))
        elif kind == 4:
            facet[0] = list(facet[1])
        elif kind == 5:
            rng.choice(facet)[rng.randrange(3)] = rng.choice((float("nan"), float("inf"), 1e300, -1e38, 1e-320, 0.0))
        elif kind == 6:  # all of it: in metres, upside down, flattened, turned
            scale = rng.choice(((1e-3,) * 3, (1e3,) * 3, (1, 1, -1), (1, 1, 0), (0, 1, 1), (-1, 1, 1)))
            facets = [[[s * x for s, x in zip(scale, corner)] for corner in f] for f in facets]
        else:
            shift = rng.choice(((0, 0, -5), (0, 0, 5), (30, 0, 0), (0, 0, -30), (3, 4, 0)))
            facets = [[[s + x for s, x in zip(shift, corner)] for corner in f] for f in facets]
    try:
        data = stl_binary(facets) if rng.random() < 0.5 else stl_text(facets).encode()
    except OverflowError:
        data = stl_text(facets).encode()
    (folder / "die.stl").write_bytes(damaged_bytes(rng, data) if rng.random() < 0.3 else data)
    return []


def damage_record(rng, tools, folder):
    tools.write_scene(folder, "remeshed")
    shutil.copytree(tools.begun, folder / "out")
    file = rng.choice([path for path in sorted((folder / "out").rglob("*")) if path.suffix in (".h5", ".csv", ".prm")])
    file.write_bytes(damaged_bytes(rng, file.read_bytes()))
    # It goes on from where it stopped, with increments that may be cut again.
    return tools.record_case[:2] + ["--set", "Press/max cuts=8", "--resume"]


KINDS = {"parameters": damage_parameters, "meshes": damage_mesh, "dies": damage_die, "records": damage_record}


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


class Server:
    """Starts the program without loading it anew, see fork_server.cc; one run at a time."""

    def __init__(self, program, environment):
        self.process = subprocess.Popen([program, str(MEMORY)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)

    def follow(self, folder, arguments):
        """Runs it for a minute at most. @return exit status, negative of a signal's number, None where it was stopped; output;
        errors; seconds since it last said something"""
        files = [folder / "../stdout", folder / "../stderr"]
        self.process.stdin.write("\x1f".join(map(str, [folder, *files, *arguments])) + "\n")
        self.process.stdin.flush()
        pid = int(self.process.stdout.readline())
        silent = []

        def stop():
            silent.append(time.time() - max(file.stat().st_mtime for file in files))
            os.kill(pid, signal.SIGKILL)

        timer = threading.Timer(LONGEST, stop)
        timer.start()
        kind, number = self.process.stdout.readline().split()
        timer.cancel()
        status = None if silent else int(number) if kind == "exit" else -int(number)
        return status, *(file.read_text(encoding="utf-8", errors="replace") for file in files), silent[0] if silent else 0.0


def follow_itself(program, folder, arguments, environment):
    """The same of a program that starts others, which a fork of another program cannot."""
    files = [folder / "../stdout", folder / "../stderr"]
    with open(files[0], "w", encoding="utf-8") as out, open(files[1], "w", encoding="utf-8") as errors:
        with subprocess.Popen([program, *map(str, arguments)], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=out,
                              stderr=errors, start_new_session=True) as running:
            resource.prlimit(running.pid, resource.RLIMIT_AS, (MEMORY, MEMORY))
            try:
                status, silent = running.wait(LONGEST), 0.0
            except subprocess.TimeoutExpired:
                status, silent = None, time.time() - max(file.stat().st_mtime for file in files)
                os.killpg(running.pid, signal.SIGKILL)
    return status, *(file.read_text(encoding="utf-8", errors="replace") for file in files), silent


def not_finite(results):
    """The first result that is no finite number, if there is one; files have null for those."""
    if (results / "optimisation.json").exists():
        found = json.loads((results / "optimisation.json").read_text(encoding="utf-8"))
        numbers = {**{of: found["objective"][of] for of in ("start", "best")},
                   **{parameter["name"]: parameter["best"] for parameter in found["parameters"]}}
        if None in numbers.values():
            return f"optimisation.json: of {numbers} one is no number"
    if (results / "summary.json").exists():
        summary = json.loads((results / "summary.json").read_text(encoding="utf-8"))
        numbers = [(objective["name"], objective["value"]) for objective in summary["objectives"]]
        numbers += [(parameter["name"], number) for parameter in summary.get("parameters", []) for number in parameter.get("gradient", {}).values()]
        numbers += [(name, summary[name]) for name in ("volume_initial", "volume_final")]
        for name, number in numbers:
            if number is None:
                return f"summary.json: {name} is no number"
    for file in results.glob("*.csv"):
        with open(file, encoding="utf-8", newline="") as stream:
            for row in csv.DictReader(stream):
                # Of the whole part nothing is known where the planes of symmetry bound none.
                bad = [(name, x) for name, x in row.items() if not name.startswith("whole") and x.strip().lower().lstrip("+-")
                       in ("nan", "inf", "infinity")]
                if bad:
                    return f"{file.name}: {bad[0]}"
    return None


def trial(tools, kind, number, seed, keep):
    rng = random.Random(f"{seed}:{kind}:{number}")
    folder = pathlib.Path(tempfile.mkdtemp(dir=tools.folder)) / "run"
    arguments = KINDS[kind](rng, tools, folder)
    word = "gradient" if kind == "records" else rng.choice(COMMANDS)
    arguments = [part for setting in SHORT.get(word, ()) for part in ("--set", setting)] + arguments
    output = folder / "out"
    beside = kind != "records" and rng.random() < 1 / 3
    if beside:
        shutil.copytree(tools.former, output)
        arguments += rng.choice(([], ["--overwrite"], ["--overwrite"]))
    before = contents(output) if output.exists() else {}
    command = [tools.program, word, "case.prm", "--output", "out"] + arguments
    status, said, errors, silent = (follow_itself(tools.program, folder, command[1:], tools.environment(tools.folder)) if word == "scan"
                                     else tools.server().follow(folder, command[1:]))
    accepted = ACCEPTED.search(said) is not None or status in (0, None)
    defect = None
    if status is None:
        outcome = "long"
        nodes = re.findall(r"(\d+) nodes", said)
        if silent > SILENT and not (nodes and int(nodes[-1]) > LARGE) and "expect hours" not in said:
            defect = f"hangs: silent for {silent:.0f} s"
    elif status == 0 or (word == "optimize" and status == 2):
        outcome = "ended"
        defect = not_finite(output) if output.exists() else None
        if re.search(r"ended by signal|ended with status|left no results", said):
            defect = "a run of a scan ended without a message"
        if RAW.search(errors + said):
            defect = "raw: " + RAW.search(errors + said).group()
    elif status == 1:
        outcome = "stopped" if accepted else "refused"
        if RAW.search(errors + said):
            defect = "raw: " + RAW.search(errors + said).group()
        elif not MESSAGE.fullmatch(errors) and not (not errors and re.search(CAN_FAIL.get(word, "(?!)"), said)):
            defect = "no message of the form where: what; rule; remedy"
    else:
        outcome, defect = "crashed", f"exit status {status}"
    if before and not (accepted and ("--overwrite" in arguments or "--resume" in arguments)):
        lost = [name for name, data in before.items() if not (output / name).exists() or (output / name).read_bytes() != data]
        if lost and not defect:
            defect = "lost of an earlier run: " + ", ".join(lost)
    if tools.told:
        print(f"{kind}:{number}: {word}: {outcome}: {errors.strip()[:200] or said.strip()[-200:]}", flush=True)
    if defect:
        defect = f"{kind}:{number}: {defect}\n    {' '.join(map(repr, command[1:]))}\n    {errors.strip()[-400:]}"
        if keep:
            shutil.copytree(folder, keep / f"{kind}_{number}", dirs_exist_ok=True)
    shutil.rmtree(folder.parent)
    return outcome, defect


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("fork_server")
    parser.add_argument("--trials", default="parameters=2000,meshes=300,dies=300,records=200")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="one trial, KIND:NUMBER")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path, help="folder that trials with defects are copied to")
    parser.add_argument("--told", action="store_true", help="tell the outcome of each trial")
    options = parser.parse_args()
    trials = {kind: int(count) for kind, count in (item.split("=") for item in options.trials.split(","))}
    todo = [(kind, i) for kind, count in trials.items() for i in range(count)]
    if options.only:
        kind, _, number = options.only.partition(":")
        todo = [(kind, int(number))]
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(os.path.abspath(options.program), os.path.abspath(options.fork_server), pathlib.Path(folder), options.told)
        outcomes, defects = collections.defaultdict(collections.Counter), []
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for (kind, _), (outcome, defect) in zip(todo, pool.map(lambda at: trial(tools, *at, options.seed, options.keep), todo)):
                outcomes[kind][outcome] += 1
                if defect:
                    defects.append(defect)
                    print("DEFECT", defect, flush=True)
    for kind, counts in outcomes.items():
        print(f"{kind}: " + ", ".join(f"{count} {outcome}" for outcome, count in sorted(counts.items())))
    print(f"{len(defects)} defects")
    sys.exit(1 if defects else 0)


main()
