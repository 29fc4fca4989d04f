// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/geometry/facet_curvature.h>
#include <retroforge/mesh/broadcast.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/renumber.h>
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/remeshing/rebuild.h>
#include <retroforge/remeshing/size_octree.h>
#include <retroforge/remeshing/slivers.h>
#include <retroforge/remeshing/trigger.h>
#include <retroforge/remeshing/uncross.h>
#include <retroforge/time/remesher.h>

namespace retroforge
{
  namespace
  {
    constexpr double relative_chord_error = 0.02;
    // Edges at a die longer than this times the wanted length call for a remeshing, which halves them.
    constexpr double coarse = 2.;
    // A mesh that cannot follow its die does so no better when it is remade each time: increments in between.
    constexpr unsigned int settling = 2;
    // The error must be larger by this than it could be with as many cells, for a mesh to be remade.
    constexpr double worthwhile_gain = 1.5;
    // Distance from a die, over the element size, within which a node touches it.
    constexpr double touching_distance = 1e-2;
    // Distance from a die, over the element size, within which a point of the surface rests on it and is left as it is:
    // a surface at rest is held within the penetration of contact, so that at the die itself there would be a kink. Put
    // onto the die, points would go with it, metal that it only comes to as well.
    constexpr double resting_distance = 1e-5;

    /// Edges that metal may be drawn over: those that stick out, and the rim of an open die. Where a die that
    /// was made for a sector ends in a plane of symmetry, nothing is.
    std::vector<TriangleSurface::Edge>
    refined_edges(const Die &die, const std::vector<Patch> &patches, const double element_size)
    {
      const TriangleSurface &surface = *die.surface();
      const auto             is_cut  = [&](const TriangleSurface::Edge &edge) {
        const auto &t = surface.triangles()[edge.facet];
        const Vec3 &a = surface.vertices()[t[edge.edge]], &b = surface.vertices()[t[(edge.edge + 1) % 3]];
        return std::any_of(patches.begin(), patches.end(), [&](const Patch &patch) {
          const auto above = [&](const Vec3 &x) {
            return (x - patch.symmetry->point) * patch.symmetry->normal > -1e-3 * element_size;
          };
          return patch.symmetry && above(a) && above(b); // the plane's normal points out of the workpiece
        });
      };
      auto edges = sharp_ridges(surface, die.feature_angle());
      for (const TriangleSurface::Edge &edge : rim(surface))
        if (!is_cut(edge))
          edges.push_back(edge);
      return edges;
    }

    std::vector<Plane> planes_of(const std::vector<Patch> &patches)
    {
      std::vector<Plane> planes;
      for (const Patch &patch : patches)
        if (patch.symmetry)
          planes.push_back(*patch.symmetry);
      return planes;
    }

    /// Positions rounded to about 1e-10 of the workpiece's size. Decisions must not hang on rounding, which
    /// is another one on another number of ranks: edges of equal length would be taken in another order.
    NodalVectors<double> on_grid(const NodalVectors<double> &X)
    {
      const auto [low, high]       = bounding_box(X);
      const double         grid    = std::ldexp(1., std::ilogb((high - low).norm()) - 33);
      NodalVectors<double> rounded = X;
      for (Vec3 &x : rounded)
        for (unsigned int i = 0; i < 3; ++i)
          x[i] = grid * std::round(x[i] / grid);
      return rounded;
    }
  } // namespace

  Remesher::Remesher(const RemesherParameters &parameters,
                     const double              element_size,
                     const std::vector<Die>   &dies,
                     const std::vector<Patch> &patches,
                     MPI_Comm                  comm)
      : parameters_(parameters)
      , element_size_(element_size)
      , dies_(dies)
      , comm_(comm)
      , near_die_(dies.size())
      , gaps_(dies,
              planes_of(patches),
              parameters.sizes == RemesherParameters::Sizes::uniform ? 0. : parameters.gap_elements,
              parameters.smallest_size * element_size)
  {
    if (parameters_.sizes == RemesherParameters::Sizes::uniform)
      return;
    const double largest = largest_size();
    const double chord_error =
      parameters_.chord_error > 0. ? parameters_.chord_error : relative_chord_error * element_size;
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (dies[d].surface())
      {
        std::vector<double> size;
        for (const double curvature : facet_curvature(*dies[d].surface(), dies[d].feature_angle()))
          size.push_back(std::clamp(std::sqrt(8. * chord_error / std::max(curvature, 1e-300)),
                                    parameters_.smallest_size * element_size,
                                    largest));
        near_die_[d].emplace(*dies[d].surface(),
                             size,
                             largest,
                             parameters_.growth,
                             refined_edges(dies[d], patches, element_size),
                             smallest_size());
      }
  }

