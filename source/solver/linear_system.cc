// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/solver/direct_solver.h>
#include <retroforge/solver/linear_system.h>
#include <retroforge/solver/preconditioner.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/solver_gmres.h>

#include <Epetra_CrsGraph.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// Of edge length h, in h^3: a regular tetrahedron has the volume h^3 / (6 sqrt 2).
    constexpr double regular_tetrahedra = 8.5;

    /// Scales of a velocity's components below this are those of a penalty that holds it.
    constexpr double penalised = 0.1;

    /// A preconditioner is made anew when a solve with it takes `patience` times the iterations that it took
    /// when it was new, and so many more; and for the next solve from `aged` times on.
    constexpr double patience = 2.5, spare_iterations = 10., aged = 1.7;
  } // namespace

  void LinearSolverParameters::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Linear solver");
    prm.add_parameter(
      "method",
      method,
      "auto takes `ilu` on small and `multigrid` on large meshes, and falls back to `direct` when they "
      "fail. Units: none.",
      Patterns::Selection("auto|ilu|multigrid|direct"));
    prm.add_parameter(
      "multigrid from", multigrid_from, "Number of nodes from which `auto` takes multigrid. Units: none.");
    prm.add_parameter("max iterations",
                      max_iterations,
                      "Krylov iterations after which the direct solver takes over. Units: none.",
                      Patterns::Integer(1));
    prm.add_parameter("restart", restart, "Krylov vectors kept. Units: none.", Patterns::Integer(5, 1000));
    prm.leave_subsection();
  }

  namespace
  {
    /// Appends `direction`, orthonormalised against the first n rows, unless it lies nearly in their span.
    unsigned int append_axis(Tensor<2, 3> &axes, const unsigned int n, Vec3 direction)
    {
      if (n == 3)
        return 3;
      for (unsigned int i = 0; i < n; ++i)
        direction -= (axes[i] * direction) * axes[i];
      if (direction.norm() < 1e-3)
        return n;
      axes[n] = direction / direction.norm();
      return n + 1;
    }
  } // namespace

  std::vector<NodeFrame> make_frames(const Scene &scene, const ContactSet<double> &contact)
  {
    std::vector<NodeFrame>    frames(scene.mesh.n_nodes());
    std::vector<unsigned int> n_axes(scene.mesh.n_nodes(), 0);
    const auto                append = [&](const NodeIndex k, const Vec3 &direction) {
      n_axes[k] = append_axis(frames[k].axes, n_axes[k], direction);
    };
    for (NodeIndex k = 0; k < frames.size(); ++k)
    {
      for (const Vec3 &direction : scene.topology.fixed_directions[k])
        append(k, direction);
      frames[k].n_fixed = n_axes[k];
    }
    // Nodes come before edges, so that a node that touches has its own normal for an axis.
    for (const bool of_nodes : {true, false})
      for (unsigned int p = 0; p < contact.pairs.size(); ++p)
        if (const ContactPoint &point = contact.pairs[p].point; point.is_node() == of_nodes)
          for (unsigned int i = 0; i < point.n_nodes(); ++i)
            append(point.nodes[i], contact.projections[p].n);
    for (NodeIndex k = 0; k < frames.size(); ++k)
      if (n_axes[k] > 0)
      {
        frames[k].identity = false;
        for (unsigned int i = 0; i < 3 && n_axes[k] < 3; ++i)
        {
          Vec3 unit;
          unit[(i + 1) % 3] = 1.;
          // A direction far from the axes there are keeps the completion well conditioned.
          Vec3 rest = unit;
          for (unsigned int j = 0; j < n_axes[k]; ++j)
            rest -= (frames[k].axes[j] * unit) * frames[k].axes[j];
          if (rest.norm() > 0.5)
            append(k, unit);
        }
      }
    return frames;
  }

  /// Rows of one block as Trilinos stores them: node b's entries of the r-th component of owned node a begin
  /// at row_begin(rows_per_node * a + r) + columns_per_node * position.
  struct LinearSystem::Block
  {
    Block(TrilinosWrappers::SparseMatrix &matrix, const unsigned int rows, const unsigned int columns)
        : rows(rows), columns(columns)
    {
      auto &epetra = const_cast<Epetra_CrsMatrix &>(matrix.trilinos_matrix());
      int  *indices;
      epetra.ExtractCrsDataPointers(row_begin, indices, values);
      column_indices = indices;
      column_map     = &epetra.ColMap();
    }

    double *entry(const unsigned int local_node, const unsigned int r, const unsigned int position) const
    {
      return values + row_begin[rows * local_node + r] + columns * position;
    }

    unsigned int           rows, columns;
    int                   *row_begin;
    double                *values;
    const int             *column_indices;
    const Epetra_BlockMap *column_map;

    /// Node of an entry's column.
    NodeIndex    node_of(const int entry) const { return column_map->GID(column_indices[entry]) / columns; }
    unsigned int component_of(const int entry) const
    {
      return column_map->GID(column_indices[entry]) % columns;
    }
  };

  LinearSystem::LinearSystem(const Scene &scene, const LinearSolverParameters &parameters, Timings &timings)
      : scene_(scene), parameters_(parameters), timings_(timings)
  {
    make_pattern();
  }

  LinearSystem::~LinearSystem() = default;

  void LinearSystem::make_pattern()
  {
    const Partition   &partition = scene_.partition;
    const unsigned int n         = scene_.mesh.n_nodes();
    IndexSet           velocity(3 * n), pressure(n);
    velocity.add_range(3 * partition.node_begin, 3 * partition.node_end);
    pressure.add_range(partition.node_begin, partition.node_end);
    // Columns are ordered alike in all blocks: owned nodes, then the others, both ascending. Left to itself,
    // Trilinos orders the others of each block in its own way.
    std::vector<NodeIndex> column_nodes, ghosts;
    std::vector<bool>      seen(n, false);
    for (NodeIndex a = partition.node_begin; a < partition.node_end; ++a)
    {
      column_nodes.push_back(a);
      for (const NodeIndex b : scene_.topology.neighbours[a])
        if (!partition.owns(b) && !seen[b])
        {
          seen[b] = true;
          ghosts.push_back(b);
        }
    }
    std::sort(ghosts.begin(), ghosts.end());
    column_nodes.insert(column_nodes.end(), ghosts.begin(), ghosts.end());
    std::vector<int> local_of(n, -1);
    for (unsigned int l = 0; l < column_nodes.size(); ++l)
      local_of[column_nodes[l]] = l;
    const Epetra_MpiComm epetra_comm(partition.comm);
    const auto           map_of = [&](const unsigned int width, const unsigned int n_nodes) {
      std::vector<int> ids;
      for (unsigned int l = 0; l < n_nodes; ++l)
        for (unsigned int i = 0; i < width; ++i)
          ids.push_back(width * column_nodes[l] + i);
      return Epetra_Map(-1, ids.size(), ids.data(), 0, epetra_comm);
    };
    const unsigned int n_owned = partition.node_end - partition.node_begin;
    const auto         make =
      [&](TrilinosWrappers::SparseMatrix &matrix, const unsigned int rows, const unsigned int columns) {
        const Epetra_Map row_map = map_of(rows, n_owned), domain_map = map_of(columns, n_owned),
                         column_map = map_of(columns, column_nodes.size());
        std::vector<int> lengths;
        for (unsigned int a = 0; a < n_owned; ++a)
          lengths.insert(
            lengths.end(), rows, columns * scene_.topology.neighbours[a + partition.node_begin].size());
        Epetra_CrsGraph  graph(Copy, row_map, column_map, lengths.data(), true);
        std::vector<int> entries;
        for (unsigned int a = 0; a < n_owned; ++a)
        {
          entries.clear();
          for (const NodeIndex b : scene_.topology.neighbours[a + partition.node_begin])
            for (unsigned int j = 0; j < columns; ++j)
              entries.push_back(columns * local_of[b] + j);
          std::sort(entries.begin(), entries.end());
          for (unsigned int i = 0; i < rows; ++i)
            graph.InsertMyIndices(rows * a + i, entries.size(), entries.data());
        }
        graph.FillComplete(domain_map, row_map);
        graph.OptimizeStorage();
        Epetra_CrsMatrix values(Copy, graph);
        values.FillComplete(domain_map, row_map);
        matrix.reinit(values, false);
      };
    matrix_.reinit(2, 2);
    make(matrix_.block(0, 0), 3, 3);
    make(matrix_.block(0, 1), 3, 1);
    make(matrix_.block(1, 0), 1, 3);
    make(matrix_.block(1, 1), 1, 1);
    matrix_.collect_sizes();
    make(schur_, 1, 1);
    A_  = std::make_unique<Block>(matrix_.block(0, 0), 3, 3);
    B_  = std::make_unique<Block>(matrix_.block(0, 1), 3, 1);
    Bt_ = std::make_unique<Block>(matrix_.block(1, 0), 1, 3);
    C_  = std::make_unique<Block>(matrix_.block(1, 1), 1, 1);
    S_  = std::make_unique<Block>(schur_, 1, 1);
    rhs_.reinit({velocity, pressure}, partition.comm);
    x_.reinit({velocity, pressure}, partition.comm);

    positions_.resize(partition.visited_cells.size());
    std::vector<unsigned int> position(n, invalid_index);
    visited_index_.assign(scene_.mesh.n_cells(), invalid_index);
    for (unsigned int v = 0; v < partition.visited_cells.size(); ++v)
      visited_index_[partition.visited_cells[v]] = v;
    for (auto &cell : positions_)
      for (auto &row : cell)
        row.fill(invalid_index);
    for (NodeIndex a = partition.node_begin; a < partition.node_end; ++a)
    {
      const unsigned int local = a - partition.node_begin;
      for (int e = C_->row_begin[local]; e < C_->row_begin[local + 1]; ++e)
        position[C_->node_of(e)] = e - C_->row_begin[local];
      diagonal_.push_back(position[a]);
      // The same node must stand at the same place in the rows of the other blocks.
      for (int e = A_->row_begin[3 * local]; e < A_->row_begin[3 * local + 1]; ++e)
        AssertThrow(position[A_->node_of(e)] * 3 + A_->component_of(e) ==
                      static_cast<unsigned int>(e - A_->row_begin[3 * local]),
                    ExcInternalError("The blocks of the matrix order their columns differently."));
      for (const CellIndex c : scene_.topology.cells[a])
        for (unsigned int i = 0; i < 4; ++i)
          if (scene_.mesh.cells[c][i] == a)
            for (unsigned int j = 0; j < 4; ++j)
              positions_[visited_index_[c]][i][j] = position[scene_.mesh.cells[c][j]];
    }
  }

  unsigned int LinearSystem::position_of(const unsigned int local_row, const NodeIndex column) const
  {
    const int begin = C_->row_begin[local_row], end = C_->row_begin[local_row + 1];
    int       entry = begin;
    while (entry < end && C_->node_of(entry) != column)
      ++entry;
    AssertThrow(entry < end, ExcMessage("A contact point lies between nodes that share no cell."));
    return entry - begin;
  }

  void LinearSystem::add_cell(const CellIndex    c,
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
          double *continuity = Bt_->entry(local, 0, position);
          for (unsigned int i = 0; i < 3; ++i)
          {
            double *row = A_->entry(local, i, position);
            for (unsigned int j = 0; j < 3; ++j)
              row[j] += A[i][j];
            *B_->entry(local, i, position) += Vp[i];
            continuity[i] += pV[i];
          }
          *C_->entry(local, 0, position) += t.C[a][b][lane];
          *S_->entry(local, 0, position) += (a == b ? 2. : 1.) * mass - t.C[a][b][lane];
        }
      }
  }

  void LinearSystem::assemble(const Stage<double> &stage,
                              const Field<double> &W,
                              const ActiveSet     &active,
                              const Linearisation  linearisation)
  {
    const auto timing = timings_.scope("assembly");
    const auto clear  = [](const Block &block, const unsigned int n_rows) {
      std::fill(block.values, block.values + block.row_begin[n_rows], 0.);
    };
    const Partition   &partition = scene_.partition;
    const unsigned int n_owned   = partition.node_end - partition.node_begin;
    clear(*A_, 3 * n_owned);
    clear(*B_, 3 * n_owned);
    clear(*Bt_, n_owned);
    clear(*C_, n_owned);
    clear(*S_, n_owned);
    frames_ = make_frames(scene_, stage.contact);
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
    viscous_diagonal_.resize(3 * n_owned);
    for (unsigned int a = 0; a < n_owned; ++a)
    {
      for (unsigned int i = 0; i < 3; ++i)
        viscous_diagonal_[3 * a + i] = A_->entry(a, i, diagonal_[a])[i];
    }
    add_contact(stage, W, active);
    scale_and_fix();
  }

  void LinearSystem::add_contact(const Stage<double> &stage, const Field<double> &W, const ActiveSet &active)
  {
    const Partition    &partition = scene_.partition;
    const unsigned int  n_owned   = partition.node_end - partition.node_begin;
    std::vector<double> added(3 * n_owned, 0.);
    edges_press_ = false;
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
    {
      const ContactPoint &point = stage.contact.pairs[p].point;
      if (!partition.sees(point.nodes))
        continue;
      edges_press_ |= !point.is_node();
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
          const unsigned int position = a == b ? diagonal_[local] : position_of(local, point.nodes[b]);
          for (unsigned int i = 0; i < 3; ++i)
          {
            if (a == b)
              added[3 * local + i] += tangent[i][i];
            for (unsigned int j = 0; j < 3; ++j)
              A_->entry(local, i, position)[j] += tangent[i][j];
          }
        }
      }
    }
    scale_.assign(3 * scene_.mesh.n_nodes(), 1.);
    for (unsigned int a = 0; a < n_owned; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        scale_[3 * (a + partition.node_begin) + i] =
          std::sqrt(viscous_diagonal_[3 * a + i] / (viscous_diagonal_[3 * a + i] + added[3 * a + i]));
    partition.gather_nodes(scale_.data(), 3);
  }

  void LinearSystem::scale_and_fix()
  {
    const Partition   &partition = scene_.partition;
    const unsigned int n_owned   = partition.node_end - partition.node_begin;
    // A fixed component has scale zero in its row and column, and its diagonal put back afterwards.
    std::vector<double> factor = scale_;
    for (NodeIndex k = 0; k < frames_.size(); ++k)
      for (unsigned int i = 0; i < frames_[k].n_fixed; ++i)
        factor[3 * k + i] = 0.;
    const auto of_columns = [&factor](const Block &block) {
      std::vector<double> values(block.column_map->NumMyElements());
      for (unsigned int j = 0; j < values.size(); ++j)
        values[j] = factor[block.column_map->GID(j)];
      return values;
    };
    const std::vector<double> A_factor = of_columns(*A_), Bt_factor = of_columns(*Bt_);
    for (unsigned int a = 0; a < n_owned; ++a)
    {
      const NodeIndex k = a + partition.node_begin;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double       f   = factor[3 * k + i];
        const unsigned int row = 3 * a + i;
        for (int e = A_->row_begin[row]; e < A_->row_begin[row + 1]; ++e)
          A_->values[e] *= f * A_factor[A_->column_indices[e]];
        if (f == 0.)
          A_->entry(a, i, diagonal_[a])[i] = viscous_diagonal_[row];
        for (int e = B_->row_begin[row]; e < B_->row_begin[row + 1]; ++e)
          B_->values[e] *= f * pressure_scale_;
      }
      for (int e = Bt_->row_begin[a]; e < Bt_->row_begin[a + 1]; ++e)
        Bt_->values[e] *= pressure_scale_ * Bt_factor[Bt_->column_indices[e]];
      for (int e = C_->row_begin[a]; e < C_->row_begin[a + 1]; ++e)
        C_->values[e] *= pressure_scale_ * pressure_scale_;
      for (int e = S_->row_begin[a]; e < S_->row_begin[a + 1]; ++e)
        S_->values[e] *= pressure_scale_ * pressure_scale_;
    }
  }

  std::pair<double, double> LinearSystem::residual_norm(const Field<double> &r) const
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

  void LinearSystem::load(const Field<double> &rhs, TrilinosWrappers::MPI::BlockVector &b) const
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
    double *momentum   = b.block(0).trilinos_vector()[0];
    double *continuity = b.block(1).trilinos_vector()[0];
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
    {
      const unsigned int local = k - partition.node_begin;
      const Vec3         v     = frames_[k].to_frame(condensed.V[k]);
      for (unsigned int i = 0; i < 3; ++i)
        momentum[3 * local + i] = i < frames_[k].n_fixed ? 0. : scale_[3 * k + i] * v[i];
      continuity[local] = pressure_scale_ * condensed.P[k];
    }
  }

  void LinearSystem::unload(const TrilinosWrappers::MPI::BlockVector &x, Field<double> &solution) const
  {
    const Partition &partition = scene_.partition;
    solution                   = Field<double>(scene_.mesh);
    const double *velocity     = x.block(0).trilinos_vector()[0];
    const double *pressure     = x.block(1).trilinos_vector()[0];
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
  }

  void LinearSystem::load_guess(const Field<double> &guess, TrilinosWrappers::MPI::BlockVector &x) const
  {
    const Partition &partition = scene_.partition;
    double          *velocity  = x.block(0).trilinos_vector()[0];
    double          *pressure  = x.block(1).trilinos_vector()[0];
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
    {
      const unsigned int local = k - partition.node_begin;
      const Vec3         v     = frames_[k].to_frame(guess.V[k]);
      for (unsigned int i = 0; i < 3; ++i)
        velocity[3 * local + i] = i < frames_[k].n_fixed ? 0. : v[i] / scale_[3 * k + i];
      pressure[local] = guess.P[k] / pressure_scale_;
    }
  }

  double LinearSystem::start_from(const std::vector<Field<double>> &guesses)
  {
    using Vector          = TrilinosWrappers::MPI::BlockVector;
    x_                    = 0.;
    Vector              r = rhs_;
    std::vector<Vector> images, sources;
    for (const Field<double> &guess : guesses)
    {
      Vector x(x_), y(x_);
      load_guess(guess, x);
      matrix_.vmult(y, x);
      const double whole = y.l2_norm();
      for (std::size_t j = 0; j < images.size(); ++j)
      {
        const double c = y * images[j];
        y.add(-c, images[j]);
        x.add(-c, sources[j]);
      }
      const double norm = y.l2_norm();
      if (!(norm > 1e-8 * whole))
        continue;
      y *= 1. / norm;
      x *= 1. / norm;
      const double c = y * r;
      r.add(-c, y);
      x_.add(c, x);
      images.push_back(y);
      sources.push_back(x);
    }
    return r.l2_norm();
  }

  unsigned int LinearSystem::solve(const Field<double>              &rhs,
                                   const double                      tolerance,
                                   Field<double>                    &solution,
                                   const std::vector<Field<double>> &guesses)
  {
    load(rhs, rhs_);
    unsigned int iterations = 0;
    if (direct())
      solve_directly();
    else
      iterations = solve_iteratively(tolerance, guesses);
    unload(x_, solution);
    const Partition &partition = scene_.partition;
    for (CellIndex c = partition.cell_begin; c < partition.cell_end; ++c)
    {
      const CellValues<double> w = solution.on_cell(scene_.mesh, c);
      solution.beta[c]           = eliminations_[visited_index_[c]].recover_bubble(rhs.beta[c], w.V, w.P);
    }
    partition.gather_cells(solution.beta.data()->begin_raw(), 3);
    ++n_solves;
    n_iterations += iterations;
    return iterations;
  }

  void LinearSystem::reset()
  {
    preconditioner_.reset();
  }

  void LinearSystem::make_preconditioner()
  {
    const auto         timing    = timings_.scope("preconditioner");
    const Partition   &partition = scene_.partition;
    const unsigned int n_rows    = 3 * (partition.node_end - partition.node_begin);
    const bool         multigrid =
      parameters_.method == "multigrid" ||
      (parameters_.method == "auto" && scene_.mesh.n_nodes() >= parameters_.multigrid_from);
    // Rigid translations, zero where a component is fixed or held by the penalty.
    std::vector<double> near_kernel(3 * n_rows, 0.);
    if (multigrid)
      for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
        for (unsigned int mode = 0; mode < 3; ++mode)
        {
          Vec3 unit;
          unit[mode]   = 1.;
          const Vec3 v = frames_[k].to_frame(unit);
          for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
            if (scale_[3 * k + i] > penalised)
              near_kernel[mode * n_rows + 3 * (k - partition.node_begin) + i] = v[i] / scale_[3 * k + i];
        }
    preconditioner_ = std::make_unique<Preconditioner>(
      matrix_.block(0, 0), matrix_.block(0, 1), schur_, multigrid, near_kernel);
    first_rate_ = 0.;
  }

  void LinearSystem::polish_penalised()
  {
    const Partition                   &partition = scene_.partition;
    TrilinosWrappers::MPI::BlockVector r(x_);
    matrix_.residual(r, x_, rhs_);
    const double             *residual = r.block(0).trilinos_vector()[0];
    double                   *velocity = x_.block(0).trilinos_vector()[0];
    std::vector<unsigned int> rows;
    for (NodeIndex k = partition.node_begin; k < partition.node_end; ++k)
      for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
        if (scale_[3 * k + i] < penalised)
          rows.push_back(3 * (k - partition.node_begin) + i);
    if (edges_press_)
    {
      std::vector<double> change;
      solve_rows(rows, residual, change);
      for (std::size_t n = 0; n < rows.size(); ++n)
        velocity[rows[n]] += change[n];
    }
    else
      for (const unsigned int row : rows)
        velocity[row] += residual[row] / A_->entry(row / 3, row % 3, diagonal_[row / 3])[row % 3];
  }

  void LinearSystem::solve_rows(const std::vector<unsigned int> &rows,
                                const double                    *r,
                                std::vector<double>             &d) const
  {
    const std::size_t         n = rows.size();
    std::vector<unsigned int> number(A_->column_map->NumMyElements(), invalid_index);
    std::vector<double>       diagonal(n), residual(n), z(n), direction(n), image(n);
    std::vector<std::vector<std::pair<unsigned int, double>>> entries(n);
    for (std::size_t i = 0; i < n; ++i)
      number[rows[i]] = i; // owned columns come first, in the order of the rows
    for (std::size_t i = 0; i < n; ++i)
    {
      for (int e = A_->row_begin[rows[i]]; e < A_->row_begin[rows[i] + 1]; ++e)
        if (const unsigned int j = number[A_->column_indices[e]]; j != invalid_index)
          entries[i].emplace_back(j, A_->values[e]);
      diagonal[i] = A_->entry(rows[i] / 3, rows[i] % 3, diagonal_[rows[i] / 3])[rows[i] % 3];
      residual[i] = r[rows[i]];
    }
    d.assign(n, 0.);
    const auto precondition = [&]() {
      double product = 0.;
      for (std::size_t i = 0; i < n; ++i)
      {
        z[i] = residual[i] / diagonal[i];
        product += residual[i] * z[i];
      }
      return product;
    };
    constexpr unsigned int most  = 30;
    double                 rz    = precondition();
    const double           first = rz;
    direction                    = z;
    for (unsigned int step = 0; step < most && rz > 1e-20 * first; ++step)
    {
      double curvature = 0.;
      for (std::size_t i = 0; i < n; ++i)
      {
        image[i] = 0.;
        for (const auto &[j, value] : entries[i])
          image[i] += value * direction[j];
        curvature += image[i] * direction[i];
      }
      const double length = rz / curvature;
      for (std::size_t i = 0; i < n; ++i)
      {
        d[i] += length * direction[i];
        residual[i] -= length * image[i];
      }
      const double next = precondition();
      for (std::size_t i = 0; i < n; ++i)
        direction[i] = z[i] + next / rz * direction[i];
      rz = next;
    }
  }

  unsigned int LinearSystem::solve_iteratively(const double                      tolerance,
                                               const std::vector<Field<double>> &guesses)
  {
    const double norm = rhs_.l2_norm();
    x_                = 0.;
    if (norm == 0.)
      return 0;
    const double start = start_from(guesses);
    if (start <= tolerance * norm)
      return 0;
    const double decades = std::max(0.5, std::log10(start / (tolerance * norm)));
    unsigned int total   = 0;
    for (unsigned int attempt = 0; attempt < 2; ++attempt)
    {
      const bool fresh = !preconditioner_;
      if (fresh)
        make_preconditioner();
      const unsigned int limit =
        fresh ? parameters_.max_iterations
              : std::min<unsigned int>(parameters_.max_iterations,
                                       patience * first_rate_ * decades + spare_iterations);
      const auto                                       timing = timings_.scope("krylov");
      SolverControl                                    control(limit, tolerance * norm, false, false);
      SolverFGMRES<TrilinosWrappers::MPI::BlockVector> krylov(
        control,
        typename SolverFGMRES<TrilinosWrappers::MPI::BlockVector>::AdditionalData(
          std::min(parameters_.restart, limit + 2)));
      try
      {
        krylov.solve(matrix_, x_, rhs_, *preconditioner_);
        polish_penalised();
        total += control.last_step();
        const double rate = control.last_step() / decades;
        if (fresh)
          first_rate_ = rate;
        else if (rate > aged * first_rate_ + 1.)
          reset();
        return total;
      }
      catch (const SolverControl::NoConvergence &)
      {
        total += control.last_step();
        reset();
        if (fresh)
          break;
      }
    }
    if (parameters_.method != "auto")
      throw Error("Linear solver/method",
                  "'" + parameters_.method + "' did not reach " + as_text(tolerance) + " in " +
                    std::to_string(parameters_.max_iterations) + " iterations",
                  "the linear system must be solved",
                  "use 'auto', which falls back to the direct solver, or check that the billet cannot slide "
                  "or spin freely");
    solve_directly();
    return total;
  }

  void LinearSystem::solve_directly()
  {
    const auto         timing    = timings_.scope("direct solver");
    const Partition   &partition = scene_.partition;
    const unsigned int n         = scene_.mesh.n_nodes();
    IndexSet           rows(4 * n);
    rows.add_range(4 * partition.node_begin, 4 * partition.node_end);
    DynamicSparsityPattern               pattern(4 * n, 4 * n, rows);
    std::vector<types::global_dof_index> columns;
    for (NodeIndex a = partition.node_begin; a < partition.node_end; ++a)
    {
      columns.clear();
      for (const NodeIndex b : scene_.topology.neighbours[a])
        for (unsigned int j = 0; j < 4; ++j)
          columns.push_back(4 * b + j);
      for (unsigned int i = 0; i < 4; ++i)
        pattern.add_entries(4 * a + i, columns.begin(), columns.end(), true);
    }
    TrilinosWrappers::SparseMatrix whole;
    whole.reinit(rows, rows, pattern, partition.comm);
    TrilinosWrappers::MPI::Vector b(rows, partition.comm), x(rows, partition.comm);
    const auto                    copy = [&](
                        const Block &block, const unsigned int row_offset, const unsigned int column_offset) {
      for (unsigned int a = 0; a < partition.node_end - partition.node_begin; ++a)
        for (unsigned int r = 0; r < block.rows; ++r)
          for (int e = block.row_begin[block.rows * a + r]; e < block.row_begin[block.rows * a + r + 1]; ++e)
            whole.set(4 * (a + partition.node_begin) + row_offset + r,
                      4 * block.node_of(e) + column_offset + block.component_of(e),
                      block.values[e]);
    };
    copy(*A_, 0, 0);
    copy(*B_, 0, 3);
    copy(*Bt_, 3, 0);
    copy(*C_, 3, 3);
    whole.compress(VectorOperation::insert);
    const unsigned int n_owned = partition.node_end - partition.node_begin;
    for (unsigned int a = 0; a < n_owned; ++a)
      for (unsigned int i = 0; i < 4; ++i)
        b.trilinos_vector()[0][4 * a + i] =
          i < 3 ? rhs_.block(0).trilinos_vector()[0][3 * a + i] : rhs_.block(1).trilinos_vector()[0][a];
    solve_by_mumps(whole, b, x);
    for (unsigned int a = 0; a < n_owned; ++a)
      for (unsigned int i = 0; i < 4; ++i)
        (i < 3 ? x_.block(0).trilinos_vector()[0][3 * a + i] : x_.block(1).trilinos_vector()[0][a]) =
          x.trilinos_vector()[0][4 * a + i];
  }
} // namespace retroforge
