// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/path_objective.h>

namespace retroforge
{
  /// Returns the name of the file that shows where an objective's value comes from.
  std::string map_file(const std::string &objective);

  /// Writes places and values as a table, all digits:  x,y,z [mm], and a column named by the objective and its unit.
  /// @throws Error  if the file cannot be written
  void write_objective_map(const std::string  &file,
                           const std::string  &objective,
                           const std::string  &unit,
                           const ObjectiveMap &map);
} // namespace retroforge
