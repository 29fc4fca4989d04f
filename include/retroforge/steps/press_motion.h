// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>

#include <memory>

/// @file
/// How a press goes along its stroke. The path of the dies is the stroke's, whatever the motion: a die of
/// velocity v has gone  v s / |v_lead|  when the leading die has gone s. The motion tells how long that
/// takes, over the path that a press at the dies' own speed makes in the same time.
namespace retroforge
{
  /// A sort of motion. Sorts derive from PressMotionOf, and are chosen by name.
  class PressMotionType
  {
  public:
    virtual ~PressMotionType() = default;

    /// Returns how users know the numbers of the motion.
    virtual std::vector<NumberInfo> info() const { return {}; }

    /// Returns the path at the dies' own speed that takes as long as the press takes from `stroke` on by
    /// `step` [mm]; `step` itself where it goes at that speed. Positive for a positive step.
    virtual double path(const std::vector<double> &numbers, double stroke, double step) const = 0;
    virtual Dual   path(const std::vector<Dual> &numbers, double stroke, double step) const   = 0;
  };

  /// A PressMotionType made from class Type, which has for any Number
  ///   Number compute_path(const std::vector<Number> &numbers, double stroke, double step) const;
  /// smooth in the numbers. Derivatives come from dual numbers.
  template <typename Type>
  class PressMotionOf : public PressMotionType
  {
  public:
    double path(const std::vector<double> &numbers, const double stroke, const double step) const override
    {
      return static_cast<const Type &>(*this).compute_path(numbers, stroke, step);
    }
    Dual path(const std::vector<Dual> &numbers, const double stroke, const double step) const override
    {
      return static_cast<const Type &>(*this).compute_path(numbers, stroke, step);
    }
  };

  /// The motion of a press: a sort, and its numbers.
  template <typename Number>
  struct PressMotion
  {
    std::vector<Number> numbers;  ///< by PressMotionType::info
    unsigned int        type = 0; ///< as press_motion_type() counts them; 0: at constant speed

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[numbers, type] = self;
      return std::tie(numbers, type);
    }

    /// Returns PressMotionType::path.
    Number path(double stroke, double step) const;
  };

  /// Adds path_bar times the derivatives of the path in the numbers of the motion.
  void reverse_path(const PressMotion<double> &motion,
                    double                     stroke,
                    double                     step,
                    double                     path_bar,
                    PressMotion<double>       &bar);

  /// Returns sort i, as PressMotion::type counts them; 0 is at constant speed.
  const PressMotionType &press_motion_type(unsigned int i);

  /// Returns the number of the sort that a parameter file calls `name`.
  /// @param where  the setting that names it
  /// @throws Error  where there is none of this name
  unsigned int find_press_motion(const std::string &name, const std::string &where);

  /// Adds a sort of motion to those there are, by a new name, before anything names it.
  void add_press_motion(const std::string &name, std::unique_ptr<const PressMotionType> type);
} // namespace retroforge
