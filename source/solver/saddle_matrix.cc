// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/saddle_matrix.h>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// Of edge length h, in h^3: a regular tetrahedron has the volume h^3 / (6 sqrt 2).
    constexpr double regular_tetrahedra = 8.5;

    /// Scales of a velocity's components below this are those of a penalty that holds it.
    constexpr double penalised = 0.1;
  } // namespace

  SaddleMatrix::SaddleMatrix(const Scene &scene)
      : scene_(scene), nodes_{scene.partition.node_begin, scene.partition.node_end, scene.mesh.n_nodes()}
  {
    const auto pattern = std::make_shared<const NodePattern>(nodes_, nodes_, scene.topology.neighbours);
    const auto make    = [&](la::SparseMatrix &matrix, const unsigned int rows, const unsigned int columns) {
      return std::make_unique<NodeMatrix>(matrix, pattern, rows, columns, scene_.partition.comm);
    };
    la::BlockSparseMatrix &matrix = system_.matrix;
    matrix.reinit(2, 2);
    system_.A = make(matrix.block(0, 0), 3, 3);
    system_.B = make(matrix.block(0, 1), 3, 1);
    system_.D = make(matrix.block(1, 0), 1, 3);
    system_.C = make(matrix.block(1, 1), 1, 1);
    system_.S = make(system_.schur, 1, 1);
    matrix.collect_sizes();
    make_positions();
  }

  void SaddleMatrix::make_positions()
  {
    const Partition   &partition = scene_.partition;
    const NodePattern &pattern   = system_.C->pattern();
    positions_.resize(partition.visited_cells.size());
    visited_index_.assign(scene_.mesh.n_cells(), invalid_index);
    for (unsigned int v = 0; v < partition.visited_cells.size(); ++v)
      visited_index_[partition.visited_cells[v]] = v;
    for (auto &cell : positions_)
      for (auto &row : cell)
        row.fill(invalid_index);
    for (NodeIndex a = nodes_.begin; a < nodes_.end; ++a)
    {
      const unsigned int local = a - nodes_.begin;
      diagonal_.push_back(pattern.position(local, a));
      for (const CellIndex c : scene_.topology.cells[a])
        for (unsigned int i = 0; i < 4; ++i)
          if (scene_.mesh.cells[c][i] == a)
            for (unsigned int j = 0; j < 4; ++j)
              positions_[visited_index_[c]][i][j] = pattern.position(local, scene_.mesh.cells[c][j]);
    }
  }

  void SaddleMatrix::add_cell(const CellIndex    c,
                              const unsigned int visited,
                              const TangentPack &t,
                              const unsigned int lane)
  {
    const double     mass      = t.volume[lane] / 20. / t.viscosity[lane];
    const auto      &nodes     = scene_.mesh.cells[c];
    const Partition &partition = scene_.partition;
    for (unsigned int a = 0; a < 4; ++a)
      if (partition.owns(nodes[a]))
      {
        const unsigned int local   = nodes[a] - partition.node_begin;
        const NodeFrame   &frame_a = frames_[nodes[a]];
        for (unsigned int b = 0; b < 4; ++b)
        {
          const unsigned int position = positions_[visited][a][b];
          const NodeFrame   &frame_b  = frames_[nodes[b]];
          double             A[3][3], Vp[3], pV[3];
          for (unsigned int i = 0; i < 3; ++i)
          {
            Vp[i] = t.B[a][b][i][lane];
            pV[i] = t.B[b][a][i][lane];
            for (unsigned int j = 0; j < 3; ++j)
              A[i][j] = t.A[a][b][i][j][lane];
          }
          if (!frame_a.identity)
          {
            double R[3][3], r[3];
            for (unsigned int i = 0; i < 3; ++i)
            {
              const auto &q = frame_a.axes[i];
              r[i]          = q[0] * Vp[0] + q[1] * Vp[1] + q[2] * Vp[2];
              for (unsigned int j = 0; j < 3; ++j)
                R[i][j] = q[0] * A[0][j] + q[1] * A[1][j] + q[2] * A[2][j];
            }
            std::copy(&R[0][0], &R[0][0] + 9, &A[0][0]);
            std::copy(r, r + 3, Vp);
          }
          if (!frame_b.identity)
          {
            double R[3][3], r[3];
            for (unsigned int j = 0; j < 3; ++j)
            {
              const auto &q = frame_b.axes[j];
              r[j]          = q[0] * pV[0] + q[1] * pV[1] + q[2] * pV[2];
              for (unsigned int i = 0; i < 3; ++i)
                R[i][j] = A[i][0] * q[0] + A[i][1] * q[1] + A[i][2] * q[2];
            }
            std::copy(&R[0][0], &R[0][0] + 9, &A[0][0]);
            std::copy(r, r + 3, pV);
          }
          double *continuity = system_.D->entry(local, 0, position);
          for (unsigned int i = 0; i < 3; ++i)
          {
            double *row = system_.A->entry(local, i, position);
            for (unsigned int j = 0; j < 3; ++j)
              row[j] += A[i][j];
            *system_.B->entry(local, i, position) += Vp[i];
            continuity[i] += pV[i];
          }
          *system_.C->entry(local, 0, position) += t.C[a][b][lane];
          *system_.S->entry(local, 0, position) += (a == b ? 2. : 1.) * mass - t.C[a][b][lane];
        }
      }
  }

  void SaddleMatrix::assemble(const Stage<double> &stage,
                              const Field<double> &W,
                              const ActiveSet     &active,
                              const Linearisation  linearisation)
  {
    for (const auto *block : {&system_.A, &system_.B, &system_.D, &system_.C, &system_.S})
      (*block)->clear();
    frames_ = make_frames(scene_, stage.contact);
    add_cells(stage, W, linearisation);
    std::vector<double> viscous_diagonal(3 * nodes_.n_owned());
    for (unsigned int row = 0; row < viscous_diagonal.size(); ++row)
      viscous_diagonal[row] = diagonal_entry(row);
    const std::vector<double> added = add_contact(stage, W, active);
    scale_.assign(3 * nodes_.n, 1.);
    for (unsigned int row = 0; row < viscous_diagonal.size(); ++row)
      scale_[3 * nodes_.begin + row] =
        std::sqrt(viscous_diagonal[row] / (viscous_diagonal[row] + added[row]));
    scene_.partition.gather_nodes(scale_.data(), 3);
    scale_and_fix(viscous_diagonal);
    describe_rows();
  }

  double &SaddleMatrix::diagonal_entry(const unsigned int row) const
  {
    return system_.A->entry(row / 3, row % 3, diagonal_[row / 3])[row % 3];
  }

  void SaddleMatrix::add_cells(const Stage<double> &stage,
                               const Field<double> &W,
                               const Linearisation  linearisation)
  {
    const Partition &partition = scene_.partition;
    eliminations_.resize(partition.visited_cells.size());
    double                                           log_viscosity = 0., volume = 0.;
    std::array<CellGeometry<double>, n_lanes>        geometry;
    std::array<CellValues<double>, n_lanes>          w;
    std::array<BubbleElimination<double> *, n_lanes> elimination;
    BubbleElimination<double>                        unused;
    TangentPack                                      tangent;
    const unsigned int                               n_visited = partition.visited_cells.size();
    for (unsigned int begin = 0; begin < n_visited; begin += n_lanes)
    {
      const unsigned int n = std::min(n_lanes, n_visited - begin);
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
      {
        // Lanes without a cell repeat the last one.
        const CellIndex c = partition.visited_cells[begin + std::min(lane, n - 1)];
        geometry[lane]    = cell_geometry(positions_of_cell(scene_.mesh, stage.X, c));
        w[lane]           = W.on_cell(scene_.mesh, c);
        elimination[lane] = lane < n ? &eliminations_[begin + lane] : &unused;
      }
      compute_cell_tangents(geometry, w, stage.physics.law, linearisation, tangent, elimination);
      for (unsigned int lane = 0; lane < n; ++lane)
      {
        const CellIndex c = partition.visited_cells[begin + lane];
        add_cell(c, begin + lane, tangent, lane);
        if (c >= partition.cell_begin && c < partition.cell_end)
        {
          log_viscosity += std::log(tangent.viscosity[lane]) * tangent.volume[lane];
          volume += tangent.volume[lane];
        }
      }
    }
    volume          = partition.sum(volume);
    pressure_scale_ = std::exp(partition.sum(log_viscosity) / volume) /
                      std::cbrt(regular_tetrahedra * volume / scene_.mesh.n_cells());
  }

  std::vector<double>
  SaddleMatrix::add_contact(const Stage<double> &stage, const Field<double> &W, const ActiveSet &active)
  {
    const Partition    &partition = scene_.partition;
    const NodePattern  &pattern   = system_.A->pattern();
    std::vector<double> added(3 * nodes_.n_owned(), 0.);
    system_.penalties_couple = false;
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
    {
      const ContactPoint &point = stage.contact.pairs[p].point;
      if (!partition.sees(point.nodes))
        continue;
      system_.penalties_couple |= !point.is_node();
      const Tensor<2, 3> of_point =
        point.weight() * point.weight() *
        contact_tangent(stage.contact_node(p, W, active), stage.physics.law, stage.physics.contact);
      for (unsigned int a = 0; a < point.n_nodes(); ++a)
      {
        const NodeIndex k = point.nodes[a];
        if (!partition.owns(k))
          continue;
        const unsigned int local = k - partition.node_begin;
        for (unsigned int b = 0; b < point.n_nodes(); ++b)
        {
          const Tensor<2, 3> tangent  = frames_[k].axes * of_point * transpose(frames_[point.nodes[b]].axes);
          const unsigned int position = a == b ? diagonal_[local] : pattern.position(local, point.nodes[b]);
          for (unsigned int i = 0; i < 3; ++i)
          {
            if (a == b)
              added[3 * local + i] += tangent[i][i];
            for (unsigned int j = 0; j < 3; ++j)
              system_.A->entry(local, i, position)[j] += tangent[i][j];
          }
        }
      }
    }
    return added;
  }

  void SaddleMatrix::scale_and_fix(const std::vector<double> &viscous_diagonal)
  {
    // A fixed component has scale zero in its row and column, and its diagonal put back afterwards.
    std::vector<double> factor = scale_;
    for (NodeIndex k = 0; k < frames_.size(); ++k)
      for (unsigned int i = 0; i < frames_[k].n_fixed; ++i)
        factor[3 * k + i] = 0.;
    const std::vector<double> of_rows(factor.begin() + 3 * nodes_.begin, factor.begin() + 3 * nodes_.end);
    const std::vector<double> of_pressures(nodes_.n, pressure_scale_);
    system_.A->scale(of_rows, factor);
    system_.B->scale(of_rows, of_pressures);
    system_.D->scale(of_pressures, factor);
    system_.C->scale(of_pressures, of_pressures);
    system_.S->scale(of_pressures, of_pressures);
    for (unsigned int row = 0; row < of_rows.size(); ++row)
      if (of_rows[row] == 0.)
        diagonal_entry(row) = viscous_diagonal[row];
  }

  void SaddleMatrix::describe_rows()
  {
    const unsigned int n_rows = 3 * nodes_.n_owned();
    system_.penalised.clear();
    system_.translations.assign(3 * n_rows, 0.);
    for (NodeIndex k = nodes_.begin; k < nodes_.end; ++k)
    {
      for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
      {
        const unsigned int row   = 3 * (k - nodes_.begin) + i;
        const double       scale = scale_[3 * k + i];
        if (scale < penalised)
          system_.penalised.push_back(row);
        else
          for (unsigned int mode = 0; mode < 3; ++mode)
          {
            const double along = frames_[k].identity ? i == mode : frames_[k].axes[i][mode];
            system_.translations[mode * n_rows + row] = along / scale;
          }
      }
    }
  }

  std::pair<double, double> SaddleMatrix::residual_norm(const Field<double> &r) const
  {
    const Partition &partition = scene_.partition;
    double           momentum2 = 0., continuity2 = 0.;
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
    {
      const Vec3 v = frames_[k].to_frame(r.V[k]);
      for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
        momentum2 += std::pow(scale_[3 * k + i] * v[i], 2);
      continuity2 += r.P[k] * r.P[k];
    }
    return {std::sqrt(partition.sum(momentum2)), std::sqrt(partition.sum(continuity2))};
  }

  la::BlockVector SaddleMatrix::vector() const
  {
    return la::BlockVector({nodes_.dofs(3), nodes_.dofs(1)}, scene_.partition.comm);
  }

  void SaddleMatrix::load(const Field<double> &rhs, la::BlockVector &b) const
  {
    const Partition &partition = scene_.partition;
    Field<double>    condensed(scene_.mesh);
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
    {
      condensed.V[k] = rhs.V[k];
      condensed.P[k] = rhs.P[k];
    }
    for (unsigned int v = 0; v < partition.visited_cells.size(); ++v)
    {
      const CellIndex    c    = partition.visited_cells[v];
      CellValues<double> cell = {};
      cell.beta               = rhs.beta[c];
      eliminations_[v].condense(cell);
      for (unsigned int a = 0; a < 4; ++a)
      {
        condensed.V[scene_.mesh.cells[c][a]] += cell.V[a];
        condensed.P[scene_.mesh.cells[c][a]] += cell.P[a];
      }
    }
    double *momentum   = b.block(0).begin();
    double *continuity = b.block(1).begin();
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
    {
      const unsigned int local = k - partition.node_begin;
      const Vec3         v     = frames_[k].to_frame(condensed.V[k]);
      for (unsigned int i = 0; i < 3; ++i)
        momentum[3 * local + i] = i < frames_[k].n_fixed ? 0. : scale_[3 * k + i] * v[i];
      continuity[local] = pressure_scale_ * condensed.P[k];
    }
  }

  void SaddleMatrix::unload(const la::BlockVector &x, const Field<double> &rhs, Field<double> &solution) const
  {
    const Partition &partition = scene_.partition;
    solution                   = Field<double>(scene_.mesh);
    const double *velocity     = x.block(0).begin();
    const double *pressure     = x.block(1).begin();
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
    {
      const unsigned int local = k - partition.node_begin;
      Vec3               v;
      for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
        v[i] = scale_[3 * k + i] * velocity[3 * local + i];
      solution.V[k] = frames_[k].to_space(v);
      solution.P[k] = pressure_scale_ * pressure[local];
    }
    partition.gather(solution.V);
    partition.gather(solution.P);
    for (CellIndex c = partition.cell_begin; c < partition.cell_end; ++c)
    {
      const CellValues<double> w = solution.on_cell(scene_.mesh, c);
      solution.beta[c]           = eliminations_[visited_index_[c]].recover_bubble(rhs.beta[c], w.V, w.P);
    }
    partition.gather_cells(solution.beta.data()->begin_raw(), 3);
  }

  void SaddleMatrix::load_guess(const Field<double> &guess, la::BlockVector &x) const
  {
    const Partition &partition = scene_.partition;
    double          *velocity  = x.block(0).begin();
    double          *pressure  = x.block(1).begin();
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
    {
      const unsigned int local = k - partition.node_begin;
      const Vec3         v     = frames_[k].to_frame(guess.V[k]);
      for (unsigned int i = 0; i < 3; ++i)
        velocity[3 * local + i] = i < frames_[k].n_fixed ? 0. : v[i] / scale_[3 * k + i];
      pressure[local] = guess.P[k] / pressure_scale_;
    }
  }
} // namespace retroforge
