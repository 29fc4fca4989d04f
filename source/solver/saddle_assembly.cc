// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/solver/saddle_matrix.h>

#include <limits>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// Of edge length h, in h^3: a regular tetrahedron has the volume h^3 / (6 sqrt 2).
    constexpr double regular_tetrahedra = 8.5;

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

    /// q x, as `to_frame` of a block's rows or columns.
    void rotate(const NodeFrame &frame, double (&x)[3])
    {
      if (frame.identity)
        return;
      double r[3];
      for (unsigned int i = 0; i < 3; ++i)
        r[i] = frame.axes[i][0] * x[0] + frame.axes[i][1] * x[1] + frame.axes[i][2] * x[2];
      std::copy(r, r + 3, x);
    }

    void rotate_rows(const NodeFrame &frame, double (&A)[3][3])
    {
      if (frame.identity)
        return;
      double R[3][3];
      for (unsigned int i = 0; i < 3; ++i)
      {
        const auto &q = frame.axes[i];
        for (unsigned int j = 0; j < 3; ++j)
          R[i][j] = q[0] * A[0][j] + q[1] * A[1][j] + q[2] * A[2][j];
      }
      std::copy(&R[0][0], &R[0][0] + 9, &A[0][0]);
    }

    void rotate_columns(const NodeFrame &frame, double (&A)[3][3])
    {
      if (frame.identity)
        return;
      double R[3][3];
      for (unsigned int j = 0; j < 3; ++j)
      {
        const auto &q = frame.axes[j];
        for (unsigned int i = 0; i < 3; ++i)
          R[i][j] = A[i][0] * q[0] + A[i][1] * q[1] + A[i][2] * q[2];
      }
      std::copy(&R[0][0], &R[0][0] + 9, &A[0][0]);
    }

    /// Tangents of n_lanes cells of the mini element, with what the elimination of their bubbles needs.
    struct MiniTangents
    {
      static constexpr unsigned int n_nodes = 4;

      TangentPack pack;

      void compute(const std::array<CellGeometry<double>, n_lanes> &geometry,
                   const std::array<CellValues<double>, n_lanes>   &w,
                   const MaterialLaw<double>                       &law,
                   const Linearisation                              linearisation,
                   const unsigned int                               n,
                   BubbleElimination<double>                       *elimination)
      {
        BubbleElimination<double>                        unused;
        std::array<BubbleElimination<double> *, n_lanes> of_lanes;
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
          of_lanes[lane] = lane < n ? elimination + lane : &unused;
        compute_cell_tangents(geometry, w, law, linearisation, pack, of_lanes);
      }

      double C(const unsigned int a, const unsigned int b, const unsigned int lane) const
      {
        return pack.C[a][b][lane];
      }
    };

    struct TaylorHoodTangents
    {
      static constexpr unsigned int n_nodes = 10;

      TaylorHoodPack pack;

      void compute(const std::array<CellGeometry<double>, n_lanes>     &geometry,
                   const std::array<TaylorHoodValues<double>, n_lanes> &w,
                   const MaterialLaw<double>                           &law,
                   const Linearisation                                  linearisation,
                   unsigned int,
                   BubbleElimination<double> *)
      {
        compute_cell_tangents(geometry, w, law, linearisation, pack);
      }

      double C(unsigned int, unsigned int, unsigned int) const { return 0.; }
    };

    MiniTangents tangents_of(MiniPair)
    {
      return MiniTangents();
    }
    TaylorHoodTangents tangents_of(TaylorHoodPair)
    {
      return TaylorHoodTangents();
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

  void SaddleMatrix::make_positions()
  {
    const Partition &partition = scene_.partition;
    const Spaces    &spaces    = scene_.spaces;
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
      diagonal_.push_back(system_.A->pattern().position(local, velocities_.range().begin + local));
    const auto place = [](const NodePattern &pattern, const unsigned int local, const unsigned int column) {
      const unsigned int position = pattern.position(local, column);
      AssertThrow(position <= std::numeric_limits<Place>::max(),
                  ExcMessage("A node has too many neighbours."));
      return static_cast<Place>(position);
    };
    const unsigned int n = spaces.pair() == ElementPair::mini ? 4 : 10;
    places_per_cell_     = n * n + 8 * n + 16;
    places_.assign(places_per_cell_ * partition.visited_cells.size(), 0);
    for (unsigned int visited = 0; visited < partition.visited_cells.size(); ++visited)
    {
      const NodeIndex *nodes  = spaces.velocity_nodes(partition.visited_cells[visited]);
      Place           *places = &places_[places_per_cell_ * visited];
      for (unsigned int a = 0; a < n; ++a)
        if (velocities_.owns(nodes[a]))
        {
          const unsigned int local = velocities_.local(nodes[a]);
          for (unsigned int b = 0; b < n; ++b)
            places[n * a + b] = place(system_.A->pattern(), local, velocities_.number(nodes[b]));
          for (unsigned int b = 0; b < 4; ++b)
            places[n * n + 4 * a + b] = place(system_.B->pattern(), local, pressures_.number(nodes[b]));
        }
      for (unsigned int a = 0; a < 4; ++a)
        if (pressures_.owns(nodes[a]))
        {
          const unsigned int local = pressures_.local(nodes[a]);
          for (unsigned int b = 0; b < n; ++b)
            places[n * n + 4 * n + n * a + b] =
              place(system_.D->pattern(), local, velocities_.number(nodes[b]));
          for (unsigned int b = 0; b < 4; ++b)
            places[n * n + 8 * n + 4 * a + b] =
              place(system_.C->pattern(), local, pressures_.number(nodes[b]));
        }
    }
  }

  template <typename Tangents>
  void SaddleMatrix::add_cell(const unsigned int visited, const Tangents &tangents, const unsigned int lane)
  {
    constexpr unsigned int n     = Tangents::n_nodes;
    const auto            &t     = tangents.pack;
    const NodeIndex       *nodes = scene_.spaces.velocity_nodes(scene_.partition.visited_cells[visited]);
    const Place *of_A = &places_[places_per_cell_ * visited], *of_B = of_A + n * n, *of_D = of_B + 4 * n,
                *of_C = of_D + 4 * n;
    for (unsigned int a = 0; a < n; ++a)
    {
      if (!velocities_.owns(nodes[a]))
        continue;
      const unsigned int local   = velocities_.local(nodes[a]);
      const NodeFrame   &frame_a = frames_[nodes[a]];
      for (unsigned int b = 0; b < n; ++b)
      {
        double A[3][3];
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            A[i][j] = t.A[a][b][i][j][lane];
        rotate_rows(frame_a, A);
        rotate_columns(frames_[nodes[b]], A);
        for (unsigned int i = 0; i < 3; ++i)
        {
          double *row = system_.A->entry(local, i, of_A[n * a + b]);
          for (unsigned int j = 0; j < 3; ++j)
            row[j] += A[i][j];
        }
      }
      for (unsigned int b = 0; b < 4; ++b)
      {
        double of_pressure[3] = {t.B[a][b][0][lane], t.B[a][b][1][lane], t.B[a][b][2][lane]};
        rotate(frame_a, of_pressure);
        for (unsigned int i = 0; i < 3; ++i)
          *system_.B->entry(local, i, of_B[4 * a + b]) += of_pressure[i];
      }
    }
    const double mass = t.volume[lane] / 20. / t.viscosity[lane];
    for (unsigned int a = 0; a < 4; ++a)
    {
      if (!pressures_.owns(nodes[a]))
        continue;
      const unsigned int local = pressures_.local(nodes[a]);
      for (unsigned int b = 0; b < n; ++b)
      {
        double of_velocity[3] = {t.B[b][a][0][lane], t.B[b][a][1][lane], t.B[b][a][2][lane]};
        rotate(frames_[nodes[b]], of_velocity);
        double *row = system_.D->entry(local, 0, of_D[n * a + b]);
        for (unsigned int i = 0; i < 3; ++i)
          row[i] += of_velocity[i];
      }
      for (unsigned int b = 0; b < 4; ++b)
      {
        const double C = tangents.C(a, b, lane);
        *system_.C->entry(local, 0, of_C[4 * a + b]) += C;
        *system_.S->entry(local, 0, of_C[4 * a + b]) += (a == b ? 2. : 1.) * mass - C;
      }
    }
  }

  void SaddleMatrix::add_cells(const Stage<double> &stage,
                               const Field<double> &W,
                               const Linearisation  linearisation)
  {
    const Partition &partition     = scene_.partition;
    double           log_viscosity = 0., volume = 0.;
    with_pair(scene_.spaces, [&](const auto pair) {
      using Values = typename decltype(pair)::template Values<double>;
      std::array<CellGeometry<double>, n_lanes> geometry;
      std::array<Values, n_lanes>               w;
      auto                                      tangents  = tangents_of(pair);
      const unsigned int                        n_visited = partition.visited_cells.size();
      for (unsigned int begin = 0; begin < n_visited; begin += n_lanes)
      {
        const unsigned int n = std::min(n_lanes, n_visited - begin);
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
        {
          // Lanes without a cell repeat the last one.
          const CellIndex c = partition.visited_cells[begin + std::min(lane, n - 1)];
          geometry[lane]    = geometry_of_cell(scene_.mesh, stage.X, c);
          w[lane]           = pair.on_cell(scene_.spaces, W, c);
        }
        tangents.compute(geometry,
                         w,
                         stage.physics.law,
                         linearisation,
                         n,
                         eliminations_.empty() ? nullptr : &eliminations_[begin]);
        for (unsigned int lane = 0; lane < n; ++lane)
        {
          const CellIndex c = partition.visited_cells[begin + lane];
          add_cell(begin + lane, tangents, lane);
          if (partition.cells().owns(c))
          {
            log_viscosity += std::log(tangents.pack.viscosity[lane]) * tangents.pack.volume[lane];
            volume += tangents.pack.volume[lane];
          }
        }
      }
    });
    volume          = partition.sum(volume);
    pressure_scale_ = std::exp(partition.sum(log_viscosity) / volume) /
                      std::cbrt(regular_tetrahedra * volume / scene_.mesh.n_cells());
  }

  std::vector<double>
  SaddleMatrix::add_contact(const Stage<double> &stage, const Field<double> &W, const ActiveSet &active)
  {
    const Partition    &partition = scene_.partition;
    const NodePattern  &pattern   = system_.A->pattern();
    std::vector<double> added(3 * velocities_.range().n_owned(), 0.);
    system_.penalties_couple = false;
    const ActiveSet chosen   = active.empty() ? stage.decide_active(W) : active;
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
    {
      const ContactPoint &point = stage.contact.pairs[p].point;
      if (!partition.sees(point.nodes))
        continue;
      system_.penalties_couple |= !point.has_own_velocity();
      const Tensor<2, 3> of_point =
        point.velocity_weight() * point.velocity_weight() *
        contact_tangent(stage.contact_node(p, W, chosen), stage.physics.law, stage.physics.contact);
      for (unsigned int a = 0; a < point.n_velocity_nodes(); ++a)
      {
        const NodeIndex k = point.velocity_node_at(a);
        if (!velocities_.owns(k))
          continue;
        const unsigned int local = velocities_.local(k);
        for (unsigned int b = 0; b < point.n_velocity_nodes(); ++b)
        {
          const Tensor<2, 3> tangent =
            frames_[k].axes * of_point * transpose(frames_[point.velocity_node_at(b)].axes);
          const unsigned int position =
            a == b ? diagonal_[local]
                   : pattern.position(local, velocities_.number(point.velocity_node_at(b)));
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
} // namespace retroforge
