// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>

namespace retroforge
{
  /// Sets what the program says on the error stream when it is stopped from now on (Ctrl-C, a signal to end,
  /// a closed terminal), before it ends as it would have. Signals that are ignored stay ignored.
  void set_interrupt_message(const std::string &text);
} // namespace retroforge
