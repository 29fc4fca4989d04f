# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The command scene: what it lists and draws is as computed by hand; a scene that is refused gets the message that a run gives, on the
error stream, in the listing and in scene.json, and what could be made of it is there all the same. Usage: look.py RETROFORGE

By hand: the scene is a quarter of a cube of 10 mm that stands on die lower, z = 0; die upper moves down at 100 mm/s."""
import json
import math
import os
import pathlib
import re
import resource
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "contrib"))
import block_meshes  # noqa: E402
import whole_runs  # noqa: E402
from retroforge_report import vtu  # noqa: E402
from whole_runs import ENVIRONMENT, PROGRAM, ROOT, contents, judge, prm, run, start, text_of, write  # noqa: E402

CASE = prm(whole_runs.cube(10, 4, 1, 3))
MOST_SECONDS = 5  # of processor time, for a scene of the tutorial
NEAR = 1e-9


def stl(*facets):
    """Binary, of facets of three corners each."""
    return b" " * 80 + struct.pack("<I", len(facets)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(x for corner in facet for x in corner), 0) for facet in facets)


def tip(x, y, wide, high):
    """A pyramid of four facets that points down to (x, y, 0), normals outwards, open above: its base is `wide` and stands `high`."""
    a = wide / 2
    base = [(x - a, y - a, high), (x + a, y - a, high), (x + a, y + a, high), (x - a, y + a, high)]
    return [((x, y, 0), base[(i + 1) % 4], base[i]) for i in range(4)]


def pyramid(z, more=()):
    """Die upper is a pyramid whose tip starts at (1.5, 2, z)."""
    return ["Die upper/shape=stl", "Die upper/file=tip.stl", f"Die upper/point=0, 0, {z}", *more]


def look(name, *settings, case="case.prm"):
    """The run, and scene.json."""
    done = run("scene", "scene", "--overwrite", *settings, case=case)
    print(f"  {name}: {(done.stderr.strip() or done.stdout.strip().splitlines()[-1])[:240]}")
    return done, json.loads(text_of("scene", "scene.json"))


def die_of(scene, name):
    return next(die for die in scene["dies"] if die["name"] == name)


def near(found, wanted, tolerance=NEAR):
    if isinstance(wanted, (list, tuple)):
        return len(found) == len(wanted) and all(near(f, w, tolerance) for f, w in zip(found, wanted))
    return found is not None and math.isclose(found, wanted, rel_tol=tolerance, abs_tol=tolerance)


def same(name, found, wanted, tolerance=NEAR):
    judge(name, near(found, wanted, tolerance), f"{found}, by hand {wanted}")


def pictures(scene):
    """What scene.pvd lists must be there: the billet, if there is one, and all dies."""
    listed = re.findall(r'file="([^"]+)"', text_of("scene", "scene.pvd"))
    wanted = (["scene_billet.vtu"] if "billet" in scene else []) + [f"scene_die_{die['name']}.vtu" for die in scene["dies"]]
    return listed == wanted and all(len(vtu.read(os.path.join("scene", name)).points) > 0 for name in listed)


def sound():
    done, scene = look("cube")
    judge("a sound scene is accepted", done.returncode == 0 and not done.stderr and scene["refusals"] == [], done.stderr)
    judge("nothing is forged", not any(name.startswith(("fields", "history", "record", "summary")) for name in os.listdir("scene")))
    judge("its pictures are there", pictures(scene))
    billet = scene["billet"]
    same("extents", billet["extents"], [[0, 0, 0], [5, 5, 10]])
    same("volume of the mesh", billet["volume"], 250)
    same("volume of the shape", billet["volume_of_shape"], 250)
    judge("whole part", billet["whole"] == {"copies": 4, "force_factor": 4}, billet["whole"])
    same("patches", sorted((p["name"], p["area"]) for p in billet["patches"])[0][1], 25)
    judge("patches by name", [p["name"] for p in billet["patches"]] == ["bottom", "top", "side +x", "side +y"], billet["patches"])
    same("symmetry planes", [plane["normal"] for plane in billet["symmetry_planes"]], [[-1, 0, 0], [0, -1, 0]])
    judge("both dies touch", all(die["touches"] and "overlap" not in die for die in scene["dies"]))
    same("the moving die has no way to go", die_of(scene, "upper")["first_touch"]["distance"], 0)
    judge("of a die at rest no way is told", "first_touch" not in die_of(scene, "lower"))
    same("areas on which they touch", [die["contact_area"] for die in scene["dies"]], [25, 25])
    same("where they go", [die["travel"] for die in scene["dies"]], [[0, 0, 0], [0, 0, -1]])
    judge("increments that are given", not scene["press"]["increments_chosen"])
    same("press", [scene["press"][key] for key in ("stroke", "increments", "seconds")], [1, 3, 0.01])
    for words in ("volume of the part 1000 mm^3; the model is 1/4 of the part, 250 mm^3; its mesh has 250 mm^3", ", on 25 mm^2", "ends through (0, 0, 9)", "symmetry plane `symmetry 1' through (0, 0, 0)", "die lower, plane", "touches the billet at the start", "stands still",
                  "stroke 1 mm of die upper, 0.01 s; 3 increments of 0.333333 mm, 0.00333333 s each"):
        judge(f"the listing says: {words}", words in done.stdout, done.stdout)
    mesh = vtu.read("scene/scene_billet.vtu")
    gap = mesh.point_data["gap [mm]"]
    judge("the picture has the distance of each node from the nearest die",
          abs(gap - [min(z, 10 - z) for z in mesh.points[:, 2]]).max() < 1e-5)
    estimate = scene.get("estimate")
    judge("an estimate by name", estimate and "slab" in estimate["name"], estimate)


def cylinder():
    """By hand: pi r^2 h / 4 of the shape; a quarter of an n-gon has less."""
    case = prm(whole_runs.upsetting("cylinder", {"radius": 5, "height": 8}, 2, 8, 1, 4))
    write("cylinder.prm", case)
    _, scene = look("cylinder", case="cylinder.prm")
    billet = scene["billet"]
    same("volume of a round shape", billet["volume_of_shape"], math.pi * 25 * 8 / 4)
    judge("of which the mesh lacks some", 0.95 < billet["volume"] / billet["volume_of_shape"] < 1, billet["volume"])
    _, wider = look("another design", ("billet/radius", 5.1), case="cylinder.prm")
    same("--at moves the billet", wider["billet"]["extents"][1], [5.1, 5.1, 8], 1e-6)


def gaps():
    _, scene = look("die 2 mm above", "Die upper/point=0, 0, 12", "Press/stroke=3")
    upper = die_of(scene, "upper")
    same("gap of a plane", upper["gap"]["distance"], 2)
    same("way to its first touch", [upper["first_touch"]["distance"], upper["first_touch"]["stroke"]], [2, 2])
    same("height of that place", upper["first_touch"]["place"][2], 10)

    _, scene = look("oblique plane", "Die upper/point=0, 0, 20", "Die upper/facing=0, 0.6, -0.8", "Press/stroke=15")
    upper = die_of(scene, "upper")
    # the point of the box with the largest 0.8 z - 0.6 y is (., 0, 10): 0.8 (20 - 10) away, along z 10
    same("gap of an oblique plane", upper["gap"]["distance"], 8)
    same("its way", upper["first_touch"]["distance"], 10)
    same("its place", upper["first_touch"]["place"][1:], [0, 10])

    _, scene = look("tip above a face", *pyramid(12.5), "Press/stroke=4")
    upper = die_of(scene, "upper")
    same("gap of a tip above the middle of a face", upper["gap"]["distance"], 2.5, 1e-6)
    same("its way", upper["first_touch"]["distance"], 2.5, 1e-6)
    same("its place", upper["first_touch"]["place"], [1.5, 2, 10], 1e-5)
    judge("it stands on the planes of symmetry", upper["mirrored_by"] == [], upper)
    done, scene = look("tip beside a plane", *pyramid(12.5, ["Die upper/point=3, 0, 12.5"]), "Press/stroke=4")
    judge("beside one its image is another die", die_of(scene, "upper")["mirrored_by"] == ["symmetry 1"]
          and "all of it on one side of plane `symmetry 1'" in done.stdout, done.stdout)
    judge("extents of a surface", near(upper["extents"], [[-2.5, -2, 12.5], [5.5, 6, 16.5]], 1e-6) and upper["facets"] == 4, upper)

    done, scene = look("two dies that move", "Die upper/point=0, 0, 13", "Die lower/point=0, 0, -1", "Die lower/velocity=0, 0, 50",
                       "Press/leading die=upper", "Press/stroke=4")
    upper, lower = die_of(scene, "upper"), die_of(scene, "lower")
    same("ways of both", [upper["first_touch"]["distance"], lower["first_touch"]["distance"]], [3, 1])
    same("strokes of the leading die then", [upper["first_touch"]["stroke"], lower["first_touch"]["stroke"]], [3, 2])
    judge("which leads", upper["leads"] and not lower["leads"] and done.returncode == 0, done.stderr)


def covers():
    """By hand: the pyramid's base, 8 mm x 8 mm around (1.5, 2), has all of the quarter's 5 mm x 5 mm below it; moved, a corner of that."""
    for name, at, part in (("all", (0, 0), 1), ("most", (3, 2), 4.5 * 5 / 25), ("a third", (4.2, 4.2), 3.3 * 2.8 / 25), ("a corner", (6.5, 5.8), 1.2 / 25)):
        done, scene = look(f"a pyramid covers {name}", *pyramid(12, [f"Die upper/point={at[0]}, {at[1]}, 12", "Press/stroke=6"]))
        upper = die_of(scene, "upper")
        same("the part it covers", upper["covered"], part, 1e-6)
        told = f"covers {float(f'{100 * part:.3g}'):g} % of the billet's side that faces it"
        judge("is told, and not only of a plane", told in done.stdout and die_of(scene, "lower")["covered"] is None, done.stdout)
        judge("and what of it is doubtful", [("is it where it should be" in text) for text in scene["warnings"] if "covers" in text] == [True] * (part < 0.05)
              and (f"of dies that cover the billet: die upper {told}" in done.stdout) == (part < 0.5), done.stdout)


def estimates():
    """Speed and height are those along what the upper die faces, and the force at the end is that of the distance of the dies there."""
    _, straight = look("straight down")
    _, oblique = look("oblique", "Die upper/velocity=0, -100, -10", "Press/stroke=5")
    same("speed of an oblique die", [oblique["estimate"][key] for key in ("speed", "strain_rate")], [10, 1])
    judge("its force is that of the rate", oblique["estimate"]["stress"] < straight["estimate"]["stress"], oblique["estimate"])
    below, above = (look(f"2 mm {name}", setting, "Press/stroke=5")[1]["estimate"]
                    for name, setting in (("below", "Die lower/point=0, 0, -2"), ("above", "Die upper/point=0, 0, 12")))
    _, shorter = look("as far from touch on", "Press/stroke=3")
    for key in ("first_force", "final_force"):
        same(f"{key}, whichever die has the gap", [below[key], above[key]], [shorter["estimate"][key]] * 2)
    judge("which grows with the way from touch on", straight["estimate"]["final_force"] < below["final_force"], below)
    done, free = look("increments left free", "Press/increments=0")
    judge("who chose them is told", free["press"]["increments_chosen"] and "increments chosen by the program, of at most" in done.stdout, done.stdout)


# name: (settings, what the message says, dies that are drawn, whether the billet is)
BOTH = ["lower", "upper"]
REFUSED = {
    "billet inside a plane": (["Die lower/point=0, 0, 1"], r"Die lower.*inside", BOTH, True),
    "tip inside a face": (pyramid(7), r"Die upper.*inside", BOTH, True),
    "die away": (["Die upper/point=0, 0, 12"], r"Die upper", BOTH, True),
    "die that moves away": (["Die upper/velocity=0, 0, 100"], r"Die upper", BOTH, True),
    "die beside the billet": (pyramid(12, ["Die upper/point=60, 0, 12", "Press/stroke=5"]), r"Die upper", BOTH, True),
    "stroke too long": (["Press/stroke=12"], r"Press/stroke", BOTH, True),
    "missing file of a die": (["Die upper/shape=stl", "Die upper/file=absent.stl"], r"absent\.stl.*cannot be read", ["lower"], True),
    "die in metres": (pyramid(11, ["Die upper/scale=0.001", "Press/stroke=5"]), r"scale", BOTH, True),
    "missing mesh": (["Billet/symmetry planes=", "Billet/shape=file", "Billet/file name=absent.msh"], r"absent\.msh", BOTH, False),
    "garbage for a mesh": (["Billet/symmetry planes=", "Billet/shape=file", "Billet/file name=garbage.msh"], r"garbage\.msh", BOTH, False),
    "symmetry plane beside the billet": (["Billet/symmetry point=-40, 0, 0"], r"Billet/symmetry planes", BOTH, False),
    "unknown symmetry patch": (["Billet/symmetry planes=", "Billet/shape=file", "Billet/file name=cube.msh",
                                "Billet/symmetry patches=nowhere"], r"nowhere", BOTH, False),
    "no symmetry, no friction": (["Billet/symmetry planes=", "Die lower/friction=0", "Die upper/friction=0"], r"free", BOTH, True),
    "unknown design parameter": (["Design/parameters=material/L"], r"material/L", BOTH, True),
    "unknown patch of an objective": (["Objectives/names=cylinder distance", "Objective cylinder distance/patches=side"], r"patches", BOTH, True),
    "unknown law of the metal": (["Material/law=lower"], r"Material/law", [], False),
    "unknown motion of the press": (["Press/motion=crank"], r"Press/motion", [], False),
    "unknown setting": (["Press/strok=3"], r"Press/strok", [], False),
    "die without section": (["Dies/names=lower, upper, third"], r"[Dd]ie third", [], False),
}


def refused():
    for name, (settings, pattern, dies, has_billet) in REFUSED.items():
        done, scene = look(name, *settings)
        message = done.stderr.strip()
        judge(f"{name}: refused", done.returncode == 1 and re.fullmatch(r"retroforge: [^;\n]+: [^;\n]+;[^;\n]+;[^\n]+", message)
              and re.search(pattern, message), message)
        told = message[len("retroforge: "):]
        judge(f"{name}: told at the top, and in the file", scene["refusals"][0] == told
              and done.stdout.splitlines()[1] == f"  REFUSED: {told}", done.stdout[:300])
        judge(f"{name}: what can be made is there", [die["name"] for die in scene["dies"]] == dies and ("billet" in scene) == has_billet
              and (not dies or pictures(scene)), f"{[die['name'] for die in scene['dies']]} {sorted(os.listdir('scene'))}")
        same_run = run("simulate", "run", "--overwrite", *settings)
        judge(f"{name}: a run says the same", same_run.stderr == done.stderr, f"{same_run.stderr} {done.stderr}")


def overlaps():
    _, scene = look("1 mm inside", "Die lower/point=0, 0, 1")
    lower = die_of(scene, "lower")
    same("depth", lower["overlap"]["distance"], 1)
    same("place", lower["overlap"]["place"][2], 0)
    same("what frees it", lower["overlap"]["frees"], [0, 0, -1])
    freed, after = look("moved by that", "Die lower/point=0, 0, 0")
    judge("then it is free", freed.returncode == 0 and "overlap" not in die_of(after, "lower"))

    _, scene = look("tip 3 mm inside", *pyramid(7))
    upper = die_of(scene, "upper")
    same("depth of a tip in a face", upper["overlap"]["distance"], 3, 0.35)  # along the normal of a facet it is less
    same("what frees it", upper["overlap"]["frees"], [0, 0, 3], 1e-5)
    freed, _ = look("moved by that", *pyramid(10))
    judge("then it is free", freed.returncode == 0, freed.stderr)


def folders():
    """No run writes over another, and looking is none that hinders a run."""
    run("scene", "kept")
    before = contents("kept")
    again = run("scene", "kept")
    judge("a second look is refused", again.returncode == 1 and re.search(r"kept.*already.*--overwrite", again.stderr), again.stderr)
    forged = run("simulate", "kept", "Press/stroke=0.1", "Press/increments=1")
    judge("so is a run", forged.returncode == 1 and "already" in forged.stderr, forged.stderr)
    judge("and nothing has changed", contents("kept") == before)
    resumed = run("scene", "kept", "--resume")
    judge("there is nothing to resume", resumed.returncode == 1 and "--resume" in resumed.stderr and contents("kept") == before, resumed.stderr)
    forged = run("simulate", "kept", "--overwrite", "Press/stroke=0.1", "Press/increments=1")
    judge("a run that may replaces it", forged.returncode == 0 and not any(name.startswith("scene") for name in os.listdir("kept")), forged.stderr)
    run("scene", "kept", "--overwrite")
    judge("and the other way round", sorted(os.listdir("kept")) == ["scene.json", "scene.pvd", "scene_billet.vtu", "scene_die_lower.vtu",
                                                                    "scene_die_upper.vtu"], sorted(os.listdir("kept")))
    default = start([PROGRAM, "scene", "case.prm"])
    judge("by default it has a folder of its own", default.returncode == 0 and os.path.isfile("case-scene/scene.json"), default.stderr)


def ranks():
    """Two write what one does."""
    for name, settings in (("sound", []), ("refused", ["Die lower/point=0, 0, 1"])):
        run("scene", "one", "--overwrite", *settings)
        done = start(["mpirun", "-np", "2", *whole_runs.command("scene", "two", "--overwrite", *settings)])
        one, two = ({path.split(os.sep, 1)[1]: data for path, (data, _) in contents(folder).items()} for folder in ("one", "two"))
        for files in (one, two):
            files["scene.json"] = re.sub(rb'"wall_seconds": .*', b"", files["scene.json"])
        judge(f"a {name} scene on two ranks", one == two and ("REFUSED" in done.stdout) == (done.returncode != 0) == (name == "refused"),
              done.stderr)


def tutorial():
    for case in sorted(pathlib.Path(ROOT, "prm/tutorial").rglob("*.prm")):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = start([PROGRAM, "scene", str(case), "--output", "scene", "--overwrite"])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        judge(f"{case.name}: accepted, in {seconds:.1f} s", done.returncode == 0 and seconds < MOST_SECONDS, done.stderr)
        scene = json.loads(text_of("scene", "scene.json"))
        judge(f"{case.name}: every die stands outside, one that moves touches",
              all("overlap" not in die for die in scene["dies"])
              and any(die.get("first_touch", {}).get("distance") is not None for die in scene["dies"]), scene["dies"])
        judge(f"{case.name}: drawn", pictures(scene))


# What another release of the mesher makes otherwise: counts, edges and angles, and which of the many nodes that touch is named.
OF_THE_MESH = (r"(?P<nodes>\d+) nodes, (?P<cells>\d+) tetrahedra; edges of the surface from (?P<shortest>\S+) to (?P<longest>\S+) mm"
               r"|smallest angle (?P<angle>\S+) degrees|touches the billet at the start, at \((?P<place>[^)]*)\)")


def of_the_mesh(listing):
    """Its values by name, as numbers; of both dies the places."""
    found = {}
    for match in re.finditer(OF_THE_MESH, listing):
        for name, text in match.groupdict().items():
            if text:
                found.setdefault(name, []).append([float(x) for x in text.split(",")])
    return found


def manual():
    """The listing that the manual shows is that of the program, word for word but for the mesh: both meshes have as many nodes and cells to a
    tenth, edges of the length that is asked for, sound angles, and a node of the billet's ends at the die where it is said to touch."""
    shown = re.search(r"^```\n(  billet, .*?)^```", (ROOT / "doc/manual/first_forging.md").read_text(encoding="utf-8"), re.M | re.S)[1]
    done = start([PROGRAM, "scene", str(ROOT / "prm/tutorial/upsetting/upsetting.prm"), "--output", "scene", "--overwrite"])
    listed = done.stdout[done.stdout.find("  billet, "):]
    words = [re.sub(OF_THE_MESH, "#", text) for text in (shown, listed)]
    judge("the manual's listing, word for word but for the mesh", words[0].count("#") == 4 and words[1].startswith(words[0]), done.stdout)
    meshes = [of_the_mesh(text) for text in (shown, listed)]
    for name in ("nodes", "cells"):
        (a,), (b,) = (mesh[name][0] for mesh in meshes)
        judge(f"its {name} to a tenth", abs(a - b) <= 0.1 * a, f"{a} {b}")
    for where, mesh in zip(("manual", "listing"), meshes):
        (shortest,), (longest,), (angle,) = (mesh[name][0] for name in ("shortest", "longest", "angle"))
        judge(f"edges of the {where} about 4 mm, and angles", 2 < shortest < 4 < longest < 6 and angle > 15, f"{shortest} {longest} {angle}")
        judge(f"places of the {where}", all(math.hypot(x, y) < 20.001 and min(x, y) > -1e-9 and z == height
                                            for (x, y, z), height in zip(mesh["place"], (0, 40))) and len(mesh["place"]) == 2, mesh["place"])


def main():
    files = {"case.prm": CASE, "garbage.msh": "this is not a mesh\n", "cube.msh": block_meshes.msh_of_cube(2, 10.0)}
    ENVIRONMENT["OMPI_MCA_btl"] = "^tcp"

    def dies():
        with open("tip.stl", "wb") as file:
            file.write(stl(*tip(1.5, 2, 8, 4)))

    whole_runs.main(files, (dies, sound, cylinder, gaps, covers, estimates, refused, overlaps, folders, ranks, tutorial, manual))


main()
