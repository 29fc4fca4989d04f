// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/parts_quality.h>
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/solver/rigid_modes.h>
#include <retroforge/time/increment_limits.h>

#include <algorithm>
#include <sstream>

namespace retroforge
{
  /// A cavity is full where this part of the workpiece's surface touches dies, and this part of its volume is
  /// in them: metal that has no room goes into the corners of dies, where a node feels one of their faces.
  constexpr double touching_when_full = 0.95, inside_when_full = 2e-3, part_that_is_near = 0.125;

  /// What may hold what dies leave loose: a force of this part of the largest of the dies', and its moment at an
  /// arm of this part of an edge. That much, a mesh that feels a narrow contact as a line may miss.
  constexpr double most_held = 0.1, longest_arm = 0.7;

  /// By which a step that is repeated may go farther than one that is chosen: neighbouring designs come somewhat
  /// farther in the same step than the one that chose it, and are to keep it.
  constexpr double slack_of_repeated = 2.;

  namespace
  {
    std::string at(const Vec3 &x)
    {
      std::ostringstream text;
      text.precision(4);
      text << " at (" << x[0] << ", " << x[1] << ", " << x[2] << ")";
      return text.str();
    }

    /// A corner of the cell of the least quality.
    Vec3 flattest_cell(const TetMesh &mesh, const NodalVectors<double> &X)
    {
      CellIndex flattest = 0;
      double    least    = std::numeric_limits<double>::infinity();
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        if (const double quality = tet_quality(corners(mesh.cells[c], X)); quality < least)
        {
          least    = quality;
          flattest = c;
        }
      return X[mesh.cells[flattest][0]];
    }

    bool touches(const Scene &scene, const NodalVectors<double> &X, const Die &die, const Vec3 &displacement)
    {
      const double near = 5e-3 * std::cbrt(volume(scene.mesh.cells, X));
      for (NodeIndex k = 0; k < X.size(); ++k)
        if (scene.topology.is_on_surface(k) && die.signed_distance(X[k], displacement) < near)
          return true;
      return false;
    }

    double face_area(const BoundaryFace &face, const NodalVectors<double> &X)
    {
      return 0.5 * facet_vector(X[face.nodes[0]], X[face.nodes[1]], X[face.nodes[2]]).norm();
    }

    /// The mean length of the surface's edges [mm].
    double surface_edge(const Scene &scene, const NodalVectors<double> &X)
    {
      double sum = 0.;
      for (const auto &[a, b] : scene.topology.surface_edges)
        sum += (X[b] - X[a]).norm();
      return sum / scene.topology.surface_edges.size();
    }

    /// Of an increment, that bring it down to what is allowed when it is `excess` times as long.
    unsigned int halvings(const double excess)
    {
      return std::max(1, static_cast<int>(std::ceil(std::log2(excess))));
    }
  } // namespace

  std::optional<StepRejection> IncrementLimits::rejection(const Process<double>      &process,
                                                          const MeshEpoch            &epoch,
                                                          const IncrementRecord      &record,
                                                          const NodalVectors<double> &X,
                                                          const NodalVectors<double> &X_next) const
  {
    if (is_full(process, epoch.scene, record, X_next))
      return StepRejection{"the cavity is full", 1, false, true};
    const auto reason     = violated_limit(epoch.scene, X, X_next);
    const Slip slip       = largest_slip(process, record, X, X_next);
    const bool bears_slip = allow(slip.of_edge / slack_of_repeated);
    if (reason)
      return StepRejection{*reason,
                           1,
                           true,
                           false,
                           false,
                           bears_slip && !violated_limit(epoch.scene, X, X_next, slack_of_repeated)};
    if (allow(slip.of_edge))
      return {};
    // Velocities hardly depend on the increment's length: what it must be is known at once.
    return StepRejection{"a node would slip along " + slip.where,
                         halvings(slip.of_edge / press_.largest_slip),
                         false,
                         false,
                         false,
                         bears_slip};
  }

  bool IncrementLimits::bear(const ForgingState &state, const double step) const
  {
    return allow(state.slip * step / slack_of_repeated) &&
           allow_strain(state.strain_rate * step / slack_of_repeated);
  }

