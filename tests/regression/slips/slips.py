# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Slips of a new user, in units, signs, places, names and files, each in one setting or two of a sound scene: before the first increment the
run is refused with one message, or warns once, by the name of the setting. The sound scene itself, and each of the scenes that come with
Retroforge, is told nothing. Usage: slips.py RETROFORGE"""
import os
import re
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import whole_runs  # noqa: E402
from whole_runs import PROGRAM, ROOT, judge, judge_message, prm, settings, start  # noqa: E402

# A quarter of a cube of 40 mm in 7 increments, each of which takes a blink.
SCENE = whole_runs.changed(whole_runs.cube(40, 16, 4, 7), {"Output": {"fields every": 0, "record": "false"}})
CASE = prm(SCENE)
WHOLE = "Billet/symmetry planes="


def plate(side, unit=1.0):
    """A square as STL, which faces upwards; lengths over the unit of the file."""
    a = side / 2 / unit
    facets = ((-a, -a, 0, a, -a, 0, a, a, 0), (-a, -a, 0, a, a, 0, -a, a, 0))
    return b" " * 80 + struct.pack("<I", 2) + b"".join(struct.pack("<12fH", 0, 0, 0, *facet, 0) for facet in facets)


FILES = {"plate.stl": plate(120), "plate_in_inches.stl": plate(120, 25.4), "plate_in_metres.stl": plate(120, 1000.0),
         "plate_in_microns.stl": plate(120, 1e-3), "eighth.stl": plate(40 * 3**0.5 / 2**0.5 / 8), "empty.stl": b""}


def stl(name, *more):
    return settings("Die lower/shape=stl", f"Die lower/file={name}", *more)


def at(name, value):
    return ["--at", f"{name}={value}"]


# What is warned of: (words after the case, how the warning begins)
WARNED = {
    "consistency in Pa": (settings("Material/consistency=1.693e6"), "Material/consistency"),
    "consistency in GPa": (settings("Material/consistency=1.693e-3"), "Material/consistency"),
    "consistency in Pa, as a design": (at("material/K", "1.7e6"), "Material/consistency"),
    "velocity in m/s": (settings("Die upper/velocity=0, 0, -0.2"), "Die upper/velocity"),
    "velocity in micrometres": (settings("Die upper/velocity=0, 0, -1e5"), "Die upper/velocity"),
    "speed in m/s, as a design": (at("die upper/speed", "0.2"), "Die upper/velocity"),
    "friction in per cent": (settings("Die upper/friction=30"), "Die upper/friction"),
    "friction of both in per cent": (settings("Die lower/friction=30"), "Die lower/friction"),
    "stroke in metres": (settings("Press/stroke=0.004"), "Press/stroke"),
    "all lengths in metres": (settings("Billet/size=0.04, 0.04, 0.04", "Billet/element size=0.016", "Die upper/point=0, 0, 0.04",
                                       "Press/stroke=0.004"), "Billet"),
    "elements larger than the billet": (settings("Billet/element size=100"), "Billet/element size"),
    "elements of remeshing larger than that": (settings("Remeshing/element size=100"), "Remeshing/element size"),
    "whole stroke in one increment": (settings("Press/stroke=12", "Press/increments=1"), "Press/increments"),
    "regularised beyond the rate": (settings("Material/regularising strain rate=5"), "Material/regularising strain rate"),
    "die that moves through a symmetry plane": (settings("Die upper/velocity=30, 0, -100"), "Die upper/velocity"),
    "cavity off the symmetry planes": (settings("Die upper/shape=bell", "Die upper/point=5, 0, 40", "Die upper/Bell/mouth radius=12",
                                                "Die upper/Bell/depth=5", "Die upper/Bell/edge radius=1", "Die upper/Bell/fillet radius=1"),
                                       "Die upper/point"),
    "punch off the symmetry planes": (settings("Die upper/shape=punch", "Die upper/point=0, -6, 40", "Die upper/Punch/radius=10"),
                                      "Die upper/point"),
    "die beyond a symmetry plane": (settings("Dies/names=lower, upper, beside", "Die beside/shape=punch", "Die beside/facing=0, 0, -1",
                                             "Die beside/point=8, -22, 40", "Die beside/Punch/radius=10"), "Die beside/point"),
    "die in inches": (stl("plate_in_inches.stl"), "Die lower/scale"),
    "die scaled to inches twice": (stl("plate.stl", "Die lower/scale=25.4"), "Die lower/scale"),
}

# What is refused: (words after the case, what the message says)
REFUSED = {
    "velocity upwards": (settings("Die upper/velocity=0, 0, 100"), r"Die upper"),
    "upper die faces upwards": (settings("Die upper/facing=0, 0, 1"), r"Die upper"),
    "lower die faces downwards": (settings("Die lower/facing=0, 0, -1"), r"Die lower"),
    "stroke negative": (settings("Press/stroke=-4"), r"Press/stroke.*-4"),
    "stroke longer than the billet": (settings("Press/stroke=44"), r"Press/stroke.*less than 40"),
    "friction negative": (settings("Die upper/friction=-0.3"), r"Die upper/friction"),
    "upper die below the floor": (settings("Die upper/point=0, 0, -40"), r"Die upper"),
    "upper die in the billet": (settings("Die upper/point=0, 0, 30"), r"Die upper.*inside"),
    "upper die in centimetres too far": (settings("Die upper/point=0, 0, 400"), r"Die upper"),
    "lower die in the billet": (settings("Die lower/point=0, 0, 5"), r"Die lower.*inside"),
    "lower die beyond the stroke": (settings("Die lower/point=0, 0, -5"), r"Billet: nothing holds it against die upper"),
    "lower die not listed": (settings("Dies/names=upper"), r"Billet: nothing holds it.*`Die lower' is not read, as Dies/names"),
    "upper die not listed": (settings("Dies/names=lower"), r"Dies: no die moves.*`Die upper' is not read, as Dies/names"),
    "die that moves sideways": (settings("Die upper/velocity=100, 0, 0", WHOLE), r"Die upper/velocity.*along the billet"),
    "no friction at all": (settings(WHOLE, "Die upper/friction=0", "Die lower/friction=0"),
                                r"Billet.*free to slide along x, slide along y, turn about z;.*friction"),
    "billet in inches": (settings("Billet/size=1.57, 1.57, 1.57", "Billet/element size=0.6"), r"Die upper.*starts 38\.43 mm away"),
    "die in metres": (stl("plate_in_metres.stl"), r"Die lower.*scale"),
    "die in micrometres": (stl("plate_in_microns.stl"), r"Die lower.*scale"),
    "die's file missing": (stl("plat.stl"), r"plat\.stl"),
    "die's file empty": (stl("empty.stl"), r"empty\.stl"),
    "case for a die": (stl("case.prm"), r"case\.prm"),
    "die's file for a billet": (settings(WHOLE, "Billet/shape=file", "Billet/file name=plate.stl"), r"plate\.stl"),
    "die misspelt": (settings("Dies/names=lower, uper"), r"uper"),
    "setting misspelt": (settings("Billet/elment size=5"), r"elment size.*element size"),
    "shape misspelt": (settings("Billet/shape=cilinder"), r"cilinder"),
    "objective misspelt": (settings("Objectives/names=enrgy"), r"enrgy.*did you mean 'energy'"),
    "design parameter misspelt": (settings("Design/parameters=die uper/friction"), r"die uper/friction"),
    "leading die that stands": (settings("Press/leading die=lower"), r"Press/leading die.*lower"),
    "decimal comma": (settings("Die upper/friction=0,3"), r"Die upper/friction"),
    "unit in a number": (settings("Material/consistency=1.693 MPa"), r"Material/consistency"),
    "exponent in per cent": (settings("Material/strain rate sensitivity=14"), r"Material/strain rate sensitivity"),
    "vector of two": (settings("Die upper/velocity=0, -100"), r"Die upper/velocity"),
}


def before_increments(words):
    """Lines of the console before the table of increments; the run is not waited for, where it comes so far."""
    lines = []
    with subprocess.Popen(words, env=whole_runs.ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as running:
        for line in running.stdout:
            if re.match(r"\s+(inc\s+stroke|1\s+\d)", line):
                break
            lines.append(line.strip())
        running.kill()
    return lines


def simulate(*more):
    return [PROGRAM, "simulate", "case.prm", "--output", "run", "--overwrite", *more]


def warned():
    for name, (words, begin) in WARNED.items():
        lines = before_increments(simulate(*words))
        told = [line for line in lines if line.startswith(f"warning: {begin}")]
        judge(name, len(told) == 1, "\n".join(lines))
        print(f"         {' | '.join(told)}")


def refused():
    for die, pattern in (("lower", r"Billet: nothing holds it against die upper"), ("upper", r"no die moves")):
        other = "upper" if die == "lower" else "lower"
        sections = {name: section for name, section in SCENE.items() if name != f"Die {die}"}
        whole_runs.write("forgotten.prm", prm(whole_runs.changed(sections, {"Dies": {"names": other}})))
        judge_message(f"{die} die forgotten", start([PROGRAM, "simulate", "forgotten.prm", "--output", "run", "--overwrite"]), pattern)
    for name, (words, pattern) in REFUSED.items():
        done = start(simulate(*words))
        judge_message(name, done, pattern)
        judge(f"{name}: before it is forged", not re.search(r"^ +1 +\d", done.stdout, re.MULTILINE), done.stdout)


def sound():
    """Nobody is told of what is right."""
    judge("sound scene", not [line for line in before_increments(simulate()) if line.startswith("warning")])
    judge("die of an eighth of the billet's size is not taken for a file in inches",
          not [line for line in before_increments(simulate(*stl("eighth.stl"))) if "inches" in line])
    judge("sound die of a file", not [line for line in before_increments(simulate(*stl("plate.stl"))) if line.startswith("warning")])
    for case in sorted((ROOT / "prm").glob("**/*.prm")):
        if "Die " not in case.read_text(encoding="utf-8"):
            continue
        lines = before_increments([PROGRAM, "simulate", str(case), "--output", "run", "--overwrite", *settings("Output/record=false")])
        if lines and re.search(r"cannot be read|needs a mesh", lines[-1]):
            print(f"skipped {case.relative_to(ROOT)}: a script makes its files")
            continue
        judge(f"{case.relative_to(ROOT)} is told nothing",
              lines and not [line for line in lines if line.startswith(("warning", "retroforge:"))], "\n".join(lines))


def count():
    clear = len(WARNED) + len(REFUSED) + 2
    print(f"{clear} slips")
    judge("forty of them", clear >= 40)


def files():
    for name, content in FILES.items():
        with open(name, "wb") as file:
            file.write(content)


whole_runs.main({"case.prm": CASE}, (files, warned, refused, sound, count))
