// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/shares.h>
#include <retroforge/objective/corner_positions.h>
#include <retroforge/objective/local_derivatives.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/unfilled_volume.h>

namespace retroforge
{
  namespace
  {
    /// The shape as a die around it: triangles turned round, on facets as they are.
    Die inside_out(const TriangleSurface &shape)
    {
      std::vector<Triangle> triangles = shape.triangles();
      for (Triangle &triangle : triangles)
        std::swap(triangle[1], triangle[2]);
      DieSurfaceLaw law;
      law.smooth = false;
      // Points outside by more are not at the surface.
      const double depth = 0.01 * shape.diagonal();
      return Die("target", TriangleSurface("target", shape.vertices(), std::move(triangles)), depth, law);
    }

    /// The number of the normal at a point of a facet, for those that have one.
    constexpr std::array<unsigned int, 7> normal_at = {
      {0, 1, 2, invalid_index, invalid_index, invalid_index, 3}};

    /// Coordinates of the point of a tetrahedron that shadows are seen from: in no plane of symmetry of it.
    constexpr double eye_of_cell[4] = {0.31, 0.27, 0.23, 0.19};

    template <typename Number>
    Vector3<Number> eye_of(const Tetrahedron<Number> &x)
    {
      Vector3<Number> eye;
      for (unsigned int k = 0; k < 4; ++k)
        eye += x[k] * Number(eye_of_cell[k]);
      return eye;
    }

    template <typename Number>
    Tetrahedron<Number> corners_of(const FinalView<Number> &view, const CellIndex c)
    {
      Tetrahedron<Number> x;
      for (unsigned int k = 0; k < 4; ++k)
        x[k] = view.X[view.scene.mesh.cells[c][k]];
      return x;
    }
  } // namespace

  namespace
  {
    /// The region as the workpiece sees it, which is in the sector: its nodes lie in the symmetry planes but for
    /// rounding, and whether they are behind them must not be asked.
    Region without_sector(Region region)
    {
      region.sector.clear();
      return region;
    }

    /// A region and how much it counts.
    struct RegionPart
    {
      Region region;
      double weight;
    };

    /// The region with its symmetry planes a little inside, and twice as far: the linear continuation of both is
    /// that at the planes to second order, whether the die ends there or goes on. Edges of a die often lie in a
    /// symmetry plane, where rounding would decide on which side, and derivatives would divide by it.
    std::vector<RegionPart> inside_sector(const Region &region)
    {
      if (region.sector.empty())
        return {{region, 1.}};
      const double            distance = 1e-6 * (region.box.second - region.box.first).norm();
      std::vector<RegionPart> parts    = {{region, 2.}, {region, -1.}};
      for (unsigned int i = 0; i < 2; ++i)
        for (Plane &plane : parts[i].region.sector)
          plane.point -= (i + 1.) * distance * plane.normal; // they face outwards
      return parts;
    }
  } // namespace

  /// The surface where a view has it, and the region there.
  template <typename Number>
  struct UnfilledVolume::Surface
  {
    DieState<Number>               state;
    NodalVectors<Number>           vertices; ///< without the displacement
    RegionPlace<Number>            place;
    std::vector<HalfSpace<Number>> half_spaces;
    std::vector<HalfSpace<double>> values; ///< of the half-spaces

    Surface(const UnfilledVolume &objective, const FinalView<Number> &view, const Region &region)
    {
      if (!objective.is_within())
        state.displacement = view.dies[objective.index_].displacement;
      if (view.target)
        vertices = state.vertices = *view.target;
      else
        convert(objective.die_.surface()->vertices(), vertices);
      place       = region.place(vertices, state.displacement);
      half_spaces = region.half_spaces(place);
      for (const auto &space : half_spaces)
      {
        HalfSpace<double> value;
        for (unsigned int i = 0; i < 3; ++i)
          value.normal[i] = value_of(space.normal[i]);
        value.offset = value_of(space.offset);
        values.push_back(value);
      }
    }

