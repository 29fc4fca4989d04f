# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What `cmake --install` leaves is enough for another project: contrib/examples is configured, compiled and linked with it alone, and finds the
values and derivatives of the installed program, to the last bits; so do the lines of the manual's page; the presets are understood. Usage: install.py RETROFORGE BUILD CMAKE"""
import json
import os
import re
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import whole_runs  # noqa: E402
from whole_runs import ROOT, judge, main, start, summary_of, text_of  # noqa: E402

BUILD, CMAKE = sys.argv[2:4]
CASE = str(ROOT / "prm/tutorial/upsetting/upsetting.prm")
QUICK = ("Billet/element size=9", "Press/stroke=4", "Press/increments=3", "Output/fields every=0", "Objectives/names=energy, mean strain")


def settings():
    return [word for setting in QUICK for word in ("--set", setting)]


def installed():
    done = start([CMAKE, "--install", BUILD, "--prefix", os.path.abspath("prefix")])
    judge("installs", done.returncode == 0, done.stderr)
    files = [os.path.join(place, name) for place, _, names in os.walk("prefix") for name in names if name.endswith(".cmake")]
    judge("a package", {os.path.basename(file) for file in files} >= {"RetroforgeConfig.cmake", "RetroforgeConfigVersion.cmake"}, files)
    told = [file for file in files if str(ROOT / "include") in text_of(file) or BUILD in text_of(file)]
    judge("which names neither source nor build", not told, told)


def built():
    build_type = re.search(r"^CMAKE_BUILD_TYPE:\w+=(.*)$", text_of(BUILD, "CMakeCache.txt"), re.M)[1]
    for words in (["-S", str(ROOT / "contrib/examples"), "-B", "example", "-G", "Ninja", f"-DCMAKE_BUILD_TYPE={build_type}",
                   "-DCMAKE_PREFIX_PATH=" + os.path.abspath("prefix")], ["--build", "example"]):
        done = start([CMAKE, *words])
        judge(f"cmake {words[0]}", done.returncode == 0, done.stdout[-3000:] + done.stderr)


PAGE_PROGRAM = """#include <retroforge/run/forward_run.h>
#include <iostream>
using namespace retroforge;
int main(int argc, char *argv[])
{
  int    n_words = 1;
  char  *word[]  = {argv[0], nullptr};
  char **words   = word;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(n_words, words, 1);
  %s
  std::cout.precision(17);
  std::cout << made.combinations[0].name << ' ' << made.combine(values)[0] << '\\n';
  for (std::size_t i = 0; i < gradient.size(); ++i)
    std::cout << "  by " << made.design.parameters()[i].name << ' ' << gradient[i] << '\\n';
}
"""


def lines_of_the_page():
    """The C++ of the page as one program, built by the CMake lines of the page."""
    page = text_of(ROOT, "doc/manual/library.md")
    lines, = re.findall(r"```cmake\n(.*?)```", page, re.S)
    os.makedirs("page", exist_ok=True)
    with open("page/nodal_gradient.cc", "w", encoding="utf-8") as file:
        file.write(PAGE_PROGRAM % "".join(re.findall(r"```cpp\n(.*?)```", page, re.S)))
    with open("page/CMakeLists.txt", "w", encoding="utf-8") as file:
        file.write("cmake_minimum_required(VERSION 3.20)\nproject(page LANGUAGES CXX)\n" + lines)
    build_type = re.search(r"^CMAKE_BUILD_TYPE:\w+=(.*)$", text_of(BUILD, "CMakeCache.txt"), re.M)[1]
    for words in (["-S", "page", "-B", "page/build", "-G", "Ninja", f"-DCMAKE_BUILD_TYPE={build_type}",
                   "-DCMAKE_PREFIX_PATH=" + os.path.abspath("prefix")], ["--build", "page/build"]):
        done = start([CMAKE, *words])
        judge(f"the page's lines: cmake {words[0]}", done.returncode == 0, done.stdout[-3000:] + done.stderr)
    done = start([os.path.abspath("page/build/nodal_gradient"), "gradient", CASE, *settings()])
    judge("the page's lines run", done.returncode == 0, done.stderr)
    (name, mine), = numbers_of(done.stdout).items()
    summary = summary_of("results")
    judge("and find the same", mine["value"] == {o["name"]: o["value"] for o in summary["objectives"]}[name] and
          {p["name"]: p["gradient"][name] for p in summary["parameters"]}.items() <= mine.items(), mine)


def numbers_of(text):
    """{objective: ({"value", "wider by 1 %" or a parameter: number})} of what the example prints."""
    found, entries = {}, None
    for line in text.splitlines():
        name, _, number = line.strip().rpartition(" ")
        if line.startswith("  "):
            entries[name.removeprefix("by ")] = float(number)
        else:
            entries = found[name] = {"value": float(number)}
    return found


def same_as_the_program():
    whole_runs.PROGRAM = os.path.abspath("prefix/bin/retroforge")
    done = whole_runs.run("gradient", "results", *QUICK, case=CASE)
    judge("the installed program runs", done.returncode == 0, done.stderr)
    done = start([os.path.abspath("example/nodal_gradient"), "gradient", CASE, *settings()])
    judge("the example runs", done.returncode == 0, done.stderr)
    found, summary = numbers_of(done.stdout), summary_of("results")
    nodes = np.loadtxt("results/sensitivity_nodes.csv", delimiter=",", skiprows=1)
    for j, objective in enumerate(summary["objectives"]):
        name, mine = objective["name"], found[objective["name"]]
        judge(f"{name}: value", mine["value"] == objective["value"], (mine, objective))
        judge(f"{name}: by parameters", {p["name"]: p["gradient"][name] for p in summary["parameters"]}.items() <= mine.items(), mine)
        wider = (nodes[:, 4 + 3 * j:6 + 3 * j] * 0.01 * nodes[:, 1:3]).sum()
        radius = 0.2 * mine["billet/radius"]  # the same change: one per cent of 20 mm
        judge(f"{name}: by nodes", all(abs(x / mine["wider by 1 %"] - 1) < 1e-10 for x in (wider, radius)), (wider, radius, mine))
    done = start([os.path.abspath("example/nodal_gradient"), "gradient", CASE, "--set", "Press/strok=1"])
    judge("mistakes are told", done.returncode == 1 and "unknown parameter 'Press/strok'" in done.stderr, done.stderr)


def presets():
    names = [preset["name"] for preset in json.loads(text_of(ROOT, "CMakePresets.json"))["configurePresets"]]
    done = start([CMAKE, "--list-presets", "-S", str(ROOT)])
    judge("presets", done.returncode == 0 and names == ["release", "debug", "asan"] and all(f'"{name}"' in done.stdout for name in names), done.stderr)


main({}, (installed, built, same_as_the_program, lines_of_the_page, presets))
