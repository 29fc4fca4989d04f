// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/box_tree.h>
#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// Bounds of sizes [mm], and of their growth, dimensionless.
  struct SizeBounds
  {
    double uniform; ///< edge length of a uniform mesh with the wanted number of cells
    double smallest, largest;
    double growth; ///< most by which they change per distance
  };

  /// Sizes of cells with which a mesh has the least error, where the cells of the present one are.
  struct OptimalSizes
  {
    NodalVectors<double> centre; ///< centres of the present cells
    std::vector<double>  volume; ///< volumes of the present cells [mm^3]
    std::vector<double>  size;   ///< wanted there [mm]

    /// By how much the error of the present mesh is larger than with these sizes and as many cells as it has.
    double gain = 1.;
  };

  /// Computes optimal sizes from the contribution of each cell to the error. With cells of size h the error
  /// per volume is d h^(2p), with d as the present cell of size h_T = 2 |T|^(1/3) says, d = eta_T / (|T|
  /// h_T^(2p)). The sum is least, at a given number of cells ~ int h^-3, for
  ///
  ///   h = c d^(-1/(2p+3)),   bounded,   c such that  int h^-3 = V / uniform^3.
  ///
  /// Contributions of single cells are noisy: d is the geometric mean over the cells around each node, and
  /// then over the nodes of the cell. Sizes are rounded to parts of 1e-4: the last digits of a solution are
  /// others on another number of ranks, and are not to show.
  /// @param errors  eta_T >= 0, of any unit; where all are zero, sizes are uniform
  /// @param degree  p
  OptimalSizes optimal_sizes(const TetMesh              &mesh,
                             const NodalVectors<double> &X,
                             const std::vector<double>  &errors,
                             unsigned int                degree,
                             const SizeBounds           &bounds);

  /// Wanted length of edges from the sizes of cells. Each cell stands for a ball of its volume:
  ///
  ///   h(x) = min( largest, min_T ( s h_T + growth * distance of x to the ball ) ),
  ///
  /// which changes by at most the growth per distance; s such that still  int h^-3 = V / uniform^3. Nothing
  /// is tabulated: an evaluation is a branch-and-bound search, as in GradedSize.
  class ErrorSizes
  {
  public:
    ErrorSizes(const OptimalSizes &sizes, const SizeBounds &bounds);

    double operator()(const Vec3 &x) const;

  private:
    void   set_scale(double scale, const OptimalSizes &sizes);
    double wanted_cells(const OptimalSizes &sizes) const;

    SizeBounds           bounds_;
    NodalVectors<double> centre_;
    std::vector<double>  radius_, size_;
    BoxTree              tree_;
    std::vector<double>  least_; ///< smallest size in each branch of the tree
  };
} // namespace retroforge
