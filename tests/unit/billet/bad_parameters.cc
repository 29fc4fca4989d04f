// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Wrong input for a billet is refused with the parameter's path, the value, the rule and a remedy.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

using namespace retroforge;

void refuse(const std::vector<std::pair<std::string, std::string>> &entries)
{
  std::string title;
  for (const auto &[name, value] : entries)
    title += (title.empty() ? "" : ", ") + name + " = " + value;
  print_error(title, [&]() { billet(entries); });
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  refuse({{"size", "50, -1, 50"}});
  refuse({{"shape", "cylinder"}, {"radius", "0"}});
  refuse({{"shape", "cylinder"}, {"height", "0"}});
  refuse({{"element size", "0"}});
  refuse({{"element size", "0.001"}});
  refuse({{"symmetry planes", "0, 0, 0"}});
  refuse({{"symmetry planes", "1, 0, 0; 2, 0, 0"}});
  refuse({{"symmetry planes", "1, 0, 0; -1, 0, 0"}});
  refuse({{"symmetry planes", "0, 0, 1"}});
  refuse({{"symmetry planes", "1, 0, 0"}, {"symmetry point", "100, 0, 0"}});
  refuse({{"symmetry planes", "1, 0, 0"}, {"symmetry point", "top"}});
  refuse({{"symmetry point", "1, 2"}});
  refuse({{"sector angle", "60"}});
  refuse({{"shape", "cylinder"}, {"sector angle", "181"}});
  refuse({{"shape", "cylinder"}, {"sector angle", "90"}, {"symmetry planes", "-1, 0, 0"}});
  refuse({{"shape", "file"}});
  refuse({{"shape", "file"}, {"file name", "a.msh"}, {"symmetry planes", "1, 0, 0"}});
  refuse({{"symmetry patches", "left"}});
  refuse({{"rotation axis", "0, 0, 0"}, {"rotation angle", "5"}});
}
