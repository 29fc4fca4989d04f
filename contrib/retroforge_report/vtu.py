# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Read VTU files (ASCII, or inline base64 with or without zlib): tetrahedra, whose boundary is drawn, or triangles.

Nodes and cells keep the order that they have in the file. Of quadratic cells the corners count."""
import base64
import dataclasses
import xml.etree.ElementTree as xml
import zlib

import numpy as np

TYPES = {"Float64": "f8", "Float32": "f4", "Int64": "i8", "UInt64": "u8", "Int32": "i4", "UInt32": "u4",
         "Int16": "i2", "UInt16": "u2", "Int8": "i1", "UInt8": "u1"}
TRIANGLE, TETRAHEDRON, QUADRATIC_TETRAHEDRON = 5, 10, 24
N_POINTS = {TRIANGLE: 3, TETRAHEDRON: 4, QUADRATIC_TETRAHEDRON: 10}
N_CORNERS = {TRIANGLE: 3, TETRAHEDRON: 4, QUADRATIC_TETRAHEDRON: 4}
FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))  # outward for a positive tetrahedron


@dataclasses.dataclass
class Surface:
    """Triangles; `cell` is the mesh's cell behind each, or each itself, `node` the mesh's node of each point."""
    points: np.ndarray
    triangles: np.ndarray
    cell: np.ndarray
    node: np.ndarray

    def area_vectors(self):
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        return 0.5 * np.cross(b - a, c - a)

    def nodal_area_vectors(self):
        """One third of the area vectors of the triangles around each point."""
        areas = np.zeros_like(self.points)
        for corner in range(3):
            np.add.at(areas, self.triangles[:, corner], self.area_vectors() / 3)
        return areas

    def nodal_areas(self):
        """One third of the areas of the triangles around each point; not below the length of their area vector."""
        return self.nodal_sums(np.linalg.norm(self.area_vectors(), axis=1) / 3)

    def nodal_sums(self, values):
        """Of the triangles around each point."""
        sums = np.zeros(len(self.points))
        for corner in range(3):
            np.add.at(sums, self.triangles[:, corner], values)
        return sums

    def to_triangles(self, nodal):
        return nodal[self.triangles].mean(axis=1)


@dataclasses.dataclass
class Mesh:
    """Cells (n, 4) are tetrahedra, cells (n, 3) triangles. Point data have one value at each node, cell data one in each cell.
    Symmetry planes: point and outward normal of each."""
    points: np.ndarray
    cells: np.ndarray
    point_data: dict
    cell_data: dict
    symmetry_planes: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros((0, 6)))

    def surface(self):
        """Without the points that belong to no triangle of it."""
        if self.cells.shape[1] == N_CORNERS[TRIANGLE]:
            faces, owner = self.cells, np.arange(len(self.cells))
        else:
            faces, owner = self._boundary()
        node, triangles = np.unique(faces, return_inverse=True)
        return Surface(self.points[node], triangles.reshape(-1, 3), owner, node)

    def to_nodes(self, cell_values):
        """Means over the tetrahedra around each node, by their volume."""
        a, b, c, d = (self.points[self.cells[:, i]] for i in range(4))
        volumes = np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a))
        sums, weights = np.zeros(len(self.points)), np.zeros(len(self.points))
        for corner in range(4):
            np.add.at(sums, self.cells[:, corner], volumes * cell_values)
            np.add.at(weights, self.cells[:, corner], volumes)
        return sums / weights

    def _boundary(self):
        """Faces of one cell only, and that cell."""
        faces = np.concatenate([self.cells[:, face] for face in FACES])
        owner = np.tile(np.arange(len(self.cells)), len(FACES))
        _, index, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        boundary = index[count == 1]
        return faces[boundary], owner[boundary]


def read(path):
    """The tetrahedra of a file or, where it has none, its triangles.

    @throws ValueError  for no piece or several, a compressor or a data format that is not known, cells of other types
    """
    root = xml.parse(path).getroot()
    grid = root.find("UnstructuredGrid")
    pieces = [] if grid is None else grid.findall("Piece")
    if len(pieces) != 1:
        raise ValueError(f"{path}: has {len(pieces)} pieces of an unstructured grid; one is read")
    decode = _Decoder(path, root)
    mesh = _mesh(path, pieces[0], decode)
    planes = grid.find("FieldData/DataArray[@Name='symmetry_planes']")
    if planes is not None:
        mesh.symmetry_planes = decode(planes).reshape(-1, 6)
    return mesh


def _mesh(path, piece, decode):
    arrays = {array.get("Name"): decode(array) for array in piece.find("Cells")}
    kind = next((kind for kind in (QUADRATIC_TETRAHEDRON, TETRAHEDRON, TRIANGLE) if (arrays["types"] == kind).any()), None)
    if kind is None:
        raise ValueError(f"{path}: has neither tetrahedra nor triangles; the report draws nothing else")
    chosen = arrays["types"] == kind
    first = arrays["offsets"].astype(int)[chosen] - N_POINTS[kind]
    corners = arrays["connectivity"].astype(int)[first[:, None] + np.arange(N_CORNERS[kind])]
    node, cells = np.unique(corners, return_inverse=True)
    point_data, cell_data = ({array.get("Name"): decode(array)[of_mesh] for array in piece.findall(f"{where}/DataArray")}
                             for where, of_mesh in (("PointData", node), ("CellData", chosen)))
    points = decode(piece.find("Points/DataArray")).reshape(-1, 3)[node].astype(float)
    return Mesh(points, cells.reshape(corners.shape), point_data, cell_data)


class _Decoder:
    def __init__(self, path, root):
        self.path = path
        self.order = "<" if root.get("byte_order", "LittleEndian") == "LittleEndian" else ">"
        self.header = np.dtype(self.order + TYPES[root.get("header_type", "UInt32")])
        self.compressor = root.get("compressor")
        if self.compressor not in (None, "vtkZLibDataCompressor"):
            raise ValueError(f"{path}: compressor {self.compressor} is not known; write it with zlib")

    def __call__(self, array):
        dtype = np.dtype(self.order + TYPES[array.get("type")])
        text = (array.text or "").strip()
        if array.get("format") == "ascii":
            values = np.array(text.split(), dtype=dtype)
        elif array.get("format") == "binary":
            text = "".join(text.split())
            values = np.frombuffer(self.inflate(text) if self.compressor else self.plain(text), dtype)
        else:
            raise ValueError(f"{self.path}: data format {array.get('format')} is not known; "
                             "write it as ascii or binary")
        components = int(array.get("NumberOfComponents", 1))
        return values.reshape(-1, components) if components > 1 else values

    def plain(self, text):
        return base64.b64decode(text)[self.header.itemsize:]

    def inflate(self, text):
        """Layout: number of blocks, block size, last block size, compressed sizes; then the blocks."""
        if not text:
            return b""
        n_blocks = int(np.frombuffer(_decode_bytes(text, self.header.itemsize), self.header)[0])
        n_bytes = (3 + n_blocks) * self.header.itemsize
        sizes = np.frombuffer(_decode_bytes(text, n_bytes), self.header)[3:].astype(int)
        data = base64.b64decode(text[_encoded_length(n_bytes):])
        ends = np.cumsum(sizes)
        return b"".join(zlib.decompress(data[end - size:end]) for size, end in zip(sizes, ends))


def _encoded_length(n_bytes):
    return 4 * ((n_bytes + 2) // 3)


def _decode_bytes(text, n_bytes):
    return base64.b64decode(text[:_encoded_length(n_bytes)])[:n_bytes]
