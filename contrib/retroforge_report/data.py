# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What a run left in its directory."""
import csv
import json
import pathlib
import xml.etree.ElementTree as xml

import numpy as np

from retroforge_report import vtu

SCHEMA = 1


class Run:
    """Files that are absent read as None: not every command writes all of them."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        path = self.directory / "summary.json"
        if not path.is_file():
            raise ValueError(f"{path}: not found; a run directory holds summary.json; "
                             "give the --output directory of a finished run")
        self.summary = json.loads(path.read_text(encoding="utf-8"))
        if self.summary.get("schema") != SCHEMA:
            raise ValueError(f"{path}: schema is {self.summary.get('schema')}; this report reads {SCHEMA}; "
                             "run the case again")
        self.history = self._read_history()
        self.initial, self.final = self._read_shapes()
        path = self.directory / "sensitivity.vtu"
        self.sensitivity = vtu.read(path) if path.is_file() else None

    @property
    def objectives(self):
        return self.summary.get("objectives", [])

    @property
    def parameters(self):
        return self.summary.get("parameters", [])

    @property
    def checks(self):
        return self.summary.get("check", [])

    def unit(self, objective):
        return next((o.get("unit", "") for o in self.objectives if o["name"] == objective), "")

    def _read_history(self):
        """Columns by name; None when there is no increment."""
        path = self.directory / "history.csv"
        if not path.is_file():
            return None
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file, skipinitialspace=True))
        return {name.strip(): np.array([float(row[name]) for row in rows]) for name in rows[0]} if rows else None

    def _read_shapes(self):
        path = self.directory / "fields.pvd"
        if not path.is_file():
            return None, None
        entries = [(float(entry.get("timestep", 0)), entry.get("file")) for entry in xml.parse(path).iter("DataSet")]
        if not entries:
            return None, None
        entries.sort(key=lambda entry: entry[0])
        return tuple(vtu.read(self.directory / entries[i][1]) for i in (0, -1))
