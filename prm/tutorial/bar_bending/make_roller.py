#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Writes roller.stl, an ASCII STL: a roller of radius 1 mm about the axis y, 6 mm long, normals outwards.

A scene scales and moves it. Its ends are open: no metal comes there.
"""
import pathlib
import sys

import numpy as np

LENGTH, FACETS_PER_TURN = 6.0, 96


def facets():
    """(normal, corners); the corners run counter-clockwise as seen from outside."""
    turn = [np.array([np.cos(t), 0.0, np.sin(t)]) for t in np.linspace(0, 2 * np.pi, FACETS_PER_TURN + 1)]
    front, back = np.array([0, -LENGTH / 2, 0]), np.array([0, LENGTH / 2, 0])
    for a, b in zip(turn[:-1], turn[1:]):
        normal = (a + b) / np.linalg.norm(a + b)
        yield normal, (a + front, b + back, b + front)
        yield normal, (a + front, a + back, b + back)


def write_stl(path):
    with open(path, "w", encoding="ascii") as file:
        file.write("solid roller\n")
        for normal, corners in facets():
            file.write("facet normal {:.6g} {:.6g} {:.6g}\nouter loop\n".format(*normal))
            for corner in corners:
                file.write("vertex {:.9g} {:.9g} {:.9g}\n".format(*corner))
            file.write("endloop\nendfacet\n")
        file.write("endsolid roller\n")


if __name__ == "__main__":
    write_stl(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "roller.stl")
