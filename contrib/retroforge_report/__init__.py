# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Turns a run directory into a self-contained page of pictures and tables.

data     reads a run directory         curves  draws what depends on stroke, parameter or step
vtu      reads one VTU file            shapes  draws billet and dies, render  their surfaces
effects  ranks parameters              units   as the page shows them
document headings, tables, pictures    page    the sections of the page
screen   a virtual one for VTK         gallery the page of the tutorial's scenes
scenes   the page of a scene           sections billet and dies cut by planes
"""
