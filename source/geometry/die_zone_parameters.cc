// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/geometry/die_zone_parameters.h>

#include <algorithm>

namespace retroforge
{
  void add_friction(dealii::ParameterHandler &prm, std::string &law, double &friction, double &shear_limit)
  {
    prm.add_parameter(
      "friction law",
      law,
      "Law of the friction on the die. Norton: tau = alpha K |dv|^m, with the metal's K and m. Tresca: tau = "
      "friction k, k = sigma_0/sqrt3 the shear flow stress of the metal at the die. Coulomb: tau = friction "
      "p, p "
      "the pressure of the die, and at most `shear limit' k, by a smooth minimum. Units: none.");
    prm.add_parameter(
      "friction",
      friction,
      "Coefficient of the law of friction: alpha of Norton's, the shear factor of Tresca's, at most 1, mu of "
      "Coulomb's; 0 is a frictionless die. Units: those of the law, of Norton's mm^(-m), else none.",
      dealii::Patterns::Double(0.));
    prm.add_parameter(
      "shear limit",
      shear_limit,
      "Part of the metal's shear flow stress that the friction of Coulomb's law cannot exceed; other "
      "laws do not read it. Units: none.",
      dealii::Patterns::Double(1e-6, 1.));
  }

  void DieZoneParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Zone " + name);
    prm.add_parameter(
      "from",
      from,
      "Lower corner of the box that is the zone, where the die stands at the start of the run. "
      "Units: mm.");
    prm.add_parameter("to", to, "Upper corner. Units: mm.");
    add_friction(prm, friction_law, friction, shear_limit);
    prm.leave_subsection();
  }

  void DieZoneParameters::check() const
  {
    for (unsigned int i = 0; i < 3; ++i)
      if (!(from[i] < to[i]))
        throw Error(section() + "/from",
                    "is not below `to' in each coordinate",
                    "the two are the lower and the upper corner of a box",
                    "give the lower coordinates first, and the box a height across a plane die");
  }

  void check_apart(const std::vector<DieZoneParameters> &zones)
  {
    for (std::size_t a = 0; a < zones.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
      {
        bool overlap = true;
        for (unsigned int i = 0; i < 3; ++i)
          overlap = overlap &&
                    std::max(zones[a].from[i], zones[b].from[i]) < std::min(zones[a].to[i], zones[b].to[i]);
        if (overlap)
          throw Error(zones[a].section() + "/from",
                      "this zone overlaps zone " + zones[b].name,
                      "one friction holds at each place of a die",
                      "let them end at a common face");
      }
  }

  namespace
  {
    /// Whether some of the die may be in the box: the plane cuts it, or the box around a facet does.
    bool meets(const Die &die, const DieZoneParameters &zone)
    {
      const Vec3 &from = zone.from, &to = zone.to;
      if (!die.surface())
      {
        bool before = false, behind = false;
        for (unsigned int corner = 0; corner < 8; ++corner)
        {
          Vec3 x;
          for (unsigned int i = 0; i < 3; ++i)
            x[i] = (corner >> i & 1) != 0 ? to[i] : from[i];
          const double distance = die.signed_distance(x, Vec3());
          before |= distance >= 0.;
          behind |= distance <= 0.;
        }
        return before && behind;
      }
      const auto &vertices = die.surface()->vertices();
      return std::any_of(
        die.surface()->triangles().begin(), die.surface()->triangles().end(), [&](const Triangle &facet) {
          bool meets = true;
          for (unsigned int i = 0; i < 3; ++i)
          {
            const auto [least, most] =
              std::minmax({vertices[facet[0]][i], vertices[facet[1]][i], vertices[facet[2]][i]});
            meets = meets && most >= from[i] && least <= to[i];
          }
          return meets;
        });
    }
  } // namespace

  FrictionZones zones_of(const Die &die, const std::vector<DieZoneParameters> &zones, const double edge)
  {
    FrictionZones made;
    made.edge = edge;
    for (const DieZoneParameters &zone : zones)
    {
      if (!meets(die, zone))
        throw Error(zone.section() + "/from",
                    "no part of die " + die.name + " is in this zone",
                    "friction acts on the surface of the die",
                    "move the box to where the die stands at the start, or make it larger");
      made.boxes.emplace_back(zone.from, zone.to);
    }
    return made;
  }
} // namespace retroforge
