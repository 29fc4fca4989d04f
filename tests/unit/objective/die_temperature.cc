// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The largest temperature of a die's surface.
// - By hand: a die of 200 C whose skin has warmed by 300 and 180 K in two modes has 680 C at its surface, beneath whatever metal, and
//   679 C where it is a degree less: a face has the mean of its nodes, a node that of its faces, and the largest is the smooth
//   one of these, by their areas. A die that touches nothing has its own temperature, and so has one that is not in the press.
// - The reverse against dual numbers in positions, displacements, vertices and temperatures of the dies, and skins, each alone,
//   and the Taylor order along all: between a wavy die that a box
//   touches in part, and a plane across its corner, with thin skins and thick ones.

#include <retroforge/billet/billet.h>
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/die_temperature.h>

#include <deal.II/base/mpi.h>

#include "../geometry/geometry_test_tools.h"
#include "objective_test_tools.h"

using namespace retroforge;

namespace
{
  template <typename Number>
  struct Inputs
  {
    NodalVectors<Number>          X;
    std::vector<DieState<Number>> dies;
    NodeSkins<Number>             skin;
    HeatLaw<Number>               law;

    std::vector<Group<Number>> groups()
    {
      std::vector<Group<Number>> groups = {
        {"X", {}}, {"displacement", {}}, {"dies", {}}, {"temperatures of dies", {}}, {"skin", {}}};
      append(X, groups[0].second);
      for (auto &die : dies)
      {
        for (unsigned int i = 0; i < 3; ++i)
          groups[1].second.push_back(&die.displacement[i]);
        append(die.vertices, groups[2].second);
        groups[3].second.push_back(&die.temperature);
      }
      for_each_number([&](Number &value) { groups[4].second.push_back(&value); }, skin);
      return groups;
    }
  };

  struct Problem
  {
    Scene          scene;
    Inputs<double> at;

    Problem(TetMesh mesh, const std::vector<Die> &dies, const HeatLaw<double> &law)
        : scene(std::move(mesh), DiscretizationChoice(), dies, MPI_COMM_WORLD)
        , at{scene.mesh.X,
             std::vector<DieState<double>>(dies.size()),
             NodeSkins<double>::none(scene.mesh.n_nodes(), dies.size()),
             law}
    {
      for (std::size_t d = 0; d < dies.size(); ++d)
      {
        at.dies[d].temperature = 200.;
        if (dies[d].surface())
          at.dies[d].vertices = dies[d].surface()->vertices();
      }
      at.law.heating = static_cast<unsigned int>(Heating::conduction);
    }

    template <typename Number, typename F>
    auto with_view(const Inputs<Number> &inputs, const F &f) const
    {
      const std::vector<Number> q(scene.mesh.n_cells(), Number(0.));
      return f(FinalView<Number>{
        scene, inputs.X, q, inputs.dies, nullptr, nullptr, nullptr, &inputs.skin, &inputs.law});
    }

    FinalDecisions decide(const DieTemperature &objective) const
    {
      return with_view(at, [&](const auto &view) { return objective.decide(view); });
    }

    template <typename Number>
    Number value(const DieTemperature &objective,
                 const FinalDecisions &decisions,
                 const Inputs<Number> &inputs) const
    {
      return with_view(inputs, [&](const auto &view) {
        return objective.value(objective.integrals(view, decisions).complete(), decisions);
      });
    }

    double value(const DieTemperature &objective) const { return value(objective, decide(objective), at); }

    Inputs<double> reverse(const DieTemperature &objective,
                           const FinalDecisions &decisions,
                           const Inputs<double> &inputs) const
    {
      return with_view(inputs, [&](const auto &view) {
        const auto b = objective.integrals(view, decisions).complete();
        auto bar = objective.derivatives(view, decisions, objective.reverse_value(b, decisions)).complete();
        return Inputs<double>{bar.X, bar.dies, bar.skin, {}};
      });
    }
  };

  TetMesh box(const Vec3 &base, const Vec3 &size, const double element_size)
  {
    BilletParameters parameters;
    parameters.base_centre  = base;
    parameters.size         = size;
    parameters.element_size = element_size;
    return make_billet(parameters, MPI_COMM_WORLD);
  }

  HeatLaw<double> known_law()
  {
    HeatLaw<double> law;
    law.capacity       = 3.;
    law.conductivity   = 48.;
    law.contact_film   = 3.;
    law.die_effusivity = 4.;
    law.gap            = 0.1;
    return law;
  }

