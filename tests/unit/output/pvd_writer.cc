// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a time series lists its files after every call, with times of all digits and the parts of a time
// numbered.
#include <retroforge/output/pvd_writer.h>
#include <retroforge/output/safe_file.h>

#include <filesystem>
#include <iostream>

using namespace retroforge;

int main()
{
  PvdWriter series("run.pvd");
  series.add(0., {{"workpiece", "step-0.vtu"}});
  std::cout << read_file("run.pvd") << '\n';
  series.add(1. / 3., {{"workpiece", "step-1.vtu"}, {"die upper", "die_upper_000000.vtu"}});
  series.add(2. / 3., {{"workpiece", "replaced.vtu"}});
  series.add(2. / 3., {{"workpiece", "a & b.vtu"}});

  std::cout << read_file("run.pvd") << '\n';
  std::cout << "no temporary file is left: " << !std::filesystem::exists("run.pvd.tmp") << '\n';
}
