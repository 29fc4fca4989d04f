# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""An optimisation: the contour of a billet that ends with a straight side, free and with limits and bounds; its results are
those of runs a user would make by hand; killed and resumed it is the same; failing designs are refused and told.
Usage: optimize.py RETROFORGE"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from scene import SCENE, best_of, found_in, lines_of, optimize, rows_of  # noqa: E402
from whole_runs import ENVIRONMENT, ROOT, changed, command, history_of, judge, main, prm, run, start, summary_of, text_of, write  # noqa: E402


def whole():
    found, printed = optimize("whole")
    objective, rows = found["objective"], rows_of("whole")
    judge("the side is straight", objective["best"] < 0.1 * objective["start"], objective)
    judge("the gradient has vanished", "gradient" in found["stop"] and found["finished"])
    decisions = [row["decision"] for row in rows]
    judge("rows", decisions[:3] == ["start", "noise", "noise"] and set(decisions[3:]) <= {"accepted", "refused"}, decisions)
    judge("few designs", found["simulations"] == len(rows) < 15, len(rows))
    judge("noise is small", 0 <= objective["noise"] < 1e-4 * objective["start"], objective["noise"])
    judge("it says so", "gradient has vanished" in printed and "results in whole" in printed)


def noise_at_the_end():
    """Where the search ends for its noise, that is measured again, by the values around the design accepted last and its gradient."""
    found, printed = optimize("measured", "Optimisation/gradient tolerance=1e-12")
    rows = rows_of("measured")
    decisions = [row["decision"] for row in rows]
    again = [i for i, decision in enumerate(decisions) if decision == "noise" and i > 2]
    judge("it ends for its noise", "more than the noise" in found["stop"], found["stop"])
    judge("measured at the start and there", decisions[1:3] == ["noise"] * 2 and len(again) == 2 and again[1] == again[0] + 1, decisions)
    there = max(i for i in range(again[0]) if decisions[i] in ("start", "accepted"))
    names = [parameter["name"] for parameter in found["parameters"]][:2]
    done = run("gradient", "there", *((name, float(rows[there][f"{name} [mm]"])) for name in names), case="measured/best.prm")
    judge("that design", done.returncode == 0, done.stderr)
    gradient = [parameter["gradient"]["barrel"] for parameter in summary_of("there")["parameters"]]
    value = float(rows[there]["barrel [mm^2]"])
    off = [float(rows[i]["barrel [mm^2]"]) - value - sum(slope * (float(rows[i][f"{name} [mm]"]) - float(rows[there][f"{name} [mm]"]))
                                                         for slope, name in zip(gradient, names)) for i in again]
    noise = np.sqrt(np.mean(np.square(off)))
    judge("as large as it says", abs(found["objective"]["noise"] / noise - 1) < 1e-3, [found["objective"]["noise"], noise])
    told = [float(line.split()[1]) for line in printed.splitlines() if line.startswith("  noise: ")]
    went_on = len(decisions) > again[1] + 1
    judge("it goes on only where it is less than half", len(told) == 2 and (not went_on or told[1] < 0.501 * told[0]), [told, decisions])


def begins_in_a_die():
    """What `simulate' warns of before the best design is forged, the optimisation tells, too."""
    scene = changed(SCENE, {"Objectives": {"names": "energy"}, "Objective energy": {"weight": -1}, "Design": {"parameters": "die upper/offset"}})
    scene["Optimisation"] = {"noise runs": 0, "confirmation": 0, "lower bounds": "die upper/offset: -0.3", "upper bounds": "die upper/offset: 0.3"}
    del scene["Objective barrel"]
    write("inwards.prm", prm(scene))
    found, printed = optimize("inwards", case="inwards.prm")
    done = run("simulate", "from_inside", case="inwards/best.prm")
    warnings = [line.removeprefix("  warning: ") for line in done.stdout.splitlines() if "mm inside it" in line]
    judge("it ends where the die stands in the billet", abs(best_of(found)[0]) == 0.3 and len(warnings) == 1, [best_of(found), done.stdout])
    judge("and says so", all(f"warning: the best design: {warning}\n" in printed for warning in warnings), printed)


def ends_in_a_die():
    """Metal that is inside a die where the best design ends: told, and where and how deep as `simulate' tells it of the last increment."""
    found, printed = optimize("sunk", "Contact/largest depth=0", "Optimisation/iterations=2", "Optimisation/noise runs=0")
    told = [warning for warning in found.get("warnings", []) if "inside die" in warning]
    judge("depth is told", len(told) == 1 and f"the best design: {told[0]}" in printed, found.get("warnings"))
    done = run("simulate", "sunk_by_hand", "Contact/largest depth=0", case="sunk/best.prm")
    judge("that design", done.returncode == 0, done.stderr)
    depth = float(history_of("sunk_by_hand")[-1]["depth"])
    judge("the last increment's", abs(float(told[0].split("up to ")[1].split()[0]) / depth - 1) < 1e-2, [told, depth])
    judge("no word where that depth may be", "warnings" not in optimize("may", "Optimisation/iterations=1", "Optimisation/noise runs=0")[0])


def by_hand():
    """The best design forged as any other, from its parameters and from its mesh."""
    found = found_in("whole")
    done = run("gradient", "hand", case="whole/best.prm")
    judge("its parameters", done.returncode == 0 and summary_of("hand")["objectives"][0]["value"] == found["objective"]["best"], done.stderr)
    for parameter, of_run in zip(found["parameters"], summary_of("hand")["parameters"]):
        judge(f"gradient by {parameter['name']}", parameter["gradient"] == of_run["gradient"]["barrel"], of_run["gradient"])
    billet = changed(SCENE, {"Billet": {"shape": "file", "file name": "whole/designs/best_billet.msh"},
                             "Press": {"max cuts": 8}, "Design": {"parameters": "material/K"}})
    for setting in ("control points", "volume held by", "element size", "symmetry planes"):
        del billet["Billet"][setting]
    billet["Billet"]["symmetry patches"] = ", ".join(SYMMETRY)
    write("mesh.prm", prm(billet))
    done = run("simulate", "mesh", case="mesh.prm")
    value = summary_of("mesh")["objectives"][0]["value"] if done.returncode == 0 else float("nan")
    judge("its mesh", abs(value / found["objective"]["best"] - 1) < 1e-6, f"{value} {done.stderr}")


