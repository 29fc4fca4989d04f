// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Words by which parameter files name the values of an enum.
  template <typename Enum>
  using EnumWords = std::vector<std::pair<std::string, Enum>>;

  /// Returns the word that stands for a value.
  template <typename Enum>
  std::string word_of(const Enum value, const EnumWords<Enum> &words)
  {
    for (const auto &[word, meaning] : words)
      if (meaning == value)
        return word;
    AssertThrow(false, dealii::ExcMessage("no word stands for this value"));
    throw;
  }

  /// Declares a setting whose words stand for the values of an enum; its present value is the default.
  template <typename Enum>
  void add_enum(dealii::ParameterHandler &prm,
                const std::string        &entry,
                Enum                     &value,
                const EnumWords<Enum>    &words,
                const std::string        &documentation)
  {
    std::string all;
    for (const auto &[word, meaning] : words)
      all += (all.empty() ? "" : "|") + word;
    prm.declare_entry(entry, word_of(value, words), dealii::Patterns::Selection(all), documentation);
    prm.add_action(entry, [&value, words](const std::string &text) {
      for (const auto &[word, meaning] : words)
        if (word == text)
          value = meaning;
    });
  }
} // namespace retroforge
