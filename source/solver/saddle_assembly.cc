// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/saddle_matrix.h>

#include <map>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// The columns that owned row nodes meet in the visited cells.
    /// @param rows, columns  of a cell: (nodes, how many)
    template <typename CellRows, typename CellColumns, typename LocalRow, typename Number>
    Rows<unsigned int> neighbours(const Partition   &partition,
                                  const unsigned int n_rows,
                                  const CellRows    &rows,
                                  const CellColumns &columns,
                                  const LocalRow    &local_row,
                                  const Number      &number)
    {
      std::vector<std::vector<unsigned int>> met(n_rows);
      for (const CellIndex c : partition.visited_cells)
        for (const NodeIndex a : rows(c))
          if (const unsigned int local = local_row(a); local != invalid_index)
            for (const NodeIndex b : columns(c))
              met[local].push_back(number(b));
      Rows<unsigned int> result;
      for (std::vector<unsigned int> &row : met)
      {
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        result.entries.insert(result.entries.end(), row.begin(), row.end());
        result.begin.push_back(result.entries.size());
      }
      return result;
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
    const Partition   &partition = scene_.partition;
    const Spaces      &spaces    = scene_.spaces;
    const unsigned int n_of_cell = spaces.pair() == ElementPair::mini ? 4 : 10;
    const auto         velocity  = [&](const CellIndex c) {
      return ArrayView<const NodeIndex>(spaces.velocity_nodes(c), n_of_cell);
    };
    const auto pressure = [&](const CellIndex c) {
      return ArrayView<const NodeIndex>(spaces.velocity_nodes(c), 4);
    };
    const auto velocity_row = [&](const NodeIndex k) {
      return velocities_.owns(k) ? velocities_.local(k) : invalid_index;
    };
    const auto pressure_row = [&](const NodeIndex k) {
      return pressures_.owns(k) ? pressures_.local(k) : invalid_index;
    };
    const auto velocity_number = [&](const NodeIndex k) { return velocities_.number(k); };
    const auto pressure_number = [&](const NodeIndex k) { return pressures_.number(k); };
    const auto pattern = [](const NodeRange &rows, const NodeRange &columns, const Rows<unsigned int> &met) {
      return std::make_shared<const NodePattern>(rows, columns, met);
    };
    const NodeRange   &v = velocities_.range(), &p = pressures_.range();
    const unsigned int n_v = v.n_owned(), n_p = p.n_owned();
    const auto         pp =
      pattern(p, p, neighbours(partition, n_p, pressure, pressure, pressure_row, pressure_number));
    const bool alike = n_of_cell == 4;
    const auto vv =
      alike ? pp
            : pattern(v, v, neighbours(partition, n_v, velocity, velocity, velocity_row, velocity_number));
    const auto vp =
      alike ? pp
            : pattern(v, p, neighbours(partition, n_v, velocity, pressure, velocity_row, pressure_number));
    const auto pv =
      alike ? pp
            : pattern(p, v, neighbours(partition, n_p, pressure, velocity, pressure_row, velocity_number));
    const auto make = [&](la::SparseMatrix                         &matrix,
                          const std::shared_ptr<const NodePattern> &met,
                          const unsigned int                        rows,
                          const unsigned int                        columns) {
      return std::make_unique<NodeMatrix>(matrix, met, rows, columns, partition.comm);
    };
    la::BlockSparseMatrix &matrix = system_.matrix;
    matrix.reinit(2, 2);
    system_.A = make(matrix.block(0, 0), vv, 3, 3);
    system_.B = make(matrix.block(0, 1), vp, 3, 1);
    system_.D = make(matrix.block(1, 0), pv, 1, 3);
    system_.C = make(matrix.block(1, 1), pp, 1, 1);
    system_.S = make(system_.schur, pp, 1, 1);
    matrix.collect_sizes();
    for (unsigned int local = 0; local < n_v; ++local)
      diagonal_.push_back(vv->position(local, v.begin + local));
    // A numbers its columns by itself: from there back to nodes.
    std::vector<NodeIndex> node_of_number(v.n);
    for (NodeIndex k = 0; k < v.n; ++k)
      node_of_number[velocities_.number(k)] = k;
    for (const unsigned int number : vv->column_nodes())
      column_nodes_.push_back(node_of_number[number]);
    if (spaces.edges())
      make_interpolation_pattern(*spaces.edges());
  }

  void SaddleMatrix::make_interpolation_pattern(const MeshEdges &edges)
  {
    Rows<unsigned int> parents;
    const unsigned int n_vertices = scene_.mesh.n_nodes();
    for (const NodeIndex k : velocities_.owned())
    {
      if (k < n_vertices)
        parents.entries.push_back(pressures_.number(k));
      else
        for (const NodeIndex end : edges.nodes[k - n_vertices])
          parents.entries.push_back(pressures_.number(end));
      parents.begin.push_back(parents.entries.size());
    }
    const auto pattern =
      std::make_shared<const NodePattern>(velocities_.range(), pressures_.range(), parents);
    system_.P = std::make_unique<NodeMatrix>(system_.interpolation, pattern, 3, 3, scene_.partition.comm);
  }

  std::vector<double> SaddleMatrix::viscous_diagonal() const
  {
    std::vector<double> diagonal;
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeFrame &frame = frames_[velocities_.owned()[local]];
      const auto      &block = sums_->row(local)[diagonal_[local]];
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

  void SaddleMatrix::write_sums()
  {
    const NodePattern &pattern    = system_.A->pattern();
    const unsigned int n_vertices = scene_.mesh.n_nodes();
    const double       squared    = pressure_scale_ * pressure_scale_;
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeIndex           k       = velocities_.owned()[local];
      const double             *scale_k = &unknown_scale_[3 * k];
      const auto                columns = pattern.row(local);
      const TangentSums::Block *block   = sums_->row(local);
      const double             *schur   = sums_->schur_row(local);
      double                   *A[3], *B[3], *D = nullptr, *C = nullptr, *S = nullptr;
      for (unsigned int i = 0; i < 3; ++i)
      {
        A[i] = system_.A->entry(local, i, 0);
        B[i] = system_.B->entry(local, i, 0);
      }
      // Vertices come first among the velocities, in the order of the pressures.
      if (k < n_vertices)
      {
        D = system_.D->entry(local, 0, 0);
        C = system_.C->entry(local, 0, 0);
        S = system_.S->entry(local, 0, 0);
      }
      for (unsigned int met = 0; met < columns.size(); ++met, ++block, ++schur)
      {
        const NodeIndex b       = column_nodes_[columns[met]];
        const double   *scale_b = &unknown_scale_[3 * b];
        double          of_velocities[3][3];
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            of_velocities[i][j] = block->rows[i][j];
        rotate(frames_[k], frames_[b], of_velocities);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            *A[i]++ = scale_k[i] * of_velocities[i][j] * scale_b[j];
        if (b < n_vertices)
        {
          double of_pressure[3] = {block->rows[0][3], block->rows[1][3], block->rows[2][3]};
          test(frames_[k], of_pressure);
          for (unsigned int i = 0; i < 3; ++i)
            *B[i]++ = scale_k[i] * of_pressure[i] * pressure_scale_;
        }
        if (k < n_vertices)
        {
          double of_velocity[3] = {block->rows[3][0], block->rows[3][1], block->rows[3][2]};
          rotate(frames_[b], of_velocity);
          for (unsigned int j = 0; j < 3; ++j)
            *D++ = pressure_scale_ * of_velocity[j] * scale_b[j];
          if (b < n_vertices)
          {
            *C++ = squared * block->rows[3][3];
            *S++ = squared * *schur;
          }
        }
      }
    }
  }

  std::vector<SaddleMatrix::ContactEntries>
  SaddleMatrix::contact_entries(const Stage<double> &stage, const Field<double> &W, const ActiveSet &active)
  {
    std::vector<ContactEntries> entries;
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
    {
      const ContactPoint &point = stage.contact.pairs[p].point;
      if (!scene_.partition.sees(point.nodes))
        continue;
      const Tensor<2, 3> of_point =
        point.velocity_weight() * point.velocity_weight() *
        contact_tangent(stage.contact_node(p, W, active), stage.physics.law, stage.physics.contact);
      for (unsigned int a = 0; a < point.n_velocity_nodes(); ++a)
        if (const NodeIndex k = point.velocity_node_at(a); velocities_.owns(k))
          for (unsigned int b = 0; b < point.n_velocity_nodes(); ++b)
          {
            const NodeIndex m = point.velocity_node_at(b);
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
      const unsigned int local    = velocities_.local(of.row);
      const unsigned int position = system_.A->pattern().position(local, velocities_.number(of.column));
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          system_.A->entry(local, i, position)[j] +=
            unknown_scale_[3 * of.row + i] * of.tangent[i][j] * unknown_scale_[3 * of.column + j];
    }
  }
} // namespace retroforge
