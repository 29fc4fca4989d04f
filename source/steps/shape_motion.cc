// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/numbers.h>
#include <retroforge/remeshing/surface_features.h>
#include <retroforge/steps/shape_motion.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>

#include <algorithm>
#include <map>
#include <set>

namespace retroforge
{
  namespace
  {
    Vec3 area_vector(const TetMesh &mesh, const BoundaryFace &face)
    {
      const Vec3 &origin = mesh.X[face.nodes[0]];
      return 0.5 * dealii::cross_product_3d(mesh.X[face.nodes[1]] - origin, mesh.X[face.nodes[2]] - origin);
    }

    Vec3 without(Vec3 x, const std::vector<Vec3> &normals)
    {
      for (const Vec3 &n : normals)
        x -= (x * n) * n;
      return x;
    }

    bool includes(const std::vector<unsigned int> &all, const std::vector<unsigned int> &some)
    {
      return std::includes(all.begin(), all.end(), some.begin(), some.end());
    }

    void add(const NodalVectors<double> &x, NodalVectors<double> &to)
    {
      for (std::size_t k = 0; k < to.size(); ++k)
        to[k] += x[k];
    }

    /// The neighbours of each node along edges where patches of the surface meet.
    std::vector<std::vector<NodeIndex>> along_borders(const TetMesh &mesh)
    {
      std::vector<std::vector<NodeIndex>> beside(mesh.n_nodes());
      for (const SurfaceEdge &edge : surface_edges(mesh.faces))
      {
        const BoundaryFace &first = mesh.faces[edge.faces[0]], &second = mesh.faces[edge.faces[1]];
        if (first.patch == second.patch || !mesh.is_surface(first) || !mesh.is_surface(second))
          continue;
        beside[edge.nodes[0]].push_back(edge.nodes[1]);
        beside[edge.nodes[1]].push_back(edge.nodes[0]);
      }
      return beside;
    }

    /// The direction of a border at a node; none at its ends and corners.
    std::vector<Vec3>
    direction_of(const NodalVectors<double> &X, const NodeIndex k, const std::vector<NodeIndex> &beside)
    {
      constexpr double corner = 0.7; // cosine of the turn
      if (beside.size() != 2)
        return {};
      const Vec3 to = X[k] - X[beside[0]], from = X[beside[1]] - X[k], chord = to + from;
      if (to * from < corner * to.norm() * from.norm())
        return {};
      return {chord / chord.norm()};
    }

    Vec3 derivative(const Vector3<Dual> &x)
    {
      return Vec3({x[0].dx(0), x[1].dx(0), x[2].dx(0)});
    }
  } // namespace

  ShapeMotion::ShapeMotion(const TetMesh &mesh)
      : normals_(mesh.n_nodes()), planes_(mesh.n_nodes()), on_surface_(mesh.n_nodes(), false)
  {
    make_surface(mesh);
    make_sliding(mesh);
    make_levels(mesh);
  }

  void ShapeMotion::make_surface(const TetMesh &mesh)
  {
    for (const BoundaryFace &face : mesh.faces)
      for (const NodeIndex k : face.nodes)
        if (mesh.is_surface(face))
          on_surface_[k] = true;
        else if (std::find(planes_[k].begin(), planes_[k].end(), face.patch) == planes_[k].end())
        {
          planes_[k].push_back(face.patch);
          const Vec3       n        = without(mesh.patches[face.patch].symmetry->normal, normals_[k]);
          constexpr double parallel = 1e-6;
          if (n.norm() > parallel)
            normals_[k].push_back(n / n.norm());
        }
    for (auto &planes : planes_)
      std::sort(planes.begin(), planes.end());
    std::vector<dealii::SymmetricTensor<2, 3>> normal_squares(mesh.n_nodes());
    std::vector<Vec3>                          area(mesh.n_nodes());
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
      {
        const Vec3 a = area_vector(mesh, face);
        for (const NodeIndex k : face.nodes)
        {
          const Vec3 in_planes = without(a, normals_[k]);
          area[k] += in_planes;
          normal_squares[k] += dealii::symmetrize(dealii::outer_product(in_planes, in_planes)) / a.norm();
        }
      }
    // Where a surface turns by 40 degrees along an edge, the second eigenvalue is the square of tan(20 degrees) of the first.
    constexpr double sharp = 0.13;
    constexpr double least = 0.3; // that is left of a direction
    sliding_.directions.resize(mesh.n_nodes());
    const auto borders = along_borders(mesh);
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    {
      if (!on_surface_[k])
        continue;
      const auto pairs =
        dealii::eigenvectors(normal_squares[k], dealii::SymmetricTensorEigenvectorMethod::jacobi);
      std::vector<Vec3> smooth;
      for (const auto &[value, direction] : pairs)
        if (value < sharp * pairs[0].first)
          smooth.push_back(direction);
      std::vector<Vec3> held = normals_[k];
      held.push_back(area[k] / area[k].norm());
      // A border is laid into the old one, even where both patches lie flat on a die.
      for (const Vec3 &direction : borders[k].empty() ? smooth : direction_of(mesh.X, k, borders[k]))
        if (const Vec3 t = without(direction, held); t.norm() > least)
        {
          sliding_.directions[k].push_back(t / t.norm());
          held.push_back(sliding_.directions[k].back());
        }
    }
  }

