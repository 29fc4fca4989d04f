# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The scorecard reports what a command printed, and fails when a bar is missed or a figure is absent."""
import json
import unittest

from scripts import ScratchTest, call

DRIVER = """import pathlib, sys
with open("runs", "a") as runs: runs.write("x")
print("some other output")
print("FIGURE error 2e-10")
print("FIGURE order 1.99")
print("FIGURE broken nan")
print("FIGURE word many")
sys.exit(int(sys.argv[1]))
"""


class Scorecard(ScratchTest):
    def case(self, rows, status=0, name="verification/cube", **others):
        self.write(f"prm/{name}/driver.py", DRIVER)
        content = {"command": ["{python}", "{case}/driver.py", str(status)], "label": "quick", "rows": rows, **others}
        self.write(f"prm/{name}/scorecard.json", json.dumps(content))

    def run_it(self, *arguments):
        return call("scorecard", "--root", self.root, *arguments)

    def test_rows_reached_share_one_run(self):
        self.case([{"name": "error", "what": "the error", "at most": 1e-9},
                   {"name": "order", "what": "the order", "at least": 1.95, "thesis": "none"}])
        result = self.run_it()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertRegex(result.stdout, r"verification/cube +the error +2e-10 +at most 1e-09 +reached")
        self.assertIn("2 of 2 reached", result.stdout)
        self.assertEqual((self.root / "results/scorecard/verification/cube/runs").read_text(), "x")

    def test_results_elsewhere(self):
        self.case([{"name": "error", "what": "the error", "at most": 1e-9}])
        result = self.run_it("--output", self.root / "elsewhere")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertTrue((self.root / "elsewhere/verification/cube/runs").is_file())
        self.assertFalse((self.root / "results").exists())

    def test_rows_missed(self):
        for name, bar, said in (("error", {"at most": 1e-10}, "NOT REACHED"), ("order", {"at least": 2}, "NOT REACHED"),
                                ("broken", {"at most": 1}, "NOT REACHED"), ("broken", {"at least": 1}, "NOT REACHED"),
                                ("word", {"at most": 1}, "is not a number"), ("absent", {"at most": 1}, "no line FIGURE")):
            with self.subTest(name=name, bar=bar):
                self.case([{"name": name, "what": "w", **bar}])
                result = self.run_it()
                self.assertEqual(result.returncode, 1)
                self.assertIn(said, result.stdout)

    def test_a_failing_command_reaches_nothing(self):
        self.case([{"name": "error", "what": "the error", "at most": 1}], status=3)
        result = self.run_it()
        self.assertEqual(result.returncode, 1)
        self.assertIn("NOT REACHED (exit status 3", result.stdout)

    def test_a_missing_program(self):
        self.case([{"name": "error", "what": "w", "at most": 1, "command": ["{build}/nothing"]}])
        result = self.run_it()
        self.assertEqual(result.returncode, 1)
        self.assertIn("No such file", result.stdout)

    def test_selection_and_table(self):
        self.case([{"name": "error", "what": "quick one", "at most": 1},
                   {"name": "order", "what": "slow one", "at most": 1, "label": "slow"}])
        self.case([{"name": "error", "what": "another", "at most": 1}], name="reproduction/thesis/table_4")
        self.assertEqual(len(self.run_it("--list").stdout.splitlines()), 3)
        self.assertEqual(len(self.run_it("--list", "--quick").stdout.splitlines()), 2)
        self.assertEqual(len(self.run_it("--list", "table_4").stdout.splitlines()), 1)
        result = self.run_it("--quick", "--write", self.root / "table.md")
        self.assertEqual(result.returncode, 0)
        table = (self.root / "table.md").read_text()
        self.assertIn("| verification/cube | quick one | 2e-10 | at most 1 |  | reached |", table)
        self.assertIn("| slow one | - | at most 1 |  | not run |  |", table)

    def test_bad_input(self):
        for row, said in (({"name": "a", "what": "w", "at most": 1, "atleast": 2}, "unknown ['atleast']"),
                          ({"name": "a", "what": "w"}, 'either "at most" or "at least"'),
                          ({"name": "a", "what": "w", "at most": "1"}, "must be a number"),
                          ({"name": "a", "what": "w", "at most": 1, "label": "fast"}, "quick or slow")):
            with self.subTest(row=row):
                self.case([row])
                result = self.run_it()
                self.assertEqual(result.returncode, 1)
                self.assertIn(said, result.stderr)

    def test_nothing_selected_is_no_success(self):
        self.assertEqual(self.run_it().returncode, 1)


if __name__ == "__main__":
    unittest.main()
