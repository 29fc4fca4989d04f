// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/output/output_parameters.h>

namespace retroforge
{
  namespace
  {
    /// Increments between pictures; nothing for `auto'.
    std::optional<unsigned int> pictures_in(const std::string &text)
    {
      if (text == "auto")
        return {};
      try
      {
        return dealii::Patterns::Tools::Convert<unsigned int>::to_value(text, dealii::Patterns::Integer(0));
      }
      catch (const dealii::ExceptionBase &)
      {
        throw Error("Output/fields every",
                    "is '" + legible(text) + "'",
                    "it is `auto' or a number of increments",
                    "write auto for some 20 pictures over the stroke, 1 for every increment, 0 for none");
      }
    }
  } // namespace

  void OutputParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Output");
    prm.declare_entry(
      "fields every",
      "auto",
      dealii::Patterns::Anything(),
      "When the fields for viewing are written: auto, at most 20 times, evenly over the stroke; or every so "
      "many increments, 0 for never. The billet, the end of the stroke, and the workpiece where a run failed "
      "come along. Units: none.");
    prm.add_action("fields every", [this](const std::string &text) { every = pictures_in(text); });
    prm.add_parameter(
      "record", record, "Keep the record that a later gradient or replay needs. Units: none.");
    prm.leave_subsection();
    tag(prm, "Output", SettingRole::report);
  }
} // namespace retroforge
