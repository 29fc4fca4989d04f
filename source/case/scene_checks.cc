// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/scene_checks.h>
#include <retroforge/case/scene_doubts.h>
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/objective/box.h>
#include <retroforge/solver/rigid_modes.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

namespace retroforge
{
  namespace
  {
    /// Extents of a die over that of the billet: a punch may be small and a bed large, but not by what metres
    /// differ from millimetres.
    constexpr double smallest_die = 1e-2, largest_die = 1e3;

    /// What lies nearer than the first part of the billet's size touches; what is deeper in a die than the
    /// second is refused.
    constexpr double touching = 1e-3, inside = 0.05;

    std::string as_components(const Vec3 &x)
    {
      const auto text = [&x](const unsigned int i) {
        return as_text(std::abs(x[i]) > 1e-9 * x.norm() ? x[i] : 0.); // the rest is rounding
      };
      return text(0) + ", " + text(1) + ", " + text(2);
    }

    /// Of a scene in which a file may be in another unit; else nothing.
    std::string how_to_scale(const Parameters &parameters, const DieParameters &die)
    {
      const bool of_file = die.shape.name == "stl";
      return parameters.billet.is_from_file()
               ? std::string("; set `scale' of the billet") + (of_file ? " or of the die" : "") +
                   ": a mesh in metres needs 1000 where lengths are in mm"
             : of_file ? "; set the die's `scale', or correct the billet's measures"
                       : "";
    }

    std::string how_to_stand_outside(const Parameters    &parameters,
                                     const DieParameters &die,
                                     const DieApproach   &approach,
                                     const bool           is_behind)
    {
      // Rounding must not leave a part of the way.
      const Vec3        move   = (1. + 1e-5) * approach.freeing;
      const std::string remedy = "move the die by " + in_brackets(move) + " mm, to Die " + die.name +
                                 "/point = " + as_components(die.point + move) +
                                 ", or the billet as far the other way";
      const std::string turn   = die.shape.name == "stl"
                                   ? "turn the facets of its file round, whose normals point to the workpiece"
                                   : "turn the die's facing round: it points from the die to the billet";
      const bool        is_way = approach.freeing.norm() > 0.;
      if (is_behind)
        return turn + (is_way ? ", or, if it is meant to stand on the other side, " + remedy : "");
      if (!is_way)
        return "move the die out of the billet" + how_to_scale(parameters, die);
      if (!parameters.design.at.empty() && !die.follows_billet)
        return "set Die " + die.name +
               "/follows billet = true where a billet that grows lifts the die and ends at the same gap, or "
               "stay closer to the nominal design, or " +
               remedy;
      return remedy + how_to_scale(parameters, die);
    }

    double extent(const NodalVectors<double> &X)
    {
      const auto [low, high] = bounding_box(X);
      return (high - low).norm();
    }

    void check_sizes(const Parameters &parameters, const Scene &scene, const NodalVectors<double> &X)
    {
      for (unsigned int d = 0; d < scene.dies.size(); ++d)
        if (const TriangleSurface *surface = scene.dies[d].surface())
          if (const double ratio = surface->diagonal() / extent(X);
              !(ratio >= smallest_die && ratio <= largest_die))
            throw Error("Die " + scene.dies[d].name,
                        "its extent is " + as_text(surface->diagonal()) + " mm, that of the billet " +
                          as_text(extent(X)) + " mm",
                        "a die is a hundredth of the billet at least, and a thousand times as large at most",
                        "correct the measures" + how_to_scale(parameters, parameters.dies[d]));
    }

    void check_depths(const Parameters &parameters, const Scene &scene)
    {
      const double least = 0.1 * parameters.edge_length(scene.mesh);
      for (unsigned int d = 0; d < scene.dies.size(); ++d)
        if (const auto depth = parameters.dies[d].shape->depth_of_contact();
            scene.dies[d].surface() && depth && *depth < least)
          throw Error(
            "Die " + parameters.dies[d].name + "/depth of contact",
            "is " + as_text(*depth) + " mm",
            "nodes deeper are lost to the die, so it must be a tenth of the element size at least, " +
              as_text(least) + " mm",
            "leave it out, which takes a tenth of the die's extent");
    }

