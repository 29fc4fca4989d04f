// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: times are inclusive by name. The outer scope holds two inner ones of 20 ms; a name nested in itself
// counts once; an open scope counts already.
#include <retroforge/core/timer.h>

#include <iostream>
#include <thread>

using namespace retroforge;

void wait()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

int main()
{
  Timings    timings;
  const auto start = std::chrono::steady_clock::now();
  {
    const auto outer = timings.scope("outer");
    for (int i = 0; i < 2; ++i)
    {
      const auto inner = timings.scope("inner");
      wait();
    }
    const auto again = timings.scope("outer");
    wait();
    std::cout << "open scopes count: " << (timings.seconds("outer") >= 0.06) << '\n';
  }
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double outer = timings.seconds("outer"), inner = timings.seconds("inner");
  std::cout << "names: " << timings.all().size() << ", unknown name: " << timings.seconds("other") << '\n'
            << "inner holds its two waits: " << (inner >= 0.04) << '\n'
            << "outer holds all three, once: " << (outer >= inner + 0.02 && outer <= elapsed) << '\n';
  wait();
  std::cout << "closed scopes stand still: " << (timings.all().at("outer") == outer) << '\n';
}