    /// The part of a facet of the workpiece, or one where it stands, that is in the region.
    Number share(const std::array<Vector3<Number>, 3> &x) const
    {
      return all_inside(values_of(x), values) ? Number(1.) : share_of_facet(x, half_spaces);
    }
  };

  UnfilledVolume::UnfilledVolume(Die die, const unsigned int index, const std::optional<Box> &region)
      : die_(std::move(die)), index_(index), region_(region)
  {
  }

  UnfilledVolume::UnfilledVolume(const TargetSurface &shape)
      : die_(inside_out(shape.shape())), index_(shape.die()), region_(shape.region())
  {
    Assert(is_within(), dealii::ExcMessage("a shape that is wanted stands still"));
    if (!shape.shape().is_closed() && !region_)
      throw Error("Unfilled volume",
                  "the target is open and has no region",
                  "there is no inside of an open surface",
                  "close it, or give a region that ends at the planes of symmetry");
  }

  UnfilledVolume::Decisions UnfilledVolume::compute_decisions(const FinalView<double> &view) const
  {
    const Die              die          = view.target ? die_.moved(*view.target) : die_;
    const TriangleSurface &surface      = *die.surface();
    const Vec3             displacement = is_within() ? Vec3() : view.dies[index_].displacement;
    Decisions              decisions;
    decisions.region = make_region(die, displacement, region_, view.scene.mesh);
    BoundingBox around(decisions.region.box.first);
    around.include(decisions.region.box.second);
    const double margin = 0.01 * (around.upper - around.lower).norm();
    const Vec3   shift  = decisions.region.follows_die ? displacement : Vec3();
    for (unsigned int i = 0; i < 3; ++i)
    {
      around.lower[i] += shift[i] - margin;
      around.upper[i] += shift[i] + margin;
    }
    const auto [begin, end] = share_of_rank(surface.n_facets(), view.scene.discretization.comm());
    for (std::size_t f = begin; f < end; ++f)
      if (around.intersects(
            BoundingBox(shifted(corners_of(surface.vertices(), surface.triangles()[f]), displacement))))
        decisions.facets.push_back(f);
    decisions.at_die = find_facets_at_die(view, die, displacement, {around.lower, around.upper});
    return decide_cells(view, die, std::move(decisions));
  }

  UnfilledVolume::Decisions
  UnfilledVolume::decide_cells(const FinalView<double> &view, const Die &die, Decisions decisions) const
  {
    const BoxTree tree(is_within() ? boxes_of_facets(*die.surface()) : std::vector<BoundingBox>());
    const auto [begin, end] = share_of_rank(view.scene.mesh.n_cells(), view.scene.discretization.comm());
    for (CellIndex c = begin; c < end; ++c)
    {
      Cell cell{c, true, {}};
      if (is_within())
      {
        const auto  x = corners_of(view, c);
        BoundingBox around(x);
        const Vec3  margin = 0.05 * (around.upper - around.lower);
        around.lower -= margin;
        around.upper += margin;
        cell.facets       = tree.intersecting(around);
        cell.eye_in_front = die.facet_distance(eye_of(x), Vec3()) > 0.;
        if (!cell.eye_in_front && cell.facets.empty())
          continue;
      }
      decisions.cells.push_back(std::move(cell));
    }
    return decisions;
  }

  namespace
  {
    template <typename Number>
    Number volume_of_cell(const UnfilledVolume::Cell           &cell,
                          const Tetrahedron<Number>            &x,
                          const std::vector<HalfSpace<Number>> &half_spaces)
    {
      return cell.eye_in_front
               ? clipped_volume(x, half_spaces.data(), half_spaces.data() + half_spaces.size())
               : Number(0.);
    }
  } // namespace

