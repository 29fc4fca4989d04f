# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The samples of a robust optimisation forged by groups of ranks side by side: bit for bit what one rank finds, with designs that fail, and
killed and resumed by another number of groups.  Usage: side_by_side.py RETROFORGE"""
import os
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from scene import SCENE, journal_of, judge_same, lines_of, optimize, rows_of  # noqa: E402
from whole_runs import ENVIRONMENT, changed, command, judge, main, prm, run, start, text_of  # noqa: E402

SCATTERED = changed(SCENE, {"Design": {"parameters": "billet/control point 1 r, billet/control point 2 r, dies/friction"},
                            "Optimisation": {"noise runs": 1, "scattered": "dies/friction", "scatter range": "0.2, 0.6", "iterations": 4}})


def groups(number):
    return f"Optimisation/side by side={number}"


def shapes_of(output):
    return sorted(os.listdir(os.path.join(output, "designs")))


def same_bits():
    optimize("one")
    for n in (2, 3):
        _, printed = optimize(f"groups{n}", groups(n), ranks=n)
        judge_same(f"{n} groups", f"groups{n}", "one")
        judge(f"{n} groups: the same shapes", shapes_of(f"groups{n}") == shapes_of("one") and all(
            text_of(f"groups{n}", "designs", name) == text_of("one", "designs", name) for name in shapes_of("one") if name.endswith(".msh")))
        judge(f"{n} groups: told once", printed.count(f"by {n} groups") == 1 and printed.count("  0  start") == 1, printed)


def groups_of_two():
    """Of 2 ranks each: the bits are those of 2 ranks."""
    settings = ("Optimisation/iterations=1", "Optimisation/noise runs=0")
    optimize("two", *settings, ranks=2)
    optimize("four", *settings, groups(2), ranks=4)
    judge_same("groups of two ranks", "four", "two")
    judge("its header", journal_of("four")[0].endswith("2 rank(s)"), journal_of("four")[0])


def failing():
    """Steps so long that the contour crosses the axis; and a first design one of whose samples, not the first, begins inside the die."""
    settings = ("Optimisation/first step=400", "Optimisation/largest step=400", "Optimisation/iterations=2")
    optimize("failing", *settings, status=2)
    rows = [row for row in rows_of("failing") if row["decision"] == "failed"]
    judge("some fail", rows and all("with dies/friction = " in row["failure"] for row in rows), rows)
    optimize("failing2", *settings, groups(2), ranks=2, status=2)
    judge_same("where designs fail", "failing2", "failing")
    offset = ("Design/parameters=billet/control point 1 r, die upper/offset", "Optimisation/scattered=die upper/offset",
              "Optimisation/scatter range=-1, 3")
    alone = run("optimize", "first", *offset)
    done = start(["mpirun", "-np", "2", *command("optimize", "first2", *offset, groups(2))])
    message = next((line for line in alone.stderr.splitlines() if "with die upper/offset = 2.5" in line), "nothing")
    judge("the first design must succeed, in all samples", alone.returncode == 1 and "cannot forge the design it begins with" in message, alone.stderr)
    judge("which is told once", done.returncode == 1 and done.stderr.count(message) == 1, done.stderr)


def killed():
    n_lines = len(text_of("one", "journal.jsonl").splitlines())
    for lines, n in ((2, 2), (n_lines // 2, 1)):
        shutil.rmtree("killed", ignore_errors=True)  # or its lines would be counted before it begins
        with subprocess.Popen(["mpirun", "-np", "2", *command("optimize", "killed", groups(2), "--overwrite")], env=ENVIRONMENT,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
            while running.poll() is None and lines_of("killed") < lines:
                time.sleep(0.002)
            time.sleep(0.03)
            running.send_signal(signal.SIGTERM)
        _, printed = optimize("killed", "--resume", groups(n), ranks=n)
        judge("it goes on", "taken from the journal" in printed)
        judge_same(f"killed after {lines} lines, resumed by {n} group(s)", "killed", "one", is_resumed=True)


def refused():
    alone = ("Design/parameters=billet/control point 1 r", "Optimisation/scattered=", "Optimisation/scatter range=")
    for what, ranks, settings, expected in (
            ("groups that do not divide the ranks", 2, [groups(3)], "is 3, and there are 2 ranks"),
            ("groups without scatter", 2, [groups(2), *alone], "each design is forged once"),
            ("more groups than samples", 4, [groups(4)], "each design is forged 3 times")):
        done = start(["mpirun", "-np", str(ranks), *command("optimize", "wrong", *settings)])
        judge(what, done.returncode == 1 and done.stderr.count(expected) == 1 and not os.path.exists("wrong"), done.stderr.strip())
    done = start(["mpirun", "-np", "4", *command("optimize", "one", "--resume", groups(2))])
    judge("groups of another size", done.returncode == 1 and "number of ranks of a group" in done.stderr, done.stderr.strip())


main({"case.prm": prm(SCATTERED)}, (same_bits, groups_of_two, failing, killed, refused))
