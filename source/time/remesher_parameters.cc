// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/time/remesher.h>

namespace retroforge
{
  void RemesherParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Remeshing");
    add_enum<When>(
      prm,
      "when",
      when,
      {{"never", When::never}, {"quality", When::quality}, {"increments", When::increments}},
      "quality: when an angle between two faces of a cell falls below the trigger angle, or an "
      "increment would invert a cell, or when the surface no longer fits a curved die. increments: that, and "
      "after every so many increments. "
      "Units: none.");
    prm.add_parameter("every", every, "Increments between remeshings. Units: none.", Integer(1));
    add_enum<Method>(prm,
                     "method",
                     method,
                     {{"local", Method::local}, {"rebuild", Method::rebuild}},
                     "local changes the mesh only where it is bad, and rebuilds it when cells are inverted; "
                     "rebuild makes the whole inside anew each time. Units: none.");
    prm.add_parameter(
      "element size",
      element_size,
      "Wanted length of the edges; 0 for that of the billet. Designs of other volumes on the same first mesh "
      "have it in proportion to the cube root of theirs. Units: mm.",
      Double(0.));
    add_enum<Sizes>(
      prm,
      "sizes",
      sizes,
      {{"uniform", Sizes::uniform}, {"dies", Sizes::dies}, {"error", Sizes::error}},
      "dies: edges are shorter near curved dies, as their curvature and sharp edges ask for, and "
      "in narrow gaps (gap elements); "
      "uniform: the same length everywhere; error: as many elements as a uniform mesh has, "
      "where by the jumps of the strain rate they lessen the error of the power most, and near "
      "curved dies as with dies. Units: none.");
    prm.add_parameter(
      "chord error",
      chord_error,
      "Wanted distance between a surface edge and a curved die, r its radius there: edges are "
      "sqrt(8 r error) long. 0 for 2 % of the element size. Units: mm.",
      Double(0.));
    prm.add_parameter("smallest size",
                      smallest_size,
                      "Edges are not wanted shorter than this part of the element size. Units: none.",
                      Double(1e-3, 1.));
    prm.add_parameter("largest size",
                      largest_size,
                      "Where sizes follow the error, edges are not wanted longer than this times the element "
                      "size. Units: none.",
                      Double(1., 100.));
    prm.add_parameter(
      "growth",
      growth,
      "Most by which the wanted length grows per distance from where it is small. Units: none.",
      Double(1e-3));
    prm.add_parameter("gap elements",
                      gap_elements,
                      "Elements wanted over the thickness of a gap between two dies, or between a die and a "
                      "plane of symmetry "
                      "that it faces, where that is thinner than so many elements: 2.5, for instance. "
                      "Not with uniform "
                      "sizes. 0: gaps do not count. Units: none.",
                      Double(0., 20.));
    prm.add_parameter(
      "die fit",
      fit,
      "Remesh when a surface edge with both ends on a curved die is deeper inside it than this "
      "part of the element size. Units: none.",
      Double(1e-6));
    prm.add_parameter(
      "largest repair",
      largest_repair,
      "Metal thinner than an element may be taken away where the surface crosses itself, or "
      "where a flat cell would stay there: over the run up to this part of the workpiece's volume. Beyond "
      "that the crossing is a fold, and the "
      "run stops. Units: none.",
      Double(0., 1.));
    prm.add_parameter(
      "first mesh", first_mesh, "Improve the billet's mesh by one pass before the run begins. Units: none.");
    prm.leave_subsection();
    tag(prm, "Remeshing", SettingRole::numerics);
    tag(prm, "Remeshing/first mesh", SettingRole::scene);
    tag(prm, "Remeshing/when", ReadBy{{"increments", {"every"}}});
    local.add_parameters(prm);
  }

  void RemesherParameters::check() const
  {
    local.check();
  }
} // namespace retroforge
