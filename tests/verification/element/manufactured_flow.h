// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "flow_problem.h"

namespace retroforge
{
  /// A smooth flow that is no solution by itself: the velocity is a curl, and a body force balances its
  /// stresses.
  ///   v = curl( cos y sin 2z, cos z sin 2x, cos x sin 2y ),   p = sin 2x + cos(y + z)
  struct ManufacturedFlow
  {
    NortonHoff<double> law;

    template <typename Number>
    using Point = std::array<Number, 3>;

    template <typename Number>
    static Point<Number> velocity(const Point<Number> &x)
    {
      using std::cos;
      using std::sin;
      Point<Number> v;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Number &a = x[i], &b = x[(i + 1) % 3], &c = x[(i + 2) % 3];
        v[i] = 2. * cos(a) * cos(Number(2. * b)) + sin(c) * sin(Number(2. * a));
      }
      return v;
    }

    template <typename Number>
    static Number pressure(const Point<Number> &x)
    {
      using std::cos;
      using std::sin;
      return sin(Number(2. * x[0])) + cos(Number(x[1] + x[2]));
    }

    /// L_ij = dv_i/dx_j.
    template <typename Number>
    static std::array<Point<Number>, 3> velocity_gradient(const Point<Number> &x)
    {
      using Derivatives = Sacado::Fad::SFad<Number, 3>;
      Point<Derivatives> independent;
      for (unsigned int i = 0; i < 3; ++i)
        independent[i] = Derivatives(3, i, x[i]);
      const Point<Derivatives>     v = velocity(independent);
      std::array<Point<Number>, 3> L;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          L[i][j] = v[i].fastAccessDx(j);
      return L;
    }

    template <typename Number>
    std::array<Point<Number>, 3> stress(const Point<Number> &x) const
    {
      std::array<Point<Number>, 3> sigma = velocity_gradient(x);
      Number                       eps2(0.);
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j <= i; ++j)
        {
          sigma[i][j] = sigma[j][i] = 0.5 * (sigma[i][j] + sigma[j][i]);
          eps2 += (i == j ? 1. : 2.) * sigma[i][j] * sigma[i][j];
        }
      const NortonHoff<Number> here{Number(law.K), Number(law.m), Number(law.e0)};
      const Number             factor = here(eps2);
      for (unsigned int i = 0; i < 3; ++i)
      {
        for (unsigned int j = 0; j < 3; ++j)
          sigma[i][j] = factor * sigma[i][j];
        sigma[i][i] -= pressure(x);
      }
      return sigma;
    }

    Vec3 body_force(const Vec3 &x) const
    {
      using Derivatives = Sacado::Fad::SFad<double, 3>;
      Point<Derivatives> independent;
      for (unsigned int i = 0; i < 3; ++i)
        independent[i] = Derivatives(3, i, x[i]);
      const auto sigma = stress(independent);
      Vec3       force;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          force[i] -= sigma[i][j].fastAccessDx(j);
      return force;
    }

    Vec3 traction(const Vec3 &x, const Vec3 &normal) const
    {
      const auto sigma = stress(Point<double>{{x[0], x[1], x[2]}});
      Vec3       t;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          t[i] += sigma[i][j] * normal[j];
      return t;
    }

    static Vec3 velocity_at(const Vec3 &x)
    {
      const auto v = velocity(Point<double>{{x[0], x[1], x[2]}});
      return Vec3({v[0], v[1], v[2]});
    }

    static double pressure_at(const Vec3 &x) { return pressure(Point<double>{{x[0], x[1], x[2]}}); }

    /// Without bubbles.
    Field<double> interpolant(const TetMesh &mesh, const Discretization<3> &discretization) const
    {
      Field<double> W(discretization);
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      {
        W.V[k] = velocity_at(mesh.X[k]);
        W.P[k] = pressure_at(mesh.X[k]);
      }
      if (const MiddleNodes *middles = discretization.middles())
        for (const auto &[a, b] : middles->ends())
          W.V[middles->between(a, b)] = velocity_at(0.5 * (mesh.X[a] + mesh.X[b]));
      return W;
    }

    /// The body force on the velocity functions of a cell at X.
    template <typename Pair>
    auto body_load(const Pair pair, const std::vector<SubCellPoint> &points, const Four<Vec3> &X) const
    {
      typename Pair::template Values<double> load   = {};
      const double                           volume = cell_geometry(X).volume;
      for (const SubCellPoint &point : points)
      {
        const Vec3                force  = body_force(point.position(X)) * (point.weight * volume);
        const std::vector<double> values = velocity_functions(pair, point);
        for (unsigned int f = 0; f < values.size(); ++f)
          coefficient(load, f) += values[f] * force;
      }
      return load;
    }

    /// Forces of the traction on one patch at the velocity nodes.
    NodalVectors<double> traction_load(const TetMesh           &mesh,
                                       const Discretization<3> &discretization,
                                       const std::string       &patch) const
    {
      const dealii::QGaussSimplex<2> rule(4);
      NodalVectors<double>           load(discretization.condensed_nodes()->n());
      for (unsigned int f = 0; f < mesh.faces.size(); ++f)
        if (mesh.patches[mesh.faces[f].patch].name == patch)
        {
          const std::vector<NodeIndex> nodes = velocity_nodes_of_face(mesh, discretization, f);
          const Vec3                  &A = mesh.X[nodes[0]], &B = mesh.X[nodes[1]], &C = mesh.X[nodes[2]];
          const Vec3                   n = cross(Vec3(B - A), Vec3(C - A)); // twice the area long
          for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double        s = rule.point(q)[0], t = rule.point(q)[1], r = 1. - s - t;
            const Vec3          force  = traction(A + s * (B - A) + t * (C - A), n) * rule.weight(q);
            std::vector<double> values = {r, s, t};
            if (nodes.size() > 3)
              values = {
                r * (2. * r - 1.), s * (2. * s - 1.), t * (2. * t - 1.), 4. * r * s, 4. * s * t, 4. * t * r};
            for (unsigned int c = 0; c < values.size(); ++c)
              load[nodes[c]] += values[c] * force;
          }
        }
      return load;
    }
  };
} // namespace retroforge
