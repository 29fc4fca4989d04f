# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A design changed by --at: at the nominal values it is the nominal run to the last bit; differences of changed runs are
the free differences of `check`, of billet, process and the shape of a die; penalty and slip follow the material and the speed; a die that follows the billet starts on it and ends at the
same gap; one that would stand in the billet begins earlier; elements of new meshes keep their proportion to the billet; a run is not resumed with another design.
Usage: changed_design.py RETROFORGE"""
import math
import os
import pathlib
import re
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import whole_runs  # noqa: E402
from whole_runs import ROOT, changed, history_of, judge, main, prm, summary_of, upsetting  # noqa: E402

sys.path.insert(0, os.path.join(ROOT, "prm", "tutorial", "hub"))
import make_die  # noqa: E402

SENSITIVITY = 0.139
NO_FIELDS = {"fields every": 0}
CYLINDER = changed(upsetting("cylinder", {"radius": 10, "height": 15}, 5, 15, 3, 6), {
    "Design": {"parameters": "billet/radius, billet/height, die upper/offset, material/m"}, "Output": NO_FIELDS})
FOLLOWED = changed(CYLINDER, {"Die upper": {"follows billet": "true"},
                              "Design": {"parameters": "billet/height, die upper/offset, material/m"}})
BELL = changed(whole_runs.cube(75, 25, 10, 8), {
    "Die lower": {"friction": 0.15},
    "Die upper": {"shape": "bell", "point": "0, 0, 52", "friction": 0.15,
                  "Bell": {"mouth radius": 62, "depth": 45, "draft angle": 20, "edge radius": 8, "fillet radius": 25, "outer radius": 100}},
    "Design": {"parameters": "die upper/depth"}, "Output": {**NO_FIELDS, "record": "false"}})
DOME = changed(upsetting("cylinder", {"radius": 10, "height": 15}, 4, 15, 3, 6), {"Die upper": {"shape": "stl", "file": "dome.stl"},
                                                                                  "Output": NO_FIELDS})

CONE = changed(whole_runs.cube(20, 5, 8, 0), {
    "Billet": {"size": "40, 40, 20"}, "Die lower": {"friction law": "Tresca", "friction": 0.5},
    "Die upper": {"shape": "stl", "file": "cone.stl", "velocity": "0, 0, -50", "friction law": "Tresca", "friction": 0.3},
    "Material": {"consistency": 45}, "Objectives": {"names": "force"}, "Objective force": {"type": "maximum effort"},
    "Design": {"parameters": "billet/height"}, "Output": NO_FIELDS})
RING = changed(DOME, {"Die upper": {"file": "ring.stl"}, "Design": {"parameters": "billet/height, die upper/offset, material/m"}})


def run(word, case, output, *settings):
    return whole_runs.run(word, output, *settings, *([] if "--resume" in settings else ["--overwrite"]), case=case)


def summary(word, case, output, *settings):
    done = run(word, case, output, *settings)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return summary_of(output)


def energy(*arguments):
    return summary(*arguments)["objectives"][0]["value"]


def nominal_is_nominal():
    plain, at = summary("gradient", "cylinder.prm", "plain"), summary("gradient", "cylinder.prm", "at", ("billet/radius", 10.0))
    for key in ("objectives", "parameters", "newton_iterations", "krylov_iterations"):
        judge(f"--at the nominal radius: {key}", plain[key] == at[key])
    at = summary("gradient", "cylinder.prm", "at", ("material/K", 2.0))
    judge("a parameter that is not listed comes along", [p["name"] for p in at["parameters"]][-1] == "material/K")
    judge("its value", at["parameters"][-1]["value"] == 2.0)
    judge("the energy is proportional to K", abs(at["objectives"][0]["value"] / plain["objectives"][0]["value"] / 2.0 * 1.693 - 1.0) < 1e-7)


WELL_SOLVED = ("Newton/tolerance=1e-12", "Adjoint/tolerance=1e-14")


def contact_follows_the_design():
    """A round die, into which middles of edges sink: half a percent of the energy hangs on the penalty. The penalty is proportional to K, so the velocities do not
    depend on it, and K dE/dK = E; where all rates and e0 grow alike, E does as their m-th power, since the slip's v0 follows the speed. Another
    design is what the parameter file makes of the same numbers. A penalty that is set stays."""
    make_die.FACETS_PER_TURN = 32
    make_die.write_stl(pathlib.Path("dome.stl"), make_die.revolved([(float(r), r * r / 40) for r in (0, 2, 4, 6, 8, 10, 13, 16, 20)]))

    def of(output, *settings):
        found = summary("gradient", "dome.prm", output, *WELL_SOLVED, *settings)
        return found["objectives"][0]["value"], {p["name"]: p["value"] * p["gradient"]["energy"] for p in found["parameters"]}

    value, by = of("scales", "Design/parameters=material/K, material/e0, die upper/speed")
    judge("K dE/dK = E", abs(by["material/K"] / value - 1) < 1e-9, f"{by['material/K'] / value - 1:.1e}")
    error = (by["die upper/speed"] + by["material/e0"]) / (SENSITIVITY * value) - 1
    judge("speed dE/dspeed + e0 dE/de0 = m E", abs(error) < 1e-8, f"{error:.1e}")
    value, by = of("apart", "Design/parameters=material/K, contact/rho")
    judge("beside a penalty that is a parameter itself it does not follow", abs(by["material/K"] / value - 1) > 3e-3, by)
    judge("and both together are E", abs(sum(by.values()) / value - 1) < 1e-9, f"{sum(by.values()) / value - 1:.1e}")
    rho = [p for p in summary_of("apart")["parameters"] if p["name"] == "contact/rho"][0]["value"]
    value, held = of("held", "Design/parameters=material/K", f"Contact/penalty={rho!r}")
    judge("one that is set stays", abs(held["material/K"] / by["material/K"] - 1) < 1e-9, f"{held} {by}")
    for at, same in ((("material/K", 2.0), "Material/consistency=2"), (("material/m", 0.2), "Material/strain rate sensitivity=0.2"),
                     (("material/e0", 0.1), "Material/regularising strain rate=0.1"),
                     (("die upper/speed", 70.0), "Die upper/velocity=0, 0, -70")):
        changed_one, set_one = (energy("simulate", "dome.prm", "side", *WELL_SOLVED, more) for more in (at, same))
        judge(f"--at {at[0]} is --set {same}", abs(changed_one / set_one - 1) < 1e-10, f"{changed_one / set_one - 1:.1e}")
    run("check", "dome.prm", "check_follows", "Design/parameters=material/K, material/m, material/e0, die upper/speed", "Material/regularising strain rate=0.1",
        "Check/steps=1e-3, 1e-4, 1e-5", "Check/taylor halvings=2", "Check/free differences=false")
    rows = {row["parameter"]: row["verdict"] == "passed" for row in summary_of("check_follows")["check"]}
    judge("adjoint, tangent and replayed differences agree", all(rows[name] for name in ("material/K", "material/m", "material/e0", "die upper/speed")), rows)


def differences_are_those_of_check(case):
    """`check` solves to 1e-12; these do the same."""
    step = 1e-3
    checked = "check_" + case
    done = run("check", case, checked, f"Check/steps={step}", "Check/taylor halvings=2")
    judge(f"check of {case} ran", os.path.exists(checked + "/summary.json"), done.stderr)
    found = summary_of(checked)
    rows = {row["parameter"]: row["steps"][0]["free_central"] for row in found["check"]}
    sizes = {"die upper/offset": 20.0}
    for parameter in found["parameters"]:
        name, nominal = parameter["name"], parameter["value"]
        h = step * sizes.get(name, nominal)
        plus, minus = (energy("simulate", case, "side", (name, nominal + d), "Newton/tolerance=1e-12")
                       for d in (h, -h))
        error = abs((plus - minus) / (2 * h) / rows[name] - 1.0)
        judge(f"{name}: free difference", error < 1e-9, f"{error:.1e}")


def without_friction():
    """At a friction of 0 the slope by it is that of the side there is."""
    none = summary("gradient", "cylinder.prm", "none", ("dies/friction", 0.0))
    slope = [p["gradient"]["energy"] for p in none["parameters"] if p["name"] == "dies/friction"][0]
    value = none["objectives"][0]["value"]
    secants = [(energy("simulate", "cylinder.prm", "little", ("dies/friction", h)) - value) / h for h in (1e-3, 2e-3)]
    there = 2 * secants[0] - secants[1]
    judge("slope at no friction", abs(slope / there - 1) < 1e-3, [slope, secants])


def die_follows_billet():
    """A billet 1 mm higher, under a die that starts 1 mm higher and ends where it did, is one pressed 1 mm farther."""
    higher, farther = ("billet/height", 16.0), ("Die upper/point=0, 0, 16", "Press/stroke=4")
    followed = energy("simulate", "followed.prm", "followed", higher)
    pressed = energy("simulate", "cylinder.prm", "pressed", higher, *farther)
    judge("a die that follows goes the longer way", abs(followed / pressed - 1.0) < 1e-6, f"{followed / pressed - 1.0:.1e}")
    time = history_of("followed")[-1]["time"]
    judge("and takes the time for it", abs(float(time) - 0.04) < 1e-12, time)
    quick = ("Design/parameters=billet/height, die upper/speed", "Check/steps=1e-3, 1e-5", "Check/taylor halvings=2", "Check/taylor start=3e-5",
             "Check/free differences=false")
    done = run("check", "followed.prm", "check_followed", *quick)
    judge("adjoint, tangent and replayed differences agree", done.returncode == 0, done.stderr + done.stdout[-1500:] if done.returncode else "")


def begins_from_outside():
    """A ring that stands on the billet: designs that it would stand in differ from those under a gap by no kink, in the energy and in its slope, by the height, by the
    die's offset and by its shape. What is differentiated there is the path that begins earlier."""
    make_die.FACETS_PER_TURN = 32
    make_die.write_stl(pathlib.Path("ring.stl"), make_die.revolved([(float(r), z) for r, z in ((0, 3), (4, 3), (6, 0), (10, 0), (20, 0))]))
    nominal = summary("gradient", "ring.prm", "ring")
    value, slopes = nominal["objectives"][0]["value"], {p["name"]: (p["value"], p["gradient"]["energy"]) for p in nominal["parameters"]}
    step, moved = 0.06, ("billet/height", "die upper/offset")
    for name in moved:
        at, slope = slopes[name]
        above, below = (summary("gradient", "ring.prm", "side", (name, at + side * step)) for side in (1, -1))
        sides = [(above["objectives"][0]["value"] - value) / step / slope - 1, (value - below["objectives"][0]["value"]) / step / slope - 1]
        judge(f"{name}: both sides have the nominal slope to 3 %", all(abs(side) < 0.03 for side in sides), sides)
        there = next(p["gradient"]["energy"] for p in above["parameters"] if p["name"] == name)
        judge(f"{name}: as the design inside has, to 5 %", abs(there / slope - 1) < 0.05, [there, slope])
    printed = run("simulate", "ring.prm", "side", ("billet/height", 15.15)).stdout
    judge("it is told", "the press begins 0.15" in printed, printed)
    judge("and goes the longer way", abs(float(history_of("side")[-1]["time"]) / 0.0315 - 1) < 1e-5, history_of("side")[-1]["time"])
    # Repeated with its start held, a design with a higher billet has the kink: of differences those that decide anew count, but for jumps.
    run("check", "ring.prm", "check_ring", "Design/parameters=billet/height, die upper/offset", ("billet/height", 15.15), "Check/steps=1e-3, 1e-4", "Check/taylor halvings=2")
    rows = {row["parameter"]: row for row in summary_of("check_ring")["check"]}
    judge("adjoint and tangent agree in there", all(abs(rows[name]["tangent"] / rows[name]["adjoint"] - 1) < 1e-10 for name in moved), rows)
    off = {name: min(abs(step["free_central"] / rows[name]["adjoint"] - 1) for step in rows[name]["steps"]) for name in moved}
    judge("and differences that decide anew, to 1 %", all(each < 0.01 for each in off.values()), off)


