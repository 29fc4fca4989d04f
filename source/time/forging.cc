// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/time/forging.h>

namespace retroforge
{
  void PressParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Press");
    prm.add_parameter(
      "leading die", leading_die, "Die whose path is the stroke; empty: the first that moves. Units: none.");
    prm.add_parameter("stroke", stroke, "Path of the leading die. Units: mm.", Double(1e-300));
    prm.add_parameter("increments",
                      increments,
                      "Number of equal increments of stroke, before any is cut; 0 for steps of 0.3 % of the "
                      "billet's height, with which the energy is smooth in the design. Units: none.",
                      Integer(0));
    prm.add_parameter(
      "scheme",
      scheme,
      "Time scheme: `midpoint` is of second order and solves twice per increment, `euler` of first order. "
      "Units: none.",
      Selection("midpoint|euler"));
    prm.add_parameter(
      "smallest volume",
      smallest_volume,
      "An increment is halved when an element would keep less than this part of its volume. Units: none.",
      Double(0., 1.));
    prm.add_parameter(
      "largest move",
      largest_move,
      "An increment is halved when two nodes of an edge would move, relative to each other, by more than "
      "this part of its length. Units: none.",
      Double(1e-6));
    prm.add_parameter(
      "max cuts", max_cuts, "Times an increment may be halved before the run stops. Units: none.");
    prm.leave_subsection();
  }

  Forging::Forging(const Scene &scene, const PressParameters &press, Increment &increment)
      : scene_(scene), press_(press), increment_(increment)
  {
  }

  bool Forging::acceptable(const NodalVectors<double> &X, const NodalVectors<double> &X_next) const
  {
    for (CellIndex c = 0; c < scene_.mesh.n_cells(); ++c)
    {
      const auto before = positions_of_cell(scene_.mesh, X, c),
                 after  = positions_of_cell(scene_.mesh, X_next, c);
      if (!(cell_geometry(after).volume > press_.smallest_volume * cell_geometry(before).volume))
        return false;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b < a; ++b)
          if (((after[a] - before[a]) - (after[b] - before[b])).norm() >
              press_.largest_move * (before[a] - before[b]).norm())
            return false;
    }
    return true;
  }

  ForgingResult
  Forging::run(const Process<double> &process, const NodalVectors<double> &X_0, const Watch &watch)
  {
    ForgingResult   result;
    IncrementReport report;
    Field<double>   W(scene_.mesh);
    result.X            = X_0;
    const double whole  = press_.stroke / press_.increments;
    double       stroke = 0.;
    unsigned int depth  = 0; // the present increment is whole / 2^depth
    while (stroke < press_.stroke - 1e-9 * whole)
    {
      IncrementRecord record;
      record.stroke = stroke;
      record.step   = std::min(whole / (1 << depth), press_.stroke - stroke);
      NodalVectors<double> X_next;
      Field<double>        solution = W;
      for (;; record.step *= 0.5, ++record.cuts, ++depth)
      {
        if (record.cuts > press_.max_cuts)
          throw Error("Press/increments",
                      "an increment at stroke " + std::to_string(stroke) + " mm was halved " +
                        std::to_string(press_.max_cuts) + " times and still inverts an element",
                      "elements must keep a positive volume",
                      "the mesh is too distorted to go on: shorten the stroke or use a finer mesh");
        solution = W;
        X_next   = increment_.forward(process, result.X, false, record, solution, report);
        result.newton += report.newton.iterations;
        result.krylov += report.newton.krylov;
        if (acceptable(result.X, X_next))
          break;
      }
      stroke += record.step;
      W = std::move(solution);
      result.energy.deformation += record.deformation_energy;
      result.energy.friction += record.friction_energy;
      ++result.increments;
      result.cuts += record.cuts;
      if (watch)
        watch({result.increments,
               record,
               report,
               result.X,
               X_next,
               W,
               stroke / process.speed(),
               result.energy.total()});
      result.X = std::move(X_next);
      // Back to longer steps once a whole number of them fits.
      const double done = stroke / whole;
      while (depth > 0 && std::abs(done * (1 << (depth - 1)) - std::round(done * (1 << (depth - 1)))) < 1e-9)
        --depth;
    }
    return result;
  }

  ForgingResult Forging::replay(const Process<double>      &process,
                                const NodalVectors<double> &X_0,
                                const unsigned int          n,
                                const Source               &source)
  {
    ForgingResult   result;
    IncrementReport report;
    result.X = X_0;
    for (unsigned int i = 0; i < n; ++i)
    {
      IncrementRecord record = source(i);
      Field<double>   W(scene_.mesh);
      W.V      = record.solves[0].V;
      W.P      = record.solves[0].P;
      result.X = increment_.forward(process, result.X, true, record, W, report);
      result.energy.deformation += record.deformation_energy;
      result.energy.friction += record.friction_energy;
      result.newton += report.newton.iterations;
      result.krylov += report.newton.krylov;
      ++result.increments;
      result.cuts += record.cuts;
    }
    return result;
  }
} // namespace retroforge
