// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/design/billet_map.h>
#include <retroforge/element/mini_element.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/mesh/mesh_quality.h>

#include <sstream>

namespace retroforge
{
  namespace
  {
    // Every node of a symmetry plane stays on it.
    bool keeps_symmetry(const ShapeParameter &parameter, const TetMesh &mesh)
    {
      for (const BoundaryFace &face : mesh.faces)
        if (const auto &plane = mesh.patches[face.patch].symmetry)
          for (const NodeIndex node : face.nodes)
            if (std::abs(parameter.direction[node] * plane->normal) > 1e-9)
              return false;
      return true;
    }

    template <typename Number>
    Number volume_at(const std::vector<std::array<NodeIndex, 4>> &cells, const NodalVectors<Number> &X)
    {
      Number sum(0.);
      for (const auto &cell : cells)
        sum += cross_product_3d(X[cell[1]] - X[cell[0]], X[cell[2]] - X[cell[0]]) * (X[cell[3]] - X[cell[0]]);
      return sum / 6.;
    }

    template <typename Number>
    void add(NodalVectors<Number> &X, const Number &factor, const NodalVectors<double> &direction)
    {
      for (std::size_t k = 0; k < X.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
          X[k][i] += factor * direction[k][i];
    }

    // Volume at X and its derivative along a field.
    Dual volume_along(const std::vector<std::array<NodeIndex, 4>> &cells,
                      const NodalVectors<double>                  &X,
                      const NodalVectors<double>                  &direction)
    {
      NodalVectors<Dual> dual(X.size());
      for (std::size_t k = 0; k < X.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
        {
          dual[k][i]                 = X[k][i];
          dual[k][i].fastAccessDx(0) = direction[k][i];
        }
      return volume_at(cells, dual);
    }

    NodalVectors<double> volume_gradient(const std::vector<std::array<NodeIndex, 4>> &cells,
                                         const NodalVectors<double>                  &X)
    {
      NodalVectors<double> gradient(X.size());
      for (const auto &cell : cells)
      {
        const auto geometry = cell_geometry(Four<Vec3>{{X[cell[0]], X[cell[1]], X[cell[2]], X[cell[3]]}});
        for (unsigned int a = 0; a < 4; ++a)
          gradient[cell[a]] += geometry.volume * geometry.g[a];
      }
      return gradient;
    }

    template <typename Number>
    std::vector<double> values_of(const std::vector<Number> &mu)
    {
      std::vector<double> values;
      for (const Number &x : mu)
        values.push_back(value_of(x));
      return values;
    }

    template <typename Number>
    NodalVectors<double> values_of(const NodalVectors<Number> &X)
    {
      NodalVectors<double> values(X.size());
      for (std::size_t k = 0; k < X.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
          values[k][i] = value_of(X[k][i]);
      return values;
    }

    std::string in_words(const double value)
    {
      std::ostringstream out;
      out << value;
      return out.str();
    }
  } // namespace

  BilletMap::BilletMap(const BilletParameters &billet, const TetMesh &mesh)
      : BilletMap(billet, first_mesh(billet, mesh))
  {
  }

  BilletMap::BilletMap(const BilletParameters &billet, const FirstMesh &first)
      : X_(first.mesh.X)
      , cells_(first.mesh.cells)
      , volume_(volume_along(cells_, X_, NodalVectors<double>(X_.size())).val())
      , shapes_(first.shapes)
      , at_(first.at)
  {
    std::vector<std::string> names;
    for (unsigned int j = 0; j < shapes_.parameters.size(); ++j)
    {
      const ShapeParameter &parameter = shapes_.parameters[j];
      if (!keeps_symmetry(parameter, first.mesh))
        continue;
      names.push_back(parameter.name);
      if (parameter.name == billet.volume_held_by)
        held_ = j;
      else
      {
        free_.push_back(parameter);
        place_.push_back(j);
      }
    }
    if (!billet.volume_held_by.empty() && !held_)
      throw Error("Billet/volume held by",
                  "is `" + billet.volume_held_by + "'",
                  names.empty() ? "this billet has no parameters of its shape"
                                : "it must be a parameter of the shape: " + join(names),
                  "name one of them, without `billet/', or leave it empty");
  }

  template <typename Number>
  NodalVectors<Number> BilletMap::moved(const std::vector<Number> &mu) const
  {
    AssertDimension(mu.size(), free_.size());
    NodalVectors<Number> X(X_.size());
    for (std::size_t k = 0; k < X.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
        X[k][i] = X_[k][i];
    for (unsigned int j = 0; j < mu.size(); ++j)
      add<Number>(X, mu[j] - at_[place_[j]], free_[j].direction);
    return X;
  }

  // Root d of V(X + d D) = V_0, a cubic in d. Quadratic convergence ends in rounding, where steps no longer
  // shrink.
  double BilletMap::held_by_newton(const NodalVectors<double> &X) const
  {
    const ShapeParameter &held   = shapes_.parameters[*held_];
    const double          growth = volume_along(cells_, X_, held.direction).dx(0); // at the nominal shape
    double                d = 0., last_step = std::numeric_limits<double>::max();
    for (unsigned int iteration = 0; iteration < 50; ++iteration)
    {
      NodalVectors<double> X_d = X;
      add(X_d, d, held.direction);
      const Dual V = volume_along(cells_, X_d, held.direction);
      if (!(V.dx(0) * growth > 0.)) // past the extremum of the cubic
        break;
      const double step = (volume_ - V.val()) / V.dx(0);
      if (std::abs(step) <= 1e-15 * held.scale ||
          (std::abs(step) < 1e-10 * held.scale && std::abs(step) >= last_step))
        return d;
      d += step;
      last_step = std::abs(step);
    }
    throw Error("Billet/volume held by",
                "no value of " + held.name + " keeps the volume " + in_words(volume_) + " mm^3",
                "there must be one for the other parameters of the shape",
                "change them less, or hold the volume by another parameter");
  }

  template <typename Number>
  Number BilletMap::held_value(const std::vector<Number> &mu) const
  {
    Assert(held_, dealii::ExcMessage("no parameter holds the volume"));
    const ShapeParameter &held = shapes_.parameters[*held_];
    NodalVectors<double>  X    = moved(values_of(mu));
    const double          d    = held_by_newton(X);
    Number                result(at_[*held_] + d);
    if constexpr (std::is_same_v<Number, Dual>)
    {
      add(X, d, held.direction);
      NodalVectors<Dual> X_mu = moved(mu);
      add(X_mu, Dual(d), held.direction);
      const double in_mu     = volume_at(cells_, X_mu).dx(0);
      const double in_held   = volume_along(cells_, X, held.direction).dx(0);
      result.fastAccessDx(0) = -in_mu / in_held;
    }
    return result;
  }

  void BilletMap::check(const std::vector<double> &mu, const double held) const
  {
    if (!shapes_.complaint)
      return;
    if (const std::string complaint = shapes_.complaint(all_values(mu, held)); !complaint.empty())
      throw Error("Design/billet",
                  complaint +
                    (held_ ? " (" + shapes_.parameters[*held_].name + " follows from the volume)" : ""),
                  "no portion of the contour may vanish or cross another, and radii are positive",
                  "stay closer to the nominal values");
  }

  void BilletMap::check_cells(const NodalVectors<double> &X) const
  {
    for (const auto &cell : cells_)
      if (!(tet_volume(corners(cell, X)) > 0.))
        throw Error("Design/billet",
                    "a tetrahedron of the mesh would be turned inside out",
                    "the mesh made at the nominal shape must be able to follow",
                    "make the new shape the nominal one, in the section Billet");
  }

  template <typename Number>
  NodalVectors<Number> BilletMap::positions(const std::vector<Number> &mu, const bool checked) const
  {
    NodalVectors<Number> X    = moved(mu);
    double               held = 0.;
    if (held_)
    {
      const ShapeParameter &parameter = shapes_.parameters[*held_];
      const Number          value     = held_value(mu);
      held                            = value_of(value);
      add<Number>(X, value - at_[*held_], parameter.direction);
    }
    if (checked)
    {
      check(values_of(mu), held);
      check_cells(values_of(X));
    }
    return X;
  }

  template <typename Number>
  NodalVectors<Number> BilletMap::positions(const std::vector<Number> &mu) const
  {
    return positions(mu, true);
  }

  double BilletMap::mesh_quality(const std::vector<double> &mu) const
  {
    return minimum_quality(cells_, positions(mu, false));
  }

  NodalVectors<double> BilletMap::nominal_positions() const
  {
    NodalVectors<double> X = X_;
    for (unsigned int j = 0; j < at_.size(); ++j)
      add(X, shapes_.parameters[j].nominal - at_[j], shapes_.parameters[j].direction);
    return X;
  }

  std::vector<double> BilletMap::all_values(const std::vector<double> &mu, const double held) const
  {
    std::vector<double> all;
    for (const ShapeParameter &parameter : shapes_.parameters)
      all.push_back(parameter.nominal);
    for (unsigned int j = 0; j < mu.size(); ++j)
      all[place_[j]] = mu[j];
    if (held_)
      all[*held_] = held;
    return all;
  }

  std::vector<double> BilletMap::all_values(const std::vector<double> &mu) const
  {
    return all_values(mu, held_ ? held_value(mu) : 0.);
  }

  std::vector<double> BilletMap::pull_back(const std::vector<double>  &mu,
                                           const NodalVectors<double> &X_bar) const
  {
    AssertDimension(mu.size(), free_.size());
    AssertDimension(X_bar.size(), X_.size());
    NodalVectors<double> bar = X_bar;
    if (held_)
    {
      // The held parameter takes up what the others do to the volume.
      const NodalVectors<double> &held     = shapes_.parameters[*held_].direction;
      const NodalVectors<double>  gradient = volume_gradient(cells_, positions(mu));
      add(bar, -dot(X_bar, held) / dot(gradient, held), gradient);
    }
    std::vector<double> mu_bar;
    for (const ShapeParameter &parameter : free_)
      mu_bar.push_back(dot(bar, parameter.direction));
    return mu_bar;
  }

  template NodalVectors<double> BilletMap::positions(const std::vector<double> &) const;
  template NodalVectors<Dual>   BilletMap::positions(const std::vector<Dual> &) const;
  template double               BilletMap::held_value(const std::vector<double> &) const;
  template Dual                 BilletMap::held_value(const std::vector<Dual> &) const;
} // namespace retroforge
