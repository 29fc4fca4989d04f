// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/choice.h>
#include <retroforge/objective/box.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/objectives.h>
#include <retroforge/objective/smooth_maximum.h>
#include <retroforge/objective/smooth_region.h>
#include <retroforge/objective/target_surface.h>

#include <deal.II/base/parameter_handler.h>

namespace retroforge
{
  /// What of a scene objectives refer to.
  struct ObjectiveContext
  {
    const std::vector<Die>              &dies;
    const std::vector<DieState<double>> &states;      ///< at the start
    unsigned int                         leading_die; ///< taken where no die is named
    double                               stroke;      ///< [mm]
    double                               consistency; ///< K, a stress of the size to expect [MPa]
    const TetMesh                       &billet;
  };

  /// What a parameter file says about one objective: the section `Objective NAME`. Each type reads what it
  /// needs of it; doc/objectives.md says what that is.
  struct ObjectiveParameters
  {
    std::string name;
    std::string type   = "energy";
    double      weight = 1.;

    std::string die;
    std::string by           = "power";
    std::string window_over  = "stroke";
    double      window_begin = 0., window_end = 0.;
    std::string maximum   = "p-norm";
    double      sharpness = 20.;
    double      exponent  = 4.;

    Vec3   region_from, region_to;
    double region_edge = 1.;

    std::string  target;
    double       rounding = 0.;
    unsigned int samples  = 40;
    double       layer    = 2.;

    std::vector<std::string> patches;
    Vec3                     axis_point, axis = Vec3({0., 0., 1.});

    /// A name that is one of the types' is of that type unless said otherwise.
    explicit ObjectiveParameters(std::string name);

    static std::vector<std::string> types();
    static ReadBy                   read_by_type();

    void add_parameters(dealii::ParameterHandler &prm);

    /// @throws Error  for a die, target or patch that is not there, an empty window, exponents out of range
    NamedObjective make(const ObjectiveContext &context) const;

  private:
    std::string   section() const { return "Objective " + name; }
    unsigned int  find_die(const ObjectiveContext &context, const std::string &die_name) const;
    Extent        extent() const;
    unsigned int  moving_die(const ObjectiveContext &context) const;
    Effort        effort(const ObjectiveContext &context) const;
    PathWindow    window(const ObjectiveContext &context) const;
    SmoothMaximum smooth_maximum() const;
    TargetSurface target_surface(const ObjectiveContext &context) const;
    bool          target_is_die() const;
    void          check_names(const ObjectiveContext &context) const;

    std::optional<Box>          box() const;
    std::optional<SmoothRegion> region() const;

    std::unique_ptr<PathObjective>  make_path(const ObjectiveContext &context) const;
    std::unique_ptr<FinalObjective> make_at_end(const ObjectiveContext &context) const;
  };
} // namespace retroforge
