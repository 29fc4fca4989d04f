#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Conduction in whole runs: the heat of a closed body, temperatures that stay within what they are made of on twenty
random scenes, the order in time, derivatives, a ball that stands off nodes, metal that arrives at dies, slopes against the trend, and what heat costs.
run.py BUILD balance | bounds | order | derivatives | ball | arrivals | trends | cost"""
import csv
import json
import math
import os
import random
import statistics
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
PRM = os.path.join(HERE, "..", "..")
sys.path[:0] = [PRM, os.path.join(HERE, "..", "curved_dies")]
import case_tools  # noqa: E402
import dies  # noqa: E402

BUILD = sys.argv[1]
UPSETTING = os.path.join(HERE, "upsetting.prm")
HUB = os.path.join(PRM, "tutorial", "hub", "hub.prm")
HOT_HUB = os.path.join(PRM, "verification", "optimisation", "hot_hub.prm")
CLOSED = {"Heat/contact film": 0, "Heat/air film": 0, "Heat/emissivity": 0}


def values(summary):
    return {objective["name"]: objective for objective in summary["objectives"]}


def balance():
    """Work and friction are all the heat there is; mean temperatures are over the volume."""
    summary, _ = case_tools.run(BUILD, "simulate", UPSETTING, {**CLOSED, "Heat/friction part": 1}, "closed")
    spent = values(summary)["energy"]["parts"]
    came = (0.9 * spent["deformation"] + spent["friction"]) / (5 * summary["volume_final"])
    ends = summary["heat"]["mean_temperature"]
    print(f"{summary['remeshings']} remeshings: rise {ends - 1100:.4f} K, by work and friction {came:.4f} K, "
          f"{(ends - 1100) / came - 1:.1e} of it")
    case_tools.figure("heat_of_closed_body", abs(ends - 1100 - came) / (ends + 273.15))


def scene(number):
    """File, settings and the range of temperatures of a scene: no heat is made in the metal; friction's goes into the dies."""
    chance = random.Random(number)
    lower, upper, air, metal = (chance.uniform(*between) for between in ((20, 400), (20, 400), (0, 60), (800, 1250)))
    if number % 5 == 4:
        upper = metal + 100  # a die that warms the metal
    settings = {"Heat/heating": "conduction", "Heat/fraction of work": 0, "Heat/friction part": 0,
                "Heat/contact film": chance.uniform(2, 20), "Heat/air film": chance.uniform(0, 0.1),
                "Heat/emissivity": chance.uniform(0, 1), "Heat/transfer time": chance.choice([0, chance.uniform(0.1, 20)]),
                "Heat/dwell time": chance.choice([0, chance.uniform(0.1, 10)]), "Heat/waiting steps": chance.randint(3, 30),
                "Heat/surroundings": air, "Die lower/temperature": lower, "Die upper/temperature": upper,
                "Material/temperature": metal, "Objectives/names": "energy, largest temperature, least temperature",
                "Design/parameters": "billet/temperature"}
    if number % 2 == 0:
        settings.update({"Billet/element size": chance.uniform(4, 7), "Press/stroke": chance.uniform(8, 20),
                         "Press/increments": chance.randint(8, 20), "Remeshing/every": chance.randint(2, 5)})
        return UPSETTING, settings, (lower, upper, air, metal)
    settings.update({"Billet/element size": chance.uniform(4.5, 6), "Press/stroke": chance.uniform(8, 16),
                     "Billet/radius": chance.uniform(13, 17)})
    return HUB, settings, (lower, upper, air, metal)


