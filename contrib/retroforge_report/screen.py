# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A virtual screen: VTK draws only with an X server, and takes the process down without."""
import importlib.util
import os
import shutil
import subprocess
import sys

INSIDE = "RETROFORGE_REPORT_UNDER_XVFB"  # set for the child that has a virtual screen
REMEDY = "shapes are drawn by matplotlib, more coarsely"


def has_screen():
    return INSIDE in os.environ


def again_with_screen():
    """Runs the whole command again in a child that has a virtual screen.

    Returns None when that worked, else a sentence for the page.
    """
    if importlib.util.find_spec("vtk") is None:
        return f"VTK for Python was not found (Debian: python3-vtk9): {REMEDY}."
    if shutil.which("xvfb-run") is None:
        return f"xvfb-run was not found (Debian: xvfb and xauth): {REMEDY}."
    status = subprocess.run(["xvfb-run", "-a", sys.executable, *sys.argv], env={**os.environ, INSIDE: "1"},
                            check=False).returncode
    return None if status == 0 else f"VTK could not draw (exit status {status}): {REMEDY}."
