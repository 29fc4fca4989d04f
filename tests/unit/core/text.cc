// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Numbers in messages keep their first digits however small or large they are.

#include <retroforge/core/text.h>

#include <iostream>

int main()
{
  const auto is = [](const double x, const char *text) { return retroforge::as_text(x) == text; };
  std::cout << is(1e-7, "1e-07") << is(0.1, "0.1") << is(2., "2") << is(1e30, "1e+30")
            << is(-1. / 3., "-0.333333") << '\n';
}