  bool Remesher::due(const TetMesh              &mesh,
                     const NodalVectors<double> &X,
                     const DieStates            &states,
                     const std::vector<bool>    &frozen,
                     const unsigned int          increments,
                     const bool                  first) const
  {
    if (increments == 0)
      return first && too_coarse(mesh, X, states);
    if (parameters_.when == RemesherParameters::When::increments && increments >= parameters_.every)
      return true;
    if (needs_remeshing(mesh, X, parameters_.local, frozen))
      return true;
    return increments > settling &&
           (too_coarse(mesh, X, states) || misfit(mesh, X, states) > parameters_.fit * element_size_);
  }

  bool Remesher::too_coarse(const TetMesh &mesh, const NodalVectors<double> &X, const DieStates &states) const
  {
    const SizeField size     = size_field(states);
    const double    smallest = smallest_size();
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
        for (unsigned int e = 0; e < 3; ++e)
        {
          const Vec3  &a = X[face.nodes[e]], &b = X[face.nodes[(e + 1) % 3]], middle = 0.5 * (a + b);
          const double length = (b - a).norm();
          if (face.nodes[e] > face.nodes[(e + 1) % 3] || length < coarse * smallest)
            continue;
          const bool in_gap = gaps_.enabled() && gaps_.narrow(middle, states, length / coarse);
          if (!in_gap && !size.below(middle, length / coarse))
            continue;
          for (unsigned int d = 0; d < dies_.size(); ++d)
            if ((near_die_[d] || in_gap) && states[d].in_press != 0)
              if (const DieFeature feature = dies_[d].closest(middle, states[d].displacement, 0.5 * length);
                  feature.found())
                return true;
        }
    return false;
  }

  std::vector<bool> Remesher::frozen(const TetMesh &mesh) const
  {
    return frozen_cells(mesh, parameters_.local);
  }

  double Remesher::misfit(const TetMesh &mesh, const NodalVectors<double> &X, const DieStates &states) const
  {
    double deepest = 0.;
    for (unsigned int d = 0; d < dies_.size(); ++d)
      if (dies_[d].surface() && states[d].in_press != 0)
      {
        const double      touching = 0.1 * parameters_.fit * element_size_;
        std::vector<bool> on_die(mesh.n_nodes(), false);
        const auto        delta = [&](const Vec3 &x) {
          const DieFeature feature = dies_[d].closest(x, states[d].displacement, touching);
          return feature.found() ? dies_[d].project(x, states[d].displacement, feature).delta
                                        : std::numeric_limits<double>::max();
        };
        for (const BoundaryFace &face : mesh.faces)
          if (mesh.is_surface(face))
            for (const NodeIndex k : face.nodes)
              if (!on_die[k])
                on_die[k] = delta(X[k]) <= touching;
        for (const BoundaryFace &face : mesh.faces)
          if (mesh.is_surface(face))
            for (unsigned int e = 0; e < 3; ++e)
              if (const NodeIndex a = face.nodes[e], b = face.nodes[(e + 1) % 3];
                  a < b && on_die[a] && on_die[b])
                deepest = std::max(deepest, -delta(0.5 * (X[a] + X[b])));
      }
    return deepest;
  }

  SizeBounds Remesher::error_size_bounds() const
  {
    return {element_size_, smallest_size(), parameters_.largest_size * element_size_, parameters_.growth};
  }

  double Remesher::largest_size() const
  {
    return follows_errors() ? error_size_bounds().largest : element_size_;
  }

  bool Remesher::worthwhile(const OptimalSizes &sizes, const unsigned int increments, const bool first)
  {
    return (first || increments > settling) && sizes.gain > worthwhile_gain;
  }

  SizeField Remesher::size_field(const DieStates &states, std::shared_ptr<const ErrorSizes> errors) const
  {
    return [this, states, errors = std::move(errors)](const Vec3 &x, const SizeQuery &query) {
      double size = errors ? (*errors)(x) : element_size_;
      for (unsigned int d = 0; d < dies_.size() && size >= query.lower; ++d)
        if (near_die_[d] && states[d].in_press != 0)
          size = (*near_die_[d])(x - states[d].displacement, {query.lower, std::min(size, query.upper)});
      return size;
    };
  }