  std::optional<StepRejection> IncrementLimits::strain_rejection(const double strain) const
  {
    constexpr double clearly = 1.5;
    if (allow_strain(strain / clearly))
      return {};
    return StepRejection{"the metal would be strained by " + as_text(strain),
                         halvings(strain / *press_.largest_strain),
                         false,
                         false,
                         true,
                         allow_strain(strain / slack_of_repeated)};
  }

  bool IncrementLimits::is_full(const Process<double>      &process,
                                const Scene                &scene,
                                const IncrementRecord      &record,
                                const NodalVectors<double> &X) const
  {
    // The longest step that the program may choose is more than what touches is off its die.
    const ContactNumerics &whole = model_.step.contact;
    const double           near  = whole.near_in(whole.step) * (choose_steps() ? part_that_is_near : 1.);
    const auto             dies  = process.at_stroke(record.stroke + record.step, record.operation).dies;
    std::vector<bool>      touches(X.size(), false);
    for (const ContactPair &pair : record.pairs)
      if (pair.point.is_node() &&
          scene.dies[pair.die].project(pair.point.position(X), dies[pair.die], pair.feature).delta <= near)
        touches[pair.point.nodes[0]] = true;
    double     surface = 0., touching = 0., inside = 0.;
    const auto is_touched = [&](const BoundaryFace &face) {
      return touches[face.nodes[0]] && touches[face.nodes[1]] && touches[face.nodes[2]];
    };
    for (const BoundaryFace &face : scene.mesh.faces)
      if (scene.mesh.is_surface(face))
      {
        const double area = face_area(face, X);
        surface += area;
        touching += is_touched(face) ? area : 0.;
      }
    if (touching < touching_when_full * surface)
      return false;
    for (const BoundaryFace &face : scene.mesh.faces)
      if (scene.mesh.is_surface(face))
      {
        const double area = face_area(face, X), within = 2. * std::sqrt(area);
        for (const NodeIndex k : face.nodes)
        {
          double depth = 0.;
          for (unsigned int d = 0; d < scene.dies.size(); ++d)
            if (dies[d].in_press != 0)
              depth = std::max(depth, scene.dies[d].depth_of(X[k], dies[d].displacement, within));
          inside += area / 3. * depth;
        }
      }
    return inside > inside_when_full * volume(scene.mesh.cells, X);
  }

  StepRejection IncrementLimits::singular(const ForgingState &state)
  {
    return {"the linear systems of an increment have no solution; the flattest element is" +
            at(flattest_cell(state.epoch->scene.mesh, state.workpiece.X))};
  }

