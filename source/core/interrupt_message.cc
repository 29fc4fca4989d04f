// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/interrupt_message.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <unistd.h>

namespace retroforge
{
  namespace
  {
    std::array<char, 1000> notice; // no memory may be asked for in a handler

    void tell_and_end(const int signal)
    {
      [[maybe_unused]] const auto written = write(STDERR_FILENO, notice.data(), std::strlen(notice.data()));
      std::signal(signal, SIG_DFL);
      std::raise(signal);
    }
  } // namespace

  void set_interrupt_message(const std::string &text)
  {
    const std::string line = "\nretroforge: " + text + "\n";
    notice.fill('\0');
    std::copy_n(line.begin(), std::min(line.size(), notice.size() - 1), notice.begin());
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
      if (std::signal(signal, tell_and_end) == SIG_IGN)
        std::signal(signal, SIG_IGN);
  }
} // namespace retroforge
