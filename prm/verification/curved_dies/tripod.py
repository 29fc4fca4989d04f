#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The tripod along its billet's radius, 17 values over +-1 %, elements of 4 mm:   tripod.py BUILD short|long

short: 20 mm in 40 increments, never remeshed. long: 40 mm in 80 increments, remeshed as the case asks. Do the local slopes have the
slope of a curve through the energies?"""
import os
import sys

import numpy as np

import runs

CASE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "reproduction", "laroussi_2003", "tripod", "case.prm")
PARTS = {"short": {"Press/stroke": 20, "Press/increments": 40, "Remeshing/when": "never", "Remeshing/first mesh": "false"},
         "long": {"Press/stroke": 40, "Press/increments": 80}}


def main():
    def more(parser):
        parser.add_argument("--points", type=int, default=17, help="number of radii")
        parser.add_argument("--size", type=float, default=4.0, help="element size [mm]")
        parser.add_argument("--case", default=CASE, help="parameter file of the tripod")
    options = runs.arguments(__doc__, *PARTS, extra=more)
    settings = {"Billet/element size": options.size, "Output/fields every": 0, **PARTS[options.part], **options.settings}
    radii = 20.0 * np.linspace(0.99, 1.01, options.points)
    energies, slopes = runs.scan(options.build, options.case, "billet/radius", radii, options.part, settings, options.timeout)
    runs.report_trend(f"tripod_{options.part}", radii, energies, slopes)


if __name__ == "__main__":
    sys.exit(main())