  template <typename Number>
  std::vector<Number> UnfilledVolume::compute_integrals(const FinalView<Number> &view,
                                                        const Decisions         &decisions) const
  {
    const Surface<Number> surface(*this, view, without_sector(decisions.region));
    const auto           &triangles = die_.surface()->triangles();
    Number                cavity(0.), metal(0.), at_facets(0.);
    for (const auto &[region, part] : inside_sector(decisions.region))
    {
      const Surface<Number> at(*this, view, region);
      // On one rank, as the others sum up their facets.
      if (region.eye_in_front &&
          dealii::Utilities::MPI::this_mpi_process(view.scene.discretization.comm()) == 0)
        cavity += part * region.volume(at.place);
      for (const unsigned int f : decisions.facets)
      {
        const auto x = shifted(corners_of(at.vertices, triangles[f]), at.state.displacement);
        cavity += part * region.shadow(at.place, x);
        if (is_within())
          continue;
        std::array<Number, 3> delta;
        const auto            points = middles(x);
        for (unsigned int q = 0; q < 3; ++q)
          delta[q] = die_.project(points[q], at.state, DieFeature{f, 0}).delta;
        cavity += part * at.share(x) * volume_of_bulge(x, delta);
      }
    }
    for (const Cell &cell : decisions.cells)
    {
      const auto x = corners_of(view, cell.cell);
      metal += volume_of_cell(cell, x, surface.half_spaces);
      for (const unsigned int f : cell.facets)
        metal += shadow_in_tetrahedron(
          x, eye_of(x), corners_of(surface.vertices, triangles[f]), surface.half_spaces);
    }
    for (const FacetAtDie &facet : decisions.at_die)
    {
      const auto        x      = corners_of(view.X, facet.nodes);
      const auto        points = FacetAtDie::points(x);
      FacetGaps<Number> gaps;
      for (unsigned int q = 0; q < 7; ++q)
      {
        const auto projection = die_.project(points[q], surface.state, facet.features[q]);
        gaps.delta[q]         = projection.delta;
        if (const unsigned int k = normal_at[q]; k != invalid_index)
          gaps.n[k] = projection.n;
      }
      at_facets += surface.share(x) * volume_at_facet(x, gaps, !is_within());
    }
    return {cavity, metal, at_facets};
  }

  void UnfilledVolume::reverse_cavity(const FinalView<double>         &view,
                                      const Region                    &region,
                                      const std::vector<unsigned int> &facets,
                                      const double                     weight,
                                      FinalBar                        &bar) const
  {
    const Surface<double> surface(*this, view, region);
    const Die             die          = view.target ? die_.moved(*view.target) : die_;
    const auto           &triangles    = die_.surface()->triangles();
    const Vec3           &displacement = surface.state.displacement;
    const bool            by_vertices  = bar.target.size() == surface.vertices.size();
    Vec3                  displacement_bar;
    double                mouth_bar = 0.;
    const auto            vertex    = [&](const unsigned int v, const Vec3 &x_bar) {
      if (by_vertices)
        bar.target[v] += x_bar;
    };
    const auto place_of = [&](LocalArguments &argument) {
      RegionPlace<LocalArguments::Number> place;
      place.shift = argument(surface.place.shift);
      place.mouth = argument(surface.place.mouth);
      return place;
    };
    const auto add_place = [&](const LocalArguments::Number &part, const unsigned int first) {
      if (region.follows_die)
        displacement_bar += derivative(part, first, weight);
      mouth_bar += weight * part.dx(first + 3);
    };
    if (region.eye_in_front &&
        dealii::Utilities::MPI::this_mpi_process(view.scene.discretization.comm()) == 0)
    {
      LocalArguments argument;
      add_place(region.volume(place_of(argument)), 0);
    }
    for (const unsigned int f : facets)
    {
      LocalArguments      argument;
      const auto          x_at  = shifted(corners_of(surface.vertices, triangles[f]), displacement);
      const auto          x     = argument(x_at);
      const auto          place = place_of(argument);
      std::array<Vec3, 3> x_bar;
      auto                part = region.shadow(place, x);
      if (!is_within())
      {
        std::array<LocalArguments::Number, 3> delta;
        const auto                            points = middles(x_at);
        for (unsigned int q = 0; q < 3; ++q)
          delta[q] = argument(die.project(points[q], displacement, DieFeature{f, 0}).delta);
        part += (all_inside(x_at, surface.values) ? LocalArguments::Number(1.)
                                                  : share_of_facet(x, region.half_spaces(place))) *
                volume_of_bulge(x, delta);
        for (unsigned int q = 0; q < 3; ++q)
        {
          Vec3 point_bar;
          die.reverse_project(points[q],
                              displacement,
                              DieFeature{f, 0},
                              weight * part.dx(13 + q),
                              Vec3(),
                              point_bar,
                              displacement_bar,
                              by_vertices ? &bar.target : nullptr);
          x_bar[q] += 0.5 * point_bar;
          x_bar[(q + 1) % 3] += 0.5 * point_bar;
        }
      }
      add_place(part, 9);
      for (unsigned int k = 0; k < 3; ++k)
      {
        x_bar[k] += derivative(part, 3 * k, weight);
        displacement_bar += x_bar[k];
        vertex(triangles[f][k], x_bar[k]);
      }
    }
    if (region.mouth_vertex != invalid_index)
      vertex(region.mouth_vertex, mouth_bar * region.axis);
    if (!is_within())
      bar.dies[index_].displacement += displacement_bar;
  }

