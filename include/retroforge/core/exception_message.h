// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <exception>
#include <string>

namespace retroforge
{
  /// Returns the message of an exception for users, on one line: `where: what; rule; remedy`. Exceptions that
  /// are no Error come from libraries, which know nothing of the case.
  std::string message_of(const std::exception_ptr &exception);
} // namespace retroforge
