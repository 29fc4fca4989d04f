// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace retroforge
{
  /// Variables of the environment, `NAME=value` each.
  std::vector<std::string> environment_now();

  /// A program with its arguments, and the file that gets what it prints.
  struct ChildProcess
  {
    std::vector<std::string> command;
    std::string              log;
  };

  /// How a program ended.
  struct ExitStatus
  {
    int    status  = 0; ///< 0: all is well
    int    signal  = 0; ///< that ended it, or 0
    double seconds = 0.;
  };

  /// Runs programs side by side, in the order given, at most `at_a_time` at once. Where this program is
  /// interrupted or terminated, or `finished` throws, those that still run are terminated too.
  /// @param finished  called as each ends, in the order of their ends
  /// @throws Error  where one cannot be started
  void run_side_by_side(const std::vector<ChildProcess>                            &processes,
                        const std::vector<std::string>                             &environment,
                        unsigned int                                                at_a_time,
                        const std::function<void(std::size_t, const ExitStatus &)> &finished);
} // namespace retroforge
