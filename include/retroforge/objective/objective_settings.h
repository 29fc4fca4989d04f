// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/effort.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/smooth_maximum.h>
#include <retroforge/objective/smooth_region.h>
#include <retroforge/objective/target_surface.h>

#include <optional>

/// @file
/// Settings that several types of objectives read.
namespace retroforge
{
  /// The die that an objective is of.
  struct DieSetting
  {
    std::string name;

    void add_parameters(dealii::ParameterHandler &prm);

    /// Returns its number.  @throws Error  where there is none of that name
    unsigned int find(const std::string &where, const ObjectiveContext &context) const;

    /// Returns the number of a die that moves.  @throws Error  for one that stands still
    unsigned int find_moving(const std::string &where, const ObjectiveContext &context) const;
  };

  /// The part of the run that an objective is of.
  struct WindowSettings
  {
    PathWindow::Over over  = PathWindow::Over::stroke;
    double           begin = 0., end = 0.;

    void add_parameters(dealii::ParameterHandler &prm);

    PathWindow make(const std::string &where, const ObjectiveContext &context) const;
  };

  /// The differentiable stand-in for a maximum.
  struct MaximumSettings
  {
    SmoothMaximum::Kind kind      = SmoothMaximum::Kind::p_norm;
    double              sharpness = 20.;

    void add_parameters(dealii::ParameterHandler &prm);

    SmoothMaximum make(const std::string &where) const;
  };

  /// A box that an objective is restricted to, or none.
  struct BoxSettings
  {
    Vec3 from, to;

    void add_parameters(dealii::ParameterHandler &prm);

    std::optional<Box> make(const std::string &where) const;
  };

  /// A box with smooth edges that an objective of the path is restricted to, or none.
  struct RegionSettings
  {
    BoxSettings box;
    double      edge = 1.;

    void add_parameters(dealii::ParameterHandler &prm);

    std::optional<SmoothRegion> make(const std::string &where) const;
  };

  /// A shape that the workpiece is compared with.
  struct TargetSettings
  {
    std::string name;
    BoxSettings region;

    void add_parameters(dealii::ParameterHandler &prm);

    bool is_die() const { return name.rfind("die ", 0) == 0; }

    void check_names(const std::string &where, const ObjectiveContext &context) const;

    TargetSurface make(const std::string &where, const ObjectiveContext &context) const;

  private:
    TargetSurface
    cavity(const std::string &where, const ObjectiveContext &context, const std::optional<Box> &box) const;

    TargetSurface shape(const std::string &where, const std::optional<Box> &box) const;
  };

  /// A type that compares the workpiece with a target.
  struct TargetType : ObjectiveType
  {
    TargetSettings target;

    void add_parameters(dealii::ParameterHandler &prm) override { target.add_parameters(prm); }

    void check_names(const std::string &where, const ObjectiveContext &context) const override;
  };

  /// Declares the setting `sharpness` of a smooth maximum.
  void add_sharpness(dealii::ParameterHandler &prm, double &sharpness);

  /// Declares the setting `temperature smoothing`, that of an ExponentialMean [K].
  void add_temperature_smoothing(dealii::ParameterHandler &prm, double &smoothing);
} // namespace retroforge
