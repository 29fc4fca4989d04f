// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Both pairs on Discretization<2>, on an irregular mesh of the unit square. Proved: upsetting at strain rate
// s is found exactly where it is uniform, and seen so by strains and pictures,
// - in plane strain, v = s (x, -y), the pressure that leaves the side free, and the power
//   K 2^(m+1) s^(m+1) per area;
// - of a cylinder around its axis, v = s (-r/2, z) upside down, and the power K 3^((m+1)/2) s^(m+1) pi; the
//   axis is no line of symmetry of the mesh;
// - in plane strain with the whole turned by 25 degrees: two lines of symmetry and the tool are inclined, and
//   nothing flows through them;
// - with quadratic geometry as with linear. What cannot be had is refused.

#include "plane_flow.h"
#include <retroforge/core/error.h>
#include <retroforge/discretization/strain_history.h>
#include <retroforge/output/cell_fields.h>

using namespace retroforge;

constexpr double s = 0.7, K = 1.693;

/// The velocity at the unit square before it is turned.
dealii::Tensor<1, 2> uniform(const dealii::Point<2> &x, const bool ring)
{
  return dealii::Tensor<1, 2>({(ring ? 0.5 : 1.) * s * x[0], -s * x[1]});
}

SimplexMesh<2> turned(SimplexMesh<2> mesh, const dealii::Tensor<1, 2> &e_x, const dealii::Tensor<1, 2> &e_y)
{
  const auto turn = [&](dealii::Tensor<1, 2> &x) { x = x[0] * e_x + x[1] * e_y; };
  for (auto &x : mesh.X)
    turn(x);
  for (auto &patch : mesh.patches)
    if (patch.symmetry)
    {
      turn(patch.symmetry->point);
      turn(patch.symmetry->normal);
    }
  return mesh;
}

/// Where it is uniform, what cells are said to undergo. Axes of the square.
void check_cells(const PlaneFlow &flow, const MaterialLaw<double> &law, const bool ring, Errors &errors)
{
  const double rate = ring ? s : 2. / std::sqrt(3.) * s, dt = 0.03;
  // Euler's scheme, from a strain of 0.1.
  const std::vector<double> before(flow.mesh.n_cells(), 0.1), after(flow.mesh.n_cells(), 0.1 + rate * dt);
  errors.compare(
    "accumulated strains", accumulate_strain(flow.discretization, flow.X, flow.W, dt, before), after);
  const CellFields fields = cell_fields(flow.discretization, flow.X, flow.W, [&](CellIndex) { return law; });
  errors.compare("strain rates", fields.strain_rate, std::vector<double>(flow.mesh.n_cells(), rate));
  const double across = ring ? 0.5 * s : s, around = ring ? 0.5 * s : 0., factor = law(1.5 * rate * rate);
  errors.compare(
    "equivalent stresses", fields.von_mises, std::vector<double>(flow.mesh.n_cells(), 1.5 * factor * rate));
  if (flow.mesh.X[1][1] == 0.) // not turned
    for (const auto &stress : fields.stress)
      errors.compare("stresses",
                     {stress.begin(), stress.end()},
                     {factor * across, -factor * s, factor * around, 0., 0., 0.});
}

void check(const DiscretizationChoice &choice, const double m, const double angle, Errors &errors)
{
  const bool                 ring = choice.kinematics == Kinematics::axisymmetric;
  const dealii::Tensor<1, 2> e_x({std::cos(angle), std::sin(angle)}),
    e_y({-std::sin(angle), std::cos(angle)});
  const std::vector<Side> held =
    ring ? std::vector<Side>{lower, upper} : std::vector<Side>{left, lower, upper};
  PlaneFlow flow(turned(unit_square(5, 0.3, held), e_x, e_y), choice);
  // As the tool moves, and as no incompressible metal does.
  flow.set_velocity([&](const dealii::Point<2> &x) { return -s * (e_y * x) * e_y; });
  const MaterialLaw<double> law{K, m, 0.};
  flow.solve(law);

  std::vector<double> v, v_expected;
  flow.for_each_node([&](const NodeIndex k, const dealii::Point<2> &x) {
    const auto local = uniform(dealii::Point<2>(e_x * x, e_y * x), ring);
    for (unsigned int i = 0; i < 2; ++i)
    {
      v.push_back(flow.W.V[k][i]);
      v_expected.push_back((local[0] * e_x + local[1] * e_y)[i]);
    }
  });
  // The side is free:  p = factor eps_xx.
  const double across = ring ? 0.5 * s : s, eps2 = ring ? 1.5 * s * s : 2. * s * s;
  const double power = ring ? dealii::numbers::PI * K * std::pow(3., 0.5 * (m + 1.)) * std::pow(s, m + 1.)
                            : K * std::pow(2. * s, m + 1.);
  errors.compare("velocities", v, v_expected);
  errors.compare("pressures",
                 {flow.W.P.begin(), flow.W.P.end()},
                 std::vector<double>(flow.mesh.n_nodes(), law(eps2) * across));
  errors.compare("power", flow.power(law), power);
  check_cells(flow, law, ring, errors);
}

/// Whether there is no such discretisation, and the message names the place.
void refused(const std::string          &what,
             const SimplexMesh<2>       &mesh,
             const DiscretizationChoice &choice,
             const std::string          &place)
{
  std::string message;
  try
  {
    const Discretization<2> made(mesh, choice, MPI_COMM_SELF);
  }
  catch (const Error &error)
  {
    message = error.what();
  }
  std::cout << "  " << what << ": " << (message.rfind(place, 0) == 0 ? "yes" : "NO, " + message) << std::endl;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
    for (const unsigned int degree : {1, 2})
    {
      const auto plane_strain = plane_choice(pair, Kinematics::plane_strain, degree),
                 axisymmetric = plane_choice(pair, Kinematics::axisymmetric, degree);
      Errors plane, inclined, ring;
      for (const double m : {1., 0.3})
      {
        check(plane_strain, m, 0., plane);
        check(plane_strain, m, 25. * dealii::numbers::PI / 180., inclined);
        check(axisymmetric, m, 0., ring);
      }
      const std::string name = name_of(pair) + (degree == 1 ? "" : ", quadratic geometry");
      std::cout << name << ", plane strain" << std::endl;
      plane.print(1e-10);
      std::cout << name << ", inclined" << std::endl;
      inclined.print(1e-10);
      std::cout << name << ", around an axis" << std::endl;
      ring.print(1e-10);
    }
  std::cout << "refused" << std::endl;
  const auto mesh   = unit_square(2, 0., {});
  const auto ring   = plane_choice(ElementPair::mini, Kinematics::axisymmetric);
  auto       beyond = mesh;
  for (auto &x : beyond.X)
    x[0] -= 0.5;
  refused("metal beyond the axis", beyond, ring, "Mesh of an axisymmetric flow, node 0:");
  refused("kinematics of space",
          mesh,
          plane_choice(ElementPair::mini, Kinematics::three_dimensions),
          "Discretization/kinematics:");
  auto closed     = ring;
  closed.assembly = Assembly::closed_form;
  refused("closed forms", mesh, closed, "Discretization/assembly:");
  refused("cubic geometry",
          mesh,
          plane_choice(ElementPair::mini, Kinematics::plane_strain, 3),
          "Discretization/geometry degree:");
}
