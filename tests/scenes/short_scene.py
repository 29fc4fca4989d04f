# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A scene of prm/tutorial in its short form: it comes to its end from any folder, keeps its volume, leaves no metal in a die, finds the
objectives that scene.json states, and gradients of the signs stated there. Usage: short_scene.py FOLDER-OF-retroforge.py SCENE

The values are those of the meshes that Gmsh 4.8 makes. Another Gmsh makes others, on which these coarse scenes are up to 5 % off.

scene.json: {"picture": ..., "short": {"settings": {"Section/name": value}, "values": {objective: value},
                                       "signs": {objective: {parameter: "+" or "-"}}}}"""
import ctypes.util
import json
import os
import pathlib
import sys
import tempfile

FOLDER, SCENE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
sys.path.insert(0, str(FOLDER))
import retroforge  # noqa: E402

SAME_MESH = ctypes.util.find_library("gmsh") == "libgmsh.so.4.8"
# relative change, parts of the element size, relative difference
VOLUME, DEPTH, VALUE = 2e-3, 0.05, 1e-3 if SAME_MESH else 6e-2
failures = 0


def judge(what, good, found):
    global failures
    failures += not good
    print(f"{'passed' if good else 'FAILED'} {what}: {found}")


def judge_run(forging, short):
    summary = forging.summary
    stroke = float(short["settings"].get("Press/stroke", forging.history["stroke"][-1]))
    judge("the stroke is done", abs(forging.history["stroke"][-1] / stroke - 1) < 1e-9, forging.history["stroke"][-1])
    change = summary["volume_final"] / summary["volume_initial"] - 1
    judge("the volume stays", abs(change) < VOLUME, f"{change:.1e}")
    depth = summary.get("deepest", {}).get("over_element_size", 0.0)
    judge("no metal is in a die", depth < DEPTH, f"{depth:.3f} of an element")
    for name, value in short["values"].items():
        found = forging.objectives[name]
        judge(f"{name} = {value}", abs(found / value - 1) < VALUE, found)
    for objective, signs in short["signs"].items():
        for parameter, sign in signs.items():
            found = forging.gradients[objective][parameter]
            judge(f"d {objective} / d {parameter} is {sign}", found * float(sign + "1") > 0, found)


def main():
    scene = json.loads((SCENE / "scene.json").read_text(encoding="utf-8"))
    readme = (SCENE / "README.md").read_text(encoding="utf-8")
    judge("the README shows the picture", "(picture.png)" in readme and (SCENE / "picture.png").is_file(), readme.splitlines()[0])
    short = scene["short"]
    with tempfile.TemporaryDirectory() as elsewhere:
        os.chdir(elsewhere)
        judge_run(retroforge.run(SCENE / f"{SCENE.name}.prm", {"Output/fields every": 0, **short["settings"]}), short)
    return 1 if failures or not short["values"] or not short["signs"] else 0


sys.exit(main())
