// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/die_free_form_parameters.h>

namespace retroforge
{
  void DieFreeFormParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("free form modes",
                      modes,
                      "How many smooth moves of a die's vertices become design parameters, `die NAME/free "
                      "form 1' and so on, from the smoothest on; `die NAME/free form' in Design/parameters "
                      "stands for all. 0 for none. Units: none.",
                      dealii::Patterns::Integer(0, 4000));
    add_enum<Along>(prm,
                    "free form along",
                    along,
                    {{"facing", Along::facing}, {"normal", Along::normal}},
                    "facing: vertices move along the die's facing, as the depth of a cavity does, and no "
                    "part of it gets an undercut; normal: along the surface's normals, for walls and "
                    "sides. Units: none.");
    prm.add_parameter("free form length",
                      length,
                      "Moves of a die that change over less than this count more: the length of their "
                      "Sobolev norm; 0 for a quarter of the root of the moving area. Units: mm.",
                      dealii::Patterns::Double(0.));
    prm.add_parameter("free form region from",
                      from,
                      "Lower corner of the box, where the die stands at the start, whose vertices and their "
                      "mirror images move; others stay. Equal corners: all move. Units: mm.");
    prm.add_parameter("free form region to", to, "Upper corner. Units: mm.");
    prm.add_parameter("free form mirrors",
                      mirrors,
                      "So many planes through the die's axis (along `facing', through `point'), equally "
                      "spaced from the x axis on, are mirrors of the moves, as planes of symmetry of the "
                      "billet always are. As many as a gear has teeth; many, for example 12, for a die of "
                      "revolution that stays one. Units: none.",
                      dealii::Patterns::Integer(0, 1000));
  }

  void DieFreeFormParameters::check(const std::string &section, const std::string &shape) const
  {
    if (modes > 0 && shape == "plane")
      throw Error(section + "/free form modes",
                  "is " + std::to_string(modes) + ", and the die is a plane",
                  "a free form moves the vertices of a surface",
                  "choose another shape, or move the plane by `offset'");
    for (unsigned int i = 0; i < 3; ++i)
      if (has_region() && !(from[i] < to[i]))
        throw Error(section + "/free form region from",
                    "is not below `free form region to' in each coordinate",
                    "the two are the lower and the upper corner of a box",
                    "give the lower coordinates first");
  }
} // namespace retroforge
