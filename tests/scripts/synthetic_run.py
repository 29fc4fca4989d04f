# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""A run directory made up by formulas: a cube barrelled to half its height under a domed die, with every file that a
run of several objectives can leave."""
import base64
import itertools
import json
import pathlib
import struct
import sys
import zlib

import numpy as np

SIDE = 50.0
BLOCK = 1000  # bytes compressed at a time: small, so that arrays have several
KUHN = [np.cumsum(np.vstack([np.zeros(3), np.eye(3)[list(order)]]), axis=0).astype(int)
        for order in itertools.permutations(range(3))]
OBJECTIVES = (("energy", None, "mJ"), ("late force", 2.5e5, "N"), ("fold (a=4)", 310.0, "mm^2 s^-3"),
              ("mean strain", 0.7, "none"), ("filling", 1200.0, "mm^3"), ("volume", SIDE**3, "mm^3"))  # name, value, unit
IDENTIFIERS = {"energy": "energy", "late force": "late_force", "fold (a=4)": "fold__a_4_", "mean strain": "mean_strain",
               "filling": "filling", "volume": "volume"}


def cube(n):
    """Positively oriented tetrahedra of n^3 boxes, six in each."""
    grid = np.arange((n + 1)**3).reshape(n + 1, n + 1, n + 1)
    points = np.stack(np.meshgrid(*[np.linspace(0, SIDE, n + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    cells = np.array([[grid[tuple(corner + box)] for corner in tet]
                      for box in itertools.product(range(n), repeat=3) for tet in KUHN])
    a, b, c, d = (points[cells[:, i]] for i in range(4))
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    cells[turned] = cells[turned][:, [0, 2, 1, 3]]
    return points, cells


def dome(n, depth=10.0):
    """Triangles of n x n squares, bent into a paraboloid twice as wide as the cube; their normals point down."""
    grid = np.arange((n + 1)**2).reshape(n + 1, n + 1)
    flat = np.stack(np.meshgrid(*[np.linspace(-SIDE, SIDE, n + 1)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    points = np.column_stack([flat + SIDE / 2, SIDE - depth * (flat**2).sum(axis=1) / SIDE**2])
    triangles = [[grid[i, j], *corner] for i, j in itertools.product(range(n), repeat=2) for corner in
                 ((grid[i + 1, j + 1], grid[i + 1, j]), (grid[i, j + 1], grid[i + 1, j + 1]))]
    return points, np.array(triangles)


def area_vectors(points, triangles):
    """A third of the area vectors of the triangles around each point."""
    result = np.zeros_like(points)
    a, b, c = (points[triangles[:, i]] for i in range(3))
    for corner in range(3):
        np.add.at(result, triangles[:, corner], np.cross(b - a, c - a) / 6)
    return result


def barrelled(points, reduction):
    z = points[:, 2] / SIDE
    bulge = np.sqrt(1 / (1 - reduction)) * (0.93 + 0.42 * reduction * z * (1 - z))
    middle = np.array([SIDE / 2, SIDE / 2])
    return np.column_stack([middle + (points[:, :2] - middle) * bulge[:, None], points[:, 2] * (1 - reduction)])


def array(name, values, encoding):
    values = np.ascontiguousarray(values)
    kind = {"f8": "Float64", "i8": "Int64", "u1": "UInt8"}[values.dtype.str[1:]]
    components = values.shape[1] if values.ndim == 2 else 1
    raw = values.tobytes()
    if encoding == "ascii":
        text = " ".join(repr(value) for value in values.reshape(-1).tolist())
    elif encoding == "zlib":
        blocks = [zlib.compress(raw[begin:begin + BLOCK]) for begin in range(0, len(raw), BLOCK)]
        header = struct.pack(f"<{3 + len(blocks)}I", len(blocks), BLOCK, len(raw) % BLOCK, *map(len, blocks))
        text = base64.b64encode(header).decode() + base64.b64encode(b"".join(blocks)).decode()
    else:
        text = base64.b64encode(struct.pack("<I", len(raw)) + raw).decode()
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
            f'format="{"ascii" if encoding == "ascii" else "binary"}">{text}</DataArray>\n')


def write_vtu(path, points, cells, point_data, cell_data, encoding):
    def block(tag, arrays):
        return f"<{tag}>" + "".join(array(name, values, encoding) for name, values in arrays.items()) + f"</{tag}>\n"

    n, corners = cells.shape
    compressor = ' compressor="vtkZLibDataCompressor"' if encoding == "zlib" else ""
    path.write_text(
        f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"{compressor}>'
        f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{n}">\n' + block("Points", {"points": points})
        + block("Cells", {"connectivity": cells.astype("i8").reshape(-1), "offsets": corners * np.arange(1, n + 1),
                          "types": np.full(n, {3: 5, 4: 10, 10: 24}[corners], "u1")})
        + block("PointData", point_data) + block("CellData", cell_data) + "</Piece></UnstructuredGrid></VTKFile>\n", encoding="utf-8")


def write_fields(directory, n):
    points, cells = cube(n)
    for index, (reduction, encoding) in enumerate(((0.0, "ascii"), (0.25, "binary"), (0.5, "zlib"))):
        X = barrelled(points, reduction)
        on_die = (points[:, 2] == 0) | (points[:, 2] == SIDE)
        off_axis = np.linalg.norm(points[:, :2] - SIDE / 2, axis=1) / SIDE
        pressure = np.where(on_die, 90 * (1.2 - off_axis), 0.0)
        velocity = np.column_stack([X[:, 0] - SIDE / 2, X[:, 1] - SIDE / 2, -X[:, 2]])
        centre = points[cells].mean(axis=1)
        rate = 1 + 3 * np.exp(-((centre - SIDE / 2)**2).sum(axis=1) / 300)
        write_vtu(directory / f"fields_{index:06}.vtu", X, cells,
                  {"velocity [mm/s]": velocity, "pressure [MPa]": pressure / 2, "contact_pressure [MPa]": pressure,
                   "touching_die": on_die.astype("f8")}, {"strain_rate [1/s]": rate}, encoding)
    entries = "".join(f'<DataSet timestep="{t}" file="fields_{i:06}.vtu"/>' for i, t in enumerate((0.0, 0.1, 0.2)))
    (directory / "fields.pvd").write_text(f'<VTKFile type="Collection"><Collection>{entries}</Collection></VTKFile>')


def write_sensitivities(directory, n, objectives):
    points, cells = cube(n)
    gradient = (points - SIDE / 2) * (1 - 2 * np.abs(points[:, 2:] / SIDE - 0.5)) * 40.0 / n**2
    gradient[:, 2] = (points[:, 2] / SIDE - 0.5) * 900.0 / n**2
    write_vtu(directory / "sensitivity.vtu", points, cells,
              {f"d{IDENTIFIERS[name]}_dX0": (k + 1) * gradient for k, name in enumerate(objectives)}, {}, "zlib")
    points, triangles = dome(2 * n)
    off_axis = np.linalg.norm(points[:, :2] - SIDE / 2, axis=1) / SIDE
    gradient = np.maximum(0.7 - off_axis, 0)[:, None] * area_vectors(points, triangles)
    write_vtu(directory / "sensitivity_die_upper.vtu", points, triangles,
              {f"d{IDENTIFIERS[name]}_dXdie": k * gradient for k, name in enumerate(objectives)}, {}, "zlib")


def write_objectives(directory, increments, objectives):
    """The energy with its parts; the others from the second half on; the last one never."""
    stroke = SIDE / 2 * np.arange(1, increments + 1) / increments
    units = {name: unit for name, _, unit in OBJECTIVES}
    titles = ["energy [mJ]", "energy: friction [mJ]", *(f"{name} [{units[name]}]" for name in objectives[1:])]
    lines = [",".join(["stroke [mm]", *titles])]
    for i, s in enumerate(stroke):
        late = [str(10 * k + s) if 2 * i >= increments and k + 2 < len(objectives) else ""
                for k in range(len(objectives) - 1)]
        lines.append(",".join([str(s), str(s**2), str(0.1 * s**2), *late]))
    (directory / "objectives.csv").write_text("\n".join(lines) + "\n")


def write_history(directory, increments):
    stroke = SIDE / 2 * np.arange(1, increments + 1) / increments
    force = 8e4 / (1 - stroke / SIDE) * (1 - np.exp(-stroke))
    energy = np.cumsum(force) * stroke[0]
    lines = ["increment,time,stroke,force,energy,volume,min_quality,newton,krylov"]
    for i, (s, f, e) in enumerate(zip(stroke, force, energy)):
        lines.append(f"{i},{s / 100},{s},{f},{e},{SIDE**3 * (1 - 3e-5 * s / SIDE)},{0.6 - 0.4 * s / SIDE},"
                     f"{8 if i == 0 else 3},{90 if i == 0 else 34}")
    (directory / "history.csv").write_text("\n".join(lines) + "\n")
    return energy[-1]


def check_entry(objective, parameter, adjoint, kink):
    steps = []
    for h in 10.0**-np.arange(2, 10):
        noise = 1e-15 / h * (1 + np.cos(1e3 * np.log(h)))
        steps.append({"step": h, "replayed_central": adjoint * (1 + h**2 + noise), "replayed_forward":
                      adjoint * (1 + 0.6 * h + noise), "replayed_backward": adjoint * (1 - 0.6 * h + noise),
                      "free_central": adjoint * (1 + h**2 + kink + noise)})
    return {"objective": objective, "parameter": parameter, "adjoint": adjoint, "tangent": adjoint * (1 + 1e-13),
            "steps": steps, "taylor_orders": [1.98, 1.99, 2.0], "verdict": "passed"}


def write(directory, n=8, increments=20, n_objectives=len(OBJECTIVES)):
    directory = pathlib.Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    write_fields(directory, n)
    objectives = [name for name, _, _ in OBJECTIVES[:n_objectives]]
    write_sensitivities(directory, n, objectives)
    write_objectives(directory, increments, objectives)
    energy = write_history(directory, increments)
    values = {name: energy if value is None else value for name, value, _ in OBJECTIVES[:n_objectives]}
    parameters = [("material/K", 1.7, "MPa s^m", 1.0), ("material/m", 0.14, "1", 0.31), ("friction/alpha", 0.4, "1", 0.12),
                  ("press/velocity", 100.0, "mm/s", 0.139), ("billet/stretch", 1.0, "1", -0.4),
                  ("dies/offset", 0.0, "mm", None)]
    points, cells = cube(n)
    summary = {
        "schema": 1, "command": "check", "version": "0.1.0", "commit": "0000000", "ranks": 1, "blas": "OpenBLAS",
        "mesh": {"nodes": len(points), "cells": len(cells)},
        "objectives": [{"name": "energy", "value": energy, "unit": "mJ",
                        "parts": {"deformation": 0.88 * energy, "friction": 0.12 * energy}},
                       *({"name": name, "value": value, "unit": unit} for name, value, unit in OBJECTIVES[1:n_objectives])],
        "parameters": [{"name": name, "value": value, "unit": unit, "gradient":
                        {o: relative * values[o] / value / (1 + k) if relative else 321.0
                         for k, o in enumerate(objectives)}}
                       for name, value, unit, relative in parameters],
        "increments": increments, "cuts": 1, "newton_iterations": 65, "krylov_iterations": 736,
        "linear_solves_forward": 65, "linear_solves_adjoint": 40, "volume_initial": SIDE**3,
        "volume_final": SIDE**3 * (1 - 1.5e-5), "record_bytes": 1234567,
        "wall_seconds": {"assembly": 1.2, "preconditioner": 2.3, "krylov": 3.1, "contact": 0.2, "record": 0.05,
                         "adjoint": 2.2, "total": 9.4},
        "check": [check_entry(o, name, relative * values[o], kink) for o in objectives for name, relative, kink in
                  (("material/K", 0.6, 0.0), ("friction/alpha", 0.3, 2e-6), ("press/velocity", 0.00139, 1e-4),
                   ("billet/stretch", -0.4, 3e-3))]}
    summary["check"][-1]["verdict"] = "failed"
    (directory / "summary.json").write_text(json.dumps(summary, indent=1))


if __name__ == "__main__":
    write(sys.argv[1])