def forces_after_a_late_mesh():
    """Slopes of a largest force where the mesh is made anew within the last twentieth of the stroke, as in some of these designs, are those of
    the trend: with all ends that follow the state they were of the other sign."""
    make_die.FACETS_PER_TURN = 48
    tip = [(4 * math.sin(math.radians(a)), 4 * (1 - math.cos(math.radians(a)))) for a in (0, 10, 20, 30, 40, 50)]
    make_die.write_stl(pathlib.Path("cone.stl"), make_die.revolved([*tip, (30.0, tip[-1][1] + (30 - tip[-1][0]) * math.tan(math.radians(50)))]))
    heights, slopes, forces = (19.6, 19.8, 20.0, 20.2, 20.4, 20.6), [], []
    for height in heights:
        found = summary("gradient", "cone.prm", "cone", ("billet/height", height))
        forces.append(found["objectives"][0]["value"])
        slopes.append(found["parameters"][0]["gradient"]["force"])
    trend = float(np.polyfit(heights, forces, 1)[0])
    judge("slopes of the trend", all(0.6 * trend < slope < 1.5 * trend for slope in slopes), [trend, slopes])


def elements_keep_their_proportion():
    """A radius larger by 40 % makes almost twice the volume: meshes that are made on the way have as many elements, as the first one has, also where it is
    meshed at another design. A wanted length that is set is that of the nominal design, too."""
    anew = ("Remeshing/when=increments", "Remeshing/every=3", "Remeshing/method=rebuild")

    def cells(*settings):
        found = re.findall(r"remeshed: \d+ nodes, (\d+) tetrahedra", run("simulate", "cylinder.prm", "grown", *anew, *settings).stdout)
        judge(f"remeshed once: {settings}", len(found) == 1, found)
        return int(found[0])

    for size in (("Remeshing/element size=2.5",), ("Billet/element size=3",)):
        nominal = cells(*size)
        for name, settings in (("grown", (("billet/radius", 14.0),)), ("shrunk", (("billet/radius", 7.0),))):
            found = cells(*size, *settings)
            judge(f"{name} {size}: as many elements", abs(found / nominal - 1) < 0.1, f"{found} of {nominal}")
    there = cells("Billet/element size=3", ("billet/radius", 14.0), "Design/meshed at=billet/radius: 14")
    judge("on a first mesh of that design as many as are wanted there", there > 1.5 * nominal, there)


