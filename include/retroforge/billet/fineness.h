// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/billet.h>

namespace retroforge
{
  /// Tetrahedra that fill a volume: about 8 per cube of the element size.
  inline double expected_cells(const double volume, const double element_size)
  {
    return 8. * volume / (element_size * element_size * element_size);
  }

  /// Volume of a billet that is meshed here, by its measures and before cuts [mm^3]; 0 of one from a file.
  double whole_volume(const BilletParameters &parameters);

  /// Tetrahedra of a billet that is meshed here, as a whole; 0 of one from a file.
  double expected_cells(const BilletParameters &parameters);
} // namespace retroforge