    /// The deepest node in a die [mm]: what contact sees of an overlap, and pushes out.
    double deepest_node(const TetMesh              &billet,
                        const Die                  &die,
                        const Vec3                 &displacement,
                        const NodalVectors<double> &X)
    {
      double deepest = 0.;
      for (const BoundaryFace &face : billet.faces)
        if (billet.is_surface(face))
          for (const NodeIndex k : face.nodes)
            deepest = std::max(deepest, -die.signed_distance(X[k], displacement));
      return deepest;
    }

    /// Whether all of the billet is on the side of the die where none should be.
    bool
    is_behind(const Scene &scene, const Die &die, const Vec3 &displacement, const NodalVectors<double> &X)
    {
      for (NodeIndex k = 0; k < X.size(); ++k)
        if (scene.topology.is_on_surface(k) && die.facet_distance(X[k], displacement) > 0.)
          return false;
      return true;
    }

    /// Up to deepest_pushed_out() what is in a die is no error: that is how a neighbour of a sound design, or a die drawn
    /// anew, begins.
    void check_outside(const Parameters               &parameters,
                       const Scene                    &scene,
                       const Process<double>          &process,
                       const NodalVectors<double>     &X,
                       const std::vector<DieApproach> &approaches,
                       std::vector<std::string>       &warnings)
    {
      const double near = touching_distance(scene.mesh, X), most = deepest_start(scene.mesh, X);
      for (unsigned int d = 0; d < scene.dies.size(); ++d)
      {
        const Overlap &overlap = approaches[d].overlap;
        if (!(overlap.depth > near))
          continue;
        const Vec3       &displacement = process.dies[d].displacement;
        const std::string name         = "Die " + scene.dies[d].name;
        if (overlap.depth > deepest_pushed_out(scene.mesh, X, scene.dies[d], displacement, overlap))
          throw Error(name,
                      standing_inside(overlap),
                      "a billet starts outside of all dies, or in one by 5 % of its size, " + as_text(most) +
                        " mm, where its nodes are",
                      how_to_stand_outside(parameters,
                                           parameters.dies[d],
                                           approaches[d],
                                           is_behind(scene, scene.dies[d], displacement, X)));
        warnings.push_back(name + ": " + standing_inside(overlap) +
                           ": the first increment pushes it out; it is free when the die is moved by " +
                           in_brackets((1. + 1e-5) * approaches[d].freeing) + " mm");
      }
    }

    [[noreturn]] void throw_out_of_reach(const Parameters           &parameters,
                                         const Scene                &scene,
                                         const Process<double>      &process,
                                         const DieApproach          &approach,
                                         const NodalVectors<double> &X)
    {
      const unsigned int lead  = process.operations.front().leading_die;
      const std::string  where = "Die " + scene.dies[lead].name, size = as_text(extent(X)),
                        rule = "a die that moves must reach the billet within the stroke";
      if (approach.moves_away)
        throw Error(where,
                    "moves away from the billet: it starts " + as_text(approach.gap) + " mm from it, at " +
                      in_brackets(approach.gap_place),
                    rule,
                    "turn its velocity round");
      if (!approach.meeting && approach.gap <= touching_distance(scene.mesh, X))
        throw Error(where + "/velocity",
                    in_brackets(process.dies[lead].velocity) +
                      " mm/s moves the die along the billet, which it touches at " +
                      in_brackets(approach.gap_place) + " and does not press",
                    "a die that moves must press the billet",
                    "let the velocity point into the billet");
      if (!approach.meeting)
        throw Error(where,
                    "does not reach the billet, whose extent is " + size + " mm: it starts " +
                      as_text(approach.gap) + " mm away, nearest to " + in_brackets(approach.gap_place) +
                      ", and passes by",
                    rule,
                    "move the die's point or the billet, or correct its velocity" +
                      how_to_scale(parameters, parameters.dies[lead]));
      throw Error(where,
                  "does not reach the billet, whose extent is " + size + " mm: it starts " +
                    as_text(approach.gap) + " mm away and meets it after " +
                    as_text(approach.meeting->travel) + " mm, at " + in_brackets(approach.meeting->place) +
                    ", and the stroke is " + as_text(parameters.press.stroke) + " mm",
                  rule,
                  "lengthen Press/stroke, move the die's point or the billet" +
                    how_to_scale(parameters, parameters.dies[lead]));
    }

