// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace retroforge
{
  /// A number that other bytes hardly share: FNV-1a, 64 bits.
  struct Fingerprint
  {
    std::uint64_t value = 0xcbf29ce484222325u;

    void add(const void *data, const std::size_t size)
    {
      const auto *bytes = static_cast<const unsigned char *>(data);
      for (std::size_t i = 0; i < size; ++i)
        value = (value ^ bytes[i]) * 0x100000001b3u;
    }
  };
} // namespace retroforge
