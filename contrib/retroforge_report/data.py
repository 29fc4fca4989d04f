# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What a run left in its directory."""
import csv
import dataclasses
import json
import pathlib
import xml.etree.ElementTree as xml

import numpy as np

from retroforge_report import vtu

SCHEMA = 1


def identifier(name):
    """An objective's name in names of fields: each byte that is no ASCII letter or digit becomes an underscore."""
    return "".join(chr(byte) if chr(byte).isalnum() and byte < 128 else "_" for byte in name.encode())


@dataclasses.dataclass
class Column:
    """An objective over the stroke, NaN where it was not known yet; or a part of the objective `of`."""
    name: str
    unit: str
    of: str
    values: np.ndarray


@dataclasses.dataclass
class Step:
    """What fields.pvd shows at one time."""
    workpiece: vtu.Mesh
    dies: list  # of vtu.Mesh


class Run:
    """Files that are absent read as None, or as empty: not every command writes all of them."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        self.finished = (self.directory / "summary.json").is_file()
        self.summary = self._read_summary() if self.finished else {}
        path = self.directory / "failure.txt"
        self.failure = path.read_text(encoding="utf-8", errors="replace").strip() if path.is_file() else None
        self.history = self._read_history()
        self.objective_strokes, self.objective_columns = self._read_objectives()
        self.initial, self.final = self._read_shapes()  # None where no fields were written
        path = self.directory / "sensitivity.vtu"
        self.sensitivity = vtu.read(path) if path.is_file() else None
        self.die_sensitivities = {path.stem[len("sensitivity_die_"):]: vtu.read(path)
                                  for path in sorted(self.directory.glob("sensitivity_die_*.vtu"))}

    def _read_summary(self):
        path = self.directory / "summary.json"
        summary = json.loads(path.read_text(encoding="utf-8"))
        if summary.get("schema") != SCHEMA:
            raise ValueError(f"{path}: schema is {summary.get('schema')}; this report reads {SCHEMA}; run the case again")
        return summary

    @property
    def copies(self):
        """How often the model stands in the whole part, or None when that is unknown."""
        return self.summary.get("whole", {"copies": 1}).get("copies")

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

    def sensitivities(self, mesh, variable):
        """(objective, field) for each field dIDENTIFIER_dVARIABLE of a mesh, in the order of the objectives.

        A field of no objective of the summary comes last, under its identifier.
        """
        fields = [field for field in mesh.point_data if field.startswith("d") and field.endswith(f"_d{variable}")]
        known = {identifier(o["name"]): (rank, o) for rank, o in reversed(list(enumerate(self.objectives)))}
        found = []
        for field in fields:
            name = field[1:-len(f"_d{variable}")]
            found.append((*known.get(name, (len(known), {"name": name})), field))
        return [(objective, field) for _, objective, field in sorted(found, key=lambda entry: entry[0])]

    def _read_history(self):
        """Columns by name; None when there is no increment."""
        rows = self._read_csv("history.csv")
        if len(rows) < 2:
            return None
        return {name.strip(): np.array([float(row[j]) for row in rows[1:]]) for j, name in enumerate(rows[0])}

    def _read_objectives(self):
        """Strokes, and a column for each objective and part: NAME [UNIT], or NAME: PART [UNIT]."""
        rows = self._read_csv("objectives.csv")
        if len(rows) < 2:
            return np.zeros(0), []
        values = np.array([[float(cell) if cell.strip() else np.nan for cell in row] for row in rows[1:]])
        known, columns = {o["name"] for o in self.objectives}, []
        for j, title in enumerate(rows[0][1:], 1):
            name, _, unit = title.strip().rpartition(" [")
            of = "" if name in known else next(
                (c.name for c in columns if not c.of and name.startswith(c.name + ": ")), "")
            columns.append(Column(name[len(of) + 2:] if of else name, unit.rstrip("]"), of, values[:, j]))
        return values[:, 0], columns

    def _read_csv(self, name):
        """Rows of complete lines: a run that was stopped may have left half of one."""
        path = self.directory / name
        if not path.is_file():
            return []
        with path.open(newline="", encoding="utf-8") as file:
            rows = [row for row in csv.reader(file, skipinitialspace=True) if row]
        return [row for row in rows if len(row) == len(rows[0])]

    def _read_shapes(self):
        path = self.directory / "fields.pvd"
        if not path.is_file():
            return None, None
        steps = {}
        for entry in xml.parse(path).iter("DataSet"):
            steps.setdefault(float(entry.get("timestep", 0)), []).append(self.directory / entry.get("file"))
        if not steps:
            return None, None
        return tuple(self._read_step(steps[time]) for time in (min(steps), max(steps)))

    @staticmethod
    def _read_step(files):
        """The first is the workpiece, the others are dies."""
        workpiece, *dies = files
        return Step(vtu.read(workpiece), [vtu.read(file) for file in dies])
