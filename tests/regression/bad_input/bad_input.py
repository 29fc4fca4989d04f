# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""Wrong input: the program ends with a non-zero status and exactly one message on the error stream,

    retroforge: where: what; rule; remedy

and what was computed before the trouble can still be read. Usage: bad_input.py RETROFORGE"""
import csv
import math
import os
import re
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import block_meshes  # noqa: E402
import whole_runs  # noqa: E402
from whole_runs import PROGRAM, ROOT, contents, judge, judge_message, prm, settings, start, summary_of, text_of, write  # noqa: E402

CASE = prm(whole_runs.cube(10, 4, 1, 3))


ZONE = ("Die upper/Zone flash/from=-1, -1, -1", "Die upper/Zone flash/to=11, 11, 100")


def msh(nodes, cells, kind=4):
    return block_meshes.msh(nodes, [(kind, 1, cell) for cell in cells])


def slender():
    """A column of 1 by 1 by 10 mm."""
    points, cells = block_meshes.block((2, 2, 2), lambda corner: (0.5 * corner[0], 0.5 * corner[1], 5.0 * corner[2]))
    return msh(points, cells)


CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1), (-1, -1, -1)]


OPEN_STL = """solid open
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 9 0 0
vertex 0 9 0
endloop
endfacet
endsolid
"""


# Flattening or inverting a tetrahedron between two others cannot be told from a matter of orientation alone: the first
# two overlap on the same side of their common face.
MESHES = {
    "two_bodies": msh(CORNERS[:4] + [(x + 100, y, z) for x, y, z in CORNERS[:4]], [(0, 1, 2, 3), (4, 5, 6, 7)]),
    "twice": msh(CORNERS[:4] * 2, [(0, 1, 2, 3), (4, 5, 6, 7)]),
    "small": msh(CORNERS[:4], [(0, 1, 2, 3)]),
    "overlapping": msh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.2, 0.2, 2)], [(0, 1, 2, 3), (0, 1, 2, 4)]),
    "flat": msh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2, 3)]),
    "non_manifold": msh(CORNERS, [(0, 1, 2, 3), (0, 1, 2, 4), (0, 1, 5, 2)]),
    "no_tets": msh(CORNERS[:3], [(0, 1, 2)], kind=2),
    "cube": block_meshes.msh_of_cube(2, 10.0),
    "cube_in_metres": block_meshes.msh_of_cube(2, 0.01),
    "slender": slender(),
    "garbage": "this is not a mesh\n",
    "step": "ISO-10303-21;\nHEADER;\n",
    "pointer": "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n",
    "abaqus": "*HEADING\n*NODE\n1, 0., 0., 0.\n",
    "surface": OPEN_STL,
    "hexahedron": msh([(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], [tuple(range(8))], kind=5),
}

def file_mesh(name):
    return ["--set", "Billet/symmetry planes=", "--set", "Billet/shape=file", "--set", f"Billet/file name={name}.msh"]


def objective(name, *pairs):
    return settings(f"Objectives/names={name}", *(f"Objective {name}/{pair}" for pair in pairs))


def binary_stl(*facets, announced, normal=0.0):
    """Facets of nine coordinates."""
    return b" " * 80 + struct.pack("<I", announced) + b"".join(struct.pack("<12fH", *[normal] * 3, *facet, 0) for facet in facets)


def square(side):
    """Two facets that face upwards, centred on the z axis."""
    a = side / 2
    return (-a, -a, 0, a, -a, 0, a, a, 0), (-a, -a, 0, a, a, 0, -a, a, 0)


def holed(side):
    """Nine such squares, without the one in the middle."""
    third = side / 3
    return [tuple(x + third * shift for x, shift in zip(facet, (i, j, 0) * 3)) for facet in square(third)
            for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]


STLS = {
    "holed.stl": binary_stl(*holed(30), announced=16),
    "open.stl": OPEN_STL.encode(),
    "half_dropped.stl": binary_stl(*square(30), announced=1),
    "in_metres.stl": binary_stl(*square(0.03), announced=2),
    "nan_normals.stl": binary_stl(*square(30), announced=2, normal=math.nan),
    "soup.stl": binary_stl(*((0, 0, i, 10, 0, i, 0, 10, i) for i in range(8)), announced=8),
    "of_git_lfs.stl": MESHES["pointer"].encode(),
    "iges.stl": b" " * 72 + b"S      1\n",
    "in_nanometres.stl": binary_stl(*square(3e7), announced=2),
}


STEPS = {
    "no_column.csv": "increment,time\n1,0.1\n",
    "far.csv": "stroke\n0.5\nfar\n",
    "back.csv": "stroke\n0.5\n0.4\n",
    "no_rows.csv": "stroke\n",
}


# name: (arguments after the case file, what the message must say)
MISTAKES = {
    "unknown parameter": (settings("Press/strok=3"), r"Press/strok\b.*stroke"),
    "unknown section": (settings("Pres/stroke=3"), r"Pres/stroke"),
    "ill-typed number": (settings("Press/stroke=far"), r"Press/stroke.*far"),
    "ill-typed integer": (settings("Press/increments=2.5"), r"Press/increments.*2\.5"),
    "out of range": (settings("Press/stroke=-1"), r"Press/stroke.*-1"),
    "negative friction": (settings("Die upper/friction=-0.3"), r"Die upper/friction.*-0\.3"),
    "sensitivity of two": (settings("Material/strain rate sensitivity=2"), r"Material/strain rate sensitivity.*2"),
    "no slip regularisation": (settings("Contact/slip regularisation=0"), r"Contact/slip regularisation"),
    "pictures in words": (settings("Output/fields every=often"), r"Output/fields every.*often.*auto"),
    "pictures below none": (settings("Output/fields every=-1"), r"Output/fields every.*-1.*auto"),
    "pictures of half an increment": (settings("Output/fields every=2.5"), r"Output/fields every.*2\.5.*auto"),
    "unknown choice": (settings("Press/scheme=leapfrog"), r"Press/scheme.*leapfrog.*midpoint"),
    "missing steps": (settings("Press/steps=absent.csv"), r"absent\.csv.*cannot be read"),
    "steps without strokes": (settings("Press/steps=no_column.csv"), r"no_column\.csv, line 1.*no column `stroke'.*history\.csv"),
    "steps in words": (settings("Press/steps=far.csv"), r"far\.csv, line 3.*'far'"),
    "steps that go back": (settings("Press/steps=back.csv"), r"back\.csv, line 3.*0\.4 after 0\.5"),
    "no steps": (settings("Press/steps=no_rows.csv"), r"no_rows\.csv.*no increments"),
    "die without section": (settings("Dies/names=lower, upper, third"), r"[Dd]ie third"),
    "no die": (settings("Dies/names="), r"Die"),
    "unknown law of friction": (settings("Die upper/friction law=Nortan"),
                                r"Die upper/friction law.*'Nortan' is no law of friction.*Norton.*did you mean 'Norton'\?"),
    "unknown law of friction in a zone": (settings("Die upper/zones=flash", *ZONE, "Die upper/Zone flash/friction law=Nortan"),
                                          r"Die upper/Zone flash/friction law.*'Nortan' is no law of friction.*did you mean 'Norton'\?"),
    "too much friction in a zone": (settings("Die upper/zones=flash", *ZONE, "Die upper/Zone flash/friction law=Tresca",
                                             "Die upper/Zone flash/friction=2"), r"Die upper/Zone flash/friction: is 2.*at most 1"),
    "a zone off the die": (settings("Die upper/zones=flash", *ZONE, "Die upper/Zone flash/to=10, 10, 1"),
                           r"Die upper/Zone flash/from.*no part of die upper is in this zone"),
    "a zone of no size": (settings("Die upper/zones=flash", *ZONE, "Die upper/Zone flash/to=-1, 10, 100"),
                          r"Die upper/Zone flash/from: is not below `to'"),
    "zones that overlap": (settings("Die upper/zones=flash, land", *ZONE, *(text.replace("flash", "land") for text in ZONE)),
                           r"Die upper/Zone land/from.*overlaps zone flash"),
    "no die moves": (settings("Die upper/velocity=0, 0, 0"), r"move"),
    "unknown leading die": (settings("Press/leading die=middle"), r"Press/leading die.*middle"),
    "unknown design parameter": (settings("Design/parameters=material/L"), r"material/L"),
    "design parameter of another shape": (settings("Design/parameters=billet/radius"), r"billet/radius"),
    "billet out of reach": (settings("Billet/translation=0, 0, 500", "Die upper/point=0, 0, 1000"), r"Die|billet"),
    "billet inside a die": (settings("Die lower/point=0, 0, 4"), r"Die lower.*inside"),
    "die of a file without one": (settings("Die lower/shape=stl"), r"Die lower/file.*empty"),
    "missing die file": (settings("Die lower/shape=stl", "Die lower/file=absent.stl"), r"Die lower/file.*absent\.stl.*cannot be read"),
    "a die's file that is no STL": (settings("Die lower/shape=stl", "Die lower/file=case.prm"), r"case\.prm"),
    "file for a plane": (settings("Die lower/file=lower.stl"), r"Die lower/file.*plane"),
    "die whose measures do not fit": (settings("Die lower/shape=tripod", "Die lower/Tripod/arm width=3"),
                                      r"Die lower/Tripod/arm width.*3"),
    "free form of a plane": (settings("Die upper/free form modes=3"), r"Die upper/free form modes.*3.*plane.*offset"),
    "free form of more modes than vertices": (settings("Die upper/shape=punch", "Die upper/free form modes=3000"),
                                              r"Die upper/free form modes.*3000.*vertices are free.*fewer modes"),
    "free form where no die is": (settings("Die upper/shape=punch", "Die upper/free form modes=3", "Die upper/free form region from=90, 0, 0",
                                           "Die upper/free form region to=91, 1, 1"), r"Die upper/free form modes.*0 of the die's.*region"),
    "corners of a free form's region swapped": (settings("Die upper/shape=punch", "Die upper/free form region from=1, 1, 1",
                                                         "Die upper/free form region to=0, 0, 0"), r"Die upper/free form region from.*lower"),
    "mode that a die does not have": (settings("Die upper/shape=punch", "Die upper/free form modes=3",
                                               "Design/parameters=die upper/free form 4"), r"Design/parameters.*free form 4.*did you mean"),
    "a time that is none": (settings("Heat/heating=conduction", "Material/temperature=900", "Design/parameters=heat/transfer time"),
                            r"Design/parameters.*heat/transfer time.*is 0.*set Heat/transfer time > 0"),
    "where a law holds, the wrong way around": (settings("Material/valid temperatures=1250, 800"), r"Material/valid temperatures: go from 1250 to 800; .*FROM, TO"),
    "where a law holds, one number": (settings("Material/valid strain rates=100"), r"Material/valid strain rates: has one number; .*FROM, TO"),
    "free form of a die without modes": (settings("Die upper/shape=punch", "Design/parameters=die upper/free form"),
                                         r"Design/parameters.*die upper/free form' is not a parameter"),
    "unknown shape of a die": (settings("Die lower/shape=cone"), r"Die lower/shape.*cone.*bell"),
    "element size of zero": (settings("Billet/element size=0"), r"Billet/element size"),
    "missing mesh": (file_mesh("absent"), r"absent\.msh"),
    "overlapping tetrahedra": (file_mesh("overlapping"), r"overlapping\.msh|[Tt]etrahed|face"),
    "flat tetrahedron": (file_mesh("flat"), r"flat\.msh|[Tt]etrahed"),
    "non-manifold mesh": (file_mesh("non_manifold"), r"face"),
    "mesh without tetrahedra": (file_mesh("no_tets"), r"tetrahed"),
    "garbage for a mesh": (file_mesh("garbage"), r"garbage\.msh"),
    "no objective": (settings("Objectives/names="), r"Objectives/names"),
    "objective named twice": (settings("Objectives/names=energy, energy"), r"Objectives/names.*energy.*twice"),
    "unknown type of objective": (settings("Objective energy/type=beauty"), r"Objective energy/type.*beauty"),
    "objective on a missing die": (objective("mean effort", "die=middle"), r"Objective mean effort.*middle.*upper"),
    "effort of a die that stands still": (objective("mean effort", "die=lower"), r"Objective mean effort/die.*lower"),
    "window after the end": (objective("mean effort", "window begin=50"), r"Objective mean effort/window begin.*50"),
    "window that ends before it begins": (objective("mean effort", "window begin=2", "window end=1"),
                                          r"Objective mean effort.*window"),
    "no target": (objective("filling"), r"Objective filling/target"),
    "missing target": (objective("filling", "target=absent.stl"), r"Objective .*/target.*absent\.stl"),
    "plane for a target": (objective("filling", "target=die upper"), r"Objective filling/target.*upper.*plane"),
    "target not watertight": (objective("unfilled volume", "target=open.stl"), r"open\.stl.*watertight"),
    "region without extent": (objective("fold", "region from=1, 1, 1", "region to=2, 2, 0"), r"Objective fold/region from"),
    "exponent below one": (objective("fold", "exponent=0.5"), r"exponent.*0\.5"),
    "damage that is not followed": (objective("damage"), r"Objective damage.*Material/damage is none.*Latham-Cockcroft"),
    "temperature of a die that stays as it is": (objective("die temperature"), r"Objective die temperature.*heat.*conduction"),
    "temperature of a missing die": (objective("die temperature", "die=middle"), r"Objective die temperature.*middle.*upper"),
    "unknown damage": (settings("Material/damage=Lemaitre"), r"Material/damage.*Lemaitre"),
    "wear of a missing die": (objective("die wear", "die=middle"), r"Objective die wear.*middle.*upper"),
    "wear within less than an element": (objective("die wear", "wear=largest", "wear radius=0.01"),
                                         r"Objective die wear/wear radius.*0\.01 mm.*element size"),
    "blunt largest wear": (objective("die wear", "wear=largest", "sharpness=0.5"), r"exponent.*0\.5"),
    "wear after the end": (objective("die wear", "window begin=50"), r"Objective die wear/window begin.*50"),
    "shear in a region without extent": (objective("largest shear", "region from=1, 1, 1", "region to=2, 2, 0"),
                                         r"Objective largest shear/region from"),
    "blunt pressure": (objective("largest hydrostatic pressure", "sharpness=0.5"), r"exponent.*0\.5"),
    "maximum without sharpness": (objective("maximum strain", "sharpness=0"), r"Objective maximum strain/sharpness"),
    "cylinder without patches": (objective("cylinder distance"), r"patch"),
    "misspelt objective": (settings("Objectives/names=maximum efort"), r"Objectives/names.*maximum efort.*did you mean 'maximum effort'"),
    "objective of unknown kind": (settings("Objectives/names=nice shape"), r"nice shape.*Objective nice shape.*filling"),
    "energy of a die that does not exist": (objective("energy", "die=foo"), r"Objective energy.*foo.*lower, upper"),
    "patch that does not exist": (objective("cylinder distance", "patches=side"),
                                  r"Objective cylinder distance/patches.*'side'.*bottom, top, side \+x, side \+y"),
    "symmetry plane for a patch": (objective("cylinder distance", "patches=symmetry 1"), r"patches.*symmetry 1"),
    "scan of a parameter that does not exist": (settings("Scan/parameter=billet/radus"), r"Scan/parameter.*billet/radus.*billet/height"),
    "die that moves away": (settings("Die upper/velocity=0, 0, 100"), r"Die upper.*moves away from the billet.*velocity"),
    "leading die out of reach": (settings("Die upper/point=0, 0, 12"), r"Die upper.*starts 2 mm away.*meets it after 2 mm.*stroke is 1 mm"),
    "curved die out of reach": (settings("Die upper/shape=bell", "Die upper/point=0, 0, 80"), r"Die upper.*does not reach the billet"),
    "stroke as long as the dies are apart": (settings("Press/stroke=10"), r"Press/stroke.*die upper.*die lower.*less than 10 mm"),
    "stroke longer than that": (settings("Press/stroke=12"), r"Press/stroke.*2 mm beyond.*less than 10 mm"),
    "stroke up to a plane of symmetry": (settings(
        "Billet/symmetry planes=-1, 0, 0; 0, -1, 0; 0, 0, -1", "Billet/symmetry point=centre", "Die lower/point=0, 0, -9",
        "Press/stroke=5"), r"Press/stroke.*symmetry plane.*less than 5 mm"),
    "curved die into a plane": (settings("Die upper/shape=bell", "Die upper/Bell/mouth radius=3", "Die upper/Bell/depth=2",
                                         "Die upper/Bell/draft angle=10", "Die upper/Bell/edge radius=0.5", "Die upper/Bell/fillet radius=0.5",
                                         "Press/stroke=12.5"), r"Press/stroke.*part of die upper.*beyond die lower.*less than 10 mm"),
    "binary STL with more facets than it announces": (settings("Die lower/shape=stl", "Die lower/file=half_dropped.stl"),
                                                      r"half_dropped\.stl.*184 bytes.*1 facets.*134"),
    "die in metres": (settings("Die lower/shape=stl", "Die lower/file=in_metres.stl"), r"Die lower.*0\.0424264 mm.*scale"),
    "die in nanometres": (settings("Die lower/shape=stl", "Die lower/file=in_nanometres.stl"), r"Die lower.*4\.24264e\+07 mm.*scale"),
    "a soup of facets": (settings("Die lower/shape=stl", "Die lower/file=soup.stl"), r"soup\.stl.*8 of its 8 facets share no edge"),
    "pointer of Git LFS for a die": (settings("Die lower/shape=stl", "Die lower/file=of_git_lfs.stl"), r"Die lower/file.*of_git_lfs\.stl.*Git LFS.*git lfs pull"),
    "IGES for a die": (settings("Die lower/shape=stl", "Die lower/file=iges.stl"), r"iges\.stl.*IGES.*gmsh iges\.stl -2"),
    "STEP for a mesh": (file_mesh("step"), r"step\.msh.*STEP.*gmsh step\.msh -3"),
    "pointer of Git LFS for a mesh": (file_mesh("pointer"), r"pointer\.msh.*Git LFS.*git lfs pull"),
    "Abaqus for a mesh": (file_mesh("abaqus"), r"abaqus\.msh.*Abaqus.*meshio convert"),
    "STL for a mesh": (file_mesh("surface"), r"surface\.msh.*STL.*Surface Loop"),
    "hexahedra": (file_mesh("hexahedron"), r"hexahedron\.msh.*1 hexahedra"),
    "device for a die": (settings("Die lower/shape=stl", "Die lower/file=/dev/zero"), r"/dev/zero.*device"),
    "device for a mesh": (file_mesh("small") + settings("Billet/file name=/dev/zero"), r"/dev/zero.*device"),
    "billet in metres": (file_mesh("small") + settings("Billet/scale=0.001"), r"Die upper.*does not reach the billet.*scale"),
    "two bodies": (file_mesh("two_bodies"), r"two_bodies\.msh.*bodies that no face connects"),
    "a mesh that is there twice": (file_mesh("twice"), r"twice\.msh.*bodies that no face connects"),
    "a layer felt too far": (settings("Contact/layer=1e-3"), r"Contact/layer.*0\.001.*0\.1"),
    "rotation of many turns": (settings("Billet/rotation angle=1e308"), r"Billet/rotation angle.*1e308.*360"),
    "rotation without an angle": (settings("Billet/rotations=0, 1, 0, 90; 0, 0, 1"), r"Billet/rotations.*3 number.*entry 2.*four"),
    "rotation about nothing": (settings("Billet/rotations=0, 0, 0, 90"), r"Billet/rotations.*length 0"),
    "rotations of many turns": (settings("Billet/rotations=0, 0, 1, 1e6"), r"Billet/rotations.*1e\+06.*360"),
    "rotations beside a rotation angle": (settings("Billet/rotation angle=10", "Billet/rotations=0, 0, 1, 30"), r"Billet/rotations.*beside"),
    "rotation of a die without an angle": (settings("Die lower/rotations=0, 0, 1"), r"Die lower/rotations.*3 number"),
    "friction of dies without any": (settings("Die lower/friction=0", "Die upper/friction=0", "Design/parameters=material/K, dies/friction"),
                                     r"Design/parameters.*'dies/friction' changes nothing.*friction of all dies is 0"),
    "speed of a die that stands still": (settings("Design/parameters=die lower/speed"), r"die lower/speed.*velocity of die lower is 0"),
    "misspelt name of a die in the list": (settings("Dies/names=lower, uper"), r"Die upper.*did you mean 'Die uper'"),
    "moves that no increment makes": (settings("Press/largest move=1e-6"), r"Press/largest move.*1e-6.*0\.001"),
    "penalty beyond all digits": (settings("Contact/penalty=1e30"), r"Contact/penalty.*1e\+30.*1e-14"),
    "penalty that holds nothing": (settings("Contact/penalty=1e-9"), r"Contact/penalty.*1e-09"),
    "metal beyond all digits": (settings("Material/consistency=1e300"), r"Material.*flow stress"),
    "friction stiff without bound": (settings("Contact/slip regularisation=1e-300"), r"Contact/slip regularisation.*1e-300"),
    "approach of many increments": (settings("Contact/approach=1e300"), r"Contact/approach.*1e300.*100"),
    "a billet of too many tetrahedra": (settings("Billet/element size=0.03"), r"Billet/element size: is 0\.03, which makes about .*1e8.*larger"),
    "times where no heat flows": (settings("Design/parameters=heat/transfer time"),
                                  r"Design/parameters.*heat/transfer time.*no heat flows.*set Heat/heating = conduction"),
    "meshes of too many tetrahedra": (settings("Remeshing/element size=1e-3"), r"Remeshing/element size.*0\.001.*1e8"),
    "billet out of the world": (settings("Billet/translation=1e300, 0, 0"), r"Billet/translation.*away from the origin"),
    "axis of infinite length": (settings("Billet/rotation axis=1e200, 0, 0", "Billet/rotation angle=5"), r"Billet/rotation axis.*inf"),
    "facing of infinite length": (settings("Die upper/facing=0, 0, -1e200"), r"Die upper/facing.*infinite"),
    "facets without number": (settings("Die upper/shape=tripod", "Die upper/chord error=1e-6"), r"Die upper/Tripod.*facets.*1e6"),
    "restart without bound": (settings("Linear solver/restart=2000000000"), r"Linear solver/restart.*1000"),
    "volume that goes": (settings("Press/largest volume change=1e-12"), r"Press/stroke: at stroke .* has lost .* of its volume"),
    "quadratic geometry in closed form": (settings("Discretization/geometry degree=2"), r"Discretization/geometry degree.*assembly = quadrature"),
    "cubic geometry": (settings("Discretization/assembly=quadrature", "Discretization/geometry degree=3"), r"Discretization/geometry degree.*3"),
    "too few Newton steps": (settings("Newton/max iterations=1"), r"Newton"),
}


def run(arguments, command="gradient"):
    return start([PROGRAM, command, *arguments])


def whole_history(name, path, at_least):
    """The lines of a history, each of which must be whole."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    judge(f"{name}: {len(rows) - 1} increments in {os.path.basename(path)}",
          len(rows) - 1 >= at_least and all(len(row) == len(rows[0]) for row in rows))


