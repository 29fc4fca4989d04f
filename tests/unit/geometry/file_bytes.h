// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <fstream>
#include <sstream>
#include <string>

inline std::string bytes_of(const std::string &file)
{
  std::ifstream      in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

inline void write_bytes(const std::string &file, const std::string &bytes)
{
  std::ofstream(file, std::ios::binary) << bytes;
}
