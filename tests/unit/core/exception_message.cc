// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Whatever is thrown, a user reads one line with its four parts: of an Error those it has, of others what the
// library says without its stack.

#include <deal.II/base/exceptions.h>

#include <retroforge/core/error.h>
#include <retroforge/core/exception_message.h>

#include <algorithm>
#include <iostream>
#include <vector>

using namespace retroforge;

namespace
{
  template <typename Thrown>
  void tell(const Thrown &thrown)
  {
    const std::string message = message_of(std::make_exception_ptr(thrown));
    std::cout << message << "\n  separators: " << std::count(message.begin(), message.end(), ';') << '\n';
  }
} // namespace

int main()
{
  tell(Error("Press/stroke", "is -1", "it must be positive", "give its length"));
  tell(dealii::ExcMessage("first line\n    and second"));
  tell(std::runtime_error("no luck\nat all"));
  tell(-22);
  tell('x');
  try
  {
    std::vector<double> all;
    all.reserve(all.max_size());
  }
  catch (const std::exception &)
  {
    std::cout << message_of(std::current_exception()) << '\n';
  }
}
