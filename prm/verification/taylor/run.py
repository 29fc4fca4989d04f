# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Order of the Taylor remainder of the energy along a random direction of all node positions."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", ".."))
from case_tools import figure, run  # noqa: E402

for scheme in ("midpoint", "euler"):
    summary, printed = run(sys.argv[1], "check", os.path.join(HERE, "case.prm"), {"Press/scheme": scheme}, may_fail=True)
    if summary is None:
        sys.exit(printed)
    row = next(row for row in summary["check"] if row["parameter"].startswith("X_0"))
    print(scheme, "orders", *(f"{order:.3f}" for order in row["taylor_orders"]))
    figure(f"order_{scheme}", min(row["taylor_orders"]))
