# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 The Retroforge authors
"""The include graph: what points backwards passes, what points forwards is named, and types that a file does not see."""
import unittest

from scripts import ScratchTest, call


class CheckIncludes(ScratchTest):
    def violations(self, path, line):
        self.write(path, f"#include <vector>\n{line}\n")
        result = call("check_includes", "--root", self.root)
        return result.returncode, result.stdout

    def test_allowed(self):
        self.write("source/main.cc", "#include <retroforge/simulation.h>\n")
        self.write("include/retroforge/simulation.h", "#include <retroforge/output/vtu.h>\n")
        status, said = self.violations("source/contact/gap.cc", "#include <retroforge/contact/gap.h>\n"
                                       "#include <retroforge/geometry/die.h>\n#include <retroforge/core/types.h>")
        self.assertEqual(status, 0, said)

    def test_forwards(self):
        status, said = self.violations("include/retroforge/geometry/die.h", "  #  include <retroforge/solver/newton.h>")
        self.assertEqual(status, 1)
        self.assertIn("include/retroforge/geometry/die.h:2: <retroforge/solver/newton.h>: geometry may not include solver",
                      said)

    def test_trilinos_in_one_place(self):
        for header in ("Epetra_Map.h", "deal.II/lac/trilinos_vector.h", "ml_MultiLevelPreconditioner.h"):
            status, said = self.violations("source/solver/newton.cc", f"#include <{header}>")
            self.assertEqual(status, 1)
            self.assertIn(f"source/solver/newton.cc:2: <{header}>: only linear_algebra knows Trilinos", said)
        status, said = self.violations("source/linear_algebra/node_matrix.cc", "#include <Epetra_Map.h>")
        self.assertNotIn("source/linear_algebra", said)

    def test_top_level_is_last(self):
        status, said = self.violations("source/output/vtu.cc", "#include <retroforge/simulation.h>")
        self.assertEqual(status, 1)
        self.assertIn("output may not include the top level", said)

    def test_unknown_module(self):
        self.assertIn("utilities/ is not a module", self.violations("source/utilities/a.cc", "")[1])

    def test_types_are_seen(self):
        self.write("include/retroforge/heat/skin.h", "namespace retroforge\n{\n  template <typename Number>\n  struct Skin\n  {\n"
                   "  };\n} // namespace retroforge\n")
        self.write("include/retroforge/steps/state.h", "#include <retroforge/heat/skin.h>\n")
        member = "  struct State\n  {\n    Skin<double> skin; // of it\n  };\n"
        status, said = self.violations("include/retroforge/steps/mechanics.h", member)
        self.assertEqual(status, 1)
        self.assertIn("include/retroforge/steps/mechanics.h:4: Skin: include <retroforge/heat/skin.h>", said)
        for first in ("#include <retroforge/steps/state.h>", "template <typename Number> struct Skin;"):
            status, said = self.violations("include/retroforge/steps/mechanics.h", first + "\n" + member)
            self.assertEqual(status, 0, said)
        status, said = self.violations("include/retroforge/steps/mechanics.h", '// Skin\nconst char *a = "Skin", *b = R"(\nSkin)";')
        self.assertEqual(status, 0, said)

    def test_quotes(self):
        self.assertIn("write <retroforge/module/file.h>", self.violations("source/core/a.cc", '#include "../a.h"')[1])


if __name__ == "__main__":
    unittest.main()
