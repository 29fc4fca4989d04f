// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/interface_law.h>
#include <retroforge/contact/surface_rates.h>
#include <retroforge/element/cell_geometry.h>
#include <retroforge/geometry/closing_speed.h>

namespace retroforge
{
  std::vector<CellIndex>
  cells_behind(const TetMesh &mesh, const Topology &topology, const ContactPoint &point)
  {
    std::vector<CellIndex> cells;
    point.for_each_face(mesh, topology, [&](const unsigned int f) {
      cells.push_back(topology.cell_of_face[f]);
      Assert(cells.back() != invalid_index, dealii::ExcMessage("a face of the boundary belongs to a cell"));
    });
    return cells;
  }

  namespace
  {
    template <typename Number>
    Four<Vector3<Number>> corners_of(const TetMesh &mesh, const NodalVectors<Number> &x, const CellIndex c)
    {
      const auto &k = mesh.cells[c];
      return {{x[k[0]], x[k[1]], x[k[2]], x[k[3]]}};
    }

    /// grad v and D, row by row.
    template <typename Number>
    using Matrix = std::array<Vector3<Number>, 3>;

    template <typename Number>
    Matrix<Number> gradient(const CellGeometry<Number> &geometry, const Four<Vector3<Number>> &v)
    {
      Matrix<Number> L;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          L[i] += geometry.g[a] * v[a][i];
      return L;
    }

    template <typename Number>
    Matrix<Number> symmetric(const Matrix<Number> &L)
    {
      Matrix<Number> D;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          D[i][j] = 0.5 * (L[i][j] + L[j][i]);
      return D;
    }

    /// 2/3 D:D
    template <typename Number>
    Number rate_in(const TetMesh              &mesh,
                   const NodalVectors<Number> &X,
                   const NodalVectors<Number> &velocity,
                   const CellIndex             c)
    {
      const Matrix<Number> D =
        symmetric(gradient(cell_geometry(corners_of(mesh, X, c)), corners_of(mesh, velocity, c)));
      return 2. / 3. * (D[0] * D[0] + D[1] * D[1] + D[2] * D[2]);
    }

    void reverse_rate_in(const TetMesh              &mesh,
                         const NodalVectors<double> &X,
                         const NodalVectors<double> &velocity,
                         const CellIndex             c,
                         const double                rate_bar,
                         NodalVectors<double>       &X_bar,
                         NodalVectors<double>       &velocity_bar)
    {
      const auto           geometry = cell_geometry(corners_of(mesh, X, c));
      const Matrix<double> L        = gradient(geometry, corners_of(mesh, velocity, c));
      Matrix<double>       L_bar    = symmetric(L);
      for (Vec3 &row : L_bar)
        row *= 4. / 3. * rate_bar;
      // dL = sum dv_a g_a - L sum dX_a g_a
      for (unsigned int a = 0; a < 4; ++a)
      {
        Vec3 at;
        for (unsigned int i = 0; i < 3; ++i)
          at[i] = L_bar[i] * geometry.g[a];
        velocity_bar[mesh.cells[c][a]] += at;
        for (unsigned int i = 0; i < 3; ++i)
          X_bar[mesh.cells[c][a]] -= at[i] * L[i];
      }
    }

    template <typename Number>
    bool knows_velocity(const ContactView<Number> &view)
    {
      return view.velocity && !view.velocity->empty();
    }

    /// Volume, and integrals of x·c and (x·c)^2.
    template <typename Number>
    std::array<Number, 3> moments(const ContactView<Number> &view, const Vector3<Number> &c)
    {
      std::array<Number, 3> sum{{Number(0.), Number(0.), Number(0.)}};
      for (CellIndex cell = 0; cell < view.mesh.n_cells(); ++cell)
      {
        const auto   X      = corners_of(view.mesh, view.X, cell);
        const Number volume = cell_geometry(X).volume;
        Number       first(0.), second(0.);
        for (const auto &x : X)
        {
          const Number y = x * c;
          first += y;
          second += y * y;
        }
        sum[0] += volume;
        sum[1] += 0.25 * volume * first;
        sum[2] += 0.05 * volume * (second + first * first);
      }
      return sum;
    }

    /// (|c|/h)^2 = (c·c)^2 / (12 variance of x·c); 0 where no die moves.
    template <typename Number>
    Number rate_of_press(const ContactView<Number> &view)
    {
      const Vector3<Number> c  = closing_dies(view.states).velocity(view.states);
      const Number          c2 = c * c;
      if (value_of(c2) == 0.)
        return Number(0.);
      const auto [volume, first, second] = moments(view, c);
      const Number mean                  = first / volume;
      return c2 * c2 / (12. * (second / volume - mean * mean));
    }

