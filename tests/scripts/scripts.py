# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Calling the scripts of contrib/ from tests."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CONTRIB = pathlib.Path(__file__).resolve().parents[2] / "contrib"


def call(script, *arguments, environment=None):
    return subprocess.run([sys.executable, CONTRIB / script, *arguments], capture_output=True, text=True, check=False, env=environment)


class ScratchTest(unittest.TestCase):
    """A test with an empty folder of its own."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)

    def write(self, path, text):
        path = self.root / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path
