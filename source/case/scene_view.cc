// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/fineness.h>
#include <retroforge/case/case_messages.h>
#include <retroforge/case/scene_checks.h>
#include <retroforge/case/scene_estimate.h>
#include <retroforge/case/scene_view.h>
#include <retroforge/core/exception_message.h>
#include <retroforge/core/remote_error.h>
#include <retroforge/core/version.h>
#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/objective/box.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/scene_pictures.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

namespace retroforge
{
  namespace
  {
    /// The parameters as understood, as far as they are: what is wrong with them is said by look().
    std::string echo_of(const CommandLine &command)
    {
      std::string echo;
      try
      {
        Parameters::read(command, echo);
      }
      catch (const Error &)
      {
      }
      return echo;
    }
  } // namespace

  SceneView::SceneView(const CommandLine &command, MPI_Comm comm) : command_(command), comm_(comm) {}

  int SceneView::run()
  {
    std::string refusal;
    if (dealii::Utilities::MPI::this_mpi_process(comm_) == 0)
    {
      make_results_folder(command_.output_directory, command_.overwrite, echo_of(command_));
      {
        const auto total = timings_.scope("total");
        look();
        attempt([&]() { draw(); });
        if (!summary_.refusals.empty())
          summary_.estimate.reset(); // of a forging that cannot be
      }
      summary_.seconds = timings_.seconds("total");
      write_file(command_.output_directory + "/scene.json", summary_.to_json());
      std::cout << summary_.listing() << "  looked at in " << as_text(summary_.seconds) << " s";
      if (summary_.billet || !summary_.dies.empty())
        std::cout << "; contrib/report " << command_.output_directory << " draws it";
      std::cout << std::endl;
      if (!summary_.refusals.empty())
        refusal = summary_.refusals.front();
    }
    refusal = dealii::Utilities::MPI::broadcast(comm_, refusal);
    if (!refusal.empty())
      throw remote_error(refusal);
    return 0;
  }

  bool SceneView::attempt(const std::function<void()> &make)
  {
    try
    {
      make();
      return true;
    }
    catch (...)
    {
      auto             &refusals = summary_.refusals;
      const std::string message  = message_of(std::current_exception());
      if (std::find(refusals.begin(), refusals.end(), message) == refusals.end())
        refusals.push_back(message);
      return false;
    }
  }

  bool SceneView::chooses_increments() const
  {
    std::string echo;
    return Parameters::read(command_, echo).press.increments == 0;
  }

  void SceneView::look()
  {
    summary_.case_file = command_.case_file;
    summary_.version   = version;
    summary_.commit    = commit;
    std::unique_ptr<const Case> made;
    if (attempt([&]() { made = std::make_unique<const Case>(command_, timings_, MPI_COMM_SELF); }))
      make_all(*made);
    else
      make_some();
    if (!parts_)
      return;
    const PressParameters &press = parts_->parameters.press;
    // Given ones are of many lengths.
    const unsigned int increments = press.steps.empty() ? press.increments : 0;
    summary_.press = {parts_->leading_die, press.stroke, parts_->seconds, increments, chooses_increments()};
    const MaterialLaw<double> metal = parts_->process.material.initial_law();
    summary_.metal                  = {metal.K, metal.m};
    describe_dies();
    if (!parts_->mesh)
      return;
    describe_billet();
    attempt([&]() {
      const Scene scene(*parts_->mesh, parts_->parameters.discretization.choice, parts_->dies, MPI_COMM_SELF);
      describe_approaches(scene);
      if (made)
        estimate(scene);
      if (made)
        warn(check_scene(parts_->parameters, scene, parts_->process, parts_->X));
    });
    attempt([&]() { describe_sizes(); });
  }

  void SceneView::make_all(const Case &made)
  {
    parts_ = {made.parameters, made.billet, made.X_0, made.model.dies, made.process, {}, {}, 0.};
    lead(*parts_);
    for (const std::string &note : notes_on(made))
      summary_.warnings.push_back("note: " + note);
  }

