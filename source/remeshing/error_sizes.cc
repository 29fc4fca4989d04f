// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/error_sizes.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace retroforge
{
  namespace
  {
    // Of the errors per volume, over the largest: cells that do not deform at all are as large as they may be
    // long before.
    constexpr double least_density = 1e-15;
    constexpr double grid          = 1e-4; // of the logarithms of sizes

    double size_of_cell(const double volume)
    {
      return 2. * std::cbrt(volume);
    }

    /// The means of a value of cells around the nodes of each cell, by the cells' volumes.
    std::vector<double>
    averaged(const TetMesh &mesh, const std::vector<double> &volume, const std::vector<double> &of_cell)
    {
      std::vector<double> at_node(mesh.n_nodes(), 0.), weight(mesh.n_nodes(), 0.), mean(mesh.n_cells(), 0.);
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        for (const NodeIndex k : mesh.cells[c])
        {
          at_node[k] += volume[c] * of_cell[c];
          weight[k] += volume[c];
        }
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        for (const NodeIndex k : mesh.cells[c])
          mean[c] += 0.25 * at_node[k] / weight[k];
      return mean;
    }

    /// Number of cells, in cubes of their size.
    double number_of_cells(const std::vector<double> &volume, const std::vector<double> &size)
    {
      double n = 0.;
      for (std::size_t c = 0; c < size.size(); ++c)
        n += volume[c] / (size[c] * size[c] * size[c]);
      return n;
    }

    /// The scale between two at which a number of cells, which falls with it, is the wanted one.
    template <typename NumberOfCells>
    double
    find_scale(double low, double high, const double wanted, const double tolerance, const NumberOfCells &n)
    {
      while (high > low * (1. + tolerance))
      {
        const double middle               = std::sqrt(low * high);
        (n(middle) > wanted ? low : high) = middle;
      }
      return std::sqrt(low * high);
    }

    double total_error(const std::vector<double> &volume,
                       const std::vector<double> &density,
                       const std::vector<double> &size,
                       const unsigned int         degree)
    {
      double error = 0.;
      for (std::size_t c = 0; c < size.size(); ++c)
        error += volume[c] * density[c] * std::pow(size[c], 2. * degree);
      return error;
    }
  } // namespace

  OptimalSizes optimal_sizes(const TetMesh              &mesh,
                             const NodalVectors<double> &X,
                             const std::vector<double>  &errors,
                             const unsigned int          degree,
                             const SizeBounds           &bounds)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    AssertDimension(errors.size(), mesh.n_cells());
    Assert(degree > 0, dealii::ExcMessage("velocities are at least linear"));
    const auto          n = mesh.n_cells();
    OptimalSizes        optimal;
    std::vector<double> present(n), density(n);
    double              total_volume = 0., largest = 0.;
    for (CellIndex c = 0; c < n; ++c)
    {
      const TetCorners x = corners(mesh.cells[c], X);
      optimal.centre.push_back((x[0] + x[1] + x[2] + x[3]) / 4.);
      // Inverted cells are there when a mesh is to be rebuilt.
      optimal.volume.push_back(std::max(tet_volume(x), 1e-300));
      total_volume += optimal.volume[c];
      present[c] = size_of_cell(optimal.volume[c]);
      density[c] = errors[c] / optimal.volume[c] / std::pow(present[c], 2. * degree);
      largest    = std::max(largest, density[c]);
    }
    optimal.size.assign(n, bounds.uniform);
    if (largest == 0.)
      return optimal;

    for (double &d : density)
      d = std::log(std::max(d / largest, least_density));
    density = averaged(mesh, optimal.volume, density);
    std::vector<double> shape(n);
    for (CellIndex c = 0; c < n; ++c)
    {
      shape[c]   = std::exp(-density[c] / (2. * degree + 3.));
      density[c] = std::exp(density[c]);
    }
    const auto bounded = [&](const double scale, const CellIndex c) {
      return std::clamp(scale * shape[c], bounds.smallest, bounds.largest);
    };
    const auto   extremes = std::minmax_element(shape.begin(), shape.end());
    const double scale    = find_scale(bounds.smallest / *extremes.second,
                                    bounds.largest / *extremes.first,
                                    total_volume / std::pow(bounds.uniform, 3.),
                                    1e-6,
                                    [&](const double s) {
                                      double cells = 0.;
                                      for (CellIndex c = 0; c < n; ++c)
                                        cells += optimal.volume[c] / std::pow(bounded(s, c), 3.);
                                      return cells;
                                    });
    for (CellIndex c = 0; c < n; ++c)
      optimal.size[c] =
        bounds.uniform * std::exp(grid * std::round(std::log(bounded(scale, c) / bounds.uniform) / grid));
    optimal.gain =
      total_error(optimal.volume, density, present, degree) /
      total_error(optimal.volume, density, optimal.size, degree) *
      std::pow(number_of_cells(optimal.volume, present) / number_of_cells(optimal.volume, optimal.size),
               2. * degree / 3.);
    return optimal;
  }

  ErrorSizes::ErrorSizes(const OptimalSizes &sizes, const SizeBounds &bounds)
      : bounds_(bounds), centre_(sizes.centre)
  {
    std::vector<BoundingBox> boxes;
    for (CellIndex c = 0; c < centre_.size(); ++c)
    {
      radius_.push_back(std::cbrt(3. * sizes.volume[c] / (4. * M_PI)));
      const Vec3  reach({radius_[c], radius_[c], radius_[c]});
      BoundingBox box(centre_[c] - reach);
      box.include(centre_[c] + reach);
      boxes.push_back(box);
    }
    tree_ = BoxTree(boxes);
    // Grading only makes sizes smaller.
    const double total_volume = std::accumulate(sizes.volume.begin(), sizes.volume.end(), 0.);
    const double scale        = find_scale(1.,
                                    bounds.largest / bounds.smallest,
                                    total_volume / std::pow(bounds.uniform, 3.),
                                    0.01,
                                    [&](const double s) {
                                      set_scale(s, sizes);
                                      return wanted_cells(sizes);
                                    });
    set_scale(scale, sizes);
  }

  void ErrorSizes::set_scale(const double scale, const OptimalSizes &sizes)
  {
    size_ = sizes.size;
    for (double &h : size_)
      h = std::min(scale * h, bounds_.largest);
    least_ = tree_.minima(size_);
  }

  double ErrorSizes::wanted_cells(const OptimalSizes &sizes) const
  {
    std::vector<double> graded;
    for (const Vec3 &x : centre_)
      graded.push_back((*this)(x));
    return number_of_cells(sizes.volume, graded);
  }

  double ErrorSizes::operator()(const Vec3 &x) const
  {
    double size = bounds_.largest;
    tree_.minimise(
      [&](const unsigned int branch) {
        return least_[branch] + bounds_.growth * std::sqrt(tree_.box(branch).square_distance(x));
      },
      [&](const unsigned int c) {
        const double distance = std::max((centre_[c] - x).norm() - radius_[c], 0.);
        return size           = std::min(size, size_[c] + bounds_.growth * distance);
      },
      size);
    return size;
  }
} // namespace retroforge