  void check_by_hand()
  {
    Errors               errors;
    const DieTemperature lower(0, 1.), upper(1, 1.);
    Problem              problem(
      box(Vec3(), Vec3({3., 3., 2.}), 1.),
      {Die("lower", Vec3(), Vec3({0., 0., 1.})), Die("upper", Vec3({0., 0., 5.}), Vec3({0., 0., -1.}))},
      known_law());
    for (auto &skin : problem.at.skin.dies[0])
    {
      skin[1] = 300.;
      skin[4] = 180.;
    }
    errors.compare("even metal", problem.value(lower), 680.);
    errors.compare("nothing touches", problem.value(upper), 200.);
    const auto          is_cold = [](const NodeIndex k) { return k % 2 == 0; };
    std::vector<double> area(problem.scene.mesh.n_nodes(), 0.),
      t(area); // of thirds of faces, and their temperatures
    const TetMesh &mesh = problem.scene.mesh;
    for (NodeIndex k = 0; k < area.size(); ++k)
      problem.at.skin.dies[0][k][4] -= is_cold(k);
    for (const BoundaryFace &face : mesh.faces)
    {
      const auto &n = face.nodes;
      if (mesh.X[n[0]][2] + mesh.X[n[1]][2] + mesh.X[n[2]][2] > 1e-9)
        continue;
      const double third = triangle_area(n, mesh.X) / 3.,
                   mean  = 680. - (is_cold(n[0]) + is_cold(n[1]) + is_cold(n[2])) / 3.;
      for (const NodeIndex k : n)
      {
        area[k] += third;
        t[k] += third * mean;
      }
    }
    double largest = 0., weights = 0., weighted = 0.;
    for (NodeIndex k = 0; k < area.size(); ++k)
      if (area[k] > 0.)
        largest = std::max(largest, t[k] /= area[k]);
    for (NodeIndex k = 0; k < area.size(); ++k)
    {
      const double weight = area[k] * std::exp(t[k] - largest);
      weights += weight;
      weighted += weight * t[k];
    }
    errors.compare("two skins", problem.value(lower), weighted / weights);
    const auto decisions = problem.decide(lower);
    errors.compare("true maximum", lower.details({}, decisions).at("true maximum"), largest);
    problem.at.dies[0].in_press = 0;
    errors.compare("not in the press", problem.value(lower), 200.);
    errors.print(1e-12);
  }

  double check_derivatives_of(const std::string &name, const double skin, const unsigned int die)
  {
    Random     random;
    const auto wave = [](const double x, const double y) {
      return 0.1 + 0.1 * std::sin(4. * x) * std::cos(3. * y);
    };
    HeatLaw<double> law         = known_law();
    law.gap                     = 0.3;
    TriangleSurface die_surface = sheet(9, wave);
    Problem         problem(box(Vec3({0., 0., 0.2}), Vec3({1.6, 1.4, 1.}), 0.4),
                    {Die("lower", die_surface, 2.), Die("side", Vec3({0.75, 0., 0.}), Vec3({-1., 0., 0.1}))},
                    law);
    for (Vec3 &x : problem.at.X)
      x += 0.03 * random.vector();
    for_each_number([&](double &m) { m = 800. * skin / n_skin_modes * (1. + 0.5 * random.scalar()); },
                    problem.at.skin);
    problem.at.dies[0].displacement = Vec3({0.02, -0.01, -0.05});
    problem.at.dies[1].temperature  = 350.;
    const DieTemperature objective(die, 20.);
    const auto           decisions = problem.decide(objective);
    Inputs<Dual>         dual;
    convert(problem.at.X, dual.X);
    convert(problem.at.dies, dual.dies);
    convert(problem.at.skin, dual.skin);
    convert(problem.at.law, dual.law);
    return check_derivatives<Inputs>(
      name,
      problem.at,
      [&](const auto &inputs) { return problem.value(objective, decisions, inputs); },
      [&](const auto &inputs) { return problem.reverse(objective, decisions, inputs); },
      dual,
      random);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  std::cout << "by hand" << std::endl;
  check_by_hand();
  std::cout << "derivatives" << std::endl;
  const double worst = std::max({check_derivatives_of("wavy die, thin skins", 1e-3, 0),
                                 check_derivatives_of("wavy die, thick skins", 0.6, 0),
                                 check_derivatives_of("plane across a corner", 1e-2, 1)});
  std::cout << "FIGURE die_temperature_derivative_error " << worst << std::endl;
}
