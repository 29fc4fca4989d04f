// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/fineness.h>
#include <retroforge/core/text.h>
#include <retroforge/core/version.h>
#include <retroforge/geometry/surface_rims.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/output/blas.h>
#include <retroforge/output/console.h>
#include <retroforge/run_messages.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <thread>

namespace retroforge
{
  namespace
  {
    constexpr double many_cells = 1e6;

    /// Nothing where it makes no millions.
    std::vector<std::string>
    note_on_fineness(const std::string &parameter, const double element_size, const double n_cells)
    {
      if (!(n_cells > many_cells))
        return {};
      return {parameter + " = " + as_text(element_size) + " makes about " + as_text(n_cells) +
              " tetrahedra; expect hours, and gigabytes of memory"};
    }

    /// Whether what is missing is small beside the surface: what closes it has the area vector  -sum_f A_f
    /// n_f.
    bool is_nearly_closed(const TriangleSurface &surface)
    {
      constexpr double small = 0.05;
      Vec3             sum;
      double           area = 0.;
      for (const Triangle &t : surface.triangles())
      {
        const auto &x = surface.vertices();
        const Vec3  v = facet_vector(x[t[0]], x[t[1]], x[t[2]]);
        sum += v;
        area += v.norm();
      }
      return sum.norm() < small * area;
    }

    /// An outer rim is what open dies have; another one, or that of a body, may be that of a facet that an
    /// export lost.
    std::vector<std::string> notes_on_holes(const Die &die)
    {
      std::vector<std::string> notes;
      if (!die.surface())
        return notes;
      const std::vector<SurfaceRim> rims = find_rims(*die.surface());
      for (std::size_t i = is_nearly_closed(*die.surface()) ? 0 : 1; i < rims.size(); ++i)
        notes.push_back("the surface of die " + die.name + " has " + (i == 0 ? "a" : "another") + " rim, " +
                        as_text(rims[i].length) + " mm around, at (" + as_text(rims[i].centre[0]) + ", " +
                        as_text(rims[i].centre[1]) + ", " + as_text(rims[i].centre[2]) +
                        "): a hole or a separate part; if that is not intended, repair the file");
      return notes;
    }

    void print_notes(const std::vector<std::string> &notes)
    {
      for (const std::string &note : notes)
        std::cout << "  note: " << note << '\n';
      std::cout << std::flush;
    }

    /// Equations of flat and slender tetrahedra are nearly dependent, and multigrid does not see it.
    std::vector<std::string> notes_on_slender_cells(const Case &at)
    {
      constexpr double slender = 10., poor = 15.; // degrees
      double           least  = 180.;
      unsigned int     n_poor = 0;
      for (const auto &cell : at.billet.cells)
      {
        const double angle = minimum_dihedral_angle(corners(cell, at.X_0));
        least              = std::min(least, angle);
        n_poor += angle < poor;
      }
      if (!(least < slender))
        return {};
      return {"faces of the billet's mesh meet at " + as_text(least) + " degrees, and " +
              std::to_string(n_poor) + " of " + std::to_string(at.billet.n_cells()) +
              " tetrahedra have less than " + as_text(poor) + ": linear systems take longer" +
              (at.parameters.remeshing.first_mesh
                 ? ""
                 : "; `Remeshing/first mesh = true' makes a better mesh before the run begins")};
    }
  } // namespace

  void print_meshing(const Parameters &parameters)
  {
    print_notes(note_on_fineness(
      "Billet/element size", parameters.billet.element_size, expected_cells(parameters.billet)));
  }

  std::vector<std::string> notes_on(const Case &at)
  {
    std::vector<std::string> notes = at.parameters.without_effect;
    const auto               add   = [&](const std::vector<std::string> &more) {
      notes.insert(notes.end(), more.begin(), more.end());
    };
    const auto remark = [&](const std::string &what, const std::vector<std::string> &remarks) {
      for (const std::string &sentence : remarks)
        notes.push_back(what + ": " + sentence);
    };
    remark("the file of the billet", at.nominal_billet.remarks);
    for (const Die &die : at.model.dies)
      if (die.surface())
        remark("the file of die " + die.name, die.surface()->remarks);
    add(notes_on_slender_cells(at));
    for (const Die &die : at.model.dies)
      add(notes_on_holes(die));
    if (const double size = at.parameters.remeshing.element_size;
        size > 0. && at.parameters.remeshing.when != "never")
      add(
        note_on_fineness("Remeshing/element size", size, expected_cells(std::pow(at.size().side, 3), size)));
    if (at.process.stretch != 1.)
      notes.push_back("die " + at.parameters.dies[at.process.leading_die].name +
                      " follows the billet: its path is " +
                      as_text(at.process.stretch * at.parameters.press.stroke) +
                      " mm long; strokes are given as the nominal design's, " +
                      as_text(at.parameters.press.stroke) + " mm");
    return notes;
  }

  void print_begin(const Case &at)
  {
    const unsigned int ranks = dealii::Utilities::MPI::n_mpi_processes(at.comm);
    double             load  = 0.;
    if (getloadavg(&load, 1) != 1)
      load = 0.;
    std::cout << "Retroforge " << version << ' ' << commit << ", " << at.billet.n_nodes() << " nodes, "
              << at.billet.n_cells() << " tetrahedra, " << ranks << " rank(s), BLAS: " << blas_in_use()
              << '\n'
              << note_on_load(ranks, load, std::thread::hardware_concurrency());
    print_notes(notes_on(at));
  }

  void print_warnings(const std::vector<std::string> &warnings)
  {
    for (const std::string &sentence : warnings)
      std::cout << "  warning: " << sentence << '\n';
    std::cout << std::flush;
  }

  void print_chords(const Case &at, const double shape)
  {
    constexpr double much      = 1e-3;
    const double     mesh      = volume(at.billet.cells, at.X_0);
    const auto      &at_design = at.parameters.design.at;
    const bool       is_chosen = std::any_of(at_design.begin(), at_design.end(), [](const auto &value) {
      return value.first.rfind("billet/", 0) == 0;
    });
    if (!(std::abs(mesh / shape - 1.) > much) || is_chosen)
      return;
    std::cout << "  note: the mesh has chords for round sides, and " << as_text(mesh)
              << " mm^3 for the shape's " << as_text(shape) << " ("
              << as_text(std::round(1e4 * (mesh / shape - 1.)) / 100.)
              << " %); energies and forces lack about as much. A smaller Billet/element size comes nearer";
    if (at.parameters.billet.shape == "cylinder" && at.parameters.billet.volume_held_by.empty())
      std::cout << ", and --at billet/radius="
                << as_text(at.parameters.billet.radius * std::sqrt(shape / mesh))
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

  std::string way_on(const Case &at)
  {
    const std::string on = at.has_record()
                             ? "the same command with --resume goes on from the last increment"
                             : "without a record (Output/record) it can only begin anew, with --overwrite";
    return "stopped; " + on + "; contrib/report " + at.command.output_directory + " shows what there is";
  }

  std::string way_on_after_failure(const Case &at, const double stroke, const bool remakes)
  {
    const std::string remeshing =
      remakes ? "'Remeshing/element size=" + as_text(0.7 * at.edge_length()) + "'" : "Remeshing/when=quality";
    return "go on from stroke " + as_text(stroke) +
           " mm, up to which it is recorded, by the same command with --resume" +
           (at.command.overwrite ? " in place of --overwrite" : "") +
           " and other numerics, for instance --set Press/increments=" +
           std::to_string(2 * at.parameters.press.increments) + " or --set " + remeshing;
  }
} // namespace retroforge
