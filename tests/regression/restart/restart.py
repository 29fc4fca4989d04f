# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A run that failed goes on with other numerics from where its record ends: more increments, remeshing, then another time
scheme and contact in other units of the increment. Proved: the failure says how; adjoint and direct method agree to 1e-10 across
the changes, differences replayed across them to 1e-6, and free ones follow the same changes; the record tells what held from where.
A stretch killed and resumed, the whole resumed twice, and a stroke made longer give the bits of a run left alone. Another
scene is refused by the names of all that differs, and nothing in the folder changes. A check that was stopped repeats nothing.

By hand: 2 mm in 4 increments and on to 3 mm are 6 increments of 0.5 mm, as 3 mm in 6 are. Usage: restart.py RETROFORGE"""
import json
import os
import re
import shutil
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from whole_runs import contents, changed, cube, history_of, judge, main, prm, run, summary_of, text_of, write  # noqa: E402

CASE = changed(cube(20, 7, 12, 6, **{"largest move": 0.18, "max cuts": 0}), {
    "Die upper": {"facing": "0.08, 0.05, -1"}, "Contact": {"penetration": 1e-4}, "Remeshing": {"when": "never"},
    "Objectives": {"names": "energy, mean strain"}, "Design": {"parameters": "material/m, billet/height"},
    "Check": {"steps": "1e-5, 1e-6", "taylor start": 1e-4, "taylor halvings": 2, "free differences": "false"}})

FINER = ("Remeshing/when=increments", "Remeshing/every=4", "Press/increments=20", "Press/largest move=0.042", "Press/max cuts=1")
OTHER = (*FINER[:2], "Press/increments=60", "Press/scheme=euler", "Contact/layer=0.8", "Contact/approach=1.5", "Newton/tolerance=1e-10")

def results(output):
    """Objectives and gradients, to all digits."""
    summary = summary_of(output)
    return summary["objectives"], summary["parameters"]


def n_recorded(output):
    return sum(name.startswith("increment_") for name in os.listdir(os.path.join(output, "record")))


def failed():
    """Too long increments on the first mesh: the message says how to go on, and does not lie."""
    done = run("simulate", "run")
    judge("failed: says how to go on", done.returncode == 1 and done.stderr.count("\n") == 1 and all(
        text in done.stderr for text in ("--resume", "--set Press/increments=12", "--set Remeshing/when=quality")), done.stderr)
    judge("failed: after some increments", 2 <= n_recorded("run") <= 5, n_recorded("run"))
    shutil.copytree("run", "failed")
    again = run("simulate", "run", "--resume")
    judge("failed: unchanged it fails alike", again.stderr == done.stderr and n_recorded("run") == n_recorded("failed"), again.stderr)


def refused():
    before = contents("run")
    done = run("simulate", "run", "--resume", *FINER, "Material/consistency=2", "Die upper/friction=0.2", "Contact/penetration=1e-3",
               "Remeshing/first mesh=true", "Press/stroke=1")
    names = ("Material/consistency is '2' and was '1.693'", "Die upper/friction is '0.2' and was '0.3'", "Contact/penetration",
             "Remeshing/first mesh", "Press/stroke is 1 mm and the record has come to", "--overwrite", "nothing was changed")
    judge("refused: all by name", done.returncode == 1 and done.stderr.count("\n") == 1 and all(n in done.stderr for n in names),
          done.stderr)
    judge("refused: what may change is not told", "Press/increments" not in done.stderr and "every" not in done.stderr, done.stderr)
    judge("refused: no byte changed", contents("run") == before)


def killed_and_resumed():
    """The second stretch is too coarse as well. Its record short of the last increments is what a kill would have left."""
    first = n_recorded("run")
    done = run("simulate", "run", "--resume", *FINER)
    second = n_recorded("run")
    judge("second stretch: fails after some increments", done.returncode == 1 and second >= first + 3, f"{first} {second} {done.stderr}")
    judge("second stretch: says what changed", "Press/increments = 20, was 6" in done.stdout and "Remeshing/when" in done.stdout,
          done.stdout)
    left = re.findall(r"^ +\d+ .* (-|\d+ s)$", done.stdout, re.M)
    judge("second stretch: time left from here on", left[:first] == ["-"] * first and len(left) == second and "-" not in left[first:], left)
    for kept in (first, second - 2):
        shutil.copytree("run", "killed")
        for i in range(kept, second):
            os.remove(f"killed/record/increment_{i:06}.h5")
        for _ in range(2):
            run("simulate", "killed", "--resume", *FINER)
        same = {path[len("run"):]: data for path, (data, _) in contents("run").items() if "/record/" in path} == {
            path[len("killed"):]: data for path, (data, _) in contents("killed").items() if "/record/" in path}
        judge(f"killed after increment {kept}: the same bits", same)
        shutil.rmtree("killed")
    return first, second


def checked(first, second):
    """Three stretches, differentiated in all ways; twice, with a stop after the first direction."""
    done = run("check", "run", "--resume", *OTHER)
    summary = summary_of("run")
    judge("checked: passes", done.returncode == 0, done.stdout + done.stderr)
    rows = summary["check"]
    judge("checked: all rows", len(rows) == 6 and summary["check_remaining"] == 0, len(rows))
    tangents = [abs(r["tangent"] / r["adjoint"] - 1) for r in rows]
    judge("adjoint against direct method", max(tangents) < 1e-10, tangents)
    replayed = [min(abs(s["replayed_central"] / r["adjoint"] - 1) for s in r["steps"]) for r in rows]
    judge("adjoint against replayed differences", max(replayed) < 1e-6, replayed)
    restarts = summary["restarts"]
    judge("restarts are told", [r["increment"] for r in restarts] == [first + 1, second + 1] and
          restarts[0]["changed"]["Press/increments"] == ["6", "20"] and restarts[1]["changed"]["Press/scheme"] == ["midpoint", "euler"] and
          "Remeshing/every" not in restarts[1]["changed"], restarts)
    judge("remeshed, and not at first", summary["remeshings"] >= 2 and "remeshed" in done.stdout)
    steps = [float(b["stroke"]) - float(a["stroke"]) for a, b in zip(history_of("run"), history_of("run")[1:])]
    judge("increments of each stretch", min(steps[:first - 1]) > 1.9 and
          0.25 < min(steps[first - 1:second - 1]) and max(steps[second - 1:]) < 0.21, steps)

    kept = json.loads(text_of("run/check.json"))
    kept["rows"] = [row for row in kept["rows"] if row["parameter"] == "material/m"]
    write("run/check.json", json.dumps(kept))
    again = run("check", "run", "--resume", *OTHER)
    judge("check resumed: repeats nothing", again.returncode == 0 and "1 done before" in again.stdout and "  1/3" not in again.stdout and
          "  2/3" in again.stdout, again.stdout + again.stderr)

    found = summary_of("run")["check"]
    judge("check resumed: what was done is kept", [r for r in found if r["parameter"] == "material/m"] == [
        r for r in rows if r["parameter"] == "material/m"], found)
    judge("check resumed: the rest is the same", [(r["objective"], r["parameter"], r["adjoint"]) for r in found] == [
        (r["objective"], r["parameter"], r["adjoint"]) for r in rows] and all(
            abs(a["replayed_central"] / b["replayed_central"] - 1) < 1e-6 for r, s in zip(found, rows) for a, b in zip(r["steps"], s["steps"])))
    other = run("check", "run", "--resume", *OTHER, "Check/steps=1e-5", "Design/parameters=material/m")
    judge("check of other steps: begins anew", "done before" not in other.stdout and other.returncode == 0, other.stdout)


def free():
    """Free runs change their numerics where the record does, and so follow the replays but for the jumps of their decisions."""
    # A decision may change between neighbours, so that one step alone tells of a jump.
    done = run("check", "run", "--resume", *OTHER, "Check/steps=3e-5, 1e-5, 3e-6, 1e-6", "Check/free differences=true", "Design/parameters=material/m")
    row = next(r for r in summary_of("run")["check"] if r["parameter"] == "material/m" and r["objective"] == "energy")
    errors = [abs(s["free_central"] / row["adjoint"] - 1) for s in row["steps"]]
    judge("free differences change numerics at the same stroke", done.returncode == 0 and sorted(errors)[1] < 3e-3, f"{errors} {done.stderr}")


def finished():
    done = [run("gradient", "run", "--resume", *OTHER)]
    once = results("run")
    done.append(run("gradient", "run", "--resume"))
    judge("finished: other settings change nothing", all(d.returncode == 0 for d in done) and results("run") == once and
          "do not change it" in done[1].stdout, done[1].stdout + done[1].stderr)
    judge("size of its record", summary_of("run")["record_bytes"] == os.path.getsize("run/record.h5"), summary_of("run")["record_bytes"])


def longer_stroke():
    sound = ("Press/largest move=0.5", "Output/fields every=0")
    run("gradient", "long", *sound, "Press/stroke=3", "Press/increments=6")
    run("simulate", "short", *sound, "Press/stroke=2", "Press/increments=4")
    shutil.copytree("short", "moved")
    done = run("gradient", "short", "--resume", *sound, "Press/stroke=3", "Press/increments=6")
    judge("longer stroke: the bits of one run", done.returncode == 0 and results("short") == results("long"), done.stderr)
    judge("longer stroke: one record", os.path.exists("short/record.h5") and not os.path.exists("short/record"))


STL = "solid wedge\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {{z}}\n" for x, y in corners) + "endloop\nendfacet\n"
    for corners in (((-60, -60), (60, 60), (60, -60)), ((-60, -60), (-60, 60), (60, 60)))) + "endsolid wedge\n"


def other_die():
    """As many facets, elsewhere."""
    die = ("Die upper/shape=stl", "Die upper/file=die.stl", "Die upper/point=0, 0, 0", "Die upper/facing=0, 0, -1", "Press/stroke=1",
           "Press/increments=2", "Press/largest move=0.5")
    for height in (20, 20.5):
        write("die.stl", STL.format(z=height))
        if height == 20:
            first = run("simulate", "stl", *die)
            before = contents("stl")
    done = run("simulate", "stl", "--resume", *die)
    judge("another die of as many facets", first.returncode == 0 and done.returncode == 1 and "Die upper" in done.stderr and
          "differs from that in the record" in done.stderr and contents("stl") == before, first.stderr + done.stderr)


def stretches():
    checked(*killed_and_resumed())


main({"case.prm": prm(CASE)}, (failed, refused, stretches, free, finished, longer_stroke, other_die))
