// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/optimization/linear_relation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace retroforge
{
  namespace
  {
    const char *const entry = "Optimisation/relations";

    std::string trimmed(const std::string &text)
    {
      const std::size_t begin = text.find_first_not_of(" \t*"), end = text.find_last_not_of(" \t*");
      return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
    }

    /// sum_j weights_j mu_j + constant
    struct LinearForm
    {
      std::vector<double> weights;
      double              constant = 0.;
    };

    [[noreturn]] void
    refuse_name(const std::string &text, const std::string &name, const std::vector<std::string> &names)
    {
      const std::string near = nearest_name(name, names, tolerated_edits(name));
      throw Error(entry,
                  "'" + text + "' has '" + name + "', which this optimisation does not vary",
                  "it varies " + join(names),
                  near.empty() ? "name some of these" : "did you mean '" + near + "'?");
    }

    [[noreturn]] void refuse_form(const std::string &text, const std::string &found)
    {
      throw Error(entry,
                  "'" + text + "' " + found,
                  "a relation is `2 NAME - NAME <= 5', with one of <=, >=, =, and spaces around + and -",
                  "write it so");
    }

    void add_term(const std::string              &text,
                  const std::string              &term,
                  const double                    sign,
                  const std::vector<std::string> &names,
                  LinearForm                     &form)
    {
      const std::string word = trimmed(term);
      if (word.empty())
        refuse_form(text, "has a term that is empty");
      char             *end    = nullptr;
      const double      number = std::strtod(word.c_str(), &end);
      const std::string name   = trimmed(end);
      const double      factor = sign * (end == word.c_str() ? 1. : number);
      if (!std::isfinite(factor))
        refuse_form(text, "has a number that is not finite");
      if (name.empty())
      {
        form.constant += factor;
        return;
      }
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end())
        refuse_name(text, name, names);
      form.weights[found - names.begin()] += factor;
    }

    LinearForm
    read_side(const std::string &text, const std::string &side, const std::vector<std::string> &names)
    {
      LinearForm        form{std::vector<double>(names.size(), 0.), 0.};
      const std::string spaced = " " + trimmed(side);
      double            sign   = 1.;
      std::size_t       begin  = 0;
      if (spaced.size() > 1 && spaced[1] == '-')
      {
        sign  = -1.;
        begin = 2;
      }
      while (true)
      {
        const std::size_t end = std::min(spaced.find(" + ", begin), spaced.find(" - ", begin));
        add_term(text, spaced.substr(begin, end - begin), sign, names, form);
        if (end == std::string::npos)
          return form;
        sign  = spaced[end + 1] == '+' ? 1. : -1.;
        begin = end + 3;
      }
    }
  } // namespace

  double LinearRelation::value(const std::vector<double> &mu) const
  {
    AssertDimension(mu.size(), weights.size());
    double sum = 0.;
    for (std::size_t j = 0; j < mu.size(); ++j)
      sum += weights[j] * mu[j];
    return sum;
  }

  double LinearRelation::excess(const std::vector<double> &mu) const
  {
    const double at = value(mu);
    return std::max({lower - at, at - upper, 0.});
  }

  LinearRelation read_relation(const std::string &text, const std::vector<std::string> &names)
  {
    const std::size_t sign = text.find_first_of("<>=");
    if (sign == std::string::npos)
      refuse_form(text, "has no <=, >= or =");
    const std::size_t length = text[sign] == '=' ? 1 : 2;
    if (length == 2 && (sign + 1 == text.size() || text[sign + 1] != '='))
      refuse_form(text, "has no = after " + text.substr(sign, 1));
    if (text.find_first_of("<>=", sign + length) != std::string::npos)
      refuse_form(text, "compares twice");
    LinearForm       left  = read_side(text, text.substr(0, sign), names);
    const LinearForm right = read_side(text, text.substr(sign + length), names);
    for (std::size_t j = 0; j < names.size(); ++j)
      left.weights[j] -= right.weights[j];
    if (std::all_of(left.weights.begin(), left.weights.end(), [](const double w) { return w == 0.; }))
      refuse_form(text, "relates no parameter");
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double     bound    = right.constant - left.constant;
    return {trimmed(text),
            left.weights,
            text[sign] == '<' ? -infinity : bound,
            text[sign] == '>' ? infinity : bound};
  }
} // namespace retroforge
