// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/geometry/die_parameters.h>

#include <cmath>

namespace retroforge
{
  void DieParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection(section());
    shape.add_name(prm,
                   "shape",
                   "plane; stl: the surface in `file`, whose normals point to the workpiece; tripod, bell, "
                   "gear: a flat face with a cavity; punch: a round bar with a flat end; these four by "
                   "measures. Units: none.");
    prm.add_parameter("point",
                      point,
                      "At the start of the run, a point of the working face; of a die by measures, where its "
                      "axis meets its face; of an STL surface, by how much it is moved. Units: mm.");
    prm.add_parameter(
      "facing",
      facing,
      "Normal of the working face, pointing from the die to the workpiece; of any length. `die "
      "NAME/offset' moves the die along it. Units: none.");
    prm.add_parameter("velocity", velocity, "Velocity of the die, constant. Units: mm/s.");
    add_friction(prm, friction_law, friction, shear_limit);
    prm.declare_entry(
      "zones",
      "",
      dealii::Patterns::Anything(),
      "Names of zones of the die in which other friction holds; each has a section `Zone NAME' in "
      "this one, with a box, `from' and `to', and `friction law', `friction' and `shear limit' as "
      "here. Units: none.");
    prm.add_parameter(
      "zone edge",
      zone_edge,
      "Width over which friction changes at the faces of zones, half of it on each side; with "
      "elements longer than this, nodes that pass a face jump. Units: mm.",
      dealii::Patterns::Double(1e-300));
    for (DieZoneParameters &zone : zones)
      zone.add_parameters(prm);
    prm.add_parameter("temperature",
                      temperature,
                      "Of the die before it touches metal, read where Heat/heating is conduction. Units: C.");
    prm.add_parameter("follows billet",
                      follows_billet,
                      "Where the design makes the billet higher or lower, the die starts as far from it as "
                      "in the nominal design, "
                      "and ends, if it is the leading one, where it ends there: the stroke changes with the "
                      "height, the final gap "
                      "does not. Strokes are given as those of the nominal design. The gradient by the "
                      "billet's nodes is that with "
                      "the dies held. Units: none.");
    shape.add_settings(prm);
    prm.leave_subsection();
    tag(prm, section(), SettingRole::scene);
    tag(prm, section() + "/file", SettingTags::Files::one);
    tag(prm, section() + "/shape", Choice<DieKind>::read_by(die_kinds()));
  }

  void DieParameters::check()
  {
    if (!(facing.norm() > 0. && std::isfinite(facing.norm())))
      throw Error(section() + "/facing",
                  facing.norm() > 0. ? "is infinite" : "is the zero vector",
                  "it must point from the die to the workpiece",
                  "use for instance 0, 0, 1 for a lower die");
    facing /= facing.norm();
    if (follows_billet && velocity.norm() > 0. && !(velocity * facing > 0.))
      throw Error(section() + "/follows billet",
                  "is true, but the die does not move along its facing",
                  "its path is lengthened by what the billet grows, towards the workpiece",
                  "correct the velocity or the facing, or leave it out");
    for (const auto &kind : shape.kinds())
      kind->check(section(), shape.name);
    for (const DieZoneParameters &zone : zones)
      zone.check();
    check_apart(zones);
  }

  Die DieParameters::die() const
  {
    Die made = shape->make(place());
    if (!zones.empty())
      made.zones = zones_of(made, zones, zone_edge);
    return made;
  }
} // namespace retroforge