  bool
  Remesher::has_narrow_gap(const TetMesh &mesh, const NodalVectors<double> &X, const DieStates &states) const
  {
    if (!gaps_.enabled())
      return false;
    std::vector<bool> is_seen(mesh.n_nodes(), false);
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
        for (const NodeIndex k : face.nodes)
          if (!is_seen[k])
          {
            is_seen[k] = true;
            if (gaps_.narrow(X[k], states, largest_size()))
              return true;
          }
    return false;
  }

  SizeField Remesher::size_field(const TetMesh                    &mesh,
                                 const NodalVectors<double>       &X,
                                 const DieStates                  &states,
                                 std::shared_ptr<const ErrorSizes> errors) const
  {
    SizeField elsewhere = size_field(states, std::move(errors));
    // Without a gap no octree is made.
    if (!has_narrow_gap(mesh, X, states))
      return elsewhere;
    const double             largest = largest_size();
    std::vector<BoundingBox> cells;
    for (const auto &cell : mesh.cells)
      cells.emplace_back(corners(cell, X));
    const SizeSource source = {
      [&](const Vec3 &x) { return gaps_(x, states, largest); },
      [&](const Vec3 &x, const double distance) { return gaps_.below(x, distance, states, largest); }};
    const auto in_gaps = std::make_shared<const SizeOctree>(
      cells, source, SizeOctreeLimits{smallest_size(), largest, parameters_.growth});
    return [in_gaps, elsewhere = std::move(elsewhere)](const Vec3 &x, const SizeQuery &query) {
      const double size = (*in_gaps)(x);
      return size < query.lower ? size : elsewhere.at_most(x, {query.lower, std::min(size, query.upper)});
    };
  }

  PushOut Remesher::push_out(const DieStates &states) const
  {
    return [this, &states](const Vec3 &x) {
      const double          resting = resting_distance * element_size_;
      std::vector<PushStep> steps;
      for (unsigned int d = 0; d < dies_.size(); ++d)
      {
        const Vec3 &at = steps.empty() ? x : steps.back().x;
        if (const DieFeature feature = dies_[d].closest(at, states[d].displacement, resting);
            feature.found() && states[d].in_press != 0)
        {
          const auto projection = dies_[d].project(at, states[d].displacement, feature);
          // What rests is left as it is: of metal that a die only comes to, it does not move with the die.
          if (projection.delta < -resting)
            steps.push_back({d, feature, at + projection.delta * projection.n});
        }
      }
      return steps;
    };
  }

  TouchesDie Remesher::touches(const DieStates &states) const
  {
    return [this, &states](const Vec3 &x) {
      const double near = touching_distance * element_size_;
      for (unsigned int d = 0; d < dies_.size(); ++d)
        if (const DieFeature feature = dies_[d].closest(x, states[d].displacement, near);
            feature.found() && states[d].in_press != 0 &&
            dies_[d].project(x, states[d].displacement, feature).delta < near)
          return true;
      return false;
    };
  }

  namespace
  {
    /// From numbers in a mesh between to those in the first.
    void compose(const std::vector<NodeIndex> &first, std::vector<NodeIndex> &old_node)
    {
      for (NodeIndex &k : old_node)
        if (k != invalid_index)
          k = first[k];
    }
  } // namespace

  namespace
  {
    /// Nodes that were made inside are where the mesh around takes them.
    std::vector<TapeWriter::Slot>
    nodes_of_rebuilt(const RebuiltMesh &from, const RebuiltMesh &rebuilt, TapeWriter &tape)
    {
      const TransferOperator J =
        make_transfer(from.mesh, from.mesh.X, rebuilt.mesh, rebuilt.old_node, Interpolation::linear);
      std::vector<TapeWriter::Slot> nodes;
      for (NodeIndex k = 0; k < rebuilt.mesh.n_nodes(); ++k)
        if (rebuilt.old_node[k] != invalid_index)
          nodes.push_back(tape.node(rebuilt.old_node[k]));
        else
        {
          std::vector<unsigned int> arguments;
          std::vector<double>       numbers;
          for (unsigned int i = J.begin[k]; i < J.begin[k + 1]; ++i)
          {
            arguments.push_back(tape.node(J.node[i]));
            numbers.push_back(J.weight[i]);
          }
          numbers.insert(numbers.end(), J.offset[k].begin_raw(), J.offset[k].end_raw());
          nodes.push_back(tape.add(PlacingRule::sum, arguments, numbers));
        }
      return nodes;
    }
  } // namespace

