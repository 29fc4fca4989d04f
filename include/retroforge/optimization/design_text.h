// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/design/design.h>

/// @file
/// Designs as text of a parameter file, read back to the same bits, and numbers with units for a reader.
namespace retroforge
{
  /// Returns a number with all its digits.
  std::string exact(double x);

  /// Returns what follows a number: ` UNIT`, or nothing where it has none.
  std::string after_number(const std::string &unit);

  /// Returns `NAME: VALUE, NAME: VALUE`, as Design/at has it.
  std::string values_by_name(const std::vector<DesignParameter> &parameters, const std::vector<double> &mu);

  /// Returns the lines of a parameter file that stand for a design.
  /// @param made_at  where the mesh was made, as in Design/meshed at; empty for that of the case
  std::string as_parameters(const std::string &design, const std::string &made_at);
} // namespace retroforge
