// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/case_messages.h>
#include <retroforge/core/text.h>
#include <retroforge/core/version.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/output/blas.h>
#include <retroforge/output/console.h>
#include <retroforge/run/run_messages.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <thread>

namespace retroforge
{
  void print_begin(const Case &forging_case)
  {
    const unsigned int ranks = dealii::Utilities::MPI::n_mpi_processes(forging_case.comm);
    double             load  = 0.;
    if (getloadavg(&load, 1) != 1)
      load = 0.;
    std::cout << "Retroforge " << version << ' ' << commit << ", " << forging_case.billet.n_nodes()
              << " nodes, " << forging_case.billet.n_cells() << " tetrahedra, " << ranks
              << " rank(s), BLAS: " << blas_in_use() << '\n'
              << note_on_load(ranks, load, std::thread::hardware_concurrency());
    print_notes(notes_on(forging_case));
  }

  void print_chords(const Case &forging_case, const double shape)
  {
    constexpr double much      = 1e-3;
    const double     mesh      = volume(forging_case.billet.cells, forging_case.X_0);
    const auto      &at_design = forging_case.parameters.design.at;
    const bool       is_chosen = std::any_of(at_design.begin(), at_design.end(), [](const auto &value) {
      return value.first.rfind("billet/", 0) == 0;
    });
    if (!(std::abs(mesh / shape - 1.) > much) || is_chosen)
      return;
    std::cout << "  note: the mesh has chords for round sides, and " << as_text(mesh)
              << " mm^3 for the shape's " << as_text(shape) << " ("
              << as_text(std::round(1e4 * (mesh / shape - 1.)) / 100.)
              << " %); energies and forces lack about as much. A smaller Billet/element size comes nearer";
    if (forging_case.parameters.billet.shape == BilletParameters::Shape::cylinder &&
        forging_case.parameters.billet.volume_held_by.empty())
      std::cout << ", and --at billet/radius="
                << as_text(forging_case.parameters.billet.radius * std::sqrt(shape / mesh))
                << " gives this mesh the shape's volume";
    std::cout << '\n' << std::flush;
  }

  void print_resumed(const unsigned int                 n_increments,
                     const bool                         is_left,
                     const std::vector<ChangedSetting> &changes)
  {
    std::cout << "  resumed after increment " << n_increments << '\n';
    if (!changes.empty())
      std::cout << (is_left ? "  with other settings from here on:\n"
                            : "  the forging is done, and other settings do not change it:\n");
    for (const ChangedSetting &setting : changes)
      std::cout << "    " << setting.path << " = " << setting.now << ", was " << setting.before << '\n';
    std::cout << std::flush;
  }

  std::string resume_hint(const Case &forging_case)
  {
    const std::string on = forging_case.has_record()
                             ? "the same command with --resume goes on from the last increment"
                             : "without a record (Output/record) it can only begin anew, with --overwrite";
    return "stopped; " + on + "; contrib/report " + forging_case.command.output_directory +
           " shows what there is";
  }

  std::string resume_hint_after_failure(const Case &forging_case, const double stroke, const bool remakes)
  {
    const PressParameters &press = forging_case.parameters.press;
    const std::string      remeshing =
      remakes ? "'Remeshing/element size=" + as_text(0.7 * forging_case.edge_length()) + "'"
                   : "Remeshing/when=quality";
    const std::string shorter =
      press.steps.empty() ? (press.largest_strain ? "accuracy=" + as_text(0.25 * press.accuracy)
                                                  : "increments=" + std::to_string(2 * press.increments))
                          : "steps=";
    return "go on from stroke " + as_text(stroke) +
           " mm, up to which it is recorded, by the same command with --resume" +
           (forging_case.command.overwrite ? " in place of --overwrite" : "") +
           " and other numerics, for instance --set Press/" + shorter + " or --set " + remeshing;
  }
} // namespace retroforge
