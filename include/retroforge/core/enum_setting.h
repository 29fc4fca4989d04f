// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Declares a setting whose words stand for the values of an enum; its present value is the default.
  template <typename Enum>
  void add_enum(dealii::ParameterHandler                        &prm,
                const std::string                               &entry,
                Enum                                            &value,
                const std::vector<std::pair<std::string, Enum>> &words,
                const std::string                               &documentation)
  {
    std::string all, present;
    for (const auto &[word, meaning] : words)
    {
      all += (all.empty() ? "" : "|") + word;
      if (meaning == value)
        present = word;
    }
    prm.declare_entry(entry, present, dealii::Patterns::Selection(all), documentation);
    prm.add_action(entry, [&value, words](const std::string &text) {
      for (const auto &[word, meaning] : words)
        if (word == text)
          value = meaning;
    });
  }
} // namespace retroforge