  RemeshedMesh Remesher::make(const TetMesh              &mesh,
                              const NodalVectors<double> &X,
                              const SizeField            &size,
                              const DieStates            &states,
                              const double                repairable,
                              double                     &removed_volume,
                              TapeWriter                 &tape) const
  {
    const PushOut    push_out = this->push_out(states);
    const TouchesDie touches  = this->touches(states);
    const double     before   = volume(mesh.cells, X);
    RebuiltMesh      start{mesh, {}};
    start.mesh.X = X;
    start.old_node.resize(mesh.n_nodes());
    std::iota(start.old_node.begin(), start.old_node.end(), 0);
    const auto use = [&](RepairedMesh &&made) {
      tape.place(tape.nodes(made.mesh.old_node));
      compose(start.old_node, made.mesh.old_node);
      start = std::move(made.mesh);
      removed_volume += made.removed;
    };
    // What remeshing moves can cross again beside what was taken away.
    constexpr unsigned int n_tries = 3;
    for (unsigned int i = 1;; ++i)
    {
      if (auto uncrossed = uncross(start.mesh, start.mesh.X, size))
        use(std::move(*uncrossed));
      if (parameters_.method != RemesherParameters::Method::local ||
          minimum_quality(start.mesh.cells, start.mesh.X) <= 0.)
      {
        RebuiltMesh rebuilt = rebuild_inside(start.mesh, start.mesh.X, size, "Remeshing");
        tape.place(nodes_of_rebuilt(start, rebuilt, tape));
        compose(start.old_node, rebuilt.old_node);
        start = std::move(rebuilt);
      }
      RemeshedMesh local =
        remesh_locally(start.mesh, start.mesh.X, size, parameters_.local, push_out, touches, before, &tape);
      compose(start.old_node, local.old_node);
      if (i == n_tries)
        return local;
      auto peeled = without_slivers(local.mesh, local.mesh.X, size, repairable - removed_volume);
      if (!peeled && self_crossings(local.mesh, local.mesh.X).empty())
        return local;
      start = {std::move(local.mesh), std::move(local.old_node)};
      if (peeled)
        use(std::move(*peeled));
    }
  }

  namespace
  {
    void broadcast(PositionTape &tape, const MPI_Comm comm)
    {
      const auto send = [comm](auto &list) { list = dealii::Utilities::MPI::broadcast(comm, list, 0); };
      NodalVectors<double> planes;
      for (const Plane &plane : tape.planes)
        planes.insert(planes.end(), {plane.point, plane.normal});
      send(tape.n_inputs);
      send(tape.rules);
      send(tape.argument_begin);
      send(tape.number_begin);
      send(tape.arguments);
      send(tape.numbers);
      send(planes);
      send(tape.results);
      tape.planes.clear();
      for (std::size_t i = 0; i < planes.size(); i += 2)
        tape.planes.push_back({planes[i], planes[i + 1]});
    }
  } // namespace

  std::shared_ptr<const RemeshRecord> Remesher::remesh(const TetMesh                     &mesh,
                                                       const NodalVectors<double>        &X,
                                                       const DieStates                   &states,
                                                       const std::optional<OptimalSizes> &errors,
                                                       const double                       repairable,
                                                       Timings                           &timings) const
  {
    auto                   record = std::make_shared<RemeshRecord>();
    std::vector<NodeIndex> old_node;
    const auto             make_numbered = [&]() {
      const NodalVectors<double> rounded = on_grid(X);
      const SizeField            size    = size_field(
        mesh, rounded, states, errors ? std::make_shared<ErrorSizes>(*errors, error_size_bounds()) : nullptr);
      TapeWriter   tape(rounded);
      RemeshedMesh made = make(mesh, rounded, size, states, repairable, record->removed_volume, tape);
      const std::vector<NodeIndex> number = renumber(made.mesh);
      std::vector<NodeIndex>       before(number.size());
      for (NodeIndex k = 0; k < number.size(); ++k)
        before[number[k]] = k;
      for (const NodeIndex k : before)
        old_node.push_back(made.old_node[k]);
      record->positions = tape.tape(before);
      // The same where nothing is rounded.
      made.mesh.X = record->positions.positions<double>({mesh, made.mesh, dies_, states}, X);
      check_mesh(made.mesh, "Remeshing");
      return std::move(made.mesh);
    };
    record->mesh = make_on_root("Remeshing", make_numbered, comm_, &old_node);
    MPI_Bcast(&record->removed_volume, 1, MPI_DOUBLE, 0, comm_);
    broadcast(record->positions, comm_);
    record->X_before  = X;
    const auto timing = timings.scope("transfer");
    record->transfer  = make_transfer(mesh, X, record->mesh, old_node);
    return record;
  }
} // namespace retroforge
