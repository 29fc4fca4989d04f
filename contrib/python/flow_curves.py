#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Draws the flow stress of a material file over the strain, at three temperatures and two strain rates.

    flow_curves.py prm/materials/C45.prm [--temperatures 900 1000 1100 1200] [--rates 1 10] [--output C45.png]

Of the laws of the program it knows Norton-Hoff, power and Hansel-Spittel; stresses in MPa, temperatures in C.
"""
import argparse
import math
import re


def read_material(file_name):
    """The settings of the section Material, as texts."""
    settings, inside = {}, False
    for line in open(file_name, encoding="utf-8"):
        line = line.split("#")[0].strip()
        if line == "subsection Material":
            inside = True
        elif line == "end":
            inside = False
        elif inside and (found := re.match(r"set\s+(.+?)\s*=\s*(.*)", line)):
            settings[found.group(1)] = found.group(2)
    return settings


def numbers_of(settings):
    """{name: value} of `further numbers`."""
    pairs = (pair.split(":") for pair in settings.get("further numbers", "").split(",") if pair.strip())
    return {name.strip(): float(value) for name, value in pairs}


def flow_stress(settings, strain, rate, temperature):
    """Flow stress [MPa] of a material file's settings; doc/manual/materials.md has the formulas."""
    law, x = settings.get("law", "Norton-Hoff"), numbers_of(settings)
    if law == "Hansel-Spittel":
        m = [x.get(f"m{i}", 0.) for i in range(10)]
        q, T = math.hypot(strain, x.get("q0", 0.02)), temperature
        return (x["A"] * math.exp(m[1] * T) * T ** m[9] * q ** m[2] * math.exp(m[4] / q)
                * (1 + q) ** (m[5] * T + m[6]) * math.exp(m[7] * q) * rate ** (m[3] + m[8] * T))
    K, m = float(settings["consistency"]), float(settings["strain rate sensitivity"])
    if law == "power":
        warming = temperature - x.get("T0", 20.)
        K *= (strain + x.get("q0", 1e-3)) ** x.get("n", 0.) * math.exp(-x.get("beta", 0.) * warming)
        m += x.get("m1", 0.) * warming
    elif law != "Norton-Hoff":
        raise SystemExit(f"flow_curves.py does not know the law `{law}'")
    return math.sqrt(3.) ** (m + 1.) * K * rate ** m


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--temperatures", type=float, nargs="+", default=[900., 1000., 1100., 1200.])
    parser.add_argument("--rates", type=float, nargs="+", default=[1., 10.])
    parser.add_argument("--strain", type=float, default=1., help="the largest")
    parser.add_argument("--output", default="flow_curves.png")
    arguments = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    settings = read_material(arguments.file)
    strains = [arguments.strain * i / 100. for i in range(101)]
    for i, T in enumerate(arguments.temperatures):
        for rate, style in zip(arguments.rates, ("-", "--", ":", "-.")):
            pyplot.plot(strains, [flow_stress(settings, q, rate, T) for q in strains], style, color=f"C{i}",
                        label=f"{T:g} C, {rate:g} /s")
    pyplot.xlabel("accumulated strain q")
    pyplot.ylabel("flow stress [MPa]")
    pyplot.title(arguments.file.split("/")[-1].rsplit(".", 1)[0])
    pyplot.ylim(bottom=0.)
    pyplot.legend(fontsize="small")
    pyplot.grid(True)
    pyplot.savefig(arguments.output, dpi=80)
    print(arguments.output)


if __name__ == "__main__":
    main()
