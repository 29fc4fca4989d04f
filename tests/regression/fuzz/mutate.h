// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "fuzz.h"

#include <algorithm>
#include <cstring>
#include <vector>

/// Damage to files.
namespace fuzz
{
  inline const std::vector<std::string> nasty_words = {"0",
                                                       "-0",
                                                       "1",
                                                       "-1",
                                                       "2",
                                                       "7",
                                                       "1.5",
                                                       "1000000",
                                                       "2147483647",
                                                       "2147483648",
                                                       "-2147483649",
                                                       "4294967295",
                                                       "4294967296",
                                                       "9223372036854775807",
                                                       "18446744073709551615",
                                                       "99999999999999999999999",
                                                       "1e-320",
                                                       "1e-30",
                                                       "1e30",
                                                       "1e154",
                                                       "1e308",
                                                       "-1e308",
                                                       "1e999",
                                                       "nan",
                                                       "-inf",
                                                       "inf",
                                                       "0x10",
                                                       "1e",
                                                       "--1",
                                                       "1,5",
                                                       "\"",
                                                       "$End",
                                                       "",
                                                       "\xff\xfe",
                                                       "\xc3\xa9",
                                                       "\x1b[2J"};

  inline const std::vector<std::uint64_t> nasty_integers = {0,
                                                            1,
                                                            2,
                                                            5,
                                                            0x7f,
                                                            0x10000,
                                                            0x7fffffff,
                                                            0x80000000,
                                                            0xffffffff,
                                                            0x100000000,
                                                            0x7ff0000000000000,
                                                            0x7ff8000000000000,
                                                            0x7fefffffffffffff,
                                                            0x7f800000,
                                                            0x7fc00000,
                                                            0x7fffffffffffffff,
                                                            0x8000000000000000,
                                                            0xffffffffffffffff};

  struct Range
  {
    std::size_t begin = 0, end = 0;
  };

  inline Range some_range(const std::string &bytes, Random &random)
  {
    const std::size_t begin = random.below(bytes.size() + 1);
    const std::size_t most  = random.below(2) == 0 ? 16 : bytes.size();
    return {begin, std::min(bytes.size(), begin + random.below(most + 1))};
  }

  /// A line with its end, and up to `more` lines after it.
  inline Range some_lines(const std::string &bytes, Random &random, const std::size_t more = 0)
  {
    Range             lines;
    const std::size_t place = random.below(bytes.size());
    const std::size_t end   = place == 0 ? std::string::npos : bytes.rfind('\n', place - 1);
    lines.begin = lines.end = end == std::string::npos ? 0 : end + 1;
    for (std::size_t i = 0; i < 1 + random.below(more + 1) && lines.end < bytes.size(); ++i)
      lines.end = std::min(bytes.find('\n', lines.end), bytes.size() - 1) + 1;
    return lines;
  }

  inline bool is_in_word(const char c)
  {
    return static_cast<unsigned char>(c) > ' ' && c != ',' && c != ';' && c != '"' && c != '=';
  }

  inline Range some_word(const std::string &bytes, Random &random)
  {
    Range word;
    word.begin = random.below(bytes.size());
    while (word.begin + 1 < bytes.size() && !is_in_word(bytes[word.begin]))
      ++word.begin;
    while (word.begin > 0 && is_in_word(bytes[word.begin - 1]))
      --word.begin;
    for (word.end = word.begin; word.end < bytes.size() && is_in_word(bytes[word.end]);)
      ++word.end;
    return word;
  }

  inline std::string part(const std::string &bytes, const Range &range)
  {
    return bytes.substr(range.begin, range.end - range.begin);
  }

  inline void replace(std::string &bytes, const Range &range, const std::string &by)
  {
    bytes.replace(range.begin, range.end - range.begin, by);
  }