    /// Signed distance of each surface node from a die.
    std::vector<double>
    distances(const Scene &scene, const Die &die, const Vec3 &displacement, const NodalVectors<double> &X)
    {
      std::vector<double> delta;
      for (NodeIndex k = 0; k < X.size(); ++k)
        if (scene.topology.is_on_surface(k))
          delta.push_back(die.signed_distance(X[k], displacement));
      return delta;
    }

    /// Whether a die touches the billet, where it stands, from some point of its path on, and does not move
    /// away from it there.
    /// @param path        of the die, beside the billet's
    /// @param must_close  whether moving along it is not enough
    bool comes_against(const Scene                &scene,
                       const unsigned int          d,
                       const Process<double>      &process,
                       const Vec3                 &path,
                       const bool                  must_close,
                       const NodalVectors<double> &X)
    {
      const double       near    = touching_distance(scene.mesh, X);
      const double       least   = (must_close ? -1e-6 : 1e-9) * near;
      const double       wanted  = scene.dies[d].surface() ? std::ceil(path.norm() / (50. * near)) : 1.;
      const unsigned int n_steps = std::clamp(wanted, 1., 200.);
      const auto         start   = distances(scene, scene.dies[d], process.dies[d].displacement, X);
      for (unsigned int i = 1; i <= n_steps; ++i)
      {
        const auto delta = distances(
          scene, scene.dies[d], process.dies[d].displacement + path * (static_cast<double>(i) / n_steps), X);
        for (std::size_t k = 0; k < delta.size(); ++k)
          if (delta[k] <= near && delta[k] <= start[k] + least)
            return true;
      }
      return false;
    }

    /// A billet that nothing holds against the die that comes first would fly along with it, at no force.
    void check_held(const Parameters           &parameters,
                    const Scene                &scene,
                    const Process<double>      &process,
                    const unsigned int          first,
                    const NodalVectors<double> &X)
    {
      const Vec3 &velocity = process.dies[first].velocity;
      for (const Plane &plane : symmetry_planes(scene.mesh))
        if (std::abs(velocity * plane.normal) > 1e-6 * velocity.norm())
          return;
      for (const unsigned int d : process.operations.front().dies)
        if (const Vec3 beside = process.dies[d].velocity - velocity; beside.norm() > 0.)
          if (comes_against(scene,
                            d,
                            process,
                            beside * process.nominal_time(parameters.press.stroke),
                            !process.dies[d].rubs(),
                            X))
            return;
      std::ostringstream way;
      way << velocity[0] << ", " << velocity[1] << ", " << velocity[2];
      throw Error("Billet",
                  "nothing holds it against die " + scene.dies[first].name + ", which pushes it along (" +
                    way.str() + ")" +
                    (scene.dies.size() > 1 ? ": no other die stands in its way within the stroke" : ""),
                  "a billet is forged between dies, or a die and a symmetry plane across its way",
                  "add the die that is missing to Dies/names, or move it into the way (point, facing)" +
                    parameters.unlisted_dies());
    }

    /// The first die to touch the billet is one that moves.
    void check_reach(const Parameters               &parameters,
                     const Scene                    &scene,
                     const Process<double>          &process,
                     const NodalVectors<double>     &X,
                     const std::vector<DieApproach> &approaches)
    {
      const double near = touching_distance(scene.mesh, X);
      for (unsigned int d = 0; d < scene.dies.size(); ++d)
        if (approaches[d].meeting &&
            approaches[d].meeting->travel <= path(parameters, process, d).norm() + near)
        {
          check_held(parameters, scene, process, d, X);
          return;
        }
      throw_out_of_reach(parameters, scene, process, approaches[process.operations.front().leading_die], X);
    }