  void ShapeMotion::make_sliding(const TetMesh &mesh)
  {
    const auto                              &directions = sliding_.directions;
    std::vector<std::map<NodeIndex, double>> beside(mesh.n_nodes());
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
        for (const NodeIndex a : face.nodes)
          for (const NodeIndex b : face.nodes)
            if (a != b)
              beside[a][b] += 1.;
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    {
      sliding_.beside.emplace_back(beside[k].begin(), beside[k].end());
      sliding_.first.push_back(sliding_.n);
      sliding_.n += directions[k].size();
    }
    if (sliding_.n == 0)
      return;
    const auto for_each_entry = [&](const auto &add) {
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
        for (unsigned int i = 0; i < directions[k].size(); ++i)
          for (const auto &[b, faces] : sliding_.beside[k])
          {
            const unsigned int row = sliding_.first[k] + i;
            add(row, row, faces);
            for (unsigned int j = 0; j < directions[b].size(); ++j)
              add(row, sliding_.first[b] + j, -faces * (directions[k][i] * directions[b][j]));
          }
    };
    dealii::DynamicSparsityPattern rows(sliding_.n, sliding_.n);
    for_each_entry([&](const unsigned int r, const unsigned int c, const double) { rows.add(r, c); });
    dealii::SparsityPattern pattern;
    pattern.copy_from(rows);
    dealii::SparseMatrix<double> A(pattern);
    for_each_entry([&](const unsigned int r, const unsigned int c, const double x) { A.add(r, c, x); });
    sliding_.inverse.initialize(A);
  }

  dealii::Vector<double> ShapeMotion::Sliding::solve(const NodalVectors<double> &y) const
  {
    dealii::Vector<double> b(n), x(n);
    for (std::size_t k = 0; k < y.size(); ++k)
      for (unsigned int i = 0; i < directions[k].size(); ++i)
        b(first[k] + i) = directions[k][i] * y[k];
    if (n > 0)
      inverse.vmult(x, b);
    return x;
  }

  NodalVectors<double> ShapeMotion::Sliding::along(const dealii::Vector<double> &x) const
  {
    NodalVectors<double> y(directions.size());
    for (std::size_t k = 0; k < y.size(); ++k)
      for (unsigned int i = 0; i < directions[k].size(); ++i)
        y[k] += x(first[k] + i) * directions[k][i];
    return y;
  }

  NodalVectors<double> ShapeMotion::Sliding::around(const NodalVectors<double> &y) const
  {
    NodalVectors<double> sums(y.size());
    for (std::size_t k = 0; k < y.size(); ++k)
      for (const auto &[b, faces] : beside[k])
        sums[k] += faces * y[b];
    return sums;
  }

  NodalVectors<double> ShapeMotion::Sliding::held(NodalVectors<double> y) const
  {
    for (std::size_t k = 0; k < y.size(); ++k)
      y[k] = without(y[k], directions[k]);
    return y;
  }

