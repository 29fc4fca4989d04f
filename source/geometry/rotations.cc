// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/physics/transformations.h>

#include <retroforge/core/error.h>
#include <retroforge/geometry/rotations.h>

#include <cmath>

namespace retroforge
{
  namespace
  {
    Vec3 axis_of(const std::vector<double> &entry)
    {
      return Vec3({entry[0], entry[1], entry[2]});
    }

    /// @param what  as in `is'
    void check_axis(const std::string &where, const std::string &what, const Vec3 &axis)
    {
      if (!(axis.norm() > 0. && std::isfinite(axis.norm())))
        throw Error(where,
                    what + (axis.norm() > 0. ? " of infinite length" : " of length 0"),
                    "an axis has a direction",
                    "write for instance 0, 0, 1 for that of z");
    }
  } // namespace

  dealii::Tensor<2, 3> rotation(const Vec3 &axis, const double degrees)
  {
    return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
      dealii::Point<3>(axis / axis.norm()), degrees * dealii::numbers::PI / 180.);
  }

  void Rotations::add_list(dealii::ParameterHandler &prm, const std::string &of)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::List;
    const unsigned int any = List::max_int_value;
    prm.add_parameter("rotations",
                      list,
                      of + " one after the other, about axes through the origin: of each its axis and the "
                           "angle in degrees, separated by semicolons, in place of `rotation angle'. `0, 1, "
                           "0, 90; 0, 0, 1, 30' lays what stands along z down along x, and turns it by 30 "
                           "degrees in plan then. Units: degrees.",
                      List(List(Double(), 0, any, ","), 0, any, ";"));
  }

  void Rotations::check(const std::string &section) const
  {
    check_axis(section + "/rotation axis", "is", axis);
    const std::string where = section + "/rotations";
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      if (list[i].size() != 4)
        throw Error(where,
                    "has " + std::to_string(list[i].size()) + " number(s) in entry " + std::to_string(i + 1),
                    "a rotation has four: an axis of three, and an angle in degrees",
                    "write for instance 0, 1, 0, 90; 0, 0, 1, 30");
      check_axis(where, "has an axis", axis_of(list[i]));
      if (!(std::abs(list[i][3]) <= 360.))
        throw Error(where,
                    "has the angle " + as_text(list[i][3]) + " in entry " + std::to_string(i + 1),
                    "an angle is from -360 to 360 degrees",
                    "leave whole turns out");
    }
    if (angle != 0. && !list.empty())
      throw Error(where,
                  "are given beside a rotation angle",
                  "a body is turned by the one or by the others",
                  "put axis and angle in front of the list, and leave the two settings out");
  }

  dealii::Tensor<2, 3> Rotations::matrix() const
  {
    dealii::Tensor<2, 3> matrix = rotation(axis, angle);
    for (const std::vector<double> &entry : list)
      matrix = rotation(axis_of(entry), entry[3]) * matrix;
    return matrix;
  }
} // namespace retroforge
