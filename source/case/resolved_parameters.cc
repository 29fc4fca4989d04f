// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/parameters.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/closing_speed.h>
#include <retroforge/mesh/mesh_quality.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace retroforge
{
  /// Of the billet's extent along the way: a step that is fine for all but what is filled or nearly closed.
  constexpr double fine_step = 2.5e-3;

  /// Edges that sank into a die come out of it within this part of a whole increment, or in one that is longer.
  /// Energies lack the force times the depth to which edges are sunk at the end, which grows with it.
  constexpr double recovery = 0.25;

  BilletSize Parameters::size_of(const TetMesh &mesh) const
  {
    const double side     = std::cbrt(volume(mesh.cells, mesh.X));
    const Vec3  &velocity = dies[leading_die()].velocity;
    const Vec3   way      = velocity / velocity.norm();
    double       lowest = std::numeric_limits<double>::max(), highest = std::numeric_limits<double>::lowest();
    for (const Vec3 &x : mesh.X)
    {
      lowest  = std::min(lowest, x * way);
      highest = std::max(highest, x * way);
    }
    const bool   halved = std::any_of(mesh.patches.begin(), mesh.patches.end(), [&](const Patch &patch) {
      return patch.symmetry && std::abs(patch.symmetry->normal * way) > 1. - 1e-6;
    });
    const double extent = highest - lowest, whole = (halved ? 2. : 1.) * extent;
    return {side, billet.is_from_file() ? whole : billet.whole_height(), extent};
  }

  void Parameters::check_derived(const BilletSize &size) const
  {
    const auto is_sound = [](const double x) { return x > 1e-50 && x < 1e50; };
    const auto require  = [](const bool sound, const std::string &where, const std::string &what) {
      if (!sound)
        throw Error(where,
                    "makes " + what + " zero or infinite",
                    "what follows from the parameters must be between 1e-50 and 1e50",
                    "use values of the usual size: lengths in mm, speeds in mm/s, stresses in MPa");
    };
    const StepModel model = step_model();
    require(is_sound(press.stroke / press.increments), "Press/stroke", "the increments of stroke");
    require(is_sound(model.reach) && is_sound(model.contact.ramp.width),
            "Contact",
            "the reach of contact (approach, layer, ramp width)");
    const Process<double> made = process(size);
    require(is_sound(made.speed()), "Dies", "the speed of the leading die");
    require(is_sound(mean_pressure(size)), "Material", "the flow stress");
    require(is_sound(made.contact.rho), "Contact", "the penalty (with the speed and the material)");
    // In words of Contact/penetration, and within its bounds.
    const double penetration = mean_pressure(size) / (made.contact.rho * closing_speed(made.dies));
    if (contact.penalty > 0. && !(penetration >= 1e-14 && penetration <= 1.))
      throw Error("Contact/penalty",
                  "is " + as_text(contact.penalty) + " MPa s/mm, with which nodes sink in at " +
                    as_text(penetration) + " times the speed at which the dies close",
                  "as for Contact/penetration that must be from 1e-14 to 1",
                  "leave it 0 and set Contact/penetration");
    const double n_cells =
      remeshing.element_size > 0. ? 8. * std::pow(size.side / remeshing.element_size, 3) : 0.;
    if (!(n_cells <= 1e8))
      throw Error("Remeshing/element size",
                  "is " + as_text(remeshing.element_size) + ", which makes about " + as_text(n_cells) +
                    " tetrahedra",
                  "a mesh may have 1e8, some 360 GB in memory",
                  "choose a larger element size, or 0 for that of the billet");
  }

  Parameters &Parameters::resolve_defaults(const BilletSize &size)
  {
    if (press.increments == 0)
    {
      constexpr double most    = 1e8;
      const auto       of_size = [&](const double step) {
        return std::max(1., std::ceil(closing_path() / (step * size.extent) - 1e-9));
      };
      if (const double number = of_size(fine_step); !(number <= most))
        throw Error("Press/stroke",
                    "is so long that it may take " + as_text(number) + " increments",
                    "there may be 1e8",
                    "shorten the stroke, or set Press/increments");
      press.largest_strain  = std::sqrt(press.accuracy);
      press.increments      = of_size(*press.largest_strain);
      press.most_increments = 10 * std::max(of_size(fine_step), of_size(*press.largest_strain));
    }
    else
      press.most_increments = 10 * std::min(press.increments, 100000000u);
    if (!press.steps_file.empty())
    {
      press.steps           = read_steps(press.steps_file, press.stroke);
      press.most_increments = std::max<unsigned int>(press.most_increments, 10 * press.steps.ends.size());
    }
    touching_gap_ =
      contact.approach * (press.largest_strain ? fine_step * size.extent : closing_path() / press.increments);
    check_derived(size);
    const Process<double> made = process(size);
    edge_stiffness_            = std::min(
      1., mean_pressure(size) / (contact.edge_sinking * closing_speed(made.dies)) / made.contact.rho);
    return *this;
  }

  double Parameters::closing_path() const
  {
    return press.stroke * (closing_speed(initial_states()) / dies[leading_die()].velocity.norm());
  }

  std::vector<DieState<double>> Parameters::initial_states() const
  {
    std::vector<DieState<double>> states;
    for (const DieParameters &die : dies)
      states.push_back(initial_state(die));
    return states;
  }

  double Parameters::mean_pressure(const BilletSize &size) const
  {
    const double speed = closing_speed(initial_states());
    return open_contact(size).mean_pressure(material.metal(speed / size.height).initial_law(), speed);
  }

  OpenContact Parameters::open_contact(const BilletSize &size) const
  {
    return {size.height,
            contact.penetration,
            contact.penalty > 0. ? std::optional(contact.penalty) : std::nullopt,
            contact.slip_fraction};
  }

  Process<double> Parameters::process(const BilletSize &size) const
  {
    Process<double> process;
    process.dies = initial_states();
    process.operations.resize(1);
    Operation<double> &operation = process.operations.front();
    operation.leading_die        = leading_die();
    operation.motion             = press.motion();
    operation.stroke             = press.stroke;
    for (unsigned int d = 0; d < process.dies.size(); ++d)
      operation.dies.push_back(d);
    const double speed = closing_speed(process.dies);
    process.material   = material.metal(speed / size.height);
    process.heat       = heat.law();
    if (process.heat.conducts())
      operation.waiting = heat.waiting(resting_die());
    process.contact = open_contact(size).law(process.material.initial_law(), speed);
    return process;
  }

  Objectives Parameters::make_objectives(const std::vector<Die> &made_dies, const TetMesh &made_billet) const
  {
    Objectives                          made;
    const std::vector<DieState<double>> states = initial_states();
    const double time = press.motion().path(0., press.stroke) / states[leading_die()].velocity.norm();
    for (const ObjectiveParameters &objective : objectives.all)
      made.push_back(objective.make({made_dies,
                                     states,
                                     leading_die(),
                                     press.stroke,
                                     time,
                                     material.metal(1.).initial_law().K,
                                     made_billet,
                                     edge_length(made_billet),
                                     FrictionRamp{touching_gap_, step_model().contact.ramp.sharp},
                                     heat.heating != Heating::none,
                                     material.damage != Damage::none,
                                     heat.heating == Heating::conduction}));
    return made;
  }

  std::vector<Combination> Parameters::combinations(const Objectives &made_objectives) const
  {
    return objectives.combined ? std::vector<Combination>{combined(made_objectives)} : each(made_objectives);
  }

  StepModel Parameters::step_model() const
  {
    StepModel    model;
    const double step            = press.stroke / press.increments;
    const double closing         = closing_path() / press.increments;
    model.scheme                 = Scheme::by_name(press.scheme);
    model.edges_touch            = contact.edges_touch;
    model.holds_loose            = contact.holds_loose;
    model.contact.approach       = contact.approach;
    model.contact.ramp.sharp     = contact.law == ContactParameters::Arrival::sharp;
    model.contact.edge_stiffness = edge_stiffness_;
    model.contact.counts_closing = contact.counts_closing;
    model.contact.ramp.width     = contact.ramp_width * contact.approach * closing;
    model.contact.ramp.wall      = contact.ramp_at_walls;
    const double layer           = model.contact.ramp.sharp ? 0. : contact.layer;
    model.contact.layer          = layer * contact.approach * closing;
    model.contact.step           = step;
    model.contact.recovery       = recovery * step;
    // Where a node meets the approach speed that closes at that of the dies.
    const double arrival = layer == 0. ? 1. : layer * std::sinh(1. / layer);
    model.reach = std::max({3., 1.5 * contact.ramp_width, 1.5 * arrival}) * contact.approach * closing;
    model.adjoint_tolerance = adjoint.tolerance;
    model.shape_derivatives = adjoint.shape_derivatives;
    return model;
  }

  double Parameters::edge_length(const TetMesh &mesh) const
  {
    if (remeshing.element_size > 0.)
      return remeshing.element_size;
    if (!billet.is_from_file())
      return billet.element_size;
    double sum = 0.;
    for (const auto &cell : mesh.cells)
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b < a; ++b)
          sum += (mesh.X[cell[a]] - mesh.X[cell[b]]).norm();
    return sum / (6. * mesh.n_cells());
  }
} // namespace retroforge
