// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "../random_numbers.h"
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/element/taylor_hood.templates.h>

#include <cmath>
#include <iostream>
#include <map>
#include <string>

namespace retroforge
{
  /// Laws that differ from lane to lane, the first one `law`.
  inline LaneLaws laws_around(const MaterialLaw<double> &law)
  {
    LaneLaws laws;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      laws[lane] = law;
      laws[lane].K *= 1. + 0.3 * lane;
      laws[lane].m /= 1. + 0.1 * lane;
      laws[lane].e0 *= 1. + 0.2 * lane;
    }
    return laws;
  }

  /// And cells, and what is in them.
  class Random : public RandomNumbers
  {
  public:
    CellValues<double> cell_values()
    {
      CellValues<double> w;
      for (unsigned int a = 0; a < 4; ++a)
      {
        w.V[a] = vector();
        w.P[a] = scalar();
      }
      w.beta = vector();
      return w;
    }

    TaylorHoodValues<double> taylor_hood_values()
    {
      TaylorHoodValues<double> w;
      for (Vec3 &v : w.V)
        v = vector();
      for (double &p : w.P)
        p = scalar();
      return w;
    }

    /// A positively oriented tetrahedron of edges near 2 that is no sliver.
    Four<Vec3> cell()
    {
      Four<Vec3> X;
      do
        for (Vec3 &x : X)
          x = vector();
      while (cell_geometry(X).volume < 0.2);
      return X;
    }
  };

  /// Largest relative error of each of several comparisons.
  class Errors
  {
  public:
    /// Compares vectors relative to the reference's largest entry (absolutely when it is zero).
    void
    compare(const std::string &what, const std::vector<double> &value, const std::vector<double> &reference)
    {
      double difference = 0., size = 0.;
      for (std::size_t i = 0; i < value.size(); ++i)
      {
        // Written so that a NaN counts as wrong.
        if (!(std::abs(value[i] - reference[i]) <= difference))
          difference = std::abs(value[i] - reference[i]);
        size    = std::max(size, std::abs(reference[i]));
        finite_ = finite_ && std::isfinite(value[i]);
      }
      double &error = errors_[what];
      error         = std::max(error, finite_ ? difference / (size > 0. ? size : 1.) : 1e300);
    }

    void compare(const std::string &what, const double value, const double reference)
    {
      compare(what, std::vector<double>{value}, std::vector<double>{reference});
    }

    double largest() const
    {
      double largest = 0.;
      for (const auto &[what, error] : errors_)
        largest = std::max(largest, error);
      return largest;
    }

    /// One line per comparison: reached or not; the number itself when not.
    void print(const double bar) const
    {
      for (const auto &[what, error] : errors_)
        if (error < bar)
          std::cout << "  " << what << " < " << bar << ": yes" << std::endl;
        else
          std::cout << "  " << what << " < " << bar << ": NO, " << error << std::endl;
    }

  private:
    std::map<std::string, double> errors_;
    bool                          finite_ = true;
  };

  inline std::vector<double> flatten(const Four<Vec3> &v)
  {
    std::vector<double> flat;
    for (const Vec3 &x : v)
      flat.insert(flat.end(), x.begin_raw(), x.end_raw());
    return flat;
  }

  template <typename Number>
  void add_entries(Vector3<Number> &v, std::vector<Number *> &all)
  {
    for (unsigned int i = 0; i < 3; ++i)
      all.push_back(&v[i]);
  }

  /// The 19 unknowns of a cell in the order V (node, component), beta, P.
  template <typename Number>
  std::vector<Number *> entries(CellValues<Number> &w)
  {
    std::vector<Number *> all;
    for (auto &v : w.V)
      add_entries(v, all);
    add_entries(w.beta, all);
    for (Number &p : w.P)
      all.push_back(&p);
    return all;
  }

  /// The 34 unknowns of a cell in the order V (node, component), P.
  template <typename Number>
  std::vector<Number *> entries(TaylorHoodValues<Number> &w)
  {
    std::vector<Number *> all;
    for (auto &v : w.V)
      add_entries(v, all);
    for (Number &p : w.P)
      all.push_back(&p);
    return all;
  }

  template <template <typename> class Values, typename Number>
  std::vector<Number> flatten(Values<Number> w)
  {
    std::vector<Number> flat;
    for (const Number *entry : entries(w))
      flat.push_back(*entry);
    return flat;
  }
} // namespace retroforge
