// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/earlier_start.h>
#include <retroforge/case/scene_checks.h>
#include <retroforge/core/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace retroforge
{
  namespace
  {
    /// Farther than so many depths a die does not back off.
    constexpr double farthest = 10.;

    /// By so much more, so that rounding leaves nothing inside.
    constexpr double rounding = 1e-6;

    /// Whether a face of the billet's surface stands in a die by more than touches: what is pushed out of it costs
    /// work at once, where that of single nodes, under a round die, grows with the square of the depth.
    bool has_a_face_inside(const TetMesh              &billet,
                           const NodalVectors<double> &X,
                           const Die                  &die,
                           const Vec3                 &displacement,
                           const double                near)
    {
      return std::any_of(billet.faces.begin(), billet.faces.end(), [&](const auto &face) {
        return !billet.patches[face.patch].symmetry &&
               std::all_of(face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) {
                 return die.signed_distance(X[k], displacement) < -near;
               });
      });
    }

    /// Whether a die has to come from outside: a face stands in it, or a part of it in the metal that pushes no node.
    bool must_come_from_outside(const TetMesh              &billet,
                                const NodalVectors<double> &X,
                                const Die                  &die,
                                const Vec3                 &displacement,
                                const Overlap              &overlap,
                                const double                near)
    {
      return overlap.depth > near &&
             (has_a_face_inside(billet, X, die, displacement, near) ||
              overlap.depth > deepest_pushed_out(billet, X, die, displacement, overlap));
    }

    /// Whether a die that moves in the first operation stands in another one, too, which would begin and end with it back.
    bool moves_later(const Process<double> &process)
    {
      const auto &first = process.operations.front().dies;
      return std::any_of(first.begin(), first.end(), [&](const unsigned int d) {
        return process.dies[d].velocity.norm() > 0. &&
               std::any_of(process.operations.begin() + 1, process.operations.end(), [&](const auto &later) {
                 return later.has(d);
               });
      });
    }

    /// How long before stroke 0 a die has left the metal that it stands in; infinite where it does not come out of it so.
    double seconds_to_leave(const Die              &die,
                            const DieState<double> &state,
                            const MetalSurface     &metal,
                            const double            depth,
                            const double            most)
    {
      const double speed = state.velocity.norm();
      if (!(speed > 0.) || depth > most)
        return std::numeric_limits<double>::infinity();
      const double travel = travel_to_be_free(die, state.displacement, -1. / speed * state.velocity, metal);
      return travel <= farthest * depth ? travel / speed : std::numeric_limits<double>::infinity();
    }
  } // namespace

  EarlierStart earlier_start(const Parameters           &parameters,
                             const TetMesh              &billet,
                             const std::vector<Die>     &dies,
                             const Process<double>      &process,
                             const NodalVectors<double> &X)
  {
    EarlierStart       start;
    const auto        &operation = process.operations.front();
    const double       near      = touching_distance(billet, X);
    const MetalSurface metal     = billet_surface(parameters.billet, billet, X, 0.2 * near);
    double             seconds   = 0.;
    std::vector<std::pair<unsigned int, std::string>> remarks;
    for (const unsigned int d : operation.dies)
      if (const Overlap overlap = find_overlap(dies[d], process.dies[d].displacement, metal);
          must_come_from_outside(billet, X, dies[d], process.dies[d].displacement, overlap, near))
      {
        const double before =
          seconds_to_leave(dies[d], process.dies[d], metal, overlap.depth, deepest_start(billet, X));
        if (!std::isfinite(before))
          return start;
        seconds = std::max(seconds, (1. + rounding) * before);
        remarks.emplace_back(d, "Die " + dies[d].name + ": " + standing_inside(overlap));
      }
    if (remarks.empty() || moves_later(process))
      return start;
    const double stroke = value_of(operation.stroke);
    start.path          = process.speed(0) * seconds;
    start.scale         = start.path / stroke;
    start.shifts.resize(dies.size());
    for (const unsigned int d : operation.dies)
      start.shifts[d] = -seconds * process.dies[d].velocity;
    for (const auto &[d, remark] : remarks)
      start.remarks.push_back(remark + ": the press begins " + as_text(start.path) +
                              " mm earlier; it is free when the die is moved by " +
                              in_brackets(start.shifts[d]) + " mm");
    return start;
  }
} // namespace retroforge
