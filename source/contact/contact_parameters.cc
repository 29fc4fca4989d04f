// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/contact_parameters.h>
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>

namespace retroforge
{
  void ContactParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Contact");
    add_enum<Arrival>(
      prm,
      "law",
      law,
      {{"smooth", Arrival::smooth}, {"sharp", Arrival::sharp}},
      "smooth: friction sets in over a ramp of the gap, the objective is differentiable as nodes arrive. "
      "sharp: friction acts where the gap is below the ramp's width, decided once per increment. "
      "Units: none.");
    add_enum<bool>(
      prm,
      "points",
      edges_touch,
      {{"nodes", false}, {"nodes and edges", true}},
      "Where dies that are no planes are felt: nodes and edges adds the middles of edges that the die bulges "
      "into, which nodes alone let into it. Units: none.");
    add_enum<bool>(
      prm,
      "closing work",
      counts_closing,
      {{"counted", true}, {"left out", false}},
      "counted: energies and forces have what sums over the increments lack where nodes arrive at dies, and "
      "are "
      "one: the energy is the work of the forces. left out: energies are those of deformation and friction "
      "at "
      "the speeds of the increments, forces the reactions to them, and a force from one is not the other. "
      "Units: none.");
    add_enum<bool>(
      prm,
      "loose billet",
      holds_loose,
      {{"held", true}, {"free", false}},
      "Of a billet between dies that touch it along lines or at points only, the rigid motions that these do "
      "not resist, as a round bar's rolling. held: a drag keeps its mean velocity along them near zero until "
      "the contacts are wide enough to hold it; a run in which that bears more than a tenth of the force "
      "stops "
      "and names the motion. free: nothing holds it. Units: none.");
    prm.add_parameter(
      "largest depth",
      largest_depth,
      "The run says so at its end when a point of the surface was deeper in a die than this part of the "
      "element size. Units: none.",
      dealii::Patterns::Double(0.));
    prm.add_parameter(
      "edge sinking",
      edge_sinking,
      "Part of the dies' closing speed at which an edge sinks into a die under the mean pressure: the "
      "penalty of edges, softer than the nodes'. Units: none.",
      dealii::Patterns::Double(1e-14, 1.));
    prm.add_parameter(
      "approach",
      approach,
      "Approach time in increments: a gap closes within this many. 1 closes it in one, larger values "
      "smooth the objective and bias the energy. Units: none.",
      dealii::Patterns::Double(1., 100.));
    prm.add_parameter(
      "layer",
      layer,
      "Bends the speed at which a gap may close, so that the force on an arriving node sets in gradually: "
      "smooths the objective at less bias than `approach' does. 0.5 is moderate, 0.3 strong, 0.1 the least; "
      "0, or the sharp law, for none. In units of approach times the path by which the dies close in an "
      "increment: its stroke, where one die moves. Units: none.",
      dealii::Patterns::Double(0.));
    prm.add_parameter(
      "ramp width",
      ramp_width,
      "Gap over which friction sets in, in units of approach times the path by which the metal "
      "came nearer to the die in an increment, as fast as in the one before. Units: none.",
      dealii::Patterns::Double(1e-6, 100.));
    prm.add_parameter("ramp at walls",
                      ramp_at_walls,
                      "Least gap over which friction sets in, where metal comes no nearer, as along walls: a "
                      "part of that where "
                      "it comes as fast as the dies close. 1: the same gap everywhere. Units: none.",
                      dealii::Patterns::Double(1e-3, 1.));
    prm.add_parameter(
      "penetration",
      penetration,
      "Part of the dies' closing speed at which a node sinks into a die under the mean pressure: sets the "
      "penalty. Units: none.",
      dealii::Patterns::Double(1e-14, 1.));
    prm.add_parameter(
      "penalty",
      penalty,
      "rho, which is then the same in every design; 0 takes it from `penetration`, the material, the speed "
      "at which the dies close and the height of the billet, and gradients by the first three know it. "
      "Units: "
      "MPa s/mm.",
      dealii::Patterns::Double(0.));
    prm.add_parameter(
      "slip regularisation",
      slip_fraction,
      "v0 in |dv|^2 -> |dv|^2 + v0^2, as a part of the speed at which the dies close, that of the moving die "
      "where there is one. Part of the model. Units: none.",
      dealii::Patterns::Double(0.));
    prm.leave_subsection();
    tag(prm, "Contact", SettingRole::scene);
    // Measured in increments, or of the mesh.
    for (const char *setting : {"points",
                                "closing work",
                                "loose billet",
                                "largest depth",
                                "edge sinking",
                                "approach",
                                "layer",
                                "ramp width",
                                "ramp at walls"})
      tag(prm, std::string("Contact/") + setting, SettingRole::numerics);
  }

  void ContactParameters::check() const
  {
    constexpr double least = 0.1;
    if (law == Arrival::smooth && layer > 0. && layer < least)
      throw Error("Contact/layer",
                  "is " + as_text(layer) + ", with which a die is felt over thousands of increments' strokes",
                  "it is 0, or " + as_text(least) + " at least",
                  "use 0.3 for a strong layer, 0 for none");
  }
} // namespace retroforge
