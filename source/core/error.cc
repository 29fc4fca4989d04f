// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    /// Bytes of the character that begins at `place`; 0 for a control character or what is not UTF-8.
    std::size_t character_bytes(const std::string &text, const std::size_t place)
    {
      const auto          byte  = [&](const std::size_t i) { return static_cast<unsigned char>(text[i]); };
      const unsigned char first = byte(place);
      if (first < 0x80)
        return first >= ' ' && first != 0x7f ? 1 : 0;
      const std::size_t bytes = first >= 0xf5   ? 0
                                : first >= 0xf0 ? 4
                                : first >= 0xe0 ? 3
                                : first >= 0xc2 ? 2
                                                : 0;
      if (place + bytes > text.size())
        return 0;
      for (std::size_t i = 1; i < bytes; ++i)
        if ((byte(place + i) & 0xc0) != 0x80)
          return 0;
      if (bytes > 0)
      {
        const unsigned char second    = byte(place + 1);
        const bool          control   = first == 0xc2 && second < 0xa0;
        const bool          overlong  = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
        const bool          surrogate = first == 0xed && second >= 0xa0;
        const bool          too_large = first == 0xf4 && second >= 0x90;
        if (control || overlong || surrogate || too_large)
          return 0;
      }
      return bytes;
    }

    std::string clean(const std::string &text)
    {
      std::string cleaned;
      for (std::size_t place = 0; place < text.size();)
      {
        const std::size_t bytes = character_bytes(text, place);
        cleaned +=
          bytes == 0 ? (text[place] == '\n' || text[place] == '\t' ? " " : "?") : text.substr(place, bytes);
        place += std::max<std::size_t>(bytes, 1);
      }
      return cleaned;
    }

    /// Long parts are lists of names, or quote what a file holds.
    std::string shortened(const std::string &text, const std::size_t most)
    {
      return text.size() <= most ? text : clean(text.substr(0, most)) + " ...";
    }
  } // namespace

  bool is_plain_text(const std::string &text)
  {
    for (std::size_t place = 0; place < text.size();)
    {
      const std::size_t bytes = text[place] == '\t' ? 1 : character_bytes(text, place);
      if (bytes == 0)
        return false;
      place += bytes;
    }
    return true;
  }

  std::string legible(const std::string &text)
  {
    return clean(shortened(text, 300));
  }

  Error::Error(const std::string &where,
               const std::string &what,
               const std::string &rule,
               const std::string &remedy)
      : std::runtime_error(legible(where) + ": " + clean(shortened(what, 2000)) + "; " +
                           clean(shortened(rule, 2000)) + "; " + clean(shortened(remedy, 2000)))
  {
  }

  Error Error::or_else(const std::string &remedy) const
  {
    return Error(what() + ("; or " + clean(shortened(remedy, 2000))));
  }

  Error Error::in_setting(const std::string &setting) const
  {
    return Error(legible(setting) + ": " + what());
  }
} // namespace retroforge