  void UnfilledVolume::reverse_cells(const FinalView<double> &view,
                                     const Decisions         &decisions,
                                     const double             weight,
                                     FinalBar                &bar) const
  {
    const Region          region = without_sector(decisions.region);
    const Surface<double> surface(*this, view, region);
    const auto           &triangles   = die_.surface()->triangles();
    const bool            by_vertices = bar.target.size() == surface.vertices.size();
    Vec3                  shift_bar;
    double                mouth_bar = 0.;
    for (const Cell &cell : decisions.cells)
    {
      const auto     x_at = corners_of(view, cell.cell);
      LocalArguments argument;
      const auto     x   = argument(x_at);
      const auto     add = [&](const LocalArguments::Number &part) {
        for (unsigned int k = 0; k < 4; ++k)
          bar.X[view.scene.mesh.cells[cell.cell][k]] += derivative(part, 3 * k, weight);
      };
      if (cell.eye_in_front && all_inside(x_at, surface.values))
        add(signed_volume(x));
      else if (cell.eye_in_front)
      {
        RegionPlace<LocalArguments::Number> place;
        place.shift     = argument(surface.place.shift);
        place.mouth     = argument(surface.place.mouth);
        const auto part = volume_of_cell(cell, x, region.half_spaces(place));
        add(part);
        shift_bar += derivative(part, 12, weight);
        mouth_bar += weight * part.dx(15);
      }
      for (const unsigned int f : cell.facets) // within a shape, which stands still
      {
        LocalArguments                      of_pair;
        const auto                          corners = of_pair(x_at);
        const auto                          facet   = of_pair(corners_of(surface.vertices, triangles[f]));
        RegionPlace<LocalArguments::Number> still;
        const auto part = shadow_in_tetrahedron(corners, eye_of(corners), facet, region.half_spaces(still));
        add(part);
        for (unsigned int k = 0; k < 3 && by_vertices; ++k)
          bar.target[triangles[f][k]] += derivative(part, 12 + 3 * k, weight);
      }
    }
    if (region.follows_die && !is_within())
      bar.dies[index_].displacement += shift_bar;
    if (region.mouth_vertex != invalid_index && by_vertices)
      bar.target[region.mouth_vertex] += mouth_bar * region.axis;
  }

