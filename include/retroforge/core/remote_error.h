// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>

namespace retroforge
{
  /// Returns the Error of another rank, from its message.
  Error remote_error(const std::string &message);
} // namespace retroforge