    void reverse_rate_of_press(const ContactView<double>     &view,
                               const double                   rate_bar,
                               NodalVectors<double>          &X_bar,
                               std::vector<DieState<double>> &dies_bar)
    {
      const ClosingDies closing = closing_dies(view.states);
      const Vec3        c       = closing.velocity(view.states);
      const double      c2      = c * c;
      if (c2 == 0.)
        return;
      const auto [volume, first, second] = moments(view, c);
      const double mean = first / volume, variance = second / volume - mean * mean,
                   rate = c2 * c2 / (12. * variance), variance_bar = -rate / variance * rate_bar;
      const double second_bar = variance_bar / volume, first_bar = -2. * mean * variance_bar / volume,
                   volume_bar = variance_bar * (-second / volume + 2. * mean * mean) / volume;
      Vec3 c_bar              = 4. * rate / c2 * rate_bar * c;
      for (CellIndex cell = 0; cell < view.mesh.n_cells(); ++cell)
      {
        const auto   X        = corners_of(view.mesh, view.X, cell);
        const auto   geometry = cell_geometry(X);
        const double v        = geometry.volume;
        double       sum = 0., squares = 0.;
        for (const Vec3 &x : X)
        {
          sum += x * c;
          squares += (x * c) * (x * c);
        }
        Four<Vec3> cell_bar = {};
        reverse_cell_geometry(geometry,
                              volume_bar + 0.25 * sum * first_bar + 0.05 * (squares + sum * sum) * second_bar,
                              {},
                              cell_bar);
        for (unsigned int a = 0; a < 4; ++a)
        {
          const double y_bar = v * (0.25 * first_bar + 0.1 * (X[a] * c + sum) * second_bar);
          X_bar[view.mesh.cells[cell][a]] += cell_bar[a] + y_bar * c;
          c_bar += y_bar * X[a];
        }
      }
      dies_bar[closing.die].velocity += c_bar;
      if (closing.other != invalid_index)
        dies_bar[closing.other].velocity -= c_bar;
    }
  } // namespace

  template <typename Number>
  std::vector<Number> surface_rates(const ContactView<Number> &view, const std::vector<ContactPair> &pairs)
  {
    if (std::none_of(view.states.begin(), view.states.end(), follows_rate<Number>))
      return {};
    std::vector<Number> rates(pairs.size(), Number(0.)), of_cells;
    std::vector<char>   known;
    Number              of_press(0.);
    if (knows_velocity(view))
    {
      AssertDimension(view.velocity->size(), view.X.size());
      of_cells.resize(view.mesh.n_cells());
      known.resize(view.mesh.n_cells(), 0);
    }
    else
      of_press = rate_of_press(view);
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (!follows_rate(view.states[pairs[p].die]))
        continue;
      if (!knows_velocity(view))
      {
        rates[p] = of_press;
        continue;
      }
      const std::vector<CellIndex> cells = cells_behind(view.mesh, view.topology, pairs[p].point);
      for (const CellIndex c : cells)
      {
        if (!known[c])
          of_cells[c] = rate_in(view.mesh, view.X, *view.velocity, c);
        known[c] = 1;
        rates[p] += of_cells[c] / double(cells.size());
      }
    }
    return rates;
  }

  template std::vector<double> surface_rates(const ContactView<double> &, const std::vector<ContactPair> &);
  template std::vector<Dual>   surface_rates(const ContactView<Dual> &, const std::vector<ContactPair> &);

  void reverse_surface_rates(const ContactView<double>      &view,
                             const std::vector<ContactPair> &pairs,
                             const std::vector<double>      &rates_bar,
                             NodalVectors<double>           &X_bar,
                             NodalVectors<double>           &velocity_bar,
                             std::vector<DieState<double>>  &dies_bar)
  {
    AssertDimension(rates_bar.size(), pairs.size());
    double              press_bar = 0.;
    std::vector<double> cells_bar(knows_velocity(view) ? view.mesh.n_cells() : 0, 0.);
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (rates_bar[p] == 0.)
        continue;
      Assert(follows_rate(view.states[pairs[p].die]), dealii::ExcMessage("a rate that nothing follows"));
      if (cells_bar.empty())
      {
        press_bar += rates_bar[p];
        continue;
      }
      const std::vector<CellIndex> cells = cells_behind(view.mesh, view.topology, pairs[p].point);
      for (const CellIndex c : cells)
        cells_bar[c] += rates_bar[p] / double(cells.size());
    }
    if (press_bar != 0.)
      reverse_rate_of_press(view, press_bar, X_bar, dies_bar);
    for (CellIndex c = 0; c < cells_bar.size(); ++c)
      if (cells_bar[c] != 0.)
        reverse_rate_in(view.mesh, view.X, *view.velocity, c, cells_bar[c], X_bar, velocity_bar);
  }
} // namespace retroforge