  void SceneView::lead(Parts &parts)
  {
    const unsigned int die = parts.process.operations.front().leading_die;
    parts.leading_die      = parts.parameters.dies[die].name;
    parts.seconds          = parts.process.time(parts.parameters.press.stroke);
    parts.path             = parts.seconds * parts.process.dies[die].velocity;
  }

  void SceneView::make_some()
  {
    Parts       parts;
    std::string echo;
    if (!attempt([&]() { parts.parameters = Parameters::read(command_, echo); }))
      return;
    Parameters &parameters = parts.parameters;
    attempt([&]() { parts.mesh = make_billet(parameters.billet, MPI_COMM_SELF); });
    BilletSize size = {1., 1., 1.}; // where it is unknown: what follows from it is not shown
    if (parts.mesh)
    {
      parts.X = parts.mesh->X;
      size    = parameters.size_of(*parts.mesh);
      attempt([&]() { parameters.resolve_defaults(size); });
    }
    // Laws and motions are found by name here.
    if (!attempt([&]() {
          parts.process = parameters.process(size);
          lead(parts);
        }))
      return;
    const auto                asked  = std::exchange(parameters.dies, {});
    const auto                states = std::exchange(parts.process.dies, {});
    std::vector<unsigned int> made(asked.size(), invalid_index); // their numbers among those that can be made
    for (unsigned int d = 0; d < asked.size(); ++d)
      attempt([&]() {
        parts.dies.push_back(asked[d].die());
        parameters.dies.push_back(asked[d]);
        parts.process.dies.push_back(states[d]);
        made[d] = parts.dies.size() - 1;
      });
    for (Operation<double> &operation : parts.process.operations)
      for (const unsigned int d : std::exchange(operation.dies, {}))
        if (made[d] != invalid_index)
          operation.dies.push_back(made[d]);
    parts_ = std::move(parts);
  }

  void SceneView::warn(const std::vector<std::string> &warnings)
  {
    for (const std::string &warning : warnings)
      summary_.warnings.push_back("warning: " + warning);
  }

  void SceneView::estimate(const Scene &scene)
  {
    const SceneEstimate made = estimate_scene(parts_->parameters, scene, parts_->process, parts_->X);
    warn(made.warnings);
    summary_.estimate = {
      "slab method", made.speed, made.strain_rate, made.flow_stress, made.first_force, made.final_force};
  }

  namespace
  {
    double
    volume_by_measures(const Parameters &parameters, const NodalVectors<double> &X, const TetMesh &mesh)
    {
      const BilletParameters &billet = parameters.billet;
      const bool              nominal =
        parameters.design.meshed_at.empty() && std::equal(X.begin(), X.end(), mesh.X.begin());
      return billet.is_from_file() || !nominal ? SceneSummary::unknown
                                               : whole_volume(billet) / n_copies(billet.symmetry_cuts());
    }

    /// @param is_meant  of a face, whether it counts
    double area_of(const TetMesh                                   &mesh,
                   const NodalVectors<double>                      &X,
                   const std::function<bool(const BoundaryFace &)> &is_meant)
    {
      double area = 0.;
      for (const BoundaryFace &face : mesh.faces)
        if (is_meant(face))
          area += 0.5 * facet_vector(X[face.nodes[0]], X[face.nodes[1]], X[face.nodes[2]]).norm();
      return area;
    }

    /// Of the faces whose corners all lie as near to a die as what touches.
    double
    contact_area(const Scene &scene, const Die &die, const Vec3 &displacement, const NodalVectors<double> &X)
    {
      const double touching = touching_distance(scene.mesh, X);
      return area_of(scene.mesh, X, [&](const BoundaryFace &face) {
        return !scene.mesh.patches[face.patch].symmetry &&
               std::all_of(face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) {
                 return die.signed_distance(X[k], displacement) <= touching;
               });
      });
    }

    /// A die that covers less of the billet is a thin tool, or stands where it is not meant.
    constexpr double least_covered = 0.05;

