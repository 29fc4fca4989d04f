// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/hdf5_tools.h>
#include <retroforge/remeshing/position_tape.h>

namespace retroforge
{
  /// Writes how the positions of a new mesh follow from the old ones.
  void write_tape(hid_t group, const PositionTape &tape);

  /// Reads it. What it refers to is not looked at, see PositionTape::defect(). Throws hdf5::Failure.
  PositionTape read_tape(hid_t group);
} // namespace retroforge