  std::optional<std::string> IncrementLimits::violated_limit(const TetMesh              &mesh,
                                                             const CellIndex             c,
                                                             const NodalVectors<double> &X,
                                                             const NodalVectors<double> &X_next,
                                                             const double                slack) const
  {
    const auto   before = corners(mesh.cells[c], X), after = corners(mesh.cells[c], X_next);
    const double volume = cell_geometry(after).volume;
    if (!(volume > press_.smallest_volume / slack * cell_geometry(before).volume))
      return (volume > 0. ? "an element would be crushed" : "an element would be inverted") + at(before[0]);
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int b = 0; b < a; ++b)
        if (((after[a] - before[a]) - (after[b] - before[b])).norm() >
            slack * press_.largest_move * (before[a] - before[b]).norm())
          return "an edge would be turned or stretched by more than Press/largest move" + at(before[a]);
    return {};
  }

  std::optional<std::string> IncrementLimits::violated_limit(const Scene                &scene,
                                                             const NodalVectors<double> &X,
                                                             const NodalVectors<double> &X_next,
                                                             const double                slack) const
  {
    const auto &owned     = scene.discretization.cells().owned();
    const auto  is_broken = [&](const CellIndex c) {
      return violated_limit(scene.mesh, c, X, X_next, slack).has_value();
    };
    const auto found = std::find_if(owned.begin(), owned.end(), is_broken);
    // All ranks tell of the same cell.
    const CellIndex first =
      dealii::Utilities::MPI::min(found == owned.end() ? invalid_index : *found, scene.discretization.comm());
    if (first == invalid_index)
      return {};
    return violated_limit(scene.mesh, first, X, X_next, slack);
  }

  IncrementLimits::Slip IncrementLimits::largest_slip(const Process<double>      &process,
                                                      const IncrementRecord      &record,
                                                      const NodalVectors<double> &X,
                                                      const NodalVectors<double> &X_next) const
  {
    if (!remesher_.enabled())
      return {};
    const auto      dies = process.over(place(record)).dies;
    const SizeField size = remesher_.size_field(dies);
    const double    time = process.duration(place(record));
    Slip            largest;
    for (const ContactPair &pair : record.pairs)
      if (pair.point.is_node() && model_.dies[pair.die].surface())
      {
        const NodeIndex k    = pair.point.nodes[0];
        const Vec3      path = X_next[k] - X[k] - time * dies[pair.die].velocity;
        const double    slip = path.norm() / size(X[k]);
        if (slip > largest.of_edge)
          largest = {slip,
                     "die " + model_.dies[pair.die].name + " by more than Press/largest slip" + at(X[k])};
      }
    return largest;
  }

  double IncrementLimits::shortest() const
  {
    return model_.step.contact.step * std::ldexp(1., -static_cast<int>(press_.max_cuts));
  }

  bool IncrementLimits::too_short(const double step) const
  {
    return step < shortest() * (1. - 1e-9);
  }

  namespace
  {
    [[noreturn]] void throw_full(const double stroke)
    {
      throw NoRoom("Press/stroke",
                   "the cavity is full at " + as_text(stroke) + " mm",
                   "metal keeps its volume, and dies do not give way",
                   "shorten the stroke to less than that, make the billet smaller, or leave it a way out, as "
                   "a flash is");
    }
  } // namespace

  void IncrementLimits::check_held(const Process<double> &process,
                                   const ForgingState    &state,
                                   const IncrementRecord &record,
                                   const std::string     &what) const
  {
    const Scene             &scene   = state.epoch->scene;
    const Physics<double>    physics = process.at_stroke(record.stroke, state.operation);
    std::vector<std::string> touching;
    for (unsigned int d = 0; d < scene.dies.size(); ++d)
      if (touches(scene, state.workpiece.X, scene.dies[d], physics.dies[d].displacement))
        touching.push_back(scene.dies[d].name);
    const Vec3 &way     = process.leading_velocity(state.operation);
    const auto  planes  = symmetry_planes(scene.mesh);
    const auto &contact = model_.step.contact;
    const bool  is_held =
      touching.size() > 1 || std::any_of(planes.begin(), planes.end(), [&](const Plane &plane) {
        return std::abs(plane.normal * way) > 1e-6 * way.norm();
      });
    const auto motions = free_rigid_motions(scene, physics, state.workpiece.X, contact.near_in(contact.step));
    if (is_held && motions.empty())
    {
      if (model_.step.holds_loose)
        return;
      const RigidHold loose = hold_of_loose(scene,
                                            physics,
                                            scene.view(physics.dies, state.workpiece.X),
                                            record.pairs,
                                            record.contact.near_in(record.step));
      if (loose.empty())
        return;
      throw Error("Billet",
                  what + ", and its dies touch it there along lines or at points only: it is free to " +
                    join(held_motions(loose, state.workpiece.X)),
                  "contacts, their friction on faces, and symmetry planes must hold it in all directions",
                  "set Contact/loose billet = held, or cut it by symmetry planes");
    }
    throw Error(
      "Billet",
      what + ", and " +
        (touching.empty() ? "no die touches the billet there"
         : !is_held       ? "die " + touching[0] + " alone touches the billet there"
                          : "no die holds the billet there: it is free to " + join(motions)),
      "dies that touch it, their friction, and symmetry planes must hold it in all directions",
      "let it touch the dies on both sides where the run begins (Billet/translation, the dies' points), "
      "give them friction, or cut it by symmetry planes");
  }

  void IncrementLimits::stop(const Process<double> &process,
                             const ForgingState    &state,
                             const IncrementRecord &record,
                             const StepRejection   &rejection) const
  {
    std::ostringstream what;
    what.precision(5);
    what << "stops at stroke " << record.stroke << " mm, where even an increment of " << shortest()
         << " mm is too long: " << rejection.reason;
    if (rejection.is_full)
      throw_full(record.stroke);
    check_held(process, state, record, what.str());
    const char *remedy =
      record.stroke == 0. ? "nothing moved yet, so the stroke is not what is wrong: use values of the usual "
                            "size, penalty and friction above all, more increments, or a better mesh"
      : remesher_.enabled()
        ? "if the dies nearly close or the cavity is full there, shorten the stroke; else use more "
          "increments or a finer mesh"
        : "the mesh may be too distorted to go on: set Remeshing/when = quality";
    throw Error("Press/stroke",
                what.str(),
                "an increment may be halved " + std::to_string(press_.max_cuts) +
                  " times (Press/max cuts), and elements must stay sound",
                remedy);
  }

  void IncrementLimits::check_hold(const Process<double> &process,
                                   const ForgingState    &state,
                                   const IncrementRecord &record) const
  {
    constexpr double noticed = 1e-5; // of the force that keeps it from moving with the fastest die
    double           largest = 0., speed = 0.;
    for (const Vec3 &force : record.forces)
      largest = std::max(largest, force.norm());
    for (const auto &die : process.over(place(record)).dies)
      speed = std::max(speed, die.velocity.norm());
    // Dies that press nothing yet.
    if (record.hold.empty() || !(largest > noticed * record.hold.drag * speed))
      return;
    const double arm  = record.hold_load.moment.norm() / largest,
                 edge = surface_edge(state.epoch->scene, state.workpiece.X);
    const bool slides = record.hold_load.force.norm() > most_held * largest;
    if (!slides && !(arm > longest_arm * edge))
      return;
    std::ostringstream what;
    what.precision(3);
    what << "at stroke " << record.stroke
         << " mm its dies press it aside, and touch it where nothing holds it: it would "
         << join(held_motions(record.hold, state.workpiece.X));
    if (slides)
      what << "; to hold it takes " << 100. * record.hold_load.force.norm() / largest << " % of their force";
    else
      what << "; their forces pass each other at " << arm << " mm";
    throw Error("Billet",
                what.str(),
                "a billet that is touched along lines or at points is held against a tenth of the force, and "
                "where forces pass each other by less than an edge",
                "cut it by symmetry planes, turn it so that faces of it touch dies with friction, or use a "
                "finer mesh or longer increments, with which contacts are wider");
  }

  void IncrementLimits::check_progress(const ForgingState &state) const
  {
    const Scene &scene = state.epoch->scene;
    const double change =
      volume(scene.mesh, state.workpiece.X, scene.discretization.cells()) / state.volume - 1.;
    std::ostringstream what;
    what.precision(4);
    if (!(std::abs(change) <= press_.largest_loss))
    {
      what << "at stroke " << state.stroke << " mm the workpiece has " << (change < 0. ? "lost " : "won ")
           << 100. * std::abs(change) << " % of its volume";
      throw Error(
        "Press/stroke",
        what.str(),
        "at most Press/largest volume change may be lost",
        "if the dies nearly close there, shorten the stroke; else use more increments or a finer mesh");
    }
    if (const unsigned int n = state.increments - state.numerics_increments; n > press_.most_increments)
    {
      what << "was cut so often that " << n << " increments brought it to " << state.stroke << " mm";
      throw Error("Press/stroke",
                  what.str(),
                  press_.largest_strain
                    ? "where the program chooses them, a run may take " +
                        std::to_string(press_.most_increments)
                    : "a run may take " + std::to_string(press_.most_increments / press_.increments) +
                        " times Press/increments",
                  "if the dies nearly close or the cavity is full there, shorten the stroke; else raise " +
                    std::string(press_.largest_strain ? "Press/accuracy" : "Press/increments"));
    }
  }

  void IncrementLimits::check_fold(const ForgingState &state) const
  {
    const TetMesh              &mesh    = state.epoch->scene.mesh;
    const NodalVectors<double> &X       = state.workpiece.X;
    const double                allowed = remesher_.largest_repair() * state.volume;
    if (!remesher_.enabled() || state.removed_volume < allowed)
      check_boundary_does_not_cross(mesh, X, "Workpiece");
    else if (const auto crossings = self_crossings(mesh, X); !crossings.empty())
    {
      std::ostringstream what;
      what.precision(4);
      what << "the workpiece folds onto itself: at stroke " << state.stroke
           << " mm its surface crosses itself" << at(X[crossings[0].edge[0]]) << ", and "
           << state.removed_volume << " mm^3 have been taken away in such places";
      throw Error(
        "Remeshing/largest repair",
        what.str(),
        "metal that meets metal is not in the model; laps thinner than an element are taken away, " +
          as_text(allowed) + " mm^3 of them at most",
        "the part has a lap there: round the die's edge, or shorten the stroke to where it does not "
        "close yet; if a lap does not matter, raise the limit");
    }
  }
} // namespace retroforge
