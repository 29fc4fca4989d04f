// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/remote_error.h>

namespace retroforge
{
  Error remote_error(const std::string &message)
  {
    // The four parts are found again by their separators.
    const auto third  = message.rfind("; ");
    const auto second = message.rfind("; ", third - 1);
    const auto first  = message.find(": ");
    return Error(message.substr(0, first),
                 message.substr(first + 2, second - first - 2),
                 message.substr(second + 2, third - second - 2),
                 message.substr(third + 2));
  }
} // namespace retroforge
