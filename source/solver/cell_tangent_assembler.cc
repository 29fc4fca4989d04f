// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/element/tangent_pack.templates.h>
#include <retroforge/solver/cell_tangent_assembler.h>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// Number of regular tetrahedra of edge length h in h^3: one has the volume h^3 / (6 sqrt 2).
    constexpr double regular_tetrahedra = 8.5;

    /// Into one lane of a pack, of the blocks that both pairs have.
    template <typename Blocks>
    void fill_lane(const QuadratureTangent<3> &t, const unsigned int lane, Blocks &blocks)
    {
      for (unsigned int a = 0; a < t.A.n_rows(); ++a)
        for (unsigned int i = 0; i < 3; ++i)
        {
          for (unsigned int b = 0; b < t.A.n_cols(); ++b)
            for (unsigned int j = 0; j < 3; ++j)
              blocks.A[a][b][i][j][lane] = t.A(a, b)[i][j];
          for (unsigned int b = 0; b < 4; ++b)
            blocks.B[a][b][i][lane] = t.B(a, b)[i];
        }
      blocks.viscosity[lane] = t.viscosity;
      blocks.volume[lane]    = t.volume;
    }

    BubbleElimination<double> elimination_of(const EliminatedBubble<3> &bubble)
    {
      BubbleElimination<double> elimination;
      for (unsigned int i = 0; i < 3; ++i)
      {
        for (unsigned int a = 0; a < 4; ++a)
        {
          elimination.Pb[a][i] = bubble.Pb[a][i];
          for (unsigned int j = 0; j < 3; ++j)
            elimination.Vb[a][i][j] = bubble.Vb[a][i][j];
        }
        for (unsigned int j = 0; j < 3; ++j)
          elimination.M[i][j] = bubble.M[i][j];
      }
      return elimination;
    }

    /// Tangents of n_lanes cells of the mini element, with what the elimination of their bubbles needs.
    struct MiniTangents : TangentPack
    {
      static constexpr unsigned int n_nodes = 4;

      void compute(const std::array<CellGeometry<double>, n_lanes> &geometry,
                   const std::array<CellValues<double>, n_lanes>   &w,
                   const LaneLaws                                  &laws,
                   const Linearisation                              linearisation,
                   BubbleElimination<double>                       *elimination)
      {
        std::array<BubbleElimination<double> *, n_lanes> of_lanes;
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
          of_lanes[lane] = elimination + lane;
        compute_cell_tangents(geometry, w, laws, linearisation, *this, of_lanes);
      }

      void compute(const std::array<QuadratureGeometry<3, double>, n_lanes> &geometry,
                   const std::array<QuadratureValues<3, double>, n_lanes>   &w,
                   const LaneLaws                                           &laws,
                   const Linearisation                                       linearisation,
                   BubbleElimination<double>                                *elimination)
      {
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
        {
          QuadratureTangent<3> t = cell_tangent(geometry[lane], w[lane], laws[lane], linearisation);
          elimination[lane]      = elimination_of(eliminate_bubble(t));
          fill_lane(t, lane, *this);
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int b = 0; b < 4; ++b)
              C[a][b][lane] = t.C(a, b);
        }
      }

      RETROFORGE_INLINE Pack of_pressures(const unsigned int a, const unsigned int b) const
      {
        return C[a][b];
      }
    };

    struct TaylorHoodTangents : TaylorHoodPack
    {
      static constexpr unsigned int n_nodes = 10;

      void compute(const std::array<CellGeometry<double>, n_lanes>     &geometry,
                   const std::array<TaylorHoodValues<double>, n_lanes> &w,
                   const LaneLaws                                      &laws,
                   const Linearisation                                  linearisation,
                   BubbleElimination<double> *)
      {
        compute_cell_tangents(geometry, w, laws, linearisation, *this);
      }

      void compute(const std::array<QuadratureGeometry<3, double>, n_lanes> &geometry,
                   const std::array<QuadratureValues<3, double>, n_lanes>   &w,
                   const LaneLaws                                           &laws,
                   const Linearisation                                       linearisation,
                   BubbleElimination<double> *)
      {
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
          fill_lane(cell_tangent(geometry[lane], w[lane], laws[lane], linearisation), lane, *this);
      }

      RETROFORGE_INLINE Pack of_pressures(unsigned int, unsigned int) const { return Pack{}; }
    };

    /// Adds four entries of four cells to row i of the block that each cell has for them.
    RETROFORGE_INLINE void add_row(const Pack                   first,
                                   const Pack                   second,
                                   const Pack                   third,
                                   const Pack                   fourth,
                                   const unsigned int          *pairs,
                                   const unsigned int           i,
                                   CellTangentAssembler::Block *blocks)
    {
      // The transpose of a matrix whose rows are the four packs.
      const Pack even_low = __builtin_shufflevector(first, second, 0, 4, 2, 6),
                 odd_low  = __builtin_shufflevector(first, second, 1, 5, 3, 7),
                 even_up  = __builtin_shufflevector(third, fourth, 0, 4, 2, 6),
                 odd_up   = __builtin_shufflevector(third, fourth, 1, 5, 3, 7);
      blocks[pairs[0]].rows[i] += __builtin_shufflevector(even_low, even_up, 0, 1, 4, 5);
      blocks[pairs[1]].rows[i] += __builtin_shufflevector(odd_low, odd_up, 0, 1, 4, 5);
      blocks[pairs[2]].rows[i] += __builtin_shufflevector(even_low, even_up, 2, 3, 6, 7);
      blocks[pairs[3]].rows[i] += __builtin_shufflevector(odd_low, odd_up, 2, 3, 6, 7);
    }

    template <typename Tangents>
    RETROFORGE_INLINE void add_tangents(const Tangents              &t,
                                        const unsigned int          *pairs,
                                        CellTangentAssembler::Block *blocks,
                                        double                      *schur)
    {
      const Pack mass = t.volume / 20. / t.viscosity;
      for (unsigned int a = 0; a < Tangents::n_nodes; ++a)
        for (unsigned int b = 0; b < Tangents::n_nodes; ++b, pairs += n_lanes)
        {
          for (unsigned int i = 0; i < 3; ++i)
            add_row(t.A[a][b][i][0],
                    t.A[a][b][i][1],
                    t.A[a][b][i][2],
                    b < 4 ? t.B[a][b][i] : Pack{},
                    pairs,
                    i,
                    blocks);
          if (a >= 4)
            continue;
          const Pack C = b < 4 ? t.of_pressures(a, b) : Pack{};
          add_row(t.B[b][a][0], t.B[b][a][1], t.B[b][a][2], C, pairs, 3, blocks);
          if (b < 4)
          {
            const Pack S = (a == b ? 2. : 1.) * mass - C;
            for (unsigned int lane = 0; lane < n_lanes; ++lane)
              schur[pairs[lane]] += S[lane];
          }
        }
    }

    RETROFORGE_ALSO_FOR("fma")
    void add_pack(const MiniTangents          &t,
                  const unsigned int          *pairs,
                  CellTangentAssembler::Block *blocks,
                  double                      *schur)
    {
      add_tangents(t, pairs, blocks, schur);
    }

    RETROFORGE_ALSO_FOR("fma")
    void add_pack(const TaylorHoodTangents    &t,
                  const unsigned int          *pairs,
                  CellTangentAssembler::Block *blocks,
                  double                      *schur)
    {
      add_tangents(t, pairs, blocks, schur);
    }

    unsigned int n_packs(const Discretization<3> &discretization)
    {
      return (discretization.visited_cells().size() + n_lanes - 1) / n_lanes;
    }
  } // namespace

  CellTangentAssembler::CellTangentAssembler(const Scene &scene, const NodePattern &met)
      : scene_(scene), begin_(1, 0)
  {
    const auto          &discretization = scene.discretization;
    const NodeNumbering &velocities     = *discretization.condensed_nodes();
    const auto           index_at       = [&](const unsigned int place) {
      return velocities.index_at(velocities.place(discretization.velocity_nodes()->node_at(place)));
    };
    const auto        &visited = discretization.visited_cells();
    const unsigned int n       = discretization.n_nodes_per_cell();
    for (unsigned int local = 0; local < velocities.n_owned(); ++local)
      begin_.push_back(begin_.back() + met.row(local).size());
    const unsigned int of_nobody = begin_.back();
    blocks_.resize(of_nobody + 1);
    schur_.resize(of_nobody + 1);
    if (discretization.has_bubbles())
      eliminations_.resize(n_lanes * n_packs(discretization));
    pairs_.assign(n * n * n_lanes * n_packs(discretization), of_nobody);
    for (unsigned int v = 0; v < visited.size(); ++v)
    {
      const unsigned int *places = discretization.velocity_places(visited[v]);
      unsigned int       *pairs  = &pairs_[n * n * n_lanes * (v / n_lanes) + v % n_lanes];
      for (unsigned int a = 0; a < n; ++a)
        if (const unsigned int local = places[a]; local < velocities.n_owned())
          for (unsigned int b = 0; b < n; ++b)
            pairs[n_lanes * (n * a + b)] = begin_[local] + met.position(local, index_at(places[b]));
    }
  }

  template <typename Tangents, typename Pair>
  void CellTangentAssembler::add_cells(const Pair                &pair,
                                       const Equilibrium<double> &stage,
                                       const Field<double>       &W,
                                       const Linearisation        linearisation)
  {
    const auto        &discretization = scene_.discretization;
    const auto        &visited        = discretization.visited_cells();
    const unsigned int pack_width     = Tangents::n_nodes * Tangents::n_nodes * n_lanes;
    double             log_viscosity = 0., volume = 0.;

    using Geometry = std::decay_t<decltype(cell_geometry(pair.positions(discretization, stage.X, 0)))>;
    std::array<Geometry, n_lanes>                               geometry;
    std::array<typename Pair::template Values<double>, n_lanes> w;
    LaneLaws                                                    laws;
    Tangents                                                    tangents;
    for (unsigned int pack = 0; pack < n_packs(discretization); ++pack)
    {
      const unsigned int begin = n_lanes * pack, n = std::min<unsigned int>(n_lanes, visited.size() - begin);
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
      {
        // Lanes without a cell repeat the last one.
        const CellIndex c = visited[begin + std::min(lane, n - 1)];
        geometry[lane]    = cell_geometry(pair.positions(discretization, stage.X, c));
        w[lane]           = pair.on_cell(discretization, W, c);
        laws[lane]        = stage.law(c);
      }
      tangents.compute(
        geometry, w, laws, linearisation, eliminations_.empty() ? nullptr : &eliminations_[begin]);
      add_pack(tangents, &pairs_[pack_width * pack], blocks_.data(), schur_.data());
      for (unsigned int lane = 0; lane < n; ++lane)
        if (discretization.cells().owns(visited[begin + lane]))
        {
          log_viscosity += std::log(tangents.viscosity[lane]) * tangents.volume[lane];
          volume += tangents.volume[lane];
        }
    }
    volume               = discretization.sum(volume);
    viscosity_over_edge_ = std::exp(discretization.sum(log_viscosity) / volume) /
                           std::cbrt(regular_tetrahedra * volume / scene_.mesh.n_cells());
  }

  void CellTangentAssembler::assemble(const Equilibrium<double> &stage,
                                      const Field<double>       &W,
                                      const Linearisation        linearisation)
  {
    std::fill(blocks_.begin(), blocks_.end(), Block{});
    std::fill(schur_.begin(), schur_.end(), 0.);
    dispatch_element(scene_.discretization, [&](const auto &pair) {
      // By quadrature, too, either pair's tangents are those that its blocks are made for.
      using Pair = std::decay_t<decltype(pair)>;
      if constexpr (!std::is_same_v<Pair, TaylorHoodPair>)
        if (scene_.discretization.pair() == ElementPair::mini)
          return add_cells<MiniTangents>(pair, stage, W, linearisation);
      if constexpr (!std::is_same_v<Pair, MiniPair>)
        add_cells<TaylorHoodTangents>(pair, stage, W, linearisation);
    });
  }
} // namespace retroforge