    /// A plane that the workpiece cannot cross, at the end of the stroke.
    struct Wall
    {
      std::string name;
      Vec3        point, facing;
    };

    std::vector<Wall> walls(const Parameters &parameters, const Scene &scene, const Process<double> &process)
    {
      std::vector<Wall> walls;
      const auto        dies = process.at_stroke(parameters.press.stroke).dies;
      for (const unsigned int d : process.operations.front().dies)
        if (!scene.dies[d].surface())
          walls.push_back({"die " + scene.dies[d].name,
                           parameters.dies[d].point + dies[d].displacement,
                           parameters.dies[d].facing});
      for (const Patch &patch : scene.mesh.patches)
        if (patch.symmetry)
          walls.push_back(
            {"the symmetry plane " + patch.name, patch.symmetry->point, -patch.symmetry->normal});
      return walls;
    }

    [[noreturn]] void throw_too_long(const double       stroke,
                                     const std::string &name,
                                     const double       beyond,
                                     const std::string &other)
    {
      throw Error("Press/stroke",
                  "is " + as_text(stroke) + " mm, after which " + name + " is " + as_text(beyond) +
                    " mm beyond " + other,
                  "the workpiece stays between the dies, and needs room there",
                  "shorten the stroke to less than " + as_text(stroke - beyond) +
                    " mm, or move the dies' points");
    }

    void check_planes(const Parameters &parameters, const Scene &scene, const Process<double> &process)
    {
      const auto planes = walls(parameters, scene, process);
      for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          if ((planes[i].facing + planes[j].facing).norm() < 1e-6)
            if (const double gap = (planes[i].point - planes[j].point) * planes[j].facing; !(gap > 0.))
              throw_too_long(parameters.press.stroke, planes[i].name, -gap, planes[j].name);
    }

    /// A box around the billet that is open along a direction.
    std::function<bool(const Vec3 &)> beside(const NodalVectors<double> &X, const Vec3 &direction)
    {
      const Vec3 n      = direction / direction.norm();
      const Vec3 first  = cross_product_3d(n, std::abs(n[0]) < 0.5 ? Vec3({1., 0., 0.}) : Vec3({0., 1., 0.}));
      const Vec3 second = cross_product_3d(n, first);
      const auto place  = [=](const Vec3 &x) { return Vec3({first * x, second * x, 0.}); };
      NodalVectors<double> flat;
      for (const Vec3 &x : X)
        flat.push_back(place(x));
      return [place, box = bounding_box(flat)](const Vec3 &x) { return is_inside(box, place(x)); };
    }

    /// The part of a curved die that faces the billet must not end inside of another die. (What is beside the
    /// billet, as a guide of the dies, may; and what is inside from the start, as a mandrel in its hole or
    /// the wall of a die that slides along an ejector.)
    void check_surfaces(const Parameters           &parameters,
                        const Scene                &scene,
                        const Process<double>      &process,
                        const NodalVectors<double> &X)
    {
      const auto   faces_billet = beside(X, process.leading_velocity());
      const auto   first = process.at_stroke(0.).dies, dies = process.at_stroke(parameters.press.stroke).dies;
      const double allowed = touching_distance(scene.mesh, X);
      for (const unsigned int a : process.operations.front().dies)
        for (const unsigned int b : process.operations.front().dies)
          if (const TriangleSurface *surface = scene.dies[a].surface();
              a != b && surface && (dies[a].velocity - dies[b].velocity).norm() > 0.)
          {
            double nearest = allowed;
            for (const Vec3 &x : surface->vertices())
              if (faces_billet(x + dies[a].displacement) &&
                  scene.dies[b].signed_distance(x + first[a].displacement, first[b].displacement) > -allowed)
                nearest = std::min(
                  nearest, scene.dies[b].signed_distance(x + dies[a].displacement, dies[b].displacement));
            if (nearest < -allowed)
              throw_too_long(parameters.press.stroke,
                             "a part of die " + scene.dies[a].name,
                             -nearest,
                             "die " + scene.dies[b].name);
          }
    }
  } // namespace

