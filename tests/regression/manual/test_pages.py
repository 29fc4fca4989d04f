# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""What pages say of cases, settings, commands and code is so:   test_pages.py PROGRAM

Scenes are excerpts of cases or run themselves; settings, options, scripts, files and names in the code exist; tables that a script prints
are as it prints them.
"""
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "contrib"), str(ROOT / "contrib/python"), str(ROOT / "tests/regression")]

import norton_hoff  # noqa: E402
from retroforge_manual import generated  # noqa: E402
import whole_runs  # noqa: E402

SHORT = {"Billet/element size": 15, "Press/stroke": 1, "Press/increments": 2, "Output/fields every": 0}

PAGES = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8")
         for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("doc/**/*.md")))}

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)
WORDS = re.compile(r"`([^`\n]+)`")


def program(*words):
    return whole_runs.start([whole_runs.PROGRAM, *map(str, words)])


def simulate(scene, settings):
    """Summary and last row of the history of a scene, in a folder that vanishes."""
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder, "scene.prm")
        case.write_text(scene, encoding="utf-8")
        words = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
        done = program("simulate", case, "--output", f"{folder}/results", *words)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        last = whole_runs.history_of(f"{folder}/results")[-1]
        return whole_runs.summary_of(f"{folder}/results"), {name: float(value) for name, value in last.items()}


def normal(text):
    """Lines without comments and superfluous blanks."""
    lines = (re.sub(r"\s+", " ", line.split("#")[0]).strip() for line in text.splitlines())
    return "\n" + "\n".join(line for line in lines if line) + "\n"


def is_scene(block):
    return "subsection Press" in block and "subsection Dies" in block


class Scenes(unittest.TestCase):
    def test_excerpts(self):
        cases = [normal(path.read_text(encoding="utf-8")) for path in ROOT.glob("prm/**/*.prm")]
        found = 0
        for page, text in PAGES.items():
            for language, block in BLOCK.findall(text):
                if language == "prm" or (not language and block.startswith("subsection") and not is_scene(block)):
                    found += 1
                    self.assertTrue(any(normal(block) in case for case in cases), f"{page}: no case has\n{block}")
        self.assertGreater(found, 1)

    def test_whole_scenes_run(self):
        scenes = [(page, block) for page, text in PAGES.items() for _, block in BLOCK.findall(text) if is_scene(block)]
        self.assertTrue(scenes)
        for page, scene in scenes:
            with self.subTest(page):
                summary, _ = simulate(scene, SHORT)
                self.assertEqual(summary["increments"], 2)
                self.assertGreater(summary["objectives"][0]["value"], 0)


class Names(unittest.TestCase):
    """What is named exists. Each test lists what does not."""

    @classmethod
    def setUpClass(cls):
        cls.settings = {f"{section}/{name}" for section, name, _ in generated.entries(program("--print-parameters").stdout)}
        cls.sections = {setting.split("/")[0].split(" ")[0] for setting in cls.settings}
        cls.usage = program("--help").stdout
        folders = ("include", "source", "contrib", "tests", "prm")
        files = [path for folder in folders for path in (ROOT / folder).rglob("*")
                 if path.suffix in {".h", ".cc", ".py", ".txt", ""} and path.is_file() and "manual" not in path.parts]
        cls.code = set(re.findall(r"\w+", "\n".join(path.read_text(encoding="utf-8", errors="replace") for path in files)))

    def words(self):
        """(page, code word) of all pages but for the rules, whose names are examples."""
        return [(page, word) for page, text in PAGES.items() if page != "CONTRIBUTING.md"
                for word in WORDS.findall(BLOCK.sub("", text))]

    def setting_of(self, word):
        """The setting that a word such as `Press/stroke = 10` or `Die NAME/scale` names; None where it names none."""
        section, slash, name = re.sub(r"\s*=.*", "", word).partition("/")
        kind = section.split(" ")[0]
        if not slash or kind not in self.sections or not re.fullmatch(r"[\w ]+", name):
            return None
        return {"Die": "Die lower", "Objective": "Objective energy"}.get(kind, section) + "/" + name

    def test_settings(self):
        named = [(page, self.setting_of(word)) for page, word in self.words()]
        self.assertGreater(len([setting for _, setting in named if setting]), 50)
        self.assertEqual([], [(page, setting) for page, setting in named if setting and setting not in self.settings])

    def problems_of_command(self, line):
        path = re.search(r"(build|contrib)/[\w./]+", line)[0]
        if path != "build/retroforge":
            return [] if (ROOT / path).is_file() else [path]
        cases = [case for case in re.findall(r"\bprm/\S+\.prm", line) if not (ROOT / case).is_file()]
        options = [option for option in re.findall(r"(?<= )--[\w-]+", line) if option not in self.usage]
        settings = [self.setting_of(word) for word in re.findall(r"--set ['\"]?([A-Z][^'\"=]*)=", line)]
        return cases + options + [setting for setting in settings if setting not in self.settings]

    def test_commands(self):
        lines = [(page, line.split(" #")[0]) for page, text in PAGES.items() for language, block in BLOCK.findall(text)
                 for line in block.splitlines() if not language and re.match(r"(mpirun -np \d+ )?(build|contrib)/\w", line)]
        self.assertGreater(len(lines), 15)
        self.assertEqual([], [(page, problem) for page, line in lines for problem in self.problems_of_command(line)])

    def test_files(self):
        """From the root, from a folder of the code, or from the page's own."""
        def exists(page, word):
            bases = (ROOT, ROOT / "include/retroforge", ROOT / "source", ROOT / "tests/unit", (ROOT / page).parent)
            return any((base / name).exists() for base in bases for name in (word, word + ".cc"))
        named = [(page, word) for page, word in self.words()
                 if re.fullmatch(r"(contrib|doc|include|prm|source|tests)/[\w./-]+|[\w./]+\.(h|cc|py)", word)]
        self.assertGreater(len(named), 50)
        self.assertEqual([], [(page, word) for page, word in named
                              if not exists(page, word) and ("/" in word or not any(ROOT.glob(f"[ipst]*/**/{word}")))])

    def test_code(self):
        """Classes and functions."""
        named = [(page, word) for page, word in self.words()
                 if re.fullmatch(r"([A-Z][a-z0-9]+){2,}|\w+(::\w+)+|[a-z]+(_[a-z]+)+(\(\))?", word)]
        self.assertGreater(len(named), 50)
        self.assertEqual([], [(page, word) for page, word in named if not set(re.findall(r"\w+", word)) <= self.code])


