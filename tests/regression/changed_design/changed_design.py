# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A design changed by --at: at the nominal values it is the nominal run to the last bit; differences of changed runs are
the free differences of `check`, of billet, process and the shape of a die; a die that follows the billet starts on it and ends at the
same gap; a run is not resumed with another design.
Usage: changed_design.py RETROFORGE"""
import json
import os
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

CYLINDER = """
subsection Billet
  set shape           = cylinder
  set radius          = 10
  set height          = 15
  set element size    = 5
  set symmetry planes = -1, 0, 0; 0, -1, 0
end
subsection Dies
  set names = lower, upper
end
subsection Die lower
  set point    = 0, 0, 0
  set facing   = 0, 0, 1
  set friction = 0.3
end
subsection Die upper
  set point    = 0, 0, 15
  set facing   = 0, 0, -1
  set velocity = 0, 0, -100
  set friction = 0.3
end
subsection Press
  set stroke     = 3
  set increments = 6
end
subsection Design
  set parameters = billet/radius, billet/height, die upper/offset, material/m
end
subsection Output
  set fields every = 0
end
"""

BELL = """
subsection Billet
  set shape           = box
  set size            = 75, 75, 75
  set element size    = 25
  set symmetry planes = -1, 0, 0; 0, -1, 0
end
subsection Dies
  set names = lower, bell
end
subsection Die lower
  set point    = 0, 0, 0
  set facing   = 0, 0, 1
  set friction = 0.15
end
subsection Die bell
  set shape    = bell
  set point    = 0, 0, 52
  set facing   = 0, 0, -1
  set velocity = 0, 0, -100
  set friction = 0.15
  subsection Bell
    set mouth radius  = 62
    set depth         = 45
    set draft angle   = 20
    set edge radius   = 8
    set fillet radius = 25
    set outer radius  = 100
  end
end
subsection Press
  set stroke     = 10
  set increments = 8
end
subsection Design
  set parameters = die bell/depth
end
subsection Output
  set fields every = 0
  set record       = false
end
"""

FOLLOWED = CYLINDER.replace("set point    = 0, 0, 15\n", "set point    = 0, 0, 15\n  set follows billet = true\n").replace(
    "set parameters = billet/radius, ", "set parameters = ")

failures = []


def judge(name, good, detail=""):
    print(f"{'passed' if good else 'FAILED'} {name} {detail}")
    if not good:
        failures.append(name)


def run(command, case, output, at=(), more=()):
    arguments = [PROGRAM, command, case, "--output", output, *more] + ([] if "--resume" in more else ["--overwrite"])
    for name, value in at:
        arguments += ["--at", f"{name}={value!r}"]
    return subprocess.run(arguments, env=ENVIRONMENT, capture_output=True, text=True, timeout=300, check=False)


def summary(*arguments, **options):
    done = run(*arguments, **options)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    with open(os.path.join(arguments[2], "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def energy(*arguments, **options):
    return summary(*arguments, **options)["objectives"][0]["value"]


def nominal_is_nominal():
    plain, at = summary("gradient", "cylinder.prm", "plain"), summary(
        "gradient", "cylinder.prm", "at", at=[("billet/radius", 10.0)])
    for key in ("objectives", "parameters", "newton_iterations", "krylov_iterations"):
        judge(f"--at the nominal radius: {key}", plain[key] == at[key])
    at = summary("gradient", "cylinder.prm", "at", at=[("material/K", 2.0)])
    judge("a parameter that is not listed comes along", [p["name"] for p in at["parameters"]][-1] == "material/K")
    judge("its value", at["parameters"][-1]["value"] == 2.0)
    judge("the energy is proportional to K",  # but for the penalty, which stays that of the nominal K
          abs(at["objectives"][0]["value"] / plain["objectives"][0]["value"] / 2.0 * 1.693 - 1.0) < 1e-4)


def differences_are_those_of_check(case):
    """`check` solves to 1e-12; these do the same."""
    step = 1e-3
    checked = "check_" + case
    done = run("check", case, checked, more=["--set", f"Check/steps={step}", "--set", "Check/taylor halvings=2"])
    judge(f"check of {case} ran", os.path.exists(checked + "/summary.json"), done.stderr)
    with open(checked + "/summary.json", encoding="utf-8") as file:
        found = json.load(file)
    rows = {row["parameter"]: row["steps"][0]["free_central"] for row in found["check"]}
    sizes = {"die upper/offset": 20.0}
    for parameter in found["parameters"]:
        name, nominal = parameter["name"], parameter["value"]
        h = step * sizes.get(name, nominal)
        plus, minus = (energy("simulate", case, "side", at=[(name, nominal + d)], more=["--set", "Newton/tolerance=1e-12"])
                       for d in (h, -h))
        error = abs((plus - minus) / (2 * h) / rows[name] - 1.0)
        judge(f"{name}: free difference", error < 1e-9, f"{error:.1e}")


def die_follows_billet():
    """A billet 1 mm higher, under a die that starts 1 mm higher and ends where it did, is one pressed 1 mm farther."""
    higher, farther = [("billet/height", 16.0)], ["--set", "Die upper/point=0, 0, 16", "--set", "Press/stroke=4"]
    followed = energy("simulate", "followed.prm", "followed", at=higher)
    pressed = energy("simulate", "cylinder.prm", "pressed", at=higher, more=farther)
    judge("a die that follows goes the longer way", abs(followed / pressed - 1.0) < 1e-6, f"{followed / pressed - 1.0:.1e}")
    with open("followed/history.csv", encoding="utf-8") as file:
        last = file.read().splitlines()[-1].split(",")
    judge("and takes the time for it", abs(float(last[1]) - 0.04) < 1e-12, last[1])
    quick = ["--set", "Design/parameters=billet/height, die upper/speed", "--set", "Check/steps=1e-3, 1e-5",
             "--set", "Check/taylor halvings=2", "--set", "Check/free differences=false"]
    done = run("check", "followed.prm", "check_followed", more=quick)
    judge("adjoint, tangent and replayed differences agree", done.returncode == 0, done.stderr + done.stdout[-1500:] if done.returncode else "")


def another_design_is_refused():
    done = run("simulate", "cylinder.prm", "plain", at=[("billet/radius", 10.1)], more=["--resume"])
    judge("resumed with another design", done.returncode != 0 and "Design/at" in done.stderr, done.stderr.strip())


def mistakes():
    for what, at, expected in (("unknown name", ("billet/raduis", 10.0), "did you mean 'billet/radius'"),
                               ("impossible value", ("material/m", 1.5), "up to 1"),
                               ("inside the die", ("die upper/offset", 3.0), "inside it"),
                               ("grown into the die", ("billet/height", 17.0), "set Die upper/follows billet = true"),
                               ("no billet", ("billet/radius", -1.0), "radius = -1")):
        done = run("simulate", "cylinder.prm", "wrong", at=[at])
        judge(what, done.returncode == 1 and done.stderr.count("\n") == 1 and expected in done.stderr, done.stderr.strip())


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, text in (("cylinder.prm", CYLINDER), ("followed.prm", FOLLOWED), ("bell.prm", BELL)):
            with open(name, "w", encoding="utf-8") as file:
                file.write(text)
        nominal_is_nominal()
        differences_are_those_of_check("cylinder.prm")
        differences_are_those_of_check("bell.prm")
        die_follows_billet()
        another_design_is_refused()
        mistakes()
    print(f"{len(failures)} failed")
    return 1 if failures else 0


sys.exit(main())
