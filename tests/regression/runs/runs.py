# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What runs leave behind: numbers of the whole part beside those of the model; of a run that fails, the reason and the
workpiece there; of one that is stopped, what it had, and how to go on; of a check, what is done; nothing of a record beside
the finished one; no number that is not finite; fields and dies as time goes on; what a user must know of the volume. Usage: runs.py RETROFORGE

By hand: without friction a block is upset evenly, and its energy does not depend on how symmetry cut it. Pressed from
above at v against a die, or from both sides at v/2 over half the stroke, is the same flow."""
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as xml

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import (ENVIRONMENT, ROOT, changed, command, cube, history_of, judge, main, prm, run, start, summary_of,  # noqa: E402
                        text_of, upsetting)

sys.path.insert(0, str(ROOT / "contrib"))
from retroforge_report import vtu  # noqa: E402

REPORT = str(ROOT / "contrib/report")
SMOOTH = {"friction": 0}
CASE = changed(cube(20, 7, 2, 4), {"Die lower": SMOOTH, "Die upper": SMOOTH,
                                   "Objectives": {"names": "energy, maximum effort, volume, mean strain"}})
CYLINDER = upsetting("cylinder", {"radius": 20, "height": 40}, 8, 40, 2, 2)
UPPER = changed({name: section for name, section in CASE.items() if name != "Die lower"}, {"Dies": {"names": "upper"}})


def results(output):
    """{objective: entry} of its summary, and the last row of its history."""
    summary, history = summary_of(output), history_of(output)
    return summary, {o["name"]: o for o in summary["objectives"]}, {k: float(v) for k, v in history[-1].items()}


def near(a, b, tolerance):
    return abs(a - b) <= tolerance * abs(b)


def whole_part():
    """A quarter, an eighth pressed half as far at half the speed, and a half: the same block."""
    runs = (("quarter", 4, 4, ()), ("half", 2, 2, ("Billet/symmetry planes=-1, 0, 0", "Die lower/friction=1e-4")),
            ("eighth", 8, 4, ("Billet/symmetry planes=-1, 0, 0; 0, -1, 0; 0, 0, -1", "Billet/symmetry point=centre", "Dies/names=upper",
                              "Die upper/velocity=0, 0, -50", "Press/stroke=1")))
    wholes = {}
    for name, copies, force_factor, settings in runs:
        done = run("simulate", name, *settings, case="upper.prm" if name == "eighth" else "case.prm")
        judge(f"{name}: ends", done.returncode == 0, done.stderr)
        summary, objectives, last = results(name)
        judge(f"{name}: factors", summary["whole"] == {"copies": copies, "force_factor": force_factor}, summary["whole"])
        for objective, factor in (("energy", copies), ("volume", copies), ("maximum effort", force_factor)):
            entry = objectives[objective]
            judge(f"{name}: {objective}", entry["whole"] == factor * entry["value"], entry)
        judge(f"{name}: no whole of a mean", "whole" not in objectives["mean strain"])
        judge(f"{name}: history", near(last["whole_energy"], objectives["energy"]["whole"], 1e-12) and
              last["whole_force"] == force_factor * last["force"] and last["whole_volume"] == copies * last["volume"])
        judge(f"{name}: printed", f"1/{copies} of the part" in done.stdout and "of the whole part" in done.stdout)
        wholes[name] = (last["whole_force"], last["whole_energy"], last["whole_volume"])
    for name in ("half", "eighth"):
        judge(f"{name}: the same block", all(near(a, b, 2e-3) for a, b in zip(wholes[name], wholes["quarter"])), wholes)
    done = start([REPORT, "--no-vtk", "quarter"])
    judge("reported", done.returncode == 0 and "whole part" in text_of("quarter", "report.html"), done.stderr)


def beside():
    """The true maximum is no summand."""
    _, objectives, last = results("quarter")
    judge("summands", near(sum(objectives["energy"]["parts"].values()), objectives["energy"]["value"], 1e-15))
    effort = objectives["maximum effort"]
    judge("the maximum is told beside", "parts" not in effort and effort["details"]["true maximum"] >= effort["value"])
    judge("which is about the force", near(effort["details"]["true maximum"], last["force"], 1e-2), (effort, last["force"]))


def trust():
    """A block whose mesh is remade before increment 19 of 20, within the few that make the largest force; and one whose mesh stays."""
    settings = ("Press/increments=20", "Remeshing/when=increments", "Design/parameters=die upper/offset, material/K",
                "Objectives/names=energy, maximum effort, volume")
    for every, remeshed in ((18, 1), (20, 0)):
        done = run("gradient", f"trust{every}", *settings, f"Remeshing/every={every}")
        judge(f"every {every}: ends", done.returncode == 0 and done.stdout.count("remeshed:") == remeshed, done.stdout + done.stderr)
        summary, objectives, _ = results(f"trust{every}")
        judge(f"every {every}: noted", [name for name, o in objectives.items() if "1 remeshing lies" in o.get("note", "")] ==
              ["maximum effort"] * remeshed and done.stdout.count("note: it is made of") == remeshed, objectives)
        final = {"volume": "not judged across 1 remeshing: scan"} if remeshed else {}
        judge(f"every {every}: slopes", [p["trust"] for p in summary["parameters"]] ==
              [{"energy": "within 5 %", "maximum effort": "within 20 %", **final}, {"energy": "exact", "maximum effort": "exact", **final}], summary["parameters"])
        judge(f"every {every}: printed", done.stdout.count("; exact\n") == 2 and done.stdout.count("; how far it holds\n") == 2 + remeshed, done.stdout)


def not_finite():
    done = run("gradient", "infinite", "Objectives/names=contact pressure", "Objective contact pressure/sharpness=1000")
    judge("infinite results", done.returncode == 1 and "Objective contact pressure: its value is inf" in done.stderr, done.stderr)
    judge("infinite results: no summary", not os.path.exists("infinite/summary.json"))


def fields():
    """Of the block upset evenly, its mesh remade before every other increment."""
    done = run("simulate", "fields", "Contact/approach=1", "Remeshing/when=increments", "Remeshing/every=2")
    judge("fields: ends", done.returncode == 0 and done.stdout.count("remeshed") == 1, done.stdout + done.stderr)
    parts = [(float(p.get("timestep")), p.get("file")) for p in xml.parse("fields/fields.pvd").iter("DataSet")]
    judge("fields: three parts at five times", [file[:-len("_000000.vtu")] for _, file in parts] == ["fields", "die_lower", "die_upper"] * 5, parts)
    judge("fields: the dies move", all(np.abs(vtu.read(f"fields/{file}").points[:, 2] - (0, 20 - 100 * t)["upper" in file]).max() < 1e-9
                                       for t, file in parts if file.startswith("die")))
    judge("fields: at the ends of the increments", np.allclose([t for t, _ in parts[::3]], [0, 0.005, 0.01, 0.015, 0.02]), parts)
    billet, last = (vtu.read(f"fields/{parts[i][1]}") for i in (0, -3))
    judge("fields: all of the billet's are zero", {**last.point_data, **last.cell_data}.keys() == {
        **billet.point_data, **billet.cell_data}.keys() and not any(x.any() for x in billet.point_data.values()))
    judge("fields: symmetry planes", np.array_equal(last.symmetry_planes[:, 3:], [[-1, 0, 0], [0, -1, 0]]), last.symmetry_planes)
    side = math.sqrt(18 / 20)
    for name, found, expected in (
            ("displacement", last.point_data["displacement [mm]"], last.points * (1 - np.array([side, side, 20 / 18]))),
            ("equivalent strain", last.cell_data["equivalent_strain"], math.log(20 / 18)),
            ("von Mises stress", last.cell_data["von_mises_stress [MPa]"], 1.693 * 3**(1.139 / 2) * (100 / 18.25)**0.139),
            ("touching die", last.point_data["touching_die"], np.select([last.points[:, 2] < 1e-3, last.points[:, 2] > 17.999],
                                                                        [1, 2]))):
        error = np.abs(found - expected).max() / np.abs(expected).max()
        judge(f"fields: {name}", error < 2e-3, f"{error:.1e}")
    reported("fields", "shapes.png")


def strokes_of(folder):
    """Of the pictures, at 100 mm/s."""
    return [100 * float(p.get("timestep")) for p in xml.parse(f"{folder}/fields.pvd").iter("DataSet") if p.get("file").startswith("f")]


def pictures():
    """Of 50 increments of 0.04 mm: the billet, and of each twentieth of the stroke, 0.1 mm, the end of the increment that reaches it."""
    done = run("simulate", "pictures", "Press/increments=50")
    expected = [0.04 * math.ceil(round(2.5 * k, 9)) for k in range(21)]
    judge("pictures: evenly over the stroke", done.returncode == 0 and np.allclose(strokes_of("pictures"), expected), strokes_of("pictures"))
    files = [name for name in os.listdir("pictures") if name.endswith(".vtu")]
    judge("pictures: no others", len(files) == 3 * 21, files)
    done = run("simulate", "none", "Output/fields every=0")
    judge("pictures: none", done.returncode == 0 and not any(name.endswith((".vtu", ".pvd")) for name in os.listdir("none")), os.listdir("none"))
    done = run("simulate", "ends", "Output/fields every=1000")
    judge("pictures: ends", done.returncode == 0 and np.allclose(strokes_of("ends"), [0, 2]), strokes_of("ends"))


def chords():
    """The quarter of a round billet, pi 20^2 40 / 4 mm^3, whose mesh lacks some; at the radius that is told its mesh has it."""
    done = run("simulate", "round", case="round.prm")
    summary, volume = summary_of("round"), math.pi * 20**2 * 40 / 4
    lack = summary["volume_initial"] / volume - 1
    judge("chords: the shape's volume", near(summary["volume_of_shape"], volume, 1e-9), summary["volume_of_shape"])
    judge("chords: the mesh has less", -0.04 < lack < -0.01, lack)
    told = re.search(r"note: the mesh has chords .* \((\S+) %\).*--at billet/radius=(\S+) ", done.stdout)
    judge("chords: told", told and near(float(told[1]), 100 * lack, 1e-2), done.stdout)
    done = run("simulate", "rounder", ("billet/radius", float(told[2])), case="round.prm")
    summary = summary_of("rounder")
    judge("chords: none lacks", near(summary["volume_initial"], volume, 2e-6) and "chords" not in done.stdout, summary["volume_initial"])
    judge("chords: of that radius", near(summary["volume_of_shape"], volume * (float(told[2]) / 20)**2, 1e-9), summary["volume_of_shape"])
    judge("chords: a block has none", near(summary_of("quarter")["volume_of_shape"], 20**3 / 4, 1e-9) and
          near(summary_of("quarter")["volume_initial"], 20**3 / 4, 1e-9))


def lost_volume():
    """Euler's long increments lose metal: told from 0.2 % on, with what helps, and the run is as good as another."""
    for name, increments, is_much in (("much", 4, True), ("little", 100, False)):
        done = run("simulate", name, "Press/scheme=euler", f"Press/increments={increments}", "Output/fields every=0")
        summary = summary_of(name)
        change = summary["volume_final"] / summary["volume_initial"] - 1
        warnings = [text for text in summary.get("warnings", []) if "of its volume" in text]
        judge(f"{name} volume lost", (abs(change) > 2e-3) == is_much, change)
        judge(f"{name} volume lost: told", done.returncode == 0 and len(warnings) == is_much and
              all(f"{100 * abs(change):.2g} %" in text and f"warning: {text}" in done.stdout for text in warnings), done.stdout)
    reported("much", "Warning: the workpiece has")


