// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/scene_checks.h>
#include <retroforge/case/scene_doubts.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/geometry/facet_curvature.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/heat/thermal_surface.h>
#include <retroforge/solver/rigid_modes.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    /// Edges of a smooth surface that turn by more [degrees] are told as a chamfer that may be none, where
    /// the surface stands by more than this part of the element size in front of the facets.
    constexpr double least_chamfer_angle = 15., chamfer_bulge = 0.02;

    /// To two digits.
    double rounded_down(const double x)
    {
      const double digit = std::pow(10., std::floor(std::log10(x)) - 1.);
      return std::floor(x / digit) * digit;
    }

    /// A smooth surface stands in front of its facets; where the billet touches these, it is in that.
    void tell_bulges(const Scene                &scene,
                     const Process<double>      &process,
                     const NodalVectors<double> &X,
                     std::vector<std::string>   &warnings)
    {
      const double near = touching_distance(scene.mesh, X);
      for (const unsigned int d : process.operations.front().dies)
      {
        const Vec3 &displacement = process.dies[d].displacement;
        double      bulge        = 0.;
        Vec3        place;
        for (NodeIndex k = 0; k < X.size(); ++k)
          if (scene.topology.is_on_surface(k))
            if (const double depth = -scene.dies[d].signed_distance(X[k], displacement);
                depth > std::max(bulge, near) && scene.dies[d].facet_distance(X[k], displacement) > -near)
            {
              bulge = depth;
              place = X[k];
            }
        if (bulge > 0.)
          warnings.push_back(
            "Die " + scene.dies[d].name + ": the billet touches its facets, and is " + as_text(bulge) +
            " mm inside the smooth surface they stand for, at " + in_brackets(place) +
            ": the first increment pushes it out; if facets are meant, set surface = facets");
      }
    }

    /// The largest angle to its neighbours that a smooth surface turns by over a facet's edges [degrees].
    double turn(const TriangleSurface &surface, const unsigned int f, const double feature_angle)
    {
      const auto normal = [&](const unsigned int facet) {
        const Triangle &t = surface.triangles()[facet];
        const auto     &x = surface.vertices();
        return facet_vector(x[t[0]], x[t[1]], x[t[2]]);
      };
      double largest = 0.;
      for (unsigned int e = 0; e < 3; ++e)
        if (const unsigned int other = surface.neighbour(f, e).facet; other != invalid_index)
        {
          const double angle = angle_between(normal(f), normal(other)) * 180. / M_PI;
          if (angle <= feature_angle)
            largest = std::max(largest, angle);
        }
      return largest;
    }

    /// Facets that turn as those of a chamfer may, and are taken for a rounding that stands far in front of
    /// them.
    void tell_chamfers(const Parameters &parameters, const Scene &scene, std::vector<std::string> &warnings)
    {
      const double least = chamfer_bulge * parameters.edge_length(scene.mesh);
      for (const Die &die : scene.dies)
      {
        const TriangleSurface *surface = die.surface();
        double                 bulge   = least;
        Vec3                   place;
        for (unsigned int f = 0; surface && f < surface->n_facets(); ++f)
          if (turn(*surface, f, die.feature_angle()) > least_chamfer_angle)
          {
            const Triangle &t      = surface->triangles()[f];
            const auto     &x      = surface->vertices();
            const Vec3      centre = (x[t[0]] + x[t[1]] + x[t[2]]) / 3.;
            if (const double height = -die.signed_distance(centre, Vec3()); height > bulge)
            {
              bulge = height;
              place = centre;
            }
          }
        if (bulge > least)
          warnings.push_back(
            "Die " + die.name + ": its smooth surface stands " + as_text(bulge) +
            " mm in front of its facets at " + in_brackets(place) +
            "; if they are a chamfer or a tip and no coarse rounding, lower `feature angle', or "
            "set surface = facets");
      }
    }

    /// A die that ends a little before a plane of symmetry: nodes on the plane are beyond its rim, and not
    /// held.
    void tell_rims(const Parameters         &parameters,
                   const Scene              &scene,
                   const Process<double>    &process,
                   std::vector<std::string> &warnings)
    {
      const double most = 0.5 * parameters.edge_length(scene.mesh);
      for (const unsigned int d : process.operations.front().dies)
        for (const Patch &patch : scene.mesh.patches)
          if (const TriangleSurface *surface = scene.dies[d].surface(); surface && patch.symmetry)
          {
            double     shortest = most;
            Vec3       place;
            const auto before = [&](const Vec3 &x) {
              return (patch.symmetry->point - x - process.dies[d].displacement) * patch.symmetry->normal;
            };
            for (const TriangleSurface::Edge &edge : rim(*surface))
            {
              const Triangle &t = surface->triangles()[edge.facet];
              const Vec3     &a = surface->vertices()[t[edge.edge]],
                         &b     = surface->vertices()[t[(edge.edge + 1) % 3]];
              const double near = std::min(before(a), before(b)), far = std::max(before(a), before(b));
              // One that runs along the plane.
              if (near > surface->rounding() && far < shortest && far - near < 0.01 * (b - a).norm())
              {
                shortest = far;
                place    = a + process.dies[d].displacement;
              }
            }
            if (shortest < most)
              warnings.push_back(
                "Die " + scene.dies[d].name + " ends " + as_text(shortest) + " mm before the plane " +
                patch.name + ", at " + in_brackets(place) +
                ": nodes on the plane are beyond it, and it does not hold them; let it reach the "
                "plane or go beyond");
          }
    }

    /// Whether a remeshing before the first increment makes edges near dies as short as that.
    bool refines_to(const Parameters &parameters, const double width, const double edge)
    {
      const RemesherParameters &remeshing = parameters.remeshing;
      return remeshing.enabled() && remeshing.sizes != RemesherParameters::Sizes::uniform &&
             remeshing.smallest_size * edge <= width;
    }

    /// What of remeshing would do so.
    std::string how_to_refine(const Parameters &parameters, const double width, const double edge)
    {
      const RemesherParameters &remeshing = parameters.remeshing;
      std::string               text;
      if (remeshing.sizes == RemesherParameters::Sizes::uniform)
        return text;
      if (!remeshing.enabled())
        text += ", or Remeshing/when = quality";
      if (remeshing.smallest_size * edge > width)
        text += (text.empty() ? ", or " : " and ") + std::string("Remeshing/smallest size = ") +
                as_text(rounded_down(width / edge));
      return text;
    }

    /// Parts of dies that come into the metal between its nodes and the middles of its edges.
    void tell_unseen(const Parameters               &parameters,
                     const Scene                    &scene,
                     const Process<double>          &process,
                     const NodalVectors<double>     &X,
                     const std::vector<DieApproach> &approaches,
                     std::vector<std::string>       &warnings)
    {
      const MetalSurface metal = metal_surface(scene.mesh, X);
      const double       edge = parameters.edge_length(scene.mesh), near = touching_distance(scene.mesh, X);
      const Vec3        &lead = process.leading_velocity();
      for (const unsigned int d : process.operations.front().dies)
      {
        if (!scene.dies[d].surface())
          continue;
        // Metal is pressed against a die that stands.
        const bool   moves = process.dies[d].velocity.norm() > 0.;
        const Vec3   way   = moves ? process.dies[d].velocity : Vec3(-lead);
        const double most =
          path(parameters, process, moves ? d : process.operations.front().leading_die).norm();
        const auto met = moves ? approaches[d].meeting
                               : first_meeting(scene.dies[d], process.dies[d].displacement, way, metal, near);
        if (!met || !(met->travel < most))
          continue;
        const double travel = met->travel + std::min(most - met->travel, 0.5 * edge);
        if (const auto unseen =
              find_unseen(scene.dies[d], process.dies[d].displacement + travel / way.norm() * way, metal);
            unseen && unseen->width > 0. && !refines_to(parameters, unseen->width, edge))
          warnings.push_back("Die " + scene.dies[d].name + " is " + as_text(unseen->width) +
                             " mm wide where it comes into the billet at " + in_brackets(unseen->place) +
                             ", between nodes: contact does not see it; set " +
                             (parameters.billet.is_from_file() ? "Remeshing" : "Billet") +
                             "/element size = " + as_text(rounded_down(unseen->width)) +
                             how_to_refine(parameters, unseen->width, edge));
      }
    }

    /// Metal that gives heat to dies from so far off that one would see it: a gap is for what meshes leave between surfaces
    /// that touch. A die to rest on that is farther off. Times that skins (heat/skin.h) do not remember.
    void tell_heat(const Parameters           &parameters,
                   const Scene                &scene,
                   const Process<double>      &process,
                   const NodalVectors<double> &X,
                   std::vector<std::string>   &warnings)
    {
      constexpr double      most = 0.2, remembered = 200.; // of the edges' length; s
      const HeatLaw<double> heat = parameters.heat.law();
      const double          edge = parameters.edge_length(scene.mesh);
      if (!heat.conducts())
        return;
      const auto  &operation = process.operations.front();
      const double time      = process.time_on_dies(operation.stroke, 0);
      if (time > remembered)
        warnings.push_back(
          "the metal is on dies for " + as_text(time) +
          " s: dies are thick half spaces, which remember what went through their surface for "
          "some 200 s; after 300 s it comes out 2 % of the difference too near to what they "
          "were, after 500 s 7 %, after 1000 s 14 %");
      if (operation.waiting.dwell > 0.)
      {
        std::vector<bool> touch(scene.dies.size(), false);
        touch[operation.waiting.resting_die] = true;
        const auto dies                      = process.over({0., 0., 0}).dies;
        if (thermal_surface(scene.view(dies, X), touch, heat.gap).faces.empty())
          warnings.push_back("die " + scene.dies[operation.waiting.resting_die].name +
                             ", on which the billet is to rest for " + as_text(operation.waiting.dwell) +
                             " s, does not touch a face of it: no heat goes there; move the die, or name "
                             "another in Heat/resting die");
      }
      if (heat.gap > most * edge)
        warnings.push_back("Heat/contact gap = " + as_text(heat.gap) + " mm is " +
                           as_text(rounded_down(heat.gap / edge)) +
                           " of the element size: metal that far from a die gives it heat as if it touched; "
                           "it is for what is left "
                           "between surfaces that touch, 0.1 mm");
    }

    /// A billet that dies touch along lines or at points only, in the first increment.
    void tell_loose(const Parameters           &parameters,
                    const Scene                &scene,
                    const Process<double>      &process,
                    const NodalVectors<double> &X,
                    std::vector<std::string>   &warnings)
    {
      const StepModel model = parameters.step_model();
      if (!model.holds_loose)
        return;
      const Physics<double> physics = process.at_stroke(0.);
      auto                  view    = scene.view(physics.dies, X);
      view.comm                     = MPI_COMM_SELF;
      const double near             = model.contact.near_in(model.contact.step);
      const auto   pairs            = find_contact_pairs(view, {near}, near, model.edges_touch);
      if (const RigidHold hold = hold_of_loose(scene, physics, view, pairs, near); !hold.empty())
        warnings.push_back("dies touch the billet along lines or at points only: what would let it " +
                           join(held_motions(hold, X)) +
                           " is held until contacts are wide enough, Contact/loose billet = held; cut by "
                           "symmetry planes, it needs less of that");
    }
  } // namespace

  void add_doubts(const Parameters               &parameters,
                  const Scene                    &scene,
                  const Process<double>          &process,
                  const NodalVectors<double>     &X,
                  const std::vector<DieApproach> &approaches,
                  std::vector<std::string>       &warnings)
  {
    tell_bulges(scene, process, X, warnings);
    tell_chamfers(parameters, scene, warnings);
    tell_rims(parameters, scene, process, warnings);
    tell_unseen(parameters, scene, process, X, approaches, warnings);
    tell_loose(parameters, scene, process, X, warnings);
    tell_heat(parameters, scene, process, X, warnings);
  }
} // namespace retroforge
