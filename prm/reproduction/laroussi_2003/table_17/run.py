#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Time of d(energy)/dV by one local sweep, and by global perturbation: run.py BUILD"""
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", ".."))
import case_tools  # noqa: E402

THESIS = ((72, "2 s"), (287, "12 s"), (1510, "8 min 27 s"), (4886, "1 h 18 min 46 s"))


def main():
    program = os.path.join(sys.argv[1], "tests", "verification", "energy_derivative", "energy_derivative")
    done = subprocess.run([program, "time", "22", "9.3", "4.55", "2.95"], capture_output=True, text=True, check=True)
    rows = [line.split()[1:] for line in done.stdout.splitlines() if line.startswith("time")]
    print("| nodes (thesis) | tetrahedra | local sweep [ms] | us per tetrahedron | global perturbation [s] | thesis, global |")
    print("| --- " * 6 + "|")
    for (thesis_nodes, thesis_time), row in zip(THESIS, rows):
        seconds = float(row[2])
        slow = row[3] if len(row) > 3 else "-"
        print(f"| {row[0]} ({thesis_nodes}) | {row[1]} | {1e3 * seconds:.3f} | {1e6 * seconds / int(row[1]):.2f} | {slow} "
              f"| {thesis_time} |")
    first, last = rows[0], rows[-1]
    exponent = math.log(float(last[2]) / float(first[2])) / math.log(int(last[1]) / int(first[1]))
    case_tools.figure("seconds_at_4886", float(last[2]))
    case_tools.figure("exponent", exponent)


if __name__ == "__main__":
    main()
