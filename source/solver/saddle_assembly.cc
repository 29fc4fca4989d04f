// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/saddle_matrix.h>
#include <retroforge/solver/velocity_pattern.h>

#include <map>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// The rows of a pattern that belong to vertices, and in all rows the columns that do: velocities have
    /// the vertices first on every rank, in the order of the pressures.
    struct VertexPatterns
    {
      Rows<unsigned int> of_velocities, of_pressures, velocities_of_pressures;
    };

    VertexPatterns vertex_patterns(const Discretization<3> &discretization, const Rows<unsigned int> &met)
    {
      const NodeNumbering &velocities = *discretization.condensed_nodes(),
                          &pressures  = *discretization.pressure_nodes();
      VertexPatterns patterns;
      for (unsigned int row = 0; row < met.size(); ++row)
      {
        std::vector<unsigned int> vertices;
        for (const unsigned int column : met[row])
          if (const NodeIndex k = velocities.node_at(velocities.place_of_index(column));
              k < discretization.n_vertices())
            vertices.push_back(pressures.index_at(pressures.place(k)));
        const auto append = [](const auto &columns, Rows<unsigned int> &rows) {
          rows.entries.insert(rows.entries.end(), columns.begin(), columns.end());
          rows.begin.push_back(rows.entries.size());
        };
        append(vertices, patterns.of_velocities);
        if (row < pressures.n_owned())
        {
          append(vertices, patterns.of_pressures);
          append(met[row], patterns.velocities_of_pressures);
        }
      }
      return patterns;
    }

    /// q x
    void rotate(const Tensor<2, 3> &q, double (&x)[3])
    {
      double r[3];
      for (unsigned int i = 0; i < 3; ++i)
        r[i] = q[i][0] * x[0] + q[i][1] * x[1] + q[i][2] * x[2];
      std::copy(r, r + 3, x);
    }

    /// Momentum of a node, along its tests.
    void test(const NodeFrame &frame, double (&x)[3])
    {
      if (!frame.identity)
        rotate(frame.tests, x);
    }

    /// Velocity of a node, or entries of a row at it, along its axes.
    void rotate(const NodeFrame &frame, double (&x)[3])
    {
      if (!frame.identity)
        rotate(frame.axes, x);
    }

    /// The entries of a pair of velocities, between the tests of one and the axes of the other.
    void rotate(const NodeFrame &of_row, const NodeFrame &of_column, double (&A)[3][3])
    {
      if (!of_row.identity)
        for (unsigned int j = 0; j < 3; ++j)
        {
          double column[3] = {A[0][j], A[1][j], A[2][j]};
          test(of_row, column);
          for (unsigned int i = 0; i < 3; ++i)
            A[i][j] = column[i];
        }
      for (unsigned int i = 0; i < 3; ++i)
        rotate(of_column, A[i]);
    }

    /// The penalty of a node that one die holds is: the normal is an axis. Where two dies hold it, penalties
    /// couple its components.
    bool is_nearly_diagonal(const Tensor<2, 3> &A)
    {
      double largest = 0., beside = 0.;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          (i == j ? largest : beside) = std::max(i == j ? largest : beside, std::abs(A[i][j]));
      return beside < 1e-3 * largest;
    }
  } // namespace

  void SaddleMatrix::make_patterns()
  {
    const auto              &discretization = scene_.discretization;
    const NodeRange         &v = velocities_.range(), &p = pressures_.range();
    const Rows<unsigned int> met = velocity_pattern(discretization);
    const auto pattern           = [](const NodeRange &rows, const NodeRange &columns, const auto &of_rows) {
      return std::make_shared<const NodePattern>(rows, columns, of_rows);
    };
    const auto vv = pattern(v, v, met);
    auto       vp = vv, pv = vv, pp = vv;
    if (discretization.middles())
    {
      const VertexPatterns vertices = vertex_patterns(discretization, met);
      vp                            = pattern(v, p, vertices.of_velocities);
      pv                            = pattern(p, v, vertices.velocities_of_pressures);
      pp                            = pattern(p, p, vertices.of_pressures);
    }
    const auto make = [&](la::SparseMatrix                         &matrix,
                          const std::shared_ptr<const NodePattern> &met,
                          const unsigned int                        rows,
                          const unsigned int                        columns) {
      return std::make_unique<NodeMatrix>(matrix, met, rows, columns, discretization.comm());
    };
    la::BlockSparseMatrix &matrix = system_.matrix;
    matrix.reinit(2, 2);
    system_.A = make(matrix.block(0, 0), vv, 3, 3);
    system_.B = make(matrix.block(0, 1), vp, 3, 1);
    system_.D = make(matrix.block(1, 0), pv, 1, 3);
    system_.C = make(matrix.block(1, 1), pp, 1, 1);
    system_.S = make(system_.schur, pp, 1, 1);
    matrix.collect_sizes();
    for (unsigned int local = 0; local < v.n_owned(); ++local)
      diagonal_.push_back(vv->position(local, v.begin + local));
    // A numbers its columns by itself: from there back to nodes.
    for (const unsigned int row : vv->column_nodes())
      column_places_.push_back(velocities_.place_of_index(row));
    if (const MiddleNodes *middles = discretization.middles())
      make_interpolation_pattern(*middles);
  }

  void SaddleMatrix::make_interpolation_pattern(const MiddleNodes &middles)
  {
    Rows<unsigned int> parents;
    const unsigned int n_vertices = scene_.mesh.n_nodes();
    for (const NodeIndex k : velocities_.owned())
    {
      if (k < n_vertices)
        parents.entries.push_back(pressures_.index_at(pressures_.place(k)));
      else
        for (const NodeIndex end : middles.ends_of(k))
          parents.entries.push_back(pressures_.index_at(pressures_.place(end)));
      parents.begin.push_back(parents.entries.size());
    }
    const auto pattern =
      std::make_shared<const NodePattern>(velocities_.range(), pressures_.range(), parents);
    system_.P =
      std::make_unique<NodeMatrix>(system_.interpolation, pattern, 3, 3, scene_.discretization.comm());
  }

  std::vector<double> SaddleMatrix::viscous_diagonal() const
  {
    std::vector<double> diagonal;
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      const NodeFrame &frame = frames_[local];
      const auto      &block = cell_tangents_->row(local)[diagonal_[local]];
      for (unsigned int i = 0; i < 3; ++i)
      {
        Vec3 row = frame.axes[i], column;
        for (unsigned int j = 0; j < 3; ++j)
          column[j] = block.rows[j][0] * row[0] + block.rows[j][1] * row[1] + block.rows[j][2] * row[2];
        diagonal.push_back(row * column);
      }
    }
    return diagonal;
  }

  void SaddleMatrix::write_cell_tangents()
  {
    const NodePattern &pattern    = system_.A->pattern();
    const unsigned int n_vertices = scene_.mesh.n_nodes();
    const double       squared    = pressure_scale_ * pressure_scale_;
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      const bool                         is_vertex = velocities_.node_at(local) < n_vertices;
      const Vec3                        &scale_k   = unknown_scale_.at_place(local);
      const auto                         columns   = pattern.row(local);
      const CellTangentAssembler::Block *block     = cell_tangents_->row(local);
      const double                      *schur     = cell_tangents_->schur_row(local);
      double                            *A[3], *B[3], *D = nullptr, *C = nullptr, *S = nullptr;
      for (unsigned int i = 0; i < 3; ++i)
      {
        A[i] = system_.A->entry(local, i, 0);
        B[i] = system_.B->entry(local, i, 0);
      }
      // Vertices come first among the velocities, in the order of the pressures.
      if (is_vertex)
      {
        D = system_.D->entry(local, 0, 0);
        C = system_.C->entry(local, 0, 0);
        S = system_.S->entry(local, 0, 0);
      }
      for (unsigned int met = 0; met < columns.size(); ++met, ++block, ++schur)
      {
        const unsigned int b            = column_places_[columns[met]];
        const bool         meets_vertex = velocities_.node_at(b) < n_vertices;
        const Vec3        &scale_b      = unknown_scale_.at_place(b);
        double             of_velocities[3][3];
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            of_velocities[i][j] = block->rows[i][j];
        rotate(frames_[local], frames_[b], of_velocities);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            *A[i]++ = scale_k[i] * of_velocities[i][j] * scale_b[j];
        if (meets_vertex)
        {
          double of_pressure[3] = {block->rows[0][3], block->rows[1][3], block->rows[2][3]};
          test(frames_[local], of_pressure);
          for (unsigned int i = 0; i < 3; ++i)
            *B[i]++ = scale_k[i] * of_pressure[i] * pressure_scale_;
        }
        if (is_vertex)
        {
          double of_velocity[3] = {block->rows[3][0], block->rows[3][1], block->rows[3][2]};
          rotate(frames_[b], of_velocity);
          for (unsigned int j = 0; j < 3; ++j)
            *D++ = pressure_scale_ * of_velocity[j] * scale_b[j];
          if (meets_vertex)
          {
            *C++ = squared * block->rows[3][3];
            *S++ = squared * *schur;
          }
        }
      }
    }
  }

  std::vector<SaddleMatrix::ContactEntries> SaddleMatrix::contact_entries(const Equilibrium<double> &stage,
                                                                          const Field<double>       &W,
                                                                          const ActiveSet           &active)
  {
    std::vector<ContactEntries> entries;
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
    {
      const ContactPoint &point = stage.contact.pairs[p].point;
      if (!scene_.sees(point))
        continue;
      const Tensor<2, 3> of_point =
        point.velocity_weight() * point.velocity_weight() *
        contact_tangent(stage.contact_node(p, W, active), stage.surface_law(p), stage.physics.contact);
      for (unsigned int a = 0; a < point.n_velocity_nodes(); ++a)
        if (const unsigned int k = velocities_.place(point.velocity_node_at(a)); k < velocities_.n_owned())
          for (unsigned int b = 0; b < point.n_velocity_nodes(); ++b)
          {
            const unsigned int m = velocities_.place(point.velocity_node_at(b));
            entries.push_back({k, m, frames_[k].axes * of_point * transpose(frames_[m].axes)});
          }
    }
    if (!system_.symmetric)
      test_contact(entries);
    system_.penalties_couple = false;
    for (const ContactEntries &of : entries)
      system_.penalties_couple |= of.row != of.column || !is_nearly_diagonal(of.tangent);
    return entries;
  }

  void SaddleMatrix::test_contact(std::vector<ContactEntries> &contact)
  {
    std::map<NodeIndex, Tensor<2, 3>> of_nodes;
    for (const ContactEntries &of : contact)
      if (of.row == of.column)
        of_nodes[of.row] += of.tangent;
    for (const auto &[k, tangent] : of_nodes)
      choose_tests(tangent, frames_[k]);
    for (ContactEntries &of : contact)
      of.tangent = frames_[of.row].tests * transpose(frames_[of.row].axes) * of.tangent;
  }

  void SaddleMatrix::add_contact(const std::vector<ContactEntries> &contact) const
  {
    for (const ContactEntries &of : contact)
    {
      const unsigned int position = system_.A->pattern().position(of.row, velocities_.index_at(of.column));
      const Vec3 &of_row = unknown_scale_.at_place(of.row), &of_column = unknown_scale_.at_place(of.column);
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          system_.A->entry(of.row, i, position)[j] += of_row[i] * of.tangent[i][j] * of_column[j];
    }
  }
} // namespace retroforge