  inline void exchange(std::string &bytes, Range a, Range b)
  {
    if (a.begin > b.begin)
      std::swap(a, b);
    if (a.end > b.begin)
      return;
    const std::string first = part(bytes, a), second = part(bytes, b);
    replace(bytes, b, first);
    replace(bytes, a, second);
  }

  inline void change_line_ends(std::string &bytes, Random &random)
  {
    const std::vector<std::string> ends = {"\r\n", "\r", "\n\n", " \n"};
    const std::string              end  = random.one_of(ends);
    const std::size_t              some = 1 + random.below(3);
    std::string                    changed;
    for (const char c : bytes)
      changed += c == '\n' && random.below(some) == 0 ? end : std::string(1, c);
    bytes = changed;
  }

  inline void overwrite(std::string &bytes, Random &random)
  {
    const std::uint64_t value = random.one_of(nasty_integers);
    const std::size_t   size  = random.below(2) == 0 ? 4 : 8;
    const std::size_t   place = random.below(bytes.size());
    std::memcpy(&bytes[place], &value, std::min(size, bytes.size() - place)); // little endian, as the files
  }

  inline void insert_noise(std::string &bytes, Random &random)
  {
    std::string noise(1 + random.below(40), '\0');
    if (random.below(2) == 0)
      for (char &c : noise)
        c = static_cast<char>(random.below(256));
    bytes.insert(random.below(bytes.size() + 1), noise);
  }

  inline void repeat(std::string &bytes, const Range &range, const std::size_t times)
  {
    const std::string once = part(bytes, range);
    std::string       many;
    for (std::size_t i = 0; i < times && many.size() < 1000000; ++i)
      many += once;
    bytes.insert(range.end, many);
  }

  inline void mutate_once(std::string &bytes, Random &random)
  {
    if (bytes.empty())
      return;
    const std::size_t place = random.below(bytes.size());
    switch (random.below(20))
    {
      case 0:
        bytes[place] = static_cast<char>(bytes[place] ^ (1 << random.below(8)));
        break;
      case 1:
        bytes[place] = static_cast<char>(random.below(256));
        break;
      case 2:
        bytes.resize(place);
        break;
      case 3:
        bytes.resize(some_lines(bytes, random).begin);
        break;
      case 4:
        replace(bytes, some_range(bytes, random), "");
        break;
      case 5:
        repeat(bytes, some_range(bytes, random), 1);
        break;
      case 6:
        repeat(bytes, some_lines(bytes, random, 5), 1);
        break;
      case 7:
        replace(bytes, some_lines(bytes, random), "");
        break;
      case 8:
        replace(bytes, some_lines(bytes, random, 20), "");
        break;
      case 9:
        exchange(bytes, some_lines(bytes, random, 5), some_lines(bytes, random, 5));
        break;
      case 10:
        exchange(bytes, some_word(bytes, random), some_word(bytes, random));
        break;
      case 11:
        change_line_ends(bytes, random);
        break;
      case 12:
        insert_noise(bytes, random);
        break;
      case 13:
        overwrite(bytes, random);
        break;
      case 14:
        bytes.insert(place, random.one_of(nasty_words));
        break;
      case 15:
        bytes += part(bytes, some_range(bytes, random));
        break;
      case 16:
        repeat(bytes,
               random.below(2) == 0 ? some_word(bytes, random) : some_lines(bytes, random),
               1 + random.below(50000));
        break;
      default: // the likeliest to get past the first checks
        replace(bytes, some_word(bytes, random), random.one_of(nasty_words));
    }
  }

  /// One to three kinds of damage: flipped, overwritten, lost, doubled and exchanged bytes, words and lines,
  /// numbers that are too large, negative, not finite or missing, other line ends, noise, repetition.
  inline std::string mutate(std::string bytes, Random &random)
  {
    const std::size_t n = random.below(3) == 0 ? 1 + random.below(3) : 1;
    for (std::size_t i = 0; i < n; ++i)
      mutate_once(bytes, random);
    return bytes;
  }
} // namespace fuzz
