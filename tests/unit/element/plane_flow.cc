// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Both pairs in the plane, on an irregular mesh of the unit square with unknowns and constraints of deal.II.
// Proved: upsetting at strain rate s is found exactly where it is uniform,
// - in plane strain, v = s (x, -y), the pressure that leaves the side free, and the power
//   K 2^(m+1) s^(m+1) per area;
// - of a cylinder around its axis, v = s (-r/2, z) upside down, and the power K 3^((m+1)/2) s^(m+1) pi;
// - in plane strain with the whole turned by 25 degrees: two lines of symmetry and the tool are inclined,
// held
//   by linear constraints.

#include "plane_flow.h"

#include <deal.II/grid/grid_tools.h>

using namespace retroforge;

constexpr double s = 0.7, K = 1.693;

/// The velocity at the unit square before it is turned.
dealii::Tensor<1, 2> uniform(const dealii::Point<2> &x, const Kinematics kinematics)
{
  return dealii::Tensor<1, 2>({(kinematics == Kinematics::axisymmetric ? 0.5 : 1.) * s * x[0], -s * x[1]});
}

void check(const PlanePair &pair,
           const Kinematics kinematics,
           const double     m,
           const double     angle,
           Errors          &errors)
{
  dealii::Triangulation<2> triangulation;
  make_square(triangulation, 5, 0.3);
  dealii::GridTools::rotate(angle, triangulation);
  const dealii::Tensor<1, 2> e_x({std::cos(angle), std::sin(angle)}),
    e_y({-std::sin(angle), std::cos(angle)});
  PlaneFlow  flow(triangulation, pair, kinematics);
  const auto on = [](const dealii::Tensor<1, 2> &n, const double distance) {
    return [n, distance](const dealii::Point<2> &x) { return std::abs(n * x - distance) < 1e-9; };
  };
  const auto still = [](const dealii::Point<2> &) { return 0.; };
  flow.hold(on(e_x, 0.), e_x, still);
  flow.hold(on(e_y, 0.), e_y, still);
  flow.hold(on(e_y, 1.), e_y, [](const dealii::Point<2> &) { return -s; });
  flow.finish_constraints();
  const MaterialLaw<double> law{K, m, 0.};
  flow.solve(law);

  std::vector<double> v, v_expected, p, p_expected;
  flow.for_each_node([&](const dealii::Point<2> &x, const std::array<unsigned int, 2> &node) {
    const auto local = uniform(dealii::Point<2>(e_x * x, e_y * x), kinematics);
    for (unsigned int i = 0; i < 2; ++i)
    {
      v.push_back(flow.solution(node[i]));
      v_expected.push_back((local[0] * e_x + local[1] * e_y)[i]);
    }
  });
  // The side is free:  p = factor eps_xx.
  const bool   ring   = kinematics == Kinematics::axisymmetric;
  const double across = ring ? 0.5 * s : s, eps2 = ring ? 1.5 * s * s : 2. * s * s;
  for (const auto &cell : flow.dofs.active_cell_iterators())
    for (const double pressure : flow.values_of(cell).P)
    {
      p.push_back(pressure);
      p_expected.push_back(law(eps2) * across);
    }
  const double power = ring ? dealii::numbers::PI * K * std::pow(3., 0.5 * (m + 1.)) * std::pow(s, m + 1.)
                            : K * std::pow(2. * s, m + 1.);
  errors.compare("velocities", v, v_expected);
  errors.compare("pressures", p, p_expected);
  errors.compare("power", flow.power(law), power);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const PlanePair &pair : {mini_pair(), quadratic_pair()})
  {
    Errors plane, inclined, ring;
    for (const double m : {1., 0.3})
    {
      check(pair, Kinematics::plane_strain, m, 0., plane);
      check(pair, Kinematics::plane_strain, m, 25. * dealii::numbers::PI / 180., inclined);
      check(pair, Kinematics::axisymmetric, m, 0., ring);
    }
    std::cout << pair.name << ", plane strain" << std::endl;
    plane.print(1e-10);
    std::cout << pair.name << ", inclined" << std::endl;
    inclined.print(1e-10);
    std::cout << pair.name << ", around an axis" << std::endl;
    ring.print(1e-10);
  }
}
