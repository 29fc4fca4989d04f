// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/output/objective_map.h>
#include <retroforge/output/safe_file.h>

#include <sstream>

namespace retroforge
{
  std::string map_file(const std::string &objective)
  {
    return "map_" + as_identifier(objective) + ".csv";
  }

  void write_objective_map(const std::string  &file,
                           const std::string  &objective,
                           const std::string  &unit,
                           const ObjectiveMap &map)
  {
    AssertDimension(map.places.size(), map.values.size());
    std::ostringstream text;
    text.precision(17);
    text << "x [mm],y [mm],z [mm]," << objective << " [" << unit << "]\n";
    for (std::size_t i = 0; i < map.values.size(); ++i)
    {
      for (unsigned int c = 0; c < 3; ++c)
        text << map.places[i][c] << ',';
      text << map.values[i] << '\n';
    }
    write_file(file, text.str());
  }
} // namespace retroforge