SYMMETRY = ("symmetry 1", "symmetry 2", "symmetry 3")


def killed():
    """At any moment: once it has so many lines in its journal, and a little later."""
    reference, expected = rows_of("whole"), found_in("whole")
    n_lines = len(text_of("whole", "journal.jsonl").splitlines())
    for lines, sign in ((1, signal.SIGKILL), (4, signal.SIGTERM), (n_lines // 2, signal.SIGKILL), (n_lines - 2, signal.SIGINT)):
        with subprocess.Popen(command("optimize", "killed", "--overwrite"), env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as running:
            while running.poll() is None and lines_of("killed") < lines:
                time.sleep(0.002)
            time.sleep(0.03)
            running.send_signal(sign)
        found, printed = optimize("killed", "--resume")
        judge(f"killed after {lines} lines: the same rows", rows_of("killed") == reference)
        judge("and the same optimum", best_of(found) == best_of(expected) and found["limits"] == expected["limits"])
    judge("it says what it takes from the journal", "taken from the journal" in printed)


def limited():
    """With half of the energy that the best design costs more than the start; what relaxing the limit gives is foretold. Meshes differ
    with their mesher, so numbers are taken from the free optimum."""
    settings = ("Optimisation/gradient tolerance=1e-5", "Optimisation/limit tolerance=1e-6", "Optimisation/noise runs=0")
    whole_values = [trial["values"] for trial in found_in("whole")["trials"]]
    start, best = whole_values[0], min(whole_values, key=lambda values: values["barrel"])
    bound, step = 0.5 * (start["energy"] + best["energy"]), 0.02 * (best["energy"] - start["energy"])
    judge("the straight side costs energy", step > 0, step)
    found, _ = optimize("limited", f"Optimisation/at most=energy: {bound!r}", *settings)
    limit = found["limits"][0]
    judge("the limit is met", abs(limit["best"] / bound - 1) < 1e-6 and limit["start"] < bound, limit)
    relaxed, _ = optimize("relaxed", f"Optimisation/at most=energy: {bound + step!r}", *settings)
    change = (relaxed["objective"]["best"] - found["objective"]["best"]) / step
    judge("its multiplier", abs(change - limit["by_relaxing"]) < 0.05 * abs(change), f"{change} {limit['by_relaxing']}")
    most = 0.5 * start["barrel"]
    tight = changed(SCENE, {"Optimisation": {"objective": "energy", "at most": f"barrel: {most!r}", "noise runs": 0}})
    write("tight.prm", prm(tight))
    found, _ = optimize("tight", case="tight.prm")
    judge("from a start beyond the limit", found["limits"][0]["start"] > most and found["limits"][0]["best"] < most * 1.0001, found["limits"])


def checked():
    found, printed = optimize("checked", "--check")
    errors = [float(line.split()[3]) for line in printed.splitlines() if line.startswith(("  0.1 ", "  0.01 ", "  0.001 "))]
    judge("differences agree", len(errors) == 3 and min(errors) < 1e-4, printed)
    judge("the search is the same", best_of(found) == best_of(found_in("whole")))
    done = run("gradient", "wrong", "--check")
    judge("--check of another command", done.returncode == 1 and "option of optimize" in done.stderr, done.stderr)


def free_form():
    """Ten modes of the side; what they find is better than the spline's."""
    settings = ("Billet/free form modes=10", "Billet/free form patches=side outer", "Billet/volume held by=free form 1",
                "Design/parameters=billet/free form", "Optimisation/confirmation=0.7", "Billet/element size=4")
    found, printed = optimize("free", *settings)
    spline, _ = optimize("spline", "Billet/element size=4")
    judge("all modes vary", len(found["parameters"]) == 9)
    judge("better than the spline", found["objective"]["best"] < spline["objective"]["best"], found["objective"])
    done = run("gradient", "free_hand", case="free/best.prm")
    value = summary_of("free_hand")["objectives"][0]["value"] if done.returncode == 0 else None
    judge("its parameters", value == found["objective"]["best"], f"{value} {done.stderr}")
    judge("modes belong to their mesh", "not confirmed" in printed and "confirmation" not in found)


def derivatives_by_modes():
    """The first mode is the die's offset; the others by the adjoint, the tangent and replayed differences, with a soft penalty that rounding
    does not spoil."""
    done = run("gradient", "modes", "Design/parameters=die upper/free form, die upper/offset", case="die.prm")
    by_mode = [parameter["gradient"]["barrel"] for parameter in summary_of("modes")["parameters"]] if done.returncode == 0 else [0, 1]
    judge("the first mode is the offset", abs(by_mode[0] / by_mode[-1] - 1) < 1e-9, f"{by_mode} {done.stderr}")
    done = run("check", "checked_die", "Contact/penetration=1e-2", "Contact/slip regularisation=0.1", "Linear solver/method=direct",
               "Check/steps=1e-5, 1e-6", "Check/taylor start=2e-5", "Check/taylor halvings=2", "Check/free differences=false", case="die.prm")
    judge("modes by adjoint, tangent and differences", done.returncode == 0, done.stdout[-3000:] + done.stderr)


def die_free_form():
    """A die of rings that takes any round shape. It begins above the billet, so that it may grow towards it, and as a flat cone: where flat
    meets flat, the least change says which node touches first. Its modes belong to the die, so they are confirmed on a finer mesh of the
    billet; the die written is the one that was forged with."""
    sys.path.insert(0, os.path.join(ROOT, "prm", "tutorial", "hub"))
    import make_die
    make_die.FACETS_PER_TURN = 16
    cone(make_die, 0.04)
    scene = changed(SCENE, {"Die upper": {"shape": "stl", "file": "cone.stl", "point": "0, 0, 17", "free form modes": 4, "free form mirrors": 16},
                            "Press": {"stroke": 7, "increments": 14}, "Remeshing": {"when": "never"},
                            "Objective barrel": {"type": "cylinder distance", "patches": "side outer"},
                            "Design": {"parameters": ", ".join(f"die upper/free form {i}" for i in (2, 3, 4))},
                            "Optimisation": {"noise runs": 0, "confirmation": 0.7, "gradient tolerance": 0.05, "iterations": 8}})
    write("die.prm", prm(scene))
    derivatives_by_modes()
    found, _ = optimize("die", case="die.prm")
    objective = found["objective"]
    judge("a shape of the die makes the side straighter", objective["best"] < 0.5 * objective["start"], objective)
    judge("and is confirmed", found["confirmation"]["best"] < 0.5 * found["confirmation"]["start"], found["confirmation"])
    done = run("gradient", "die_hand", case="die/best.prm")
    judge("its parameters", done.returncode == 0 and summary_of("die_hand")["objectives"][0]["value"] == objective["best"], done.stderr)
    for setting in ("free form modes", "free form mirrors"):
        del scene["Die upper"][setting]
    os.makedirs("elsewhere_folder", exist_ok=True)
    done = subprocess.run([*command("simulate", "die_elsewhere", case="../die/best.prm")], cwd="elsewhere_folder", env=ENVIRONMENT,
                          capture_output=True, text=True)
    value = summary_of("elsewhere_folder/die_elsewhere")["objectives"][0]["value"] if done.returncode == 0 else None
    judge("run from another folder", value == objective["best"], f"{value} {done.stderr}")
    written = changed(scene, {"Die upper": {"file": "die/designs/best_die_upper.stl", "point": "0, 0, 0"}, "Design": {"parameters": "material/K"}})
    write("written.prm", prm(written))
    another_die_file(make_die)
    done = run("simulate", "written", case="written.prm")
    value = summary_of("written")["objectives"][0]["value"] if done.returncode == 0 else float("nan")
    judge("its surface", abs(value / objective["best"] - 1) < 0.02, f"{value} {done.stderr}")


def cone(make_die, slope):
    make_die.write_stl(pathlib.Path("cone.stl"), make_die.revolved([(float(r), slope * r) for r in range(18)]))


def another_die_file(make_die):
    """Under the same name: forgings under two dies do not belong into one journal."""
    cone(make_die, 0.05)
    done = run("optimize", "die", "--resume", case="die.prm")
    judge("no resume under another die", done.returncode == 1 and "another surface of die upper" in done.stderr, done.stderr.strip())
    cone(make_die, 0.04)


def bounded():
    bound = 0.5 * (10 + best_of(found_in("whole"))[0])
    found, _ = optimize("bounded", f"Optimisation/lower bounds=billet/control point 1 r: {bound!r}")
    first = found["parameters"][0]
    judge("at its bound", first["best"] == bound and first["at"] == "at its lower bound" and first["gradient"] > 0, first)
    judge("which costs", found["objective"]["best"] > found_in("whole")["objective"]["best"])


def related():
    """Two radii that may not differ by more than half of what they would; what moving that bound gives is foretold."""
    one, two = "billet/control point 1 r", "billet/control point 2 r"
    first, second = best_of(found_in("whole"))[:2]
    settings = ("Optimisation/gradient tolerance=1e-5", "Optimisation/noise runs=0")
    bound, step = 0.5 * (second - first), 0.02 * (second - first)
    judge("they differ", bound > 0, bound)
    found, printed = optimize("related", f"Optimisation/relations={two} <= {one} + {bound!r}", *settings)
    values = best_of(found)
    relation = found["relations"][0]
    judge("the relation is kept", abs(values[1] - values[0] - bound) < 1e-8 and relation["active"], values)
    judge("it is told", "every design keeps" in printed and "felt, objective" in printed)
    wider, _ = optimize("wider", f"Optimisation/relations={two} - {one} <= {bound + step!r}", *settings)
    change = (wider["objective"]["best"] - found["objective"]["best"]) / step
    judge("its slope", abs(change - relation["by_moving"]) < 0.05 * abs(change), f"{change} {relation['by_moving']}")
    equal, _ = optimize("equal", f"Optimisation/relations={one} = {two}", *settings)
    judge("equal", abs(best_of(equal)[0] - best_of(equal)[1]) < 1e-8 and equal["objective"]["best"] < 0.5 * equal["objective"]["start"])
    rows = rows_of("equal")
    judge("in every design", max(abs(float(row[f"{one} [mm]"]) - float(row[f"{two} [mm]"])) for row in rows) < 1e-8)
    loose, _ = optimize("loose", f"Optimisation/relations={one} - {two} <= 5")
    judge("one that is not felt", abs(best_of(loose)[0] - first) < 0.02 and not loose["relations"][0]["active"], best_of(loose))


def held():
    """The parameter that follows from the volume is told, and has bounds; what moving one gives is foretold."""
    four = "billet/control point 4 r"
    found = found_in("whole")
    free, begun = found["follows"]["best"], found["follows"]["start"]
    judge("it is told", found["follows"]["name"] == four and float(rows_of("whole")[0][f"{four} [mm]"]) == begun == 10, found["follows"])
    bound, step = 0.5 * (begun + free), 0.02 * (free - begun)
    settings = ("Optimisation/gradient tolerance=1e-5", "Optimisation/limit tolerance=1e-6", "Optimisation/noise runs=0")
    side, kind = ("upper", "at most") if free > begun else ("lower", "at least")
    kept, printed = optimize("held", f"Optimisation/{side} bounds={four}: {bound!r}", *settings)
    limit = kept["limits"][0]
    judge("its bound is met", abs(kept["follows"]["best"] - bound) < 1e-5 * bound and limit["kind"] == kind, [kept["follows"], limit])
    judge("and costs", kept["objective"]["best"] > found["objective"]["best"] and "follows from the volume" in printed)
    wider, _ = optimize("held_wider", f"Optimisation/{side} bounds={four}: {bound + step!r}", *settings)
    change = (wider["objective"]["best"] - kept["objective"]["best"]) / step
    judge("its multiplier", abs(change - limit["by_relaxing"]) < 0.05 * abs(change), f"{change} {limit['by_relaxing']}")
    for setting, expected in ((f"scales={four}: 1", "follows from the volume"), (f"relations={four} <= 20", "follows from the volume")):
        done = run("optimize", "wrong", f"Optimisation/{setting}")
        judge(f"no {setting}", done.returncode == 1 and expected in done.stderr, done.stderr.strip())


def recorded():
    """The record of a design is that of a run, from which it is differentiated again."""
    found, _ = optimize("kept", "Optimisation/keep records=true", "Optimisation/iterations=2", "Optimisation/noise runs=0")
    folder = "kept/designs/best"
    done = run("gradient", folder, "--resume", case=f"{folder}/parameters.prm")
    judge("gone through again", done.returncode == 0, done.stderr)
    summary = summary_of(folder)
    judge("its value", summary["objectives"][0]["value"] == found["objective"]["best"], summary["objectives"])
    for parameter, of_run in zip(found["parameters"], summary["parameters"]):
        judge(f"gradient by {parameter['name']}", parameter["gradient"] == of_run["gradient"]["barrel"], of_run["gradient"])


def failing():
    """A first step so long that the contour crosses the axis, where no mesh is."""
    found, printed = optimize("failing", "Optimisation/first step=400", "Optimisation/largest step=400")
    rows = [row for row in rows_of("failing") if row["decision"] == "failed"]
    judge("failures are refused", rows and found["failed"] == len(rows) and found["objective"]["best"] < 0.1 * found["objective"]["start"])
    judge("and say why", all(row["failure"] for row in rows) and rows[0]["failure"] in printed, rows[:1])
    done = run("optimize", "first", "Press/max cuts=0", "Press/largest move=0.001")
    judge("the first must succeed", done.returncode == 1 and "in increment 1" in done.stderr, done.stderr)


def infeasible():
    """A limit that no design within the bounds keeps: told first, with how far it is missed, and by the exit status, however the search ends."""
    at_start, bound = found_in("whole")["trials"][0]["values"]["energy"], 0.5
    one = "billet/control point 1 r"
    half = f"Optimisation/at most=energy: {bound * at_start!r}"
    bounds = (f"Optimisation/lower bounds={one}: 9.9", f"Optimisation/upper bounds={one}: 10.1", "Design/parameters=" + one, "Optimisation/noise runs=0")
    for name, more, reason in (("infeasible", bounds, "limits are not met"), ("cut_off", ("Optimisation/iterations=1",), "as many steps were tried"),
                               ("infeasible", (*bounds, "--resume"), "limits are not met")):
        found, printed = optimize(name, half, *more, status=2)
        limit, missed = found["limits"][0], found["limits"][0]["best"] - bound * at_start
        headline = printed[printed.index("NOT FEASIBLE"):]
        judge(f"{name}: the first line of the result says so", headline.index("energy: ") < headline.index("barrel: "), printed)
        judge("and by how much", limit["missed_by"] == missed > 0.4 * at_start and f"{missed:.4g} mJ ({100 * missed / (bound * at_start):.3g} %) too much" in headline,
              f"{limit} {headline}")
        judge("what ended the search is told", f"stopped: {reason}" in printed, printed)
        judge("nothing is foretold", limit["by_relaxing"] is None and "not kept" in headline and not found["limits_kept"], limit)
    done = start([str(ROOT / "contrib/report"), "--no-vtk", "infeasible"])
    judge("the report says so first", "NOT FEASIBLE" in text_of("infeasible", "report.html"), done.stderr)
    found, printed = optimize("at_least", f"Optimisation/at least=energy: {2 * at_start!r}", *bounds, status=2)
    judge("a lower limit", found["limits"][0]["missed_by"] == 2 * at_start - found["limits"][0]["best"] and "too little" in printed, found["limits"])


def limits_that_do_not_press():
    at_start = found_in("whole")["trials"][0]["values"]["energy"]
    found, printed = optimize("loose_limit", f"Optimisation/at most=energy: {2 * at_start!r}", "Optimisation/noise runs=0")
    judge("one that is not felt", found["limits"][0]["by_relaxing"] == 0 and "not felt" in printed, found["limits"])
    found, printed = optimize("unfinished", f"Optimisation/at most=energy: {2 * at_start!r}", "Optimisation/noise runs=0", "Optimisation/iterations=1")
    judge("before the end nothing is known", found["limits"][0]["by_relaxing"] is None and "did not come to its end" in printed, found["limits"])
    judge("nor of a noise that was not measured", found["limits"][0]["noise"] == 0 and "noise of" not in printed, found["limits"])
    # Where the objective is flat: steps change it by less than its noise.
    there = [(f"billet/control point {i} r", value) for i, value in enumerate(best_of(found_in("whole")), 1)]
    shortest = ("Optimisation/iterations=1", "Optimisation/first step=1e-6", "Optimisation/limit tolerance=1e-8")
    found, printed = optimize("noisy", f"Optimisation/at most=barrel: {2 * found_in('whole')['objective']['start']!r}", *there, *shortest)
    noise = found["objective"]["noise"]
    judge("the noise of a limit on the objective is that of the objective", found["limits"][0]["noise"] == noise > 0, found["limits"])
    judge("and not told far from the limit", "noise of barrel: " not in printed, printed)
    found, printed = optimize("close", f"Optimisation/at most=barrel: {found['objective']['best'] + 0.5 * noise!r}", *there, *shortest)
    judge("what hides a limit from the search is told", "more than a first step changes it by (" in printed, printed)
    judge("near it, it is", "noise of barrel: " in printed and "nearer to the limit" in printed, [noise, printed])


def beset():
    """Designs that fail in every step from the start: the metal loses a little more of its volume there than is allowed."""
    scene = changed(SCENE, {"Objectives": {"names": "barrel, volume"}, "Optimisation": {"noise runs": 0, "iterations": 30}})
    write("beset.prm", prm(scene))
    run("gradient", "before", case="beset.prm")
    summary = summary_of("before")
    down = [[-parameter["gradient"]["barrel"], parameter["gradient"]["volume"]] for parameter in summary["parameters"]]
    loss = summary["volume_final"] - summary["volume_initial"]
    sign = 1 if sum(g * v for g, v in down) * loss > 0 else -1
    settings = (f"Objective barrel/weight={sign}", f"Press/largest volume change={abs(loss) / summary['volume_initial'] * (1 + 1e-9)!r}", "Press/max cuts=0")
    found, printed = optimize("beset", *settings, case="beset.prm", status=2)
    judge("no design but the start", {trial["decision"] for trial in found["trials"]} == {"start", "failed"} and best_of(found) == [10, 10], found["trials"])
    judge("is told first, with why", printed.index("NOTHING FOUND") < printed.index("  barrel: ") and "of its volume" in printed[printed.index("NOTHING FOUND"):], printed)
    judge("and is no convergence", not found["converged"] and "at the edge of what can be forged" in printed, found["stop"])


FAR = {"billet/control point 1 r": 18.0, "billet/control point 2 r": 3.0}
FROM_FAR = (*FAR.items(), "Design/meshed at=" + ", ".join(f"{name}: {value!r}" for name, value in FAR.items()), "Optimisation/noise runs=0")


def far_away():
    """A billet meshed at a shape far from the optimum: on the way there its cells become flat, and the mesh is made anew. The optimum is that
    of a search which begins near it, on that mesh to the tolerance, and on the nominal one but for the scatter of meshes."""
    found, printed = optimize("far", *FROM_FAR, "Optimisation/confirmation=0.9")
    rows, made = rows_of("far"), found["new_meshes"]
    judge("the mesh is made anew", made and [row["mesh"] for row in rows] == sorted(row["mesh"] for row in rows), made)
    judge("and better", all(mesh["quality"] > 1.5 * mesh["quality_before"] and mesh["quality_before"] < 0.2 for mesh in made), made)
    for i, mesh in enumerate(made):
        before, after = rows[mesh["trial"] - 1], rows[mesh["trial"]]
        judge(f"mesh {i + 1}: the same design", after["decision"] == "new mesh" and int(after["mesh"]) == i + 1 and before["decision"] != "refused"
              and all(after[f"{name} [mm]"] == before[f"{name} [mm]"] for name in FAR), [before, after])
        judge("it is told", f"{mesh['objective']:.7g}" in printed and mesh["values"]["barrel"] == float(after["barrel [mm^2]"]), mesh)
    judge("so is what it changed", "start and best are forged on meshes of their own" in printed)
    journal = [json.loads(line) for line in text_of("far", "journal.jsonl").splitlines()]
    judge("its line in the journal", [line["made at"] for line in journal if "new mesh" in line] == [mesh["meshed_at"] for mesh in made])
    scatter = sum(abs(a - b) for a, b in zip(best_of(found), best_of(found_in("whole"))))
    judge("the optimum of a start near it, but for the meshes", scatter < 0.5, f"{best_of(found)} {best_of(found_in('whole'))}")
    judge("the side is straight", found["objective"]["best"] < 0.01 * found["objective"]["start"], found["objective"])
    judge("confirmed where the mesh was made", found["confirmation"]["best"] < 0.1 * found["confirmation"]["start"], found.get("confirmation"))
    last = made[-1]["meshed_at"]
    near, _ = optimize("near", ("billet/control point 1 r", 10.0), ("billet/control point 2 r", 9.5), f"Design/meshed at={last}", "Optimisation/noise runs=0")
    # Along the valley of straight sides designs differ by more than their values do; how far depends on the mesher's mesh.
    judge("to the tolerance on its mesh", abs(found["objective"]["best"] - near["objective"]["best"]) < 1e-3 * found["objective"]["start"]
          and max(abs(a - b) for a, b in zip(best_of(found), best_of(near))) < 0.1, f"{best_of(found)} {best_of(near)} {found['objective']} {near['objective']}")
    done = run("gradient", "far_hand", case="far/best.prm")
    value = summary_of("far_hand")["objectives"][0]["value"] if done.returncode == 0 else None
    judge("the best by hand", value == found["objective"]["best"], f"{value} {done.stderr}")
    write("far.prm", text_of("far", "parameters.prm") + "include far/designs/best_design.prm\n")
    done = run("simulate", "far_included", case="far.prm")
    value = summary_of("far_included")["objectives"][0]["value"] if done.returncode == 0 else None
    judge("and by what the case is to include", value == found["objective"]["best"], f"{value} {done.stderr}")


def meshes_within_limits():
    """A limit of the energy that is felt, kept on the last mesh; a relation; a scattered friction; the same path on two ranks."""
    scattered, _ = optimize("far_scattered", *FROM_FAR, ("dies/friction", 0.3), "Optimisation/scattered=dies/friction",
                            "Optimisation/scatter range=0.2, 0.4", "Optimisation/samples=2")
    judge("scattered", scattered["new_meshes"] and scattered["objective"]["best"] < 0.01 * scattered["objective"]["start"], scattered["objective"])
    one, two = "billet/control point 1 r", "billet/control point 2 r"
    energies = [trial["values"]["energy"] for trial in found_in("far")["trials"]]
    bound = energies[-1] - 0.1 * abs(energies[-1] - energies[0])
    found, _ = optimize("far_limited", *FROM_FAR, f"Optimisation/at most=energy: {bound!r}", "Optimisation/iterations=15")
    judge("a limit on the last mesh", found["new_meshes"] and found["limits"][0]["best"] < bound * 1.002, found["limits"])
    found, _ = optimize("far_related", *FROM_FAR, f"Optimisation/relations={one} + {two} <= 22")
    judge("a relation", found["new_meshes"] and found["objective"]["best"] < 0.01 * found["objective"]["start"], found["objective"])
    exact = ("Newton/tolerance=1e-12", "Adjoint/tolerance=1e-12")
    alone, _ = optimize("far_alone", *FROM_FAR, *exact)
    done = start(["mpirun", "-np", "2", *command("optimize", "far_ranks", *FROM_FAR, *exact)])
    judge("two ranks", done.returncode == 0, done.stderr)
    difference = max(abs(a - b) for a, b in zip(best_of(found_in("far_ranks")), best_of(alone)))
    path = [[(row["decision"], row["mesh"]) for row in rows_of(folder)] for folder in ("far_alone", "far_ranks")]
    judge("the same path over meshes", path[0] == path[1] and difference / 10 < 1e-8, difference)


def free_form_far_away():
    """A waist that modes of the side are to straighten: without new meshes cells turn inside out a few steps from the start."""
    modes = ", ".join(f"billet/free form {i}: 1" for i in range(2, 7))
    settings = ("Billet/control points=15, 0; 4, 5; 4, 10; 15, 15", "Billet/element size=4", "Billet/free form modes=6",
                "Billet/free form patches=side outer", "Billet/volume held by=free form 1", "Design/parameters=billet/free form",
                f"Optimisation/scales={modes}", "Optimisation/noise runs=0", "Optimisation/iterations=9")
    found, _ = optimize("waist", *settings)
    stuck, _ = optimize("stuck", *settings, "Optimisation/mesh quality=0")
    judge("new meshes", len(found["new_meshes"]) > 0 and not stuck["new_meshes"], found["new_meshes"])
    # How much farther is up to the mesher's mesh, and to last digits: of the value where the one without gets stuck, it ends at 0.52 with
    # Gmsh 4.8, and with 4.13 at 0.83 or 0.95.
    judge("are what the search needs", found["objective"]["best"] < 0.98 * stuck["objective"]["best"], f"{found['objective']} {stuck['objective']}")
    failures = [trial["failure"] for trial in stuck["trials"] if trial["failure"]]
    judge("without them cells turn inside out", failures and all("inside out" in failure for failure in failures), failures)
    done = run("gradient", "waist_hand", case="waist/best.prm")
    value = summary_of("waist_hand")["objectives"][0]["value"] if done.returncode == 0 else None
    judge("the best by hand, its modes carried over", value == found["objective"]["best"], f"{value} {done.stderr}")
    first = found["new_meshes"][0]
    again, _ = optimize("waist", "--resume", *settings)
    judge("resumed", again["new_meshes"] == found["new_meshes"] and best_of(again) == best_of(found), first)


def resumed_through_meshes():
    reference = rows_of("far")
    settings = FROM_FAR
    lines = text_of("far", "journal.jsonl").splitlines()
    new = next(i for i, line in enumerate(lines) if '"new mesh"' in line)
    for n in (new, new + 1, new + 2, len(lines) - 1):
        shutil.copytree("far", f"cut{n}", ignore=shutil.ignore_patterns("best.prm", "confirmation.jsonl"))
        write(f"cut{n}/journal.jsonl", "".join(line + "\n" for line in lines[:n]))
        found, _ = optimize(f"cut{n}", "--resume", *settings)
        judge(f"resumed after {n} lines", rows_of(f"cut{n}") == reference and found["new_meshes"] == found_in("far")["new_meshes"])
        same = [line for line in text_of(f"cut{n}", "journal.jsonl").splitlines() if '"new mesh"' in line]
        judge("the same line of the mesh", same == [line for line in lines if '"new mesh"' in line])


def gradient_on_a_new_mesh():
    """At the design where the mesh was made, and at another one on it: adjoint, tangent and replayed differences, Taylor's order."""
    exact = ("Contact/penetration=1e-2", "Contact/slip regularisation=0.1", "Linear solver/method=direct", "Check/steps=1e-4, 1e-5, 1e-6",
             "Check/taylor halvings=2", "Check/free differences=false")
    made = found_in("far")["new_meshes"][0]
    for name, at in (("there", made["meshed_at"]), ("best", None)):
        more = [f"Design/at={', '.join(part for part in at.split(', ') if 'point 4' not in part)}"] if at else []
        done = run("check", f"checked_{name}", f"Design/meshed at={made['meshed_at']}", *more, *exact, case="far/best.prm")
        judge(f"derivatives on the new mesh, {name}", done.returncode == 0, done.stdout[-3000:] + done.stderr)


def from_elsewhere():
    found, _ = optimize("elsewhere", ("billet/control point 1 r", 9.0), ("material/K", 2))
    at_nominal = best_of(found_in("whole"))
    judge("from another start the same optimum", all(abs(a - b) < 0.02 for a, b in zip(best_of(found), at_nominal)), best_of(found))
    judge("what is not varied stays", found["parameters"][-1]["best"] == 2 and found["parameters"][-1]["at"] == "not varied")


def identified():
    """Friction and consistency from the energy and two radii of a forging whose parameters are known."""
    scene = changed(SCENE, {"Objectives": {"names": "energy, top, side"}, "Objective top": {"type": "mean radius", "patches": "top"},
                            "Objective side": {"type": "mean radius", "patches": "side outer"},
                            "Design": {"parameters": "dies/friction, material/K"}})
    scene["Optimisation"] = {"noise runs": 0, "confirmation": 0, "gradient tolerance": 1e-7}
    del scene["Objective barrel"]
    write("known.prm", prm(scene))
    done = run("simulate", "known", ("dies/friction", 0.21), ("material/K", 1.5), case="known.prm")
    judge("known", done.returncode == 0, done.stderr)
    values = {objective["name"]: objective["value"] for objective in summary_of("known")["objectives"]}
    spread = {"energy": 1e-3 * values["energy"], "top": 0.01, "side": 0.01}
    listed = {kind: ", ".join(f"{name}: {number!r}" for name, number in numbers.items())
              for kind, numbers in (("data", values), ("uncertainties", spread))}
    found, printed = optimize("found", *(f"Optimisation/{kind}={text}" for kind, text in listed.items()), case="known.prm")
    friction, consistency = best_of(found)
    judge("friction", abs(friction / 0.21 - 1) < 1e-4, friction)
    judge("consistency", abs(consistency / 1.5 - 1) < 1e-4, consistency)
    judge("few forgings", found["simulations"] <= 10, found["simulations"])
    identification = found["identification"]
    judge("all agree", identification["misfit"] < 1e-4 and identification["freedom"] == 1, identification)
    # By hand: the covariance is the inverse of J^T J of the run's own gradients.
    done = run("gradient", "at", case="found/best.prm")
    jacobian = np.array([[of["gradient"][name] / spread[name] for of in summary_of("at")["parameters"]] for name in values])
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    deviations = np.sqrt(np.diag(covariance))
    error = np.abs(np.array(identification["deviations"]) / deviations - 1).max()
    judge("deviations", error < 1e-8, error)
    correlation = covariance[0, 1] / deviations.prod()
    judge("correlation", abs(identification["correlations"][0][1] - correlation) < 1e-8, correlation)
    judge("intervals are told", "(95 %)" in printed and identification["converged"] and not identification["disagrees"])
    found, printed = optimize("begun", *(f"Optimisation/{kind}={text}" for kind, text in listed.items()), "Optimisation/iterations=1", case="known.prm")
    judge("none before the end", "no intervals" in printed and not found["identification"]["converged"], printed)
    wrong = listed["data"].replace(f"top: {values['top']!r}", f"top: {values['top'] + 0.5!r}")
    found, printed = optimize("disagreeing", f"Optimisation/data={wrong}", f"Optimisation/uncertainties={listed['uncertainties']}", case="known.prm")
    judge("data that disagree are told", found["identification"]["disagrees"] and "not to be trusted" in printed, found["identification"])
    one = {kind: text.split(", ")[0] for kind, text in listed.items()}
    found, printed = optimize("blind", *(f"Optimisation/{kind}={text}" for kind, text in one.items()), case="known.prm")
    judge("one number for two parameters", len(found["identification"]["unseen"]) == 2 and "do not see" in printed)


def scattered():
    """Mean and deviation of the energy over three frictions, and what is robust against them."""
    settings = ("Design/parameters=billet/control point 1 r, dies/friction", "Optimisation/scattered=dies/friction",
                "Optimisation/scatter range=0.2, 0.6", "Optimisation/deviations=2")
    found, printed = optimize("scattered", *settings)
    judge("it says so", "each design is forged 3 times" in printed and "mean + 2 standard deviation(s)" in printed)
    judge("forgings, not designs", found["simulations"] == 3 * len(found["trials"]) and found["sweeps"] <= found["simulations"])
    points = 0.4 + 0.2 * np.sqrt(0.6) * np.array([-1, 0, 1])
    values = []
    for i, friction in enumerate(points):
        run("simulate", f"sample{i}", ("dies/friction", float(friction)))
        values.append(summary_of(f"sample{i}")["objectives"][0]["value"])
    weights, values = np.array([5, 8, 5]) / 18, np.array(values)
    mean = weights @ values
    expected = mean + 2 * np.sqrt(weights @ (values - mean)**2)
    judge("the start", abs(found["objective"]["start"] / expected - 1) < 1e-9, f"{found['objective']['start']} {expected}")
    judge("the best", found["objective"]["best"] < 0.5 * found["objective"]["start"], found["objective"])
    judge("the scattered parameter stays", found["parameters"][1]["at"] == "not varied")


def confirmed():
    """Finer, and finer still, from the same journal."""
    first, _ = optimize("confirmed", "Optimisation/confirmation=0.9")
    again, printed = optimize("confirmed", "--resume", "Optimisation/confirmation=0.7")
    judge("confirmed", first["confirmation"]["best"] < 0.3 * first["confirmation"]["start"], first["confirmation"])
    judge("and on a finer mesh", again["confirmation"]["nodes"] > first["confirmation"]["nodes"] and best_of(again) == best_of(first))
    judge("without forging anew", "taken from the journal" in printed)


def corrected():
    """A limit that the finer mesh misses: the search goes on until it is kept there, by what that mesh adds to the value."""
    trials, there = [trial["values"]["energy"] for trial in found_in("confirmed")["trials"]], found_in("confirmed")["confirmation"]["values"]["energy"]
    best = next(row["values"]["energy"] for row in found_in("confirmed")["trials"] if row["values"]["barrel"] == found_in("confirmed")["objective"]["best"])
    # On the side of the free optimum where it is felt, and the finer mesh is beyond it.
    sign = -1 if there < best else 1
    bound = best - 0.5 * sign * abs(best - trials[0])
    settings = (f"Optimisation/{'at most' if sign > 0 else 'at least'}=energy: {bound!r}", "Optimisation/confirmation=0.7", "Optimisation/noise runs=0")
    first, printed = optimize("corrected", "Optimisation/corrections=0", *settings, status=2)
    design = text_of("corrected", "designs", "best_design.prm")
    judge("which the headline and the exit status tell", "NOT KEPT ON THE FINER MESH" in printed, printed)
    judge("missed on the finer mesh", sign * (first["confirmation"]["values"]["energy"] - bound) > 1e-3 * bound and "not kept there" in printed, first["confirmation"])
    judge("though it is kept", first["limits_kept"] and first["limits"][0]["correction"] == 0, first["limits"])
    judge("and that the search does not go on", not first["confirmation"]["limits_kept"] and "Optimisation/corrections is 0" in printed, printed)
    found, printed = optimize("corrected", "--resume", f"Optimisation/simulations={first['simulations']}", *settings, status=2)
    judge("cut off, it leaves the design before", best_of(found) == best_of(first) and found["confirmation"]["values"] == first["confirmation"]["values"]
          and found["limits"] == first["limits"] and "was cut off" in printed, [found["limits"], printed])
    judge("in its parameters, too", text_of("corrected", "designs", "best_design.prm") == design, text_of("corrected", "designs", "best_design.prm"))
    found, printed = optimize("corrected", "--resume", *settings)
    judge("kept on the finer mesh, says the result", found["confirmation"]["limits_kept"] and not found["confirmation"]["not_corrected"], found["confirmation"])
    limit, there = found["limits"][0], found["confirmation"]["values"]["energy"]
    judge("kept there", sign * (there - bound) < 1e-4 * bound and "not kept there" not in printed, [limit, found["confirmation"]])
    judge("by what it adds", abs(limit["best"] + limit["correction"] - bound) < 1e-3 * bound and sign * limit["correction"] > 0, limit)
    judge("it is told", "from here on they count what it adds: energy" in printed and "energy counts with" in printed, printed)
    judge("from where the first search ended", found["trials"][:len(first["trials"])] == first["trials"] and found["simulations"] > first["simulations"])
    judge("which costs", found["objective"]["best"] > first["objective"]["best"], [first["objective"], found["objective"]])
    again, _ = optimize("corrected", "--resume", *settings)
    judge("resumed the same", again["trials"] == found["trials"] and again["limits"] == found["limits"] and again["confirmation"] == found["confirmation"])


def on_two_ranks():
    """Systems solved well: ranks sum in another order, and default tolerances leave 1e-8 of it in the optimum."""
    exact = ("Newton/tolerance=1e-12", "Adjoint/tolerance=1e-12")
    alone, _ = optimize("alone", *exact)
    done = start(["mpirun", "-np", "2", *command("optimize", "ranks", *exact)])
    judge("two ranks", done.returncode == 0, done.stderr)
    difference = max(abs(a - b) for a, b in zip(best_of(found_in("ranks")), best_of(alone)))
    judge("the same path", len(rows_of("ranks")) == len(rows_of("alone")) and difference / 10 < 1e-8, difference)
    print(f"  optima differ by {difference / 10:.1e} of the radius")


def reported():
    for folder, expected in (("whole", "start and best"), ("failing", "Designs that failed"), ("found", "95 %"), ("limited", "Limits")):
        done = start([str(ROOT / "contrib/report"), "--no-vtk", folder])
        judge(f"report of {folder}", done.returncode == 0 and expected in text_of(folder, "report.html"), done.stderr)
    judge("its pictures", text_of("whole", "report.html").count("data:image/png;base64") == 2)


def refused():
    before = text_of("whole", "journal.jsonl")
    for what, settings, expected in (
            ("unknown objective", ["Optimisation/objective=barel"], "did you mean 'barrel'"),
            ("nothing to make small", ["Optimisation/objective=", "Optimisation/at most=barrel: 1, energy: 1"], "nothing to be made small"),
            ("unknown limit", ["Optimisation/at least=fold: 1"], "not an objective"),
            ("unknown bound", ["Optimisation/upper bounds=billet/control point 9 r: 1"], "did you mean"),
            ("data without deviations", ["Optimisation/objective=", "Optimisation/data=barrel: 0"], "has none for 'barrel'"),
            ("a scattered parameter that is not there", ["Optimisation/scattered=die upper/friction", "Optimisation/scatter range=0, 1"],
             "add it there"),
            ("a range that the scattered parameter may not have",
             ["Design/parameters=billet/control point 1 r, dies/friction", "Optimisation/scattered=dies/friction",
              "Optimisation/scatter range=-0.2, 0.6"], "Optimisation/scatter range: has -0.2"),
            ("a range the wrong way around",
             ["Design/parameters=billet/control point 1 r, dies/friction", "Optimisation/scattered=dies/friction",
              "Optimisation/scatter range=0.6, 0.2"], "exchange them"),
            ("bounds of a scattered parameter",
             ["Design/parameters=billet/control point 1 r, dies/friction", "Optimisation/scattered=dies/friction",
              "Optimisation/scatter range=0.2, 0.6", "Optimisation/lower bounds=dies/friction: 0.1"], "is scattered"),
            ("nothing but a scattered parameter",
             ["Design/parameters=dies/friction", "Optimisation/scattered=dies/friction", "Optimisation/scatter range=0.2, 0.6"],
             "none but the one that is scattered"),
            ("limits that exclude each other", ["Optimisation/at least=energy: 10", "Optimisation/at most=energy: 9"], "no value is both"),
            ("a limit that nothing can keep", ["Optimisation/at most=energy: -3"], "no value of it is below 0"),
            ("an objective twice", ["Optimisation/objective=barrel, barrel"], "stands twice"),
            ("an objective from both sides, with scatter",
             ["Design/parameters=billet/control point 1 r, dies/friction", "Optimisation/scattered=dies/friction",
              "Optimisation/scatter range=0.2, 0.6", "Optimisation/at least=energy: 1", "Optimisation/at most=energy: 1e9"],
             "limited from above"),
            ("a relation of something else", ["Optimisation/relations=billet/control point 1 r <= die upper/offset"], "does not vary"),
            ("a relation that is none", ["Optimisation/relations=billet/control point 1 r < 5"], "has no = after <"),
            ("a relation that does not hold", ["Optimisation/relations=billet/control point 1 r <= 9"], "does not hold at the start"),
            ("start outside", ["Optimisation/upper bounds=billet/control point 1 r: 9"], "begins at 10 mm"),
            ("a die in the billet", ["Die upper/point=0, 0, 13"], "inside it")):
        done = run("optimize", "wrong", *settings)
        judge(what, done.returncode == 1 and expected in done.stderr and not os.path.exists("wrong"), done.stderr.strip())
    for what, output, settings, expected in (
            ("results are there", "whole", [], "holds results already"),
            ("nothing to resume", "nowhere", ["--resume"], "no journal"),
            ("another case", "whole", ["--resume", "Die upper/friction=0.2"], "other parameters")):
        done = run("optimize", output, *settings)
        judge(what, done.returncode == 1 and expected in done.stderr, done.stderr.strip())
    done = start(["mpirun", "-np", "2", *command("optimize", "whole", "--resume")])
    judge("another number of ranks", done.returncode != 0 and "rank(s)" in done.stderr, done.stderr.strip())
    judge("nothing was touched", text_of("whole", "journal.jsonl") == before)
    found, printed = optimize("whole", "--resume", "Optimisation/gradient tolerance=1e-4")
    judge("resumed with another tolerance", "taken from the journal" in printed and found["simulations"] >= len(before.splitlines()) // 3)


main({"case.prm": prm(SCENE)}, (whole, noise_at_the_end, begins_in_a_die, ends_in_a_die, by_hand, killed, limited, infeasible, limits_that_do_not_press, beset, checked, free_form, die_free_form, bounded, related, held, recorded, failing, far_away, meshes_within_limits, resumed_through_meshes, gradient_on_a_new_mesh, free_form_far_away, from_elsewhere, identified, scattered, confirmed, corrected, on_two_ranks, reported, refused))
