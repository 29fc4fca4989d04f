# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Volume lost over a 50 % upsetting with friction, by the two time schemes."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
from case_tools import figure, run  # noqa: E402


def lost(scheme, increments):
    settings = {"Press/scheme": scheme, "Press/increments": increments, "Output/record": "false"}
    summary, _ = run(sys.argv[1], "simulate", os.path.join(HERE, "case.prm"), settings)
    figure(f"cuts_{scheme}_{increments}", summary["cuts"])
    return abs(1. - summary["volume_final"] / summary["volume_initial"])


for name in ("midpoint", "euler"):
    coarse, fine = lost(name, 25), lost(name, 50)
    figure(f"volume_lost_{name}", fine)
    figure(f"order_{name}", math.log2(coarse / fine))