def bounds():
    worst, remeshed = 0.0, 0
    for number in range(20):
        file, settings, within = scene(number)
        name = f"bounds_{number}"
        summary, _ = case_tools.run(BUILD, "simulate", file, settings, name)
        with open(os.path.join(name, "objectives.csv"), encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
        highest = max(float(row["largest temperature: true maximum [C]"]) for row in rows)
        lowest = min(float(row["least temperature: true minimum [C]"]) for row in rows)
        over = max(highest - max(within), min(within) - lowest)
        worst, remeshed = max(worst, over), remeshed + (summary["remeshings"] > 0)
        print(f"{number}: {summary['remeshings']} remeshings, {lowest:.1f} to {highest:.7f} C, over by {over:.1e} K", flush=True)
    print(f"{remeshed} of 20 scenes are remeshed")
    case_tools.figure("overshoot", max(worst, 0.0))


def order():
    found = []
    for n in (10, 20, 40):
        summary, _ = case_tools.run(BUILD, "simulate", UPSETTING,
                                    {"Billet/element size": 6, "Press/stroke": 10, "Press/increments": n,
                                     "Remeshing/when": "never", "Newton/tolerance": 1e-11, "Heat/dwell time": 1,
                                     "Die lower/friction": 0, "Die upper/friction": 0}, f"order_{n}")
        found.append((values(summary)["energy"]["value"], summary["heat"]["mean_temperature"]))
    orders = [math.log2(abs((found[0][i] - found[1][i]) / (found[1][i] - found[2][i]))) for i in (0, 1)]
    print(f"orders of energy and mean temperature: {orders[0]:.2f}, {orders[1]:.2f}")
    case_tools.figure("conduction_order", min(orders))


def derivatives():
    """Temperatures of metal and dies by the numbers of heat, positions and the press, remeshed twice."""
    numbers = ("heat capacity", "conductivity", "contact film", "die effusivity", "air film", "emissivity", "friction part", "transfer time",
               "dwell time")
    settings = {"Billet/element size": 7, "Press/stroke": 12, "Press/increments": 9, "Contact/penetration": 1e-3, "Heat/transfer time": 5,
                "Heat/dwell time": 2, "Heat/contact gap": 1, "Newton/tolerance": 1e-13, "Adjoint/tolerance": 1e-13,
                "Objectives/names": "die below, die above, largest temperature, least temperature",
                "Objective die below/type": "die temperature", "Objective die below/die": "lower", "Objective die below/temperature smoothing": 20,
                "Objective die above/type": "die temperature", "Objective die above/temperature smoothing": 20,
                "Design/parameters": ", ".join(["billet/radius", "billet/temperature", "die upper/offset", "die upper/speed", "die lower/temperature",
                                                "die upper/temperature"] + [f"heat/{number}" for number in numbers]),
                "Check/steps": "1e-3, 1e-4, 1e-5, 1e-6", "Check/free differences": "false", "Check/taylor start": 3e-5,
                "Check/taylor halvings": 3, "Output/fields every": 0, "Output/record": "false"}
    case_tools.judge_check(BUILD, UPSETTING, settings, "heat")


def ball():
    """The warmest place of a ball at 200 C that is pressed into hot metal. Between nodes of coarse elements it bulges by more than `contact gap`."""
    file = os.path.abspath("ball.stl")
    dies.write(file, dies.sphere(22.0))
    found = {}
    for size in (6, 5, 3.5, 2.5):
        settings = {"Billet/element size": size, "Die upper/shape": "stl", "Die upper/file": file, "Press/stroke": 4, "Press/increments": 8,
                    "Remeshing/when": "never", "Heat/transfer time": 0, "Heat/dwell time": 0, "Die upper/temperature": 200,
                    "Objectives/names": "die temperature", "Design/parameters": "die upper/temperature", "Output/fields every": 0}
        summary, _ = case_tools.run(BUILD, "simulate", UPSETTING, settings, f"ball_{size}")
        found[size] = values(summary)["die temperature"]["value"]
        print(f"elements of {size} mm: {found[size]:.1f} C", flush=True)
    case_tools.figure("ball", max(abs(t - found[2.5]) for t in found.values()) / (1100 - 200))


def arrivals():
    """Temperatures of dies by what moves them or the metal, on meshes that stay: slopes of nine designs against a cubic through the values, and what of
    these lies off it. Increments are long: metal arrives in them."""
    file = os.path.abspath("ball.stl")
    dies.write(file, dies.sphere(22.0))
    common = {"Remeshing/when": "never", "Objectives/names": "die temperature", "Output/fields every": 0, "Scan/points": 9}
    small = {**common, "Billet/radius": 17, "Billet/height": 25, "Billet/symmetry planes": "0, -1, 0; -0.866025403784439, 0.5, 0",
             "Die lower/friction": 0.3, "Die upper/friction": 0.3, "Die upper/shape": "stl", "Die upper/file": file, "Die upper/point": "0, 0, 25",
             "Die upper/temperature": 200, "Press/stroke": 4.5, "Press/increments": 0, "Scan/parameter": "die upper/offset", "Scan/range": 0.002}
    hub = {**common, "Press/stroke": 8, "Optimisation/objective": "", "Optimisation/at most": "", "Optimisation/lower bounds": "",
           "Optimisation/upper bounds": "", "Optimisation/scales": "", "Scan/parameter": "billet/radius"}
    noise = 0.0
    for name, file_of, settings in (("ball_4.5", UPSETTING, {**small, "Billet/element size": 4.5}),
                                    ("ball_3", UPSETTING, {**small, "Billet/element size": 3}), ("hub", HOT_HUB, hub)):
        case_tools.run(BUILD, "scan", file_of, settings, name)
        with open(os.path.join(name, "scan.json"), encoding="utf-8") as text:
            found = json.load(text)["scans"][0]["objectives"][0]
        noise = max(noise, found["noise_rms"])
        print(f"{name}: {found['mean_value']:.1f} C, slope {found['mean_fit_slope']:.3f} K/mm, gradients beside it {100 * found['bias']:.2f} %, single ones "
              f"{100 * found['roughness_max']:.1f} %; off the cubic {found['noise_rms']:.1e}", flush=True)
    case_tools.figure("arrivals_off_cubic", noise)
    case_tools.figure("arrivals_hub_slope", abs(found["bias"]))


HOT_UPSETTING = os.path.join(PRM, "tutorial", "hot_upsetting", "hot_upsetting.prm")
VARIED = {"billet/temperature": 0.03, "heat/transfer time": 0.5, "material/n": 0.3, "material/beta": 0.4, "dies/friction": 0.3}
HARDENING = {"Material/law": "power", "Material/consistency": 32, "Material/strain rate sensitivity": 0.15,
             "Material/further numbers": "n: 0.15, q0: 0.05, beta: 0.0025, T0: 1100", "Objectives/names": "energy, largest temperature",
             "Optimisation/objective": "", "Optimisation/at most": "", "Optimisation/lower bounds": "", "Optimisation/upper bounds": "",
             "Optimisation/scales": ""}


def trends():
    """Whole forgings of metal that hardens, meshes made anew."""
    for scene, case in (("upsetting", HOT_UPSETTING), ("hub", HOT_HUB)):
        found = case_tools.Trends(BUILD, case, HARDENING, VARIED, (3.85, 3.9, 3.95, 4, 4.05, 4.1, 4.15, 4.2), f"trend_{scene}")
        print("| " + scene + " | energy | largest temperature |\n" + "| --- " * 3 + "|")
        for name, part in VARIED.items():
            told = [found.beside(name, objective) for objective in ("energy", "largest temperature")]
            print(f"| {name} ± {part:.0%} | " + " | ".join(f"{mean:+.1%} ± {error:.1%}" for mean, error, _ in told) + " |", flush=True)
            case_tools.figure(f"trend_{scene}_{name.split('/')[1].replace(' ', '_')}", abs(told[0][0]))


def cost():
    """Seconds of a hub of 40 increments with Tresca's friction, of the metal at its first temperature, warmed by work, and with conduction;
    and of the backward sweep over the forward run."""
    modes = {"none": {"Heat/heating": "none", "Heat/transfer time": 0, "Heat/dwell time": 0},
             "adiabatic": {"Heat/heating": "adiabatic", "Heat/transfer time": 0, "Heat/dwell time": 0}, "conduction": {}}
    settings = {"Press/stroke": 16, "Press/increments": 40, "Objectives/names": "energy", "Optimisation/objective": "", "Optimisation/at most": "",
                "Design/parameters": "billet/radius", "Output/fields every": 0}
    seconds = {name: [] for name in modes}
    for repeat in range(3):
        for name, heat in modes.items():
            summary, _ = case_tools.run(BUILD, "gradient", HOT_HUB, {**settings, **heat}, "run_cost")
            wall = summary["wall_seconds"]
            seconds[name].append((wall["total"] - wall["adjoint"], wall["adjoint"]))
    forward = {name: statistics.median(pair[0] for pair in pairs) for name, pairs in seconds.items()}
    backward = {name: statistics.median(pair[1] / pair[0] for pair in pairs) for name, pairs in seconds.items()}
    for name in modes:
        print(f"{name}: forward {forward[name]:.2f} s, over none {forward[name] / forward['none']:.3f}; backward over forward {backward[name]:.3f}")
        case_tools.figure(f"backward_{name}", backward[name])
    case_tools.figure("cost_adiabatic", forward["adiabatic"] / forward["none"])
    case_tools.figure("cost_conduction", forward["conduction"] / forward["none"])


if __name__ == "__main__":
    {"balance": balance, "bounds": bounds, "order": order, "derivatives": derivatives, "ball": ball, "arrivals": arrivals, "trends": trends, "cost": cost}[sys.argv[2]]()