  namespace
  {
    /// Cube root of the whole part's volume, whatever symmetry leaves of it.
    double size_of_whole(const TetMesh &billet, const NodalVectors<double> &X)
    {
      const double copies = n_copies(symmetry_planes(billet));
      return std::cbrt((std::isfinite(copies) ? copies : 1.) * volume(billet.cells, X));
    }
  } // namespace

  double touching_distance(const TetMesh &billet, const NodalVectors<double> &X)
  {
    return touching * size_of_whole(billet, X);
  }

  double deepest_start(const TetMesh &billet, const NodalVectors<double> &X)
  {
    return inside * size_of_whole(billet, X);
  }

  double deepest_pushed_out(const TetMesh              &billet,
                            const NodalVectors<double> &X,
                            const Die                  &die,
                            const Vec3                 &displacement,
                            const Overlap              &overlap)
  {
    const double most = deepest_start(billet, X);
    return overlap.is_of_die ? std::min(most, 2. * deepest_node(billet, die, displacement, X)) : most;
  }

  std::string standing_inside(const Overlap &overlap)
  {
    return (overlap.is_of_die ? "a part of it stands " + as_text(overlap.depth) + " mm inside the billet"
                              : "the billet stands " + as_text(overlap.depth) + " mm inside it") +
           ", deepest at " + in_brackets(overlap.place);
  }

  Vec3 path(const Parameters &parameters, const Process<double> &process, const unsigned int d)
  {
    return process.dies[d].velocity * process.nominal_time(parameters.press.stroke);
  }

  std::string in_brackets(const Vec3 &x)
  {
    return "(" + as_components(x) + ")";
  }

  std::vector<DieApproach> find_approaches(const Parameters           &parameters,
                                           const Scene                &scene,
                                           const Process<double>      &process,
                                           const NodalVectors<double> &X)
  {
    const double             near  = touching_distance(scene.mesh, X);
    const MetalSurface       metal = billet_surface(parameters.billet, scene.mesh, X, 0.2 * near);
    std::vector<DieApproach> approaches(scene.dies.size());
    for (const unsigned int d : process.operations.front().dies)
    {
      AssertIndexRange(d, approaches.size());
      approaches[d] = find_approach(scene.dies[d],
                                    process.dies[d].displacement,
                                    process.dies[d].velocity,
                                    parameters.dies[d].facing,
                                    metal,
                                    near);
    }
    return approaches;
  }

  std::vector<std::string> check_scene(const Parameters           &parameters,
                                       const Scene                &scene,
                                       const Process<double>      &process,
                                       const NodalVectors<double> &X)
  {
    std::vector<std::string> warnings;
    check_waiting(process);
    check_sizes(parameters, scene, X);
    check_depths(parameters, scene);
    const std::vector<DieApproach> approaches = find_approaches(parameters, scene, process, X);
    check_outside(parameters, scene, process, X, approaches, warnings);
    check_reach(parameters, scene, process, X, approaches);
    add_doubts(parameters, scene, process, X, approaches, warnings);
    check_planes(parameters, scene, process);
    check_surfaces(parameters, scene, process, X);
    if (const auto motions = free_rigid_motions(scene, process.at_stroke(0.), X); !motions.empty())
    {
      const bool rubs =
        std::all_of(process.dies.begin(), process.dies.end(), [](const auto &die) { return die.rubs(); });
      throw Error(
        "Billet",
        "no die holds it: it is free to " + join(motions),
        "its velocity must be unique",
        rubs ? "its dies have friction, but touch it where that does not resist: cut the billet by symmetry "
               "planes, or add a die that holds it"
             : "cut it by symmetry planes, or give a die some friction");
    }
    return warnings;
  }
} // namespace retroforge