def failed():
    """In the second increment, for a reason that a mesh shows."""
    done = run("gradient", "failed", "Press/stroke=18", "Press/increments=6", "Press/max cuts=0", "Press/largest move=0.3",
               "Remeshing/when=never")
    judge("failed: the reason is kept", done.returncode == 1 and text_of("failed", "failure.txt") in done.stderr, done.stderr)
    judge("failed: the mesh is kept", 'file="failed.vtu"' in text_of("failed", "fields.pvd") and os.path.exists("failed/failed.vtu"))
    reported("failed", "The run failed", "shapes.png", "Press/stroke")


def reported(folder, *expected):
    done = start([REPORT, "--no-vtk", folder])
    page = text_of(folder, "report.html") if done.returncode == 0 else ""
    pictures = os.listdir(os.path.join(folder, "pictures")) if page else []
    missing = [text for text in expected if text not in page and text not in pictures]
    judge(f"{folder}: reported", done.returncode == 0 and not missing, f"{done.stderr} {missing}")


def stop(words, ready):
    """Ctrl-C when `ready`; what it said on the error stream."""
    with subprocess.Popen(words, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        for _ in range(3000):
            if ready() or process.poll() is not None:
                break
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        said = process.communicate()[1]
        judge("stopped by the signal", process.returncode == -signal.SIGINT, process.returncode)
    return said


def stopped():
    """And resumed; and the increments put back as if it had been killed as it finished."""
    fine = ("Press/increments=200", "Output/fields every=20")
    stop(command("simulate", "early", "Press/increments=2000", "Output/fields every=1000"), lambda: os.path.exists("early/fields.pvd"))
    judge("stopped early: has the billet", strokes_of("early") == [0] and os.path.exists("early/fields_000000.vtu"), os.listdir("early"))
    said = stop(command("gradient", "stopped", *fine), lambda: os.path.exists("stopped/record/increment_000030.h5"))
    judge("stopped: says how to go on", "--resume" in said and "contrib/report stopped" in said, said)
    reported("stopped", "The run was stopped", "--resume", "force.png", "Results until stroke")
    shutil.copytree("stopped/record", "copy")
    done = run("gradient", "stopped", *fine, "--resume")
    judge("stopped: resumed", done.returncode == 0, done.stderr)
    energy = results("stopped")[1]["energy"]["value"]
    shutil.copytree("copy", "stopped/record")
    done = run("gradient", "stopped", *fine, "--resume")
    judge("killed as it finished: same results", done.returncode == 0 and results("stopped")[1]["energy"]["value"] == energy, done.stderr)
    judge("killed as it finished: nothing stays", not os.path.exists("stopped/record"))


def check():
    """Four directions, one of them random: stopped after the first, and left alone. Runs by hand: 2 of each step, and 3 of the
    Taylor test."""
    few = ("Check/steps=1e-4, 1e-6", "Check/taylor halvings=2", "Check/free differences=false",
           "Design/parameters=material/K, material/m, billet/stretch")
    done = run("check", "check", *few)
    judge("check: says how many runs", "check of 4 directions by 7 forgings" in done.stdout and "28 forgings, about" in done.stdout)
    judge("check: shows progress", all(f"{i}/4 " in done.stdout for i in (1, 2, 3, 4)), done.stdout)
    summary = results("check")[0]
    judge("check: nothing remains", done.returncode == 0 and summary["check_remaining"] == 0 and len(summary["check"]) == 16)

    def one_is_done():
        try:
            return summary_of("part")["check_remaining"] < 4
        except OSError:
            return False
    stop(command("check", "part", *few, "Press/increments=40"), one_is_done)
    summary = results("part")[0]
    left = summary["check_remaining"]
    judge("check stopped: keeps what is done", 0 < left < 4 and len(summary["check"]) == 4 * (4 - left), left)
    reported("part", f"{left} directions are not checked", "energy")


main({"case.prm": prm(CASE), "upper.prm": prm(UPPER), "round.prm": prm(CYLINDER)},
     (whole_part, beside, trust, not_finite, fields, pictures, chords, lost_volume, failed, stopped, check))
