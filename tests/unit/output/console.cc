// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Ranks are warned of beside other programs where there are fewer cores than both want, and one rank never.

#include <retroforge/output/console.h>

#include <iostream>

using namespace retroforge;

int main()
{
  std::cout << "idle: [" << note_on_load(2, 0.3, 2) << "]\n"
            << "busy: [" << note_on_load(2, 1.5, 2) << "]\n"
            << "more ranks than cores: [" << note_on_load(4, 0., 2) << "]\n"
            << "one rank: [" << note_on_load(1, 7., 2) << "]\n"
            << "many cores: [" << note_on_load(4, 3., 8) << "]\n";
}