  void UnfilledVolume::reverse_facets(const FinalView<double> &view,
                                      const Decisions         &decisions,
                                      const double             weight,
                                      FinalBar                &bar) const
  {
    const Region          region = without_sector(decisions.region);
    const Surface<double> surface(*this, view, region);
    const Die             die          = view.target ? die_.moved(*view.target) : die_;
    const Vec3           &displacement = surface.state.displacement;
    const bool            by_vertices  = bar.target.size() == surface.vertices.size();
    Vec3                  displacement_bar;
    double                mouth_bar = 0.;
    for (const FacetAtDie &facet : decisions.at_die)
    {
      const auto                        x_at   = corners_of(view.X, facet.nodes);
      const auto                        points = FacetAtDie::points(x_at);
      std::array<Vec3, 3>               x_bar;
      std::array<Vec3, 7>               points_bar;
      LocalArguments                    of_gaps;
      const auto                        x = of_gaps(x_at);
      FacetGaps<LocalArguments::Number> gaps;
      std::array<Vec3, 4>               n;
      for (unsigned int q = 0; q < 7; ++q)
      {
        const auto projection = die.project(points[q], displacement, facet.features[q]);
        gaps.delta[q]         = of_gaps(projection.delta);
        if (const unsigned int k = normal_at[q]; k != invalid_index)
          n[k] = projection.n;
      }
      gaps.n             = of_gaps(n);
      const auto   part  = volume_at_facet(x, gaps, !is_within());
      const double share = surface.share(x_at);
      if (share == 0.)
        continue;
      if (!all_inside(x_at, surface.values))
      {
        LocalArguments                      of_share;
        const auto                          corners = of_share(x_at);
        RegionPlace<LocalArguments::Number> place;
        place.shift         = of_share(surface.place.shift);
        place.mouth         = of_share(surface.place.mouth);
        const auto   of_all = share_of_facet(corners, region.half_spaces(place));
        const double volume = weight * part.val();
        for (unsigned int k = 0; k < 3; ++k)
          x_bar[k] += derivative(of_all, 3 * k, volume);
        if (region.follows_die)
          displacement_bar += derivative(of_all, 9, volume);
        mouth_bar += volume * of_all.dx(12);
      }
      for (unsigned int k = 0; k < 3; ++k)
        x_bar[k] += derivative(part, 3 * k, weight * share);
      for (unsigned int q = 0; q < 7; ++q)
        die.reverse_project(
          points[q],
          displacement,
          facet.features[q],
          weight * share * part.dx(9 + q),
          normal_at[q] == invalid_index ? Vec3() : derivative(part, 16 + 3 * normal_at[q], weight * share),
          points_bar[q],
          displacement_bar,
          by_vertices ? &bar.target : nullptr);
      FacetAtDie::add_points(points_bar, x_bar);
      for (unsigned int k = 0; k < 3; ++k)
        bar.X[facet.nodes[k]] += x_bar[k];
    }
    if (!is_within())
      bar.dies[index_].displacement += displacement_bar;
    if (region.mouth_vertex != invalid_index && by_vertices)
      bar.target[region.mouth_vertex] += mouth_bar * region.axis;
  }

  void UnfilledVolume::reverse_integrals(const FinalView<double>   &view,
                                         const Decisions           &decisions,
                                         const std::vector<double> &weights,
                                         FinalBar                  &bar) const
  {
    for (const auto &[region, part] : inside_sector(decisions.region))
      reverse_cavity(view, region, decisions.facets, part * weights[0], bar);
    reverse_cells(view, decisions, weights[1], bar);
    reverse_facets(view, decisions, weights[2], bar);
  }

  template std::vector<double> UnfilledVolume::compute_integrals(const FinalView<double> &,
                                                                 const Decisions &) const;
  template std::vector<Dual>   UnfilledVolume::compute_integrals(const FinalView<Dual> &,
                                                               const Decisions &) const;

  namespace
  {
    struct UnfilledVolumeType : TargetType
    {
      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        const TargetSurface surface = target.make(where, context);
        objective.scaling           = SymmetryScaling::part;
        if (target.is_die())
          objective.at_end =
            std::make_unique<UnfilledVolume>(context.dies[surface.die()], surface.die(), surface.region());
        else
          objective.at_end = std::make_unique<UnfilledVolume>(surface);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker unfilled_volume_type()
  {
    return {"unfilled volume", Choice<ObjectiveType>::make<UnfilledVolumeType>};
  }
} // namespace retroforge
