# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The dies of the tutorial's scenes are what the scripts beside them make. Usage: made_files.py prm/tutorial"""
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

import numpy as np

TUTORIAL = pathlib.Path(sys.argv[1]).resolve()


def numbers(path):
    """Normals and corners of an STL file, binary or ASCII."""
    content = path.read_bytes()
    if content.startswith(b"solid"):
        return np.array(re.findall(rb"[-+]?\d[-+.e\d]*", content), float)
    (n,) = struct.unpack_from("<I", content, 80)
    return np.frombuffer(content, np.dtype([("x", "<12f4"), ("attribute", "<u2")]), n, 84)["x"].ravel()


def main():
    wrong = []
    for script, die in (("hub/make_die.py", "hub/hub_die.stl"), ("bar_bending/make_roller.py", "bar_bending/roller.stl")):
        with tempfile.TemporaryDirectory() as folder:
            made = pathlib.Path(folder) / "made.stl"
            subprocess.run([sys.executable, "-B", TUTORIAL / script, made], check=True)
            kept, new = numbers(TUTORIAL / die), numbers(made)
        good = len(kept) == len(new) > 100 and np.allclose(kept, new, rtol=0, atol=1e-5)
        print(f"{'passed' if good else 'FAILED'} {die}: {len(new)} numbers")
        wrong += [] if good else [die]
    return len(wrong)


sys.exit(main())