class Headers(unittest.TestCase):
    def test_comments_on_files(self):
        """A comment before the namespace is of the file (@file), or Doxygen takes it for the namespace's own."""
        wrong = [path.name for path in (ROOT / "include").rglob("*.h")
                 for match in [re.search(r"((?:^///.*\n)+)namespace retroforge", path.read_text(encoding="utf-8"), re.M)]
                 if match and not match[1].startswith("/// @file")]
        self.assertEqual(["types.h"], wrong)


class Materials(unittest.TestCase):
    page = PAGES["doc/manual/materials.md"]

    def test_table(self):
        self.assertIn(norton_hoff.table(), self.page, "run contrib/python/norton_hoff.py and renew the table")

    def test_friction_table(self):
        rows = re.findall(r"^\| m = ([\d.]+) \|(.*)\|$", self.page, re.M)
        self.assertEqual(len(rows), 3)
        for m, values in rows:
            computed = [f"{norton_hoff.friction_of_tresca(1., float(m), length, 1.):.2f}" for length in (1, 5, 10, 20, 50)]
            self.assertEqual(values.split(" | "), [" " + computed[0], *computed[1:-1], computed[-1] + " "])

    @staticmethod
    def convert(*words):
        return subprocess.run([sys.executable, "-B", ROOT / "contrib/python/norton_hoff.py", *words], capture_output=True, text=True,
                              check=False)

    def test_examples(self):
        """Each command is followed by what it prints."""
        examples = re.findall(r"^contrib/python/norton_hoff.py (.+)\n```\n\nprints `([^`]+)`", self.page, re.M)
        self.assertEqual(len(examples), 2)
        for words, printed in examples:
            self.assertEqual(self.convert(*words.split()).stdout.strip(), printed)

    def test_friction_by_hand(self):
        """A factor of sqrt(3) 0.1 2 at a slip of 10 mm times the strain rate; m of a flow stress that doubles in two decades."""
        done = self.convert("1:50", "100:100", "--coulomb", "0.1", "--pressure", "2", "--slip", "25", "--rate", "2.5")
        m = math.log(2) / math.log(100)
        self.assertEqual(done.stdout.splitlines()[1:], [f"friction {math.sqrt(3) * 0.2 * (math.sqrt(3) / 10) ** m:.4g} mm^-m"])

    def test_friction_refused(self):
        for words, said in (("--tresca 0.3 --length 10", "give m"), ("--m 0.14 --tresca 0.3", "give --length"),
                            ("--m 0.14 --tresca 0.3 --slip 25", "give --length"), ("--m 0.14", "name the friction"),
                            ("--m 0.14 --tresca 1.2 --length 10", "1.2 times the shear flow stress"),
                            ("--m 0.14 --coulomb 0.3 --pressure 3 --length 10", "1.56 times"),
                            ("1:50 1:60", "different strain rates"), ("--m 0 --tresca 0.3 --length 1", "0 is no positive number")):
            done = self.convert(*words.split())
            self.assertEqual(done.returncode, 2)
            self.assertIn(said, done.stderr)

    def test_limits(self):
        """The flow stresses of the page on what the model leaves out."""
        page = PAGES["doc/manual/limits.md"]

        def ratio(steel, temperature, strain):
            return norton_hoff.spittel(steel, temperature, strain, 10.) / norton_hoff.spittel(steel, 1100, 0.5, 10.)
        for steel, first in (("C45", "flow stress of C45 over that at 1100 °C"), ("S355J2", "S355J2")):
            for head, values in ((first, [ratio(steel, T, 0.5) for T in (900, 1000, 1050, 1150, 1200)]),
                                 (steel, [ratio(steel, 1100, strain) for strain in (0.05, 0.1, 0.2, 0.5, 1, 2)])):
                self.assertIn(" | ".join([f"| {head}", *(f"{value:.2f}" for value in values)]) + " |", page)

    def test_sources_agree(self):
        """Two published flow curves of a steel with 0.45 % carbon."""
        for temperature in (1000, 1100, 1200):
            for rate in (1., 10.):
                ratio = (norton_hoff.shida(0.45, temperature, 0.5, rate) / norton_hoff.spittel("C45", temperature, 0.5, rate))
                self.assertAlmostEqual(ratio, 1., delta=0.12)

    def test_flow_stress_of_the_program(self):
        """A cube between flat dies without friction: force over area is the flow stress that K and m came from."""
        K, m = norton_hoff.law_through(1., 75.7, 10., 110.7)
        law = {"Material": {"consistency": K, "strain rate sensitivity": m}, "Remeshing": {"when": "never"},
               **{f"Die {name}": {"friction": 0} for name in ("lower", "upper")}}
        scene = whole_runs.prm(whole_runs.changed(whole_runs.cube(20, 10, 0.2, 1), law))
        _, last = simulate(scene, {"Output/fields every": 0})
        height = 19.9  # in the middle of the increment, where the force is taken
        area, rate = 20. * 20. * 20. / height, 100. / height
        expected = norton_hoff.flow_stress(K, m, rate)
        self.assertAlmostEqual(expected, 75.7 * rate**m, delta=1e-9 * expected)
        self.assertAlmostEqual(last["whole_force"] / area / expected, 1., delta=1e-4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