    /// Planes on whose inner side all vertices of a die stand.
    std::vector<std::string>
    planes_beside(const TetMesh &mesh, const TriangleSurface &surface, const Vec3 &displacement)
    {
      std::vector<std::string> names;
      for (const Patch &patch : mesh.patches)
        if (const auto &plane = patch.symmetry;
            plane && std::all_of(surface.vertices().begin(), surface.vertices().end(), [&](const Vec3 &x) {
              return (x + displacement - plane->point) * plane->normal < -surface.rounding();
            }))
          names.push_back(patch.name);
      return names;
    }

    SceneSummary::Corners corners_of(NodalVectors<double> X, const Vec3 &displacement)
    {
      for (Vec3 &x : X)
        x += displacement;
      return bounding_box(X);
    }
  } // namespace

  void SceneView::describe_billet()
  {
    const TetMesh              &mesh = *parts_->mesh;
    const NodalVectors<double> &X    = parts_->X;
    const Topology              topology(mesh);
    SceneSummary::Billet        billet;
    billet.shape          = parts_->parameters.billet.shape_word();
    billet.extents        = bounding_box(X);
    billet.n_nodes        = mesh.n_nodes();
    billet.n_cells        = mesh.n_cells();
    billet.element_size   = parts_->parameters.edge_length(mesh);
    billet.shortest_edge  = std::numeric_limits<double>::max();
    billet.longest_edge   = 0.;
    billet.smallest_angle = minimum_dihedral_angle(mesh.cells, X);
    for (const auto &[a, b] : topology.surface_edges)
    {
      const double length  = (X[a] - X[b]).norm();
      billet.shortest_edge = std::min(billet.shortest_edge, length);
      billet.longest_edge  = std::max(billet.longest_edge, length);
    }
    billet.volume          = volume(mesh.cells, X);
    billet.volume_of_shape = volume_by_measures(parts_->parameters, X, mesh);
    billet.whole           = whole_part(mesh, parts_->path);
    for (unsigned int p = 0; p < mesh.patches.size(); ++p)
      if (const Patch &patch = mesh.patches[p]; patch.symmetry)
        billet.symmetry_planes.push_back({patch.name, patch.symmetry->point, patch.symmetry->normal});
      else
        billet.patches.emplace_back(
          patch.name, area_of(mesh, X, [p](const BoundaryFace &face) { return face.patch == p; }));
    summary_.billet = std::move(billet);
  }

  void SceneView::describe_dies()
  {
    for (unsigned int d = 0; d < parts_->dies.size(); ++d)
    {
      const DieParameters    &given = parts_->parameters.dies[d];
      const DieState<double> &state = parts_->process.dies[d];
      const Die              &die   = parts_->dies[d];
      SceneSummary::Die       described;
      described.name          = die.name;
      described.shape         = given.shape.name;
      described.n_facets      = die.n_facets();
      described.point         = given.point + state.displacement;
      described.facing        = given.facing;
      described.velocity      = state.velocity;
      described.travel        = parts_->seconds * state.velocity;
      described.friction      = given.friction;
      described.friction_name = interface_law(state.interface_law).coefficient().name;
      if (state.interface_law != 0)
        described.friction_law = given.friction_law;
      if (interface_law(state.interface_law).limit())
        described.shear_limit = given.shear_limit;
      for (const DieZoneParameters &zone : given.zones)
      {
        const InterfaceLaw &law = interface_law(find_interface_law(zone.friction_law, zone.section()));
        described.zones.push_back({zone.name,
                                   zone.friction_law,
                                   law.coefficient().name,
                                   zone.friction,
                                   law.limit() ? std::optional(zone.shear_limit) : std::nullopt});
      }
      described.leads = die.name == parts_->leading_die;
      if (die.surface())
      {
        described.extents = corners_of(die.surface()->vertices(), state.displacement);
        if (parts_->mesh)
          described.mirrored_by = planes_beside(*parts_->mesh, *die.surface(), state.displacement);
      }
      summary_.dies.push_back(std::move(described));
    }
  }

  void SceneView::describe_approaches(const Scene &scene)
  {
    const double       touching   = touching_distance(scene.mesh, parts_->X);
    const double       seconds    = parts_->seconds;
    const auto         approaches = find_approaches(parts_->parameters, scene, parts_->process, parts_->X);
    const MetalSurface metal      = metal_surface(scene.mesh, parts_->X);
    for (unsigned int d = 0; d < approaches.size(); ++d)
    {
      const DieApproach &approach  = approaches[d];
      SceneSummary::Die &described = summary_.dies[d];
      described.gap                = {approach.gap, approach.gap_place};
      described.moves_away         = approach.moves_away;
      if (approach.overlap.depth > touching)
      {
        described.overlap   = {approach.overlap.depth, approach.overlap.place};
        described.is_of_die = approach.overlap.is_of_die;
        described.frees     = approach.freeing;
      }
      described.touches = !described.overlap && approach.gap <= touching;
      if (described.touches)
        described.contact_area =
          contact_area(scene, parts_->dies[d], parts_->process.dies[d].displacement, parts_->X);
      const double speed = described.velocity.norm();
      const Vec3   way   = speed > 0. ? described.velocity : -parts_->path; // metal is pressed against it
      if (scene.dies[d].surface() && way.norm() > 0.)
        described.covered = covered_part(scene.dies[d], parts_->process.dies[d].displacement, way, metal);
      if (described.covered > 0. && described.covered < least_covered)
        warn({"Die " + described.name + "/point: the die covers " +
              as_text(std::round(1000. * described.covered) / 10.) +
              " % of the billet's side that faces it: is it where it should be, and of the right size?"});
      if (!described.overlap && approach.meeting && approach.meeting->travel <= speed * seconds + touching)
      {
        described.first_touch     = {approach.meeting->travel, approach.meeting->place};
        described.stroke_at_touch = approach.meeting->travel / speed / seconds * summary_.press->stroke;
      }
    }
  }

  void SceneView::describe_sizes()
  {
    const Parameters       &parameters = parts_->parameters;
    const std::vector<Die> &dies       = parts_->dies;
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (const TriangleSurface *surface = dies[d].surface())
      {
        const std::vector<Die> alone = {dies[d]};
        const Remesher         remesher(parameters.remeshing,
                                parameters.edge_length(*parts_->mesh),
                                alone,
                                parts_->mesh->patches,
                                MPI_COMM_SELF);
        const SizeField        size     = remesher.size_field({DieState<double>()});
        double                 smallest = std::numeric_limits<double>::max();
        for (const Vec3 &x : surface->vertices())
          smallest = std::min(smallest, size(x));
        summary_.dies[d].smallest_size = smallest;
      }
  }

  NodalVectors<double> SceneView::drawn_around() const
  {
    if (parts_->mesh)
      return parts_->X;
    // Without a mesh: where billet and dies are meant to be, and as much to all sides.
    NodalVectors<double>    points;
    const BilletParameters &billet = parts_->parameters.billet;
    const Vec3              base   = billet.base_centre + billet.translation;
    for (const double z : {0., billet.whole_height()})
      points.push_back(base + Vec3({0., 0., z}));
    for (const Die &die : parts_->dies)
      if (const TriangleSurface *surface = die.surface())
        points.insert(points.end(), surface->vertices().begin(), surface->vertices().end());
    for (const DieParameters &die : parts_->parameters.dies)
      points.push_back(die.point);
    const auto [low, high] = bounding_box(points);
    const double beside =
      0.5 * std::max(billet.whole_width(), (high - low).norm() > 0. ? (high - low).norm() : 1.);
    for (unsigned int i = 0; i < 3; ++i)
      for (const double side : {-beside, beside})
      {
        points.push_back(0.5 * (low + high));
        points.back()[i] += side;
      }
    return points;
  }

  void SceneView::draw() const
  {
    if (!parts_)
      return;
    const NodalVectors<double>           around = drawn_around();
    const std::vector<DieState<double>> &states = parts_->process.dies;
    ScenePictures                        pictures(command_.output_directory);
    if (parts_->mesh)
      pictures.add_billet(*parts_->mesh, parts_->X, parts_->dies, states);
    for (unsigned int d = 0; d < parts_->dies.size(); ++d)
      pictures.add_die(parts_->dies[d], states[d].displacement, around);
    pictures.write_list();
  }
} // namespace retroforge
