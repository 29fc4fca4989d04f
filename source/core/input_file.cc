// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/input_file.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace retroforge
{
  namespace
  {
    bool has_prefix(const std::string &bytes, const std::string &with)
    {
      return bytes.compare(0, with.size(), with) == 0;
    }

    /// @param high  where of each pair of bytes the higher one stands
    std::string from_utf_16(const std::string &bytes, const unsigned int high)
    {
      std::string text;
      for (std::size_t i = 2; i + 1 < bytes.size(); i += 2)
      {
        const char low = bytes[i + 1 - high];
        text.push_back(bytes[i + high] == 0 && static_cast<unsigned char>(low) < 0x80 ? low : '?');
      }
      return text;
    }
  } // namespace

  std::string read_input_file(const std::string &file_name, const std::string &meaning)
  {
    std::ifstream      in(file_name, std::ios::binary);
    std::ostringstream bytes;
    std::error_code    ignored;
    const bool         is_folder = std::filesystem::is_directory(file_name, ignored);
    const bool         is_device = std::filesystem::is_character_file(file_name, ignored);
    if (!in || is_folder || is_device || (in.peek() != EOF && !(bytes << in.rdbuf())))
      throw Error(file_name,
                  is_folder   ? "is a folder"
                  : is_device ? "is a device"
                              : "cannot be read",
                  meaning + " must exist",
                  "correct its name, which counts from the parameter file's folder, or from where the "
                  "program is started");
    return bytes.str();
  }

  bool has_length_of_binary_stl(const std::string &bytes)
  {
    if (bytes.size() < 84)
      return false;
    std::size_t n = 0;
    for (unsigned int i = 4; i-- > 0;)
      n = 256 * n + static_cast<unsigned char>(bytes[80 + i]);
    return bytes.size() == 84 + 50 * n;
  }

  std::string as_plain_lines(std::string bytes)
  {
    if (has_prefix(bytes, "\xef\xbb\xbf"))
      bytes.erase(0, 3);
    else if (has_prefix(bytes, "\xff\xfe"))
      bytes = from_utf_16(bytes, 1);
    else if (has_prefix(bytes, "\xfe\xff"))
      bytes = from_utf_16(bytes, 0);
    if (bytes.find('\n') == std::string::npos)
      std::replace(bytes.begin(), bytes.end(), '\r', '\n');
    return bytes;
  }
} // namespace retroforge
