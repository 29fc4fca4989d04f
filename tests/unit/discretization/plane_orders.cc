// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Both pairs on Discretization<2> and a smooth flow of a power law that is no solution by itself: a body
// force balances its stresses. The velocity is given on three sides (on the axis, where there is one, across
// it only), the traction on the fourth. Velocity, its gradient and the pressure approach the flow's, in plane
// strain and around an axis, with the orders of approximation, less a fifth:  2, 1, 1 of the mini element and
// 3, 2, 2 of P2-P1.

#include "plane_flow.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>

#include <retroforge/element/fe_simplex_hat.h>

using namespace retroforge;

/// Of a function psi,  v = (d psi/dy, -d psi/dx)  in the plane and  (-d psi/dz, d psi/dr)/r  around an axis.
struct SmoothFlow
{
  MaterialLaw<double> law;
  Kinematics          kinematics;

  template <typename Number>
  using Pair = std::array<Number, 2>;

  bool ring() const { return kinematics == Kinematics::axisymmetric; }

  template <typename Number>
  Pair<Number> velocity(const Pair<Number> &x) const
  {
    using std::cos;
    using std::sin;
    if (ring()) // psi = r^2 (1 + r^2) sin z
      return {{Number(-x[0] * (1. + x[0] * x[0]) * cos(x[1])), Number((2. + 4. * x[0] * x[0]) * sin(x[1]))}};
    // psi = sin(2x) cos(y) + x y
    return {{Number(x[0] - sin(Number(2. * x[0])) * sin(x[1])),
             Number(-x[1] - 2. * cos(Number(2. * x[0])) * cos(x[1]))}};
  }

  template <typename Number>
  static Number pressure(const Pair<Number> &x)
  {
    using std::cos;
    using std::sin;
    return sin(Number(2. * x[0])) + cos(Number(2. * x[1]));
  }

  template <typename Number>
  std::array<Pair<Number>, 2> gradient(const Pair<Number> &x) const
  {
    using Derivatives = Sacado::Fad::SFad<Number, 2>;
    const auto v      = velocity(Pair<Derivatives>{{Derivatives(2, 0, x[0]), Derivatives(2, 1, x[1])}});
    return {{{{v[0].fastAccessDx(0), v[0].fastAccessDx(1)}}, {{v[1].fastAccessDx(0), v[1].fastAccessDx(1)}}}};
  }

  /// sigma as xx, yy, around the axis, xy.
  template <typename Number>
  std::array<Number, 4> stress(const Pair<Number> &x) const
  {
    const auto                  L    = gradient(x);
    const Number                hoop = ring() ? Number(velocity(x)[0] / x[0]) : Number(0.);
    const std::array<Number, 4> eps{{L[0][0], L[1][1], hoop, Number(0.5 * (L[0][1] + L[1][0]))}};
    const MaterialLaw<Number>   here{Number(law.K), Number(law.m), Number(law.e0)};
    const Number                factor =
      here(Number(eps[0] * eps[0] + eps[1] * eps[1] + eps[2] * eps[2] + 2. * eps[3] * eps[3]));
    std::array<Number, 4> sigma;
    for (unsigned int k = 0; k < 4; ++k)
      sigma[k] = factor * eps[k] - (k < 3 ? pressure(x) : Number(0.));
    return sigma;
  }

  dealii::Tensor<1, 2> body_force(const dealii::Point<2> &x) const
  {
    using Derivatives      = Sacado::Fad::SFad<double, 2>;
    const auto           s = stress(Pair<Derivatives>{{Derivatives(2, 0, x[0]), Derivatives(2, 1, x[1])}});
    dealii::Tensor<1, 2> f({-s[0].dx(0) - s[3].dx(1), -s[3].dx(0) - s[1].dx(1)});
    if (ring())
    {
      f[0] -= (s[0].val() - s[2].val()) / x[0];
      f[1] -= s[3].val() / x[0];
    }
    return f;
  }

  double circumference(const dealii::Point<2> &x) const
  {
    return ring() ? 2. * dealii::numbers::PI * x[0] : 1.;
  }
};

/// L2 norms of errors.
struct FlowErrors
{
  double velocity = 0., gradient = 0., pressure = 0.;
};

class SmoothProblem
{
public:
  SmoothProblem(const ElementPair pair, const SmoothFlow &exact, const unsigned int n)
      : exact_(exact)
      , flow_(unit_square(n, 0.2, {}), plane_choice(pair, exact.kinematics))
      , rule_(pair == ElementPair::mini ? iterated_on_hat(dealii::QGaussSimplex<2>(3))
                                        : dealii::QGaussSimplex<2>(4))
  {
    flow_.set_velocity([&](const dealii::Point<2> &x) {
      const auto v = exact_.velocity(SmoothFlow::Pair<double>{{x[0], x[1]}});
      return dealii::Tensor<1, 2>({v[0], v[1]});
    });
    flow_.for_each_node([&](const NodeIndex k, const dealii::Point<2> &x) {
      if (x[1] < 1e-9 || x[1] > 1. - 1e-9 || (x[0] < 1e-9 && !exact.ring()))
        flow_.hold(k);
    });
  }