def interrupted():
    """Newton fails in the second increment, once a node arrives: the first increment must be on file."""
    done = run(["case.prm", "--output", "stopped"] + settings(
        "Press/stroke=9", "Press/increments=6", "Press/max cuts=0", "Press/largest move=0.3"))
    judge_message("stopped on the way", done, r"Press/stroke")
    whole_history("what was computed before is kept", "stopped/history.csv", 1)
    record = "stopped/record"
    kept = [f for f in os.listdir(record) if f.startswith("increment_")] if os.path.isdir(record) else []
    judge("its record too", len(kept) >= 1, f"{len(kept)} increments in {record}")


def resumed():
    """What --resume refuses: nothing to resume, other parameters, another billet, files that are no records."""
    short = settings("Press/stroke=0.9", "Press/max cuts=0")
    judge_message("nothing to resume", run(["case.prm", "--output", "new", "--resume"]), "new")
    judge("and no folder made", not os.path.exists("new"), "there is one")
    run(["case.prm", "--output", "done"] + short)
    before = contents("done")
    for name, value in (("Material/consistency", "2"), ("Press/stroke", "0.2"), ("Die upper/friction", "0.2"),
                        ("Billet/element size", "3")):
        judge_message(f"resumed with another {name}",
                      run(["case.prm", "--output", "done", "--resume"] + short + settings(f"{name}={value}")), name)
    judge_message("another run in its folder", run(["case.prm", "--output", "done"] + short), r"done.*already.*--overwrite")
    judge_message("a scan in its folder", run(["case.prm", "--output", "done"], "scan"), r"done.*already")
    judge_message("a scan that goes on with a run", run(["case.prm", "--output", "done", "--resume"], "scan"), r"done.*run")
    judge_message("a look at a scene in its folder", run(["case.prm", "--output", "done"], "scene"), r"done.*already.*--overwrite")
    judge_message("a look that goes on with a run", run(["case.prm", "--output", "done", "--resume"], "scene"), r"--resume.*scene")
    judge("none of them changed a file", contents("done") == before, "the folder differs")
    same = run(["case.prm", "--output", "done", "--resume"] + short + settings("Output/fields every=0", "Design/parameters=material/m"))
    judge("resumed with other output and design", same.returncode == 0, same.stderr)
    record = "done/record.h5"
    with open(record, "rb") as file:
        whole = file.read()
    for name, content in (("truncated", whole[:len(whole) // 2]), ("foreign", b"not a record at all\n" * 100), ("empty", b""),
                          ("damaged", damaged(whole))):
        with open(record, "wb") as file:
            file.write(content)
        before = contents("done")
        judge_message(f"{name} record", run(["case.prm", "--output", "done", "--resume"] + short), r"record\.h5")
        judge(f"{name} record: no result is lost", contents("done") == before)


def damaged(record):
    """A bit changed behind the header, in an increment, whose checksum tells it."""
    at = 9 * len(record) // 10
    return record[:at] + bytes([record[at] ^ 1]) + record[at + 1:]


def replaced():
    """--overwrite leaves nothing of the longer run before it, and what is not of a run."""
    output, one = "twice", settings("Press/stroke=0.3", "Press/increments=1")
    run(["case.prm", "--output", "twice"])
    for name in ("mine.txt", "report.html"):
        write(os.path.join(output, name), "mine\n")
    before = set(os.listdir(output))
    done = run(["case.prm", "--output", "twice", "--overwrite"] + one, "simulate")
    gone = before - set(os.listdir(output))
    of_increments = {f"{of}_00000{i}.vtu" for of in ("fields", "die_lower", "die_upper") for i in (2, 3)}
    judge("--overwrite replaces all", done.returncode == 0 and gone == {"report.html", "sensitivity.vtu", "sensitivity_nodes.csv", *of_increments},
          f"{done.stderr} removed {sorted(gone)}")


def full_disk():
    """A small file system of our own, where the machine lets us have one. Runs begin with their parameters, in a file and
    in the record's head, which grow with the program: sizes are what is left beside them."""
    parameters = os.path.getsize(os.path.join("twice", "parameters.prm"))
    beside = lambda left: f"{8 * math.ceil(parameters / 4096) + left}k"  # noqa: E731
    for size, name, more in (("4k", "first files", ""), (beside(70), "fields", ""),
                             (beside(60), "record", "--set 'Output/fields every=0' --set Press/increments=60")):
        disk, saved = f"disk_{name.replace(' ', '_')}", f"saved_{name.replace(' ', '_')}"
        os.mkdir(disk)
        script = (f"mount -t tmpfs -o size={size} tmpfs {disk} || exit 77; "
                  f"{PROGRAM} gradient case.prm --output {disk}/run {more}; status=$?; cp -r {disk} {saved}; exit $status")
        try:
            done = start(["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script])
        except OSError:
            done = None
        if done is None or done.returncode == 77 or done.stderr.startswith("unshare"):
            print(f"skipped disk full at the {name}: no private file system can be mounted here")
            continue
        judge_message(f"disk full at the {name}", done, re.escape(disk))
        history = os.path.join(saved, "run", "history.csv")
        if name != "first files":
            whole_history(f"what was computed before is kept ({name})", history, 1)


def any_line_ends():
    """Files as other systems write them, names in an included file, continued lines, any case: all are read alike."""
    def energy_and_volume(name, text):
        with open("variant.prm", "wb") as file:
            file.write(text.encode())
        done = run(["variant.prm", "--output", "variant", "--overwrite"], command="simulate")
        found = re.findall(r"^  (energy|volume) [0-9]", done.stdout, re.MULTILINE)
        judge(name, done.returncode == 0 and found == ["energy", "volume"], done.stderr + str(found))

    write("names.prm", "subsection Objectives\nset names = energy, volume\nend\n")
    case = prm(whole_runs.cube(10, 4, 0.1, 1))
    both = case + "subsection Objectives\n  set names = energy, volume\nend\n"
    energy_and_volume("plain file", both)
    energy_and_volume("lines that end as on Windows", both.replace("\n", "\r\n"))
    energy_and_volume("lines that end as on old systems", both.replace("\n", "\r"))
    energy_and_volume("byte order mark", "\ufeff" + both)
    energy_and_volume("names without blanks", both.replace("names = energy, volume", "names=energy,volume"))
    energy_and_volume("keywords in any case", re.sub("subsection|set |end\n", lambda m: m[0].upper(), both))
    energy_and_volume("names on two lines", both.replace("energy, ", "energy, \\\n"))
    energy_and_volume("names in another file", case + "include names.prm\n")


def template():
    """What --print-parameters writes is a case, and is the manual's page."""
    printed = start([PROGRAM, "--print-parameters"]).stdout
    write("template.prm", printed)
    done = run(["template.prm", "--output", "template"] + settings("Press/stroke=0.1", "Billet/element size=20"), command="simulate")
    judge("the printed parameters are a case", done.returncode == 0, done.stderr)
    page = ROOT / "doc/parameters/parameters.prm"
    judge("doc/parameters/parameters.prm is up to date", text_of(page) == printed,
          "write it anew: retroforge --print-parameters > doc/parameters/parameters.prm")


def told():
    """What is accepted and does not do what one may think is said."""
    short = settings("Press/stroke=0.1", "Press/increments=1")
    for name, more, pattern in (
            ("radius of a box", settings("Billet/radius=20"), r"note: Billet/radius = 20 has no effect: shape = box reads .*size"),
            ("scale of a plane", settings("Die lower/scale=2"), r"note: Die lower/scale = 2 has no effect: shape = plane"),
            ("measure of another die", settings("Die lower/Bell/depth=3"), r"note: Die lower/Bell/depth = 3 has no effect"),
            ("die of the energy", objective("energy", "die=upper"), r"note: Objective energy/die = upper has no effect"),
            ("increments between remeshings by quality", settings("Remeshing/every=3"),
             r"note: Remeshing/every = 3 has no effect: when = quality reads"),
            ("step of exact derivatives", settings("Adjoint/perturbation=1e-5"),
             r"note: Adjoint/perturbation = 1e-5 has no effect: derivatives = exact reads"),
            ("weight in no sum", objective("energy", "weight=2"), r"note: Objective energy/weight = 2 has no effect but in .optimize.: .*gradients = each"),
            ("a die with a hole", settings("Die lower/shape=stl", "Die lower/file=holed.stl"),
             r"note: the surface of die lower has another rim, 40 mm around, at \(0, 0, 0\)"),
            ("no friction", settings("Die lower/friction=0", "Die upper/friction=0"), r"note: no die has any friction: Die NAME/friction is 0 where"),
            ("friction of dies without any", settings("Die lower/friction=0", "Die upper/friction=0", "Design/parameters=material/K, dies/friction"),
             r"note: Design/parameters: 'dies/friction' changes nothing, as the friction of all dies is 0"),
            ("regularisation of a linear metal", settings("Material/strain rate sensitivity=1", "Design/parameters=material/e0"),
             r"note: Design/parameters: 'material/e0' changes nothing, as the strain rate sensitivity is 1"),
            ("a die with normals that are no numbers", settings("Die lower/shape=stl", "Die lower/file=nan_normals.stl"),
             r"note: the file of die lower: 2 normals are no numbers"),
            ("a slender mesh", file_mesh("slender") + settings("Press/stroke=0.1", "Press/increments=1"),
             r"note: faces of the billet's mesh meet at [1-9][.0-9]* degrees, .*Remeshing/first mesh = true"),
            ("a billet of a forged part", file_mesh("slender") + settings("Press/stroke=0.1", "Press/increments=1", "Material/law=power", "Material/further numbers=n: 0.2"),
             r"note: the metal of a billet from a file begins without strain and at one temperature"),
            ("metal in a die", settings("Contact/largest depth=0"), r"the surface was up to .* inside die"),
            ("heat from afar", settings("Heat/heating=conduction", "Material/temperature=900", "Heat/contact gap=5"),
             r"warning: Heat/contact gap = 5 mm is [.0-9]+ of the element size"),
            ("minutes on dies", settings("Heat/heating=conduction", "Material/temperature=900", "Heat/dwell time=400"),
             r"warning: the metal is on dies for 400[.0-9]* s: dies are thick half spaces"),
            ("rest on a die that is off", settings("Heat/heating=conduction", "Material/temperature=900", "Heat/dwell time=4",
                                                    "Dies/names=lower, upper, side", "Die side/point=50, 0, 0", "Die side/facing=-1, 0, 0",
                                                    "Heat/resting die=side"),
             r"warning: die side, on which the billet is to rest for 4 s, does not touch"),
            ("colder than the law's numbers hold", settings("Material/temperature=20", "Material/valid temperatures=800, 1250"),
             r"warning: Material/temperature = 20: the law's numbers hold from 800 to 1250 C \(Material/valid temperatures\)"),
            ("faster than they hold", settings("Material/valid strain rates=0.001, 0.01"),
             r"warning: Die upper/velocity: the billet is strained at [.0-9]+ /s, and the law's numbers hold from 0.001 to 0.01 /s"),
            ("metal that cools until they do not hold", settings("Heat/heating=conduction", "Material/temperature=900", "Heat/transfer time=30",
                                                                  "Material/valid temperatures=890, 1250"),
             r"warning: the metal ends at [.0-9]+ to [.0-9]+ C, [.0-9]+ % of it where the law's numbers do not hold: from 890 to 1250 C"),
            ("die that nothing touches", settings("Dies/names=lower, upper, side", "Die side/point=50, 0, 0", "Die side/facing=-1, 0, 0"),
             r"warning: the stroke pressed no node against die side")):
        done = run(["case.prm", "--output", "told", "--overwrite"] + short + more, command="simulate")
        judge(name, done.returncode == 0 and re.search(pattern, done.stdout), done.stdout + done.stderr)
    done = run(["case.prm", "--output", "told", "--overwrite"] + short, command="simulate")
    judge("nothing to tell", not re.search("note|warning", done.stdout), done.stdout)


def unlisted():
    """Sections of names that no list has are left unread, and that is told once; a name that is meant to be in the list is misspelt."""
    listed = {"Objectives": {"names": "energy, lost"}, "Objective lost": {"type": "volume"}}
    side = {"Die side": {"facing": "-1, 0, 0"}}
    write("more.prm", CASE + prm({**listed, **side}))
    short = settings("Press/stroke=0.1", "Press/increments=1")
    notes = {"Die side": "Dies/names", "Objective lost": "Objectives/names"}
    for name, more, expected in (("a die that is not listed", [], ["Die side"]),
                                 ("a list made shorter", settings("Objectives/names=energy"), ["Die side", "Objective lost"])):
        done = run(["more.prm", "--output", "unlisted", "--overwrite"] + short + more, command="simulate")
        told_ones = re.findall(r"note: section `(.*)' is not read, as (.*) does not name it", done.stdout)
        judge(name, done.returncode == 0 and told_ones == [(section, notes[section]) for section in expected], done.stdout + done.stderr)
    judge("their settings are not in the input that is kept", "Objective lost" not in text_of("unlisted/parameters.prm"))
    write("misspelt.prm", CASE.replace("Die upper", "Die uper"))
    judge_message("misspelt section of a die", run(["misspelt.prm", "--output", "run"]), r"Die uper.*did you mean 'Die upper'")
    judge_message("setting of a section that is not there", run(["more.prm", "--output", "run"] + settings("Die sid/friction=1")), r"Die sid/friction")


def on_two_ranks():
    """One message and status 1 for what all ranks find; what one rank alone finds is told, too, and the other does not wait for ever."""
    two = ["mpirun", "-np", "2"]
    for name, more, pattern in (("an input", settings("Press/stroke=-1"), r"Press/stroke.*-1"),
                                ("a scene", settings("Die upper/point=0, 0, 12"), r"Die upper.*starts 2 mm away"),
                                ("a forging", settings("Newton/max iterations=1"), r"Newton")):
        done = start([*two, PROGRAM, "gradient", "case.prm", "--output", "ranks", "--overwrite", *more])
        done.stderr = "".join(line for line in done.stderr.splitlines(True) if line.startswith("retroforge"))  # the rest is mpirun's
        judge_message(f"{name} on two ranks", done, pattern)
        judge("its status", done.returncode == 1, done.returncode)
    done = start(["mpirun", "-np", "2", PROGRAM, "gradient", "case.prm", "--output", "ranks", "--overwrite", *settings("Press/stroke=-1")])
    judge("nothing of an abort", "MPI_ABORT" not in done.stdout + done.stderr, done.stderr)
    first_alone = "trap '' XFSZ; [ $OMPI_COMM_WORLD_RANK = 0 ] && ulimit -f 64; exec \"$@\""
    # Messages go by sockets there: memory that ranks share is a file, which would be bounded, too.
    sockets = ["--mca", "btl", "tcp,self", "--mca", "btl_tcp_if_include", "lo"]
    done = start([*two, *sockets, "sh", "-c", first_alone, "sh", PROGRAM, "gradient", "case.prm", "--output", "alone", "--overwrite"])
    judge("a disk that is full for one rank", done.returncode != 0 and "retroforge: alone" in done.stderr, done.stderr)


def announced():
    """Meshes of millions, before they are made: the runs are not waited for."""
    for name, arguments, pattern in (
            ("billet of millions", settings("Billet/element size=0.05"), r"note: Billet/element size = 0.05 makes about 6.4e\+07 tetrahedra"),
            ("remeshings of millions", settings("Remeshing/element size=0.05"), r"note: Remeshing/element size = 0.05 makes about 1.6e\+07 tet")):
        with subprocess.Popen([PROGRAM, "simulate", "case.prm", "--output", "told", "--overwrite", *arguments], env=whole_runs.ENVIRONMENT,
                              stdout=subprocess.PIPE, text=True) as running:
            first = next((line for line in running.stdout if "note" in line), "")
            running.kill()
        judge(name, re.search(pattern, first), first)


def scaled_mesh():
    """A mesh in metres and its scale are the mesh in millimetres."""
    results = []
    for mesh, more in (("cube", []), ("cube_in_metres", settings("Billet/scale=1000"))):
        done = run(["case.prm", "--output", mesh] + file_mesh(mesh) + settings("Press/stroke=0.1", "Press/increments=1") + more,
                   "simulate")
        results.append(re.search(r"energy (\d+\.\d{6})", done.stdout))
    judge("scale of a billet's file", all(results) and results[0][1] == results[1][1], done.stdout + done.stderr)


def per_cent_of_zero():
    """Where a parameter is 0, its per cent are of a length that is told: the width of the billet, from a file too."""
    offset = settings("Press/stroke=0.1", "Press/increments=1", "Design/parameters=die upper/offset")
    for name, more in (("box", []), ("file", file_mesh("cube"))):
        done = run(["case.prm", "--output", "width", "--overwrite"] + offset + more)
        scale = summary_of("width")["parameters"][0].get("scale")
        judge(f"per cent of an offset, billet of shape {name}", scale == 10 and "(of 10 mm)" in done.stdout, done.stdout + done.stderr)


def forbidden_output():
    for file, command in (("summary.json", "gradient"), ("sensitivity.vtu", "gradient"), ("sensitivity_nodes.csv", "gradient"),
                          ("forged.msh", "gradient"), ("record.h5", "gradient"), ("check.json", "check")):
        os.makedirs(os.path.join("taken", file))
        done = run(["case.prm", "--output", "taken"], command)
        judge_message(f"{file} is a folder", done, re.escape(file))
        judge("and that is found before the run", "  1 " not in done.stdout, done.stdout)
        os.rmdir(os.path.join("taken", file))
    write("a_file", "in the way\n")
    judge_message("output below a file", run(["case.prm", "--output", "a_file/results"]), "a_file")
    judge_message("output is not writable", run(["case.prm", "--output", "/proc/results"]), "/proc/results")


def mistakes():
    for name, content in MESHES.items():
        write(f"{name}.msh", content)
    for name, content in STEPS.items():
        write(name, content)
    for name, content in STLS.items():
        with open(name, "wb") as file:
            file.write(content)
    judge_message("missing parameter file", run(["absent.prm"]), "absent.prm")
    judge_message("unknown command", run(["case.prm"], command="forge"), "forge")
    for name, (arguments, pattern) in MISTAKES.items():
        judge_message(name, run(["case.prm", "--output", "run", "--overwrite"] + arguments), pattern)
    write("unclosed.prm", CASE.rstrip()[:-3])
    judge_message("section not closed", run(["unclosed.prm"]), "unclosed.prm")


whole_runs.main({"case.prm": CASE}, (mistakes, any_line_ends, template, told, unlisted, on_two_ranks, announced, scaled_mesh, per_cent_of_zero, forbidden_output, interrupted,
                                     resumed, replaced, full_disk))