def another_design_is_refused():
    done = run("simulate", "cylinder.prm", "plain", ("billet/radius", 10.1), "--resume")
    judge("resumed with another design", done.returncode != 0 and "Design/at" in done.stderr, done.stderr.strip())


def mistakes():
    for what, at, expected in (("unknown name", ("billet/raduis", 10.0), "did you mean 'billet/radius'"),
                               ("impossible value", ("material/m", 1.5), "up to 1"),
                               ("inside the die", ("die upper/offset", 3.0), "inside it"),
                               ("grown into the die", ("billet/height", 17.0), "set Die upper/follows billet = true"),
                               ("no billet", ("billet/radius", -1.0), "radius = -1")):
        done = run("simulate", "cylinder.prm", "wrong", at)
        judge(what, done.returncode == 1 and done.stderr.count("\n") == 1 and expected in done.stderr, done.stderr.strip())


def differences():
    for case in ("cylinder.prm", "bell.prm"):
        differences_are_those_of_check(case)


main({"cylinder.prm": prm(CYLINDER), "followed.prm": prm(FOLLOWED), "bell.prm": prm(BELL), "dome.prm": prm(DOME), "ring.prm": prm(RING), "cone.prm": prm(CONE)},
     (nominal_is_nominal, contact_follows_the_design, differences, without_friction, die_follows_billet, begins_from_outside, forces_after_a_late_mesh, elements_keep_their_proportion, another_design_is_refused,
      mistakes))
