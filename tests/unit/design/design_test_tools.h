// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/design/billet_map.h>

#include "../mesh/mesh_test_tools.h"

namespace retroforge
{
  using Entries = std::vector<std::pair<std::string, std::string>>;

  /// A billet and the map of its shape.
  struct MappedBillet
  {
    explicit MappedBillet(const Entries &entries)
        : parameters(billet_parameters(entries))
        , mesh(make_billet(parameters, MPI_COMM_WORLD))
        , map(parameters, mesh)
    {
      for (const ShapeParameter &shape : map.parameters())
        nominal.push_back(shape.nominal);
    }

    const BilletParameters parameters;
    const TetMesh          mesh;
    const BilletMap        map;
    std::vector<double>    nominal;

    std::vector<double> changed(const unsigned int j, const double change) const
    {
      std::vector<double> mu = nominal;
      mu[j] += change;
      return mu;
    }
  };

  inline double norm(const NodalVectors<double> &X)
  {
    double sum = 0.;
    for (const Vec3 &x : X)
      sum += x.norm_square();
    return std::sqrt(sum);
  }

  inline NodalVectors<double>
  derivative(const BilletMap &map, const std::vector<double> &mu, const unsigned int j)
  {
    std::vector<Dual> dual(mu.begin(), mu.end());
    dual[j].fastAccessDx(0) = 1.;
    const auto           X  = map.positions(dual);
    NodalVectors<double> dX(X.size());
    for (std::size_t k = 0; k < X.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
        dX[k][i] = X[k][i].dx(0);
    return dX;
  }

  /// | dX_0/dmu_j - differences | / | dX_0/dmu_j |, the norm taken over all nodes (151), by central
  /// differences of fourth order.
  inline double derivative_error(const BilletMap &map, std::vector<double> mu, const unsigned int j)
  {
    const auto   exact = derivative(map, mu, j);
    const double step = 1e-3 * map.parameters()[j].scale, centre = mu[j];
    auto         error = exact;
    for (const auto &[multiple, weight] : {std::pair(1, 8.), {-1, -8.}, {2, -1.}, {-2, 1.}})
    {
      mu[j]        = centre + multiple * step;
      const auto X = map.positions(mu);
      for (std::size_t k = 0; k < X.size(); ++k)
        error[k] -= weight / (12. * step) * X[k];
    }
    return norm(error) / norm(exact);
  }

  /// Largest difference between the positions by double and by Dual.
  inline double dual_defect(const BilletMap &map, const std::vector<double> &mu)
  {
    const auto X    = map.positions(mu);
    const auto dual = map.positions(std::vector<Dual>(mu.begin(), mu.end()));
    double     most = 0.;
    for (std::size_t k = 0; k < X.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
        most = std::max(most, std::abs(X[k][i] - dual[k][i].val()));
    return most;
  }

  /// Whether the nominal values give the nominal positions, bit for bit.
  inline bool is_identity(const MappedBillet &billet)
  {
    return billet.map.positions(billet.nominal) == billet.mesh.X;
  }

  inline double relative_change_of_volume(const MappedBillet &billet, const NodalVectors<double> &X)
  {
    return std::abs(volume(billet.mesh.cells, X) / volume(billet.mesh.cells, billet.mesh.X) - 1.);
  }

  /// Farthest a node of a symmetry plane is from it.
  inline double symmetry_defect_at(const TetMesh &mesh, const NodalVectors<double> &X)
  {
    TetMesh moved = mesh;
    moved.X       = X;
    return symmetry_defect(moved);
  }
} // namespace retroforge