  FlowErrors errors()
  {
    const unsigned int iterations = flow_.solve(exact_.law, [this](const CellIndex c) { return load(c); });
    AssertThrow(iterations < 60, dealii::ExcMessage("Newton's method does not converge"));
    // The handlers have the numbers of the places on one rank.
    const auto            &discretization = flow_.discretization;
    dealii::Vector<double> V(flow_.n_velocities()), P(flow_.n_unknowns() - flow_.n_velocities());
    for (unsigned int i = 0; i < V.size(); ++i)
      V(i) = flow_.W.V.at_place(i / 2)[i % 2];
    for (unsigned int i = 0; i < P.size(); ++i)
      P(i) = flow_.W.P.at_place(i);
    const auto flags = dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points |
                       dealii::update_JxW_values;
    dealii::FEValues<2> velocities(mapping_, discretization.velocity_dofs().get_fe(), rule_, flags),
      pressures(mapping_, discretization.pressure_dofs().get_fe(), rule_, dealii::update_values);
    FlowErrors                                     errors;
    std::vector<dealii::Vector<double>>            v_h(rule_.size(), dealii::Vector<double>(2));
    std::vector<std::vector<dealii::Tensor<1, 2>>> L_h(rule_.size(), std::vector<dealii::Tensor<1, 2>>(2));
    std::vector<double>                            p_h(rule_.size());
    for (const auto &cell : discretization.velocity_dofs().active_cell_iterators())
    {
      velocities.reinit(cell);
      velocities.get_function_values(V, v_h);
      velocities.get_function_gradients(V, L_h);
      pressures.reinit(dealii::DoFHandler<2>::active_cell_iterator(
        &cell->get_triangulation(), cell->level(), cell->index(), &discretization.pressure_dofs()));
      pressures.get_function_values(P, p_h);
      for (unsigned int q = 0; q < rule_.size(); ++q)
      {
        const auto                     point = velocities.quadrature_point(q);
        const SmoothFlow::Pair<double> x{{point[0], point[1]}};
        const auto                     v   = exact_.velocity(x);
        const auto                     L   = exact_.gradient(x);
        const double                   JxW = velocities.JxW(q) * exact_.circumference(point);
        for (unsigned int i = 0; i < 2; ++i)
        {
          errors.velocity += JxW * std::pow(v_h[q](i) - v[i], 2);
          for (unsigned int j = 0; j < 2; ++j)
            errors.gradient += JxW * std::pow(L_h[q][i][j] - L[i][j], 2);
        }
        errors.pressure += JxW * std::pow(p_h[q] - exact_.pressure(x), 2);
      }
    }
    for (double *error : {&errors.velocity, &errors.gradient, &errors.pressure})
      *error = std::sqrt(*error);
    return errors;
  }

private:
  /// The body force, and on the right side the traction.
  std::vector<double> load(const CellIndex c) const
  {
    const auto         &dofs    = flow_.discretization.velocity_dofs();
    const auto         &element = dofs.get_fe();
    const auto          cell    = cell_with(c);
    std::vector<double> f(element.n_dofs_per_cell(), 0.);
    const auto          add = [&](const auto &values, const auto &force) {
      for (const unsigned int q : values.quadrature_point_indices())
      {
        const auto                 x = values.quadrature_point(q);
        const dealii::Tensor<1, 2> F = force(x) * (values.JxW(q) * exact_.circumference(x));
        for (unsigned int i = 0; i < f.size(); ++i)
        {
          const auto [component, a] = element.system_to_component_index(i);
          f[2 * a + component] += F[component] * values.shape_value(i, q);
        }
      }
    };
    const auto flags = dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
    dealii::FEValues<2> inside(mapping_, element, rule_, flags);
    inside.reinit(cell);
    add(inside, [this](const dealii::Point<2> &x) { return exact_.body_force(x); });
    for (const unsigned int face : cell->face_indices())
      if (cell->face(face)->at_boundary() && cell->face(face)->boundary_id() == right)
      {
        dealii::FEFaceValues<2> on_face(mapping_, element, dealii::QGauss<1>(4), flags);
        on_face.reinit(cell, face);
        add(on_face, [this](const dealii::Point<2> &x) {
          const auto s = exact_.stress(SmoothFlow::Pair<double>{{x[0], x[1]}});
          return dealii::Tensor<1, 2>({s[0], s[3]});
        });
      }
    return f;
  }

  /// Of an unpartitioned triangulation, which has its cells in the order of the mesh.
  dealii::DoFHandler<2>::active_cell_iterator cell_with(const CellIndex c) const
  {
    const auto &dofs = flow_.discretization.velocity_dofs();
    return {&dofs.get_triangulation(), 0, static_cast<int>(c), &dofs};
  }

  SmoothFlow            exact_;
  PlaneFlow             flow_;
  dealii::Quadrature<2> rule_;
  dealii::MappingFE<2>  mapping_{dealii::FE_SimplexP<2>(1)};
};

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const auto kinematics : {Kinematics::plane_strain, Kinematics::axisymmetric})
    for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
      for (const double m : {1., 0.3})
      {
        const bool         mini = pair == ElementPair::mini;
        const SmoothFlow   flow{{1., m, 0.1}, kinematics};
        const unsigned int n      = mini ? 16 : 8;
        const FlowErrors   coarse = SmoothProblem(pair, flow, n).errors(),
                         fine     = SmoothProblem(pair, flow, 2 * n).errors();
        std::cout << name_of(pair) << (flow.ring() ? ", around an axis" : ", plane strain") << ", m = " << m
                  << std::endl;
        const auto print = [&](const std::string &what, const double expected, double FlowErrors::*error) {
          const double order = std::log2(coarse.*error / fine.*error);
          std::cout << "  " << what << ", order " << expected << ": "
                    << (order > expected - 0.2 ? "yes" : "NO, " + std::to_string(order)) << std::endl;
        };
        print("velocity", mini ? 2. : 3., &FlowErrors::velocity);
        print("gradient", mini ? 1. : 2., &FlowErrors::gradient);
        print("pressure", mini ? 1. : 2., &FlowErrors::pressure);
      }
}
