// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/nearest_name.h>

#include <algorithm>
#include <cctype>

namespace retroforge
{
  namespace
  {
    bool same_letter(const char a, const char b)
    {
      return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    }
  } // namespace

  unsigned int edit_distance(const std::string &a, const std::string &b)
  {
    // d[i][j]: distance of the first i letters of a to the first j of b
    std::vector<std::vector<unsigned int>> d(a.size() + 1, std::vector<unsigned int>(b.size() + 1));
    for (unsigned int i = 0; i <= a.size(); ++i)
      for (unsigned int j = 0; j <= b.size(); ++j)
      {
        if (i == 0 || j == 0)
        {
          d[i][j] = i + j;
          continue;
        }
        const bool same = same_letter(a[i - 1], b[j - 1]);
        d[i][j]         = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
        if (i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) && same_letter(a[i - 2], b[j - 1]))
          d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    return d[a.size()][b.size()];
  }

  std::string nearest_name(const std::string              &wrong,
                           const std::vector<std::string> &known,
                           const unsigned int              max_distance)
  {
    std::string  best;
    unsigned int best_distance = max_distance + 1;
    for (const std::string &name : known)
    {
      // Too different in length: not worth the products of lengths that the distance costs.
      if (std::max(wrong.size(), name.size()) - std::min(wrong.size(), name.size()) > max_distance)
        continue;
      if (const unsigned int distance = edit_distance(wrong, name); distance < best_distance)
      {
        best          = name;
        best_distance = distance;
      }
    }
    return best;
  }

  unsigned int tolerated_edits(const std::string &word)
  {
    return std::max<unsigned int>(2, word.size() / 3);
  }

  std::string join(const std::vector<std::string> &words)
  {
    std::string text;
    for (const std::string &word : words)
      text += (text.empty() ? "" : ", ") + word;
    return text;
  }
} // namespace retroforge
