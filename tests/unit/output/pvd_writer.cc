// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a time series lists its files after every call, with times that read back to the same bits, and a
// run that goes on drops what it is about to compute again.
#include <retroforge/core/error.h>
#include <retroforge/output/pvd_writer.h>
#include <retroforge/output/safe_file.h>

#include <filesystem>
#include <iostream>

using namespace retroforge;

int main()
{
  PvdWriter series("run.pvd");
  series.add(0., "step-0.vtu");
  std::cout << read_file("run.pvd") << '\n';
  series.add(1. / 3., "step-1.vtu");
  series.add(2. / 3., "a & b.vtu");

  PvdWriter continued = PvdWriter::continue_after("run.pvd", 1. / 3.);
  std::cout << "kept " << continued.steps().size()
            << ", times exact: " << (continued.steps().back().first == 1. / 3.) << '\n';
  continued.add(0.5, "a & b.vtu");
  const PvdWriter whole = PvdWriter::continue_after("run.pvd", 1.);
  for (const auto &[time, file] : whole.steps())
    std::cout << time << ' ' << file << '\n';
  std::cout << "no temporary file is left: " << !std::filesystem::exists("run.pvd.tmp") << '\n';

  write_file("broken.pvd", "<VTKFile><Collection>");
  try
  {
    PvdWriter::continue_after("broken.pvd", 1.);
  }
  catch (const Error &error)
  {
    std::cout << error.what() << '\n';
  }
}