  void ShapeMotion::make_levels(const TetMesh &mesh)
  {
    std::vector<std::set<NodeIndex>> neighbours(mesh.n_nodes());
    std::size_t                      most = 0;
    for (const auto &cell : mesh.cells)
      for (const NodeIndex a : cell)
        for (const NodeIndex b : cell)
          if (a != b && !on_surface_[a] && includes(planes_[b], planes_[a]))
            neighbours[a].insert(b);
    for (const auto &planes : planes_)
      most = std::max(most, planes.size());
    for (std::size_t n = most + 1; n-- > 0;)
    {
      auto                      level = std::make_unique<Level>();
      std::vector<unsigned int> row(mesh.n_nodes(), invalid_index);
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
        if (!on_surface_[k] && planes_[k].size() == n)
        {
          row[k] = level->nodes.size();
          level->nodes.push_back(k);
        }
      if (level->nodes.empty())
        continue;
      const auto                     size = level->nodes.size();
      dealii::DynamicSparsityPattern rows(size, size);
      for (std::size_t i = 0; i < size; ++i)
      {
        rows.add(i, i);
        level->known.emplace_back();
        for (const NodeIndex b : neighbours[level->nodes[i]])
          if (row[b] != invalid_index)
            rows.add(i, row[b]);
          else
            level->known.back().push_back(b);
      }
      dealii::SparsityPattern pattern;
      pattern.copy_from(rows);
      dealii::SparseMatrix<double> A(pattern);
      for (std::size_t i = 0; i < size; ++i)
      {
        const auto &around = neighbours[level->nodes[i]];
        A.set(i, i, std::max<double>(around.size(), 1.));
        for (const NodeIndex b : around)
          if (row[b] != invalid_index)
            A.set(i, row[b], -1.);
      }
      level->inverse.initialize(A);
      levels_.push_back(std::move(level));
    }
  }

  std::vector<Vec3> ShapeMotion::Level::solve(const std::vector<Vec3> &b) const
  {
    std::vector<Vec3>      x(b.size());
    dealii::Vector<double> right(b.size()), solution(b.size());
    for (unsigned int c = 0; c < 3; ++c)
    {
      for (std::size_t i = 0; i < b.size(); ++i)
        right(i) = b[i][c];
      inverse.vmult(solution, right);
      for (std::size_t i = 0; i < b.size(); ++i)
        x[i][c] = solution(i);
    }
    return x;
  }

  NodalVectors<double> ShapeMotion::continued(NodalVectors<double> r) const
  {
    for (const auto &level : levels_)
    {
      std::vector<Vec3> b(level->nodes.size());
      for (std::size_t i = 0; i < b.size(); ++i)
        for (const NodeIndex k : level->known[i])
          b[i] += r[k];
      const std::vector<Vec3> x = level->solve(b);
      for (std::size_t i = 0; i < b.size(); ++i)
        r[level->nodes[i]] = x[i];
    }
    return r;
  }

  template <>
  NodalVectors<double> ShapeMotion::of(const NodalVectors<double> &d) const
  {
    AssertDimension(d.size(), on_surface_.size());
    NodalVectors<double> r = d;
    for (std::size_t k = 0; k < r.size(); ++k)
      if (!on_surface_[k])
        r[k] = Vec3();
    r = sliding_.held(std::move(r));
    add(sliding_.along(sliding_.solve(sliding_.around(r))), r);
    return continued(std::move(r));
  }

  template <>
  NodalVectors<Dual> ShapeMotion::of(const NodalVectors<Dual> &d) const
  {
    NodalVectors<double> value, d_dot;
    convert(d, value);
    for (const auto &x : d)
      d_dot.push_back(derivative(x));
    value = of(value);
    d_dot = of(d_dot);
    NodalVectors<Dual> r(d.size());
    for (std::size_t k = 0; k < d.size(); ++k)
      for (unsigned int c = 0; c < 3; ++c)
      {
        r[k][c]                 = value[k][c];
        r[k][c].fastAccessDx(0) = d_dot[k][c];
      }
    return r;
  }

  NodalVectors<double> ShapeMotion::transpose(NodalVectors<double> y) const
  {
    AssertDimension(y.size(), on_surface_.size());
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level)
    {
      const std::vector<NodeIndex> &nodes = (*level)->nodes;
      std::vector<Vec3>             b;
      for (const NodeIndex k : nodes)
        b.push_back(y[k]);
      const std::vector<Vec3> x = (*level)->solve(b); // A is symmetric
      for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        y[nodes[i]] = Vec3();
        for (const NodeIndex k : (*level)->known[i])
          y[k] += x[i];
      }
    }
    add(sliding_.around(sliding_.along(sliding_.solve(y))), y);
    return sliding_.held(std::move(y));
  }
} // namespace retroforge
