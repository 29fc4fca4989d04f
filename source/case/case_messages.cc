// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/fineness.h>
#include <retroforge/case/case_messages.h>
#include <retroforge/core/text.h>
#include <retroforge/geometry/surface_rims.h>
#include <retroforge/mesh/mesh_quality.h>

#include <algorithm>
#include <cmath>
#include <iostream>

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
      constexpr double memory = 3.6e-6; // of a tetrahedron, in runs of up to 1.3 millions [GB]
      return {parameter + " = " + as_text(element_size) + " makes about " + as_text(n_cells) +
              " tetrahedra; expect hours, and " + as_text(std::ceil(memory * n_cells)) + " GB of memory"};
    }

    /// What a setting that is left out leaves out of the model.
    std::vector<std::string> notes_on_what_is_left_out(const Case &forging_case)
    {
      std::vector<std::string> notes;
      const auto              &dies = forging_case.process.dies;
      if (std::none_of(dies.begin(), dies.end(), [](const DieState<double> &die) { return die.rubs(); }))
        notes.push_back("no die has any friction: Die NAME/friction is 0 where it is not set");
      if (forging_case.parameters.billet.is_from_file() && forging_case.process.material.depends_on_state())
        notes.push_back(
          "the metal of a billet from a file begins without strain and at one temperature: what an earlier "
          "forging did to it is not in the file");
      return notes;
    }

    /// Whether what is missing is small beside the surface: what closes it has the area vector  -sum_f A_f
    /// n_f.
    bool is_nearly_closed(const TriangleSurface &surface)
    {
      constexpr double small = 0.05;
      return mean_normal(surface).norm() < small;
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

    /// Equations of flat and slender tetrahedra are nearly dependent, and multigrid does not see it.
    std::vector<std::string> notes_on_slender_cells(const Case &forging_case)
    {
      constexpr double slender = 10., poor = 15.; // degrees
      double           least  = 180.;
      unsigned int     n_poor = 0;
      for (const auto &cell : forging_case.billet.cells)
      {
        const double angle = minimum_dihedral_angle(corners(cell, forging_case.X_0));
        least              = std::min(least, angle);
        n_poor += angle < poor;
      }
      if (!(least < slender))
        return {};
      return {"faces of the billet's mesh meet at " + as_text(least) + " degrees, and " +
              std::to_string(n_poor) + " of " + std::to_string(forging_case.billet.n_cells()) +
              " tetrahedra have less than " + as_text(poor) + ": linear systems take longer" +
              (forging_case.parameters.remeshing.first_mesh
                 ? ""
                 : "; `Remeshing/first mesh = true' makes a better mesh before the run begins")};
    }
  } // namespace

  void print_meshing(const Parameters &parameters)
  {
    print_notes(note_on_fineness(
      "Billet/element size", parameters.billet.element_size, expected_cells(parameters.billet)));
  }

  std::vector<std::string> notes_on(const Case &forging_case)
  {
    std::vector<std::string> notes = forging_case.parameters.without_effect;
    const auto               add   = [&](const std::vector<std::string> &more) {
      notes.insert(notes.end(), more.begin(), more.end());
    };
    const auto remark = [&](const std::string &what, const std::vector<std::string> &remarks) {
      for (const std::string &sentence : remarks)
        notes.push_back(what + ": " + sentence);
    };
    remark("the file of the billet", forging_case.nominal_billet.remarks);
    for (const Die &die : forging_case.model.dies)
      if (die.surface())
        remark("the file of die " + die.name, die.surface()->remarks);
    add(notes_on_what_is_left_out(forging_case));
    add(notes_on_slender_cells(forging_case));
    for (const Die &die : forging_case.model.dies)
      add(notes_on_holes(die));
    if (const double size = forging_case.parameters.remeshing.element_size;
        size > 0. && forging_case.parameters.remeshing.enabled())
      add(note_on_fineness(
        "Remeshing/element size", size, expected_cells(std::pow(forging_case.size().side, 3), size)));
    if (const PressParameters &press = forging_case.parameters.press;
        std::abs(press.steps.stretch - 1.) > 1e-6)
      notes.push_back("the increments of " + press.steps_file + " end at " +
                      as_text(press.stroke / press.steps.stretch) + " mm and are stretched to " +
                      as_text(press.stroke) + " mm");
    if (forging_case.process.operations.front().path_scale != 1.)
      notes.push_back(
        "die " + forging_case.parameters.dies[forging_case.process.operations.front().leading_die].name +
        " follows the billet: its path is " +
        as_text(forging_case.process.operations.front().path_scale * forging_case.parameters.press.stroke) +
        " mm long; strokes are given as the nominal design's, " +
        as_text(forging_case.parameters.press.stroke) + " mm");
    return notes;
  }

  void print_notes(const std::vector<std::string> &notes)
  {
    for (const std::string &note : notes)
      std::cout << "  note: " << note << '\n';
    std::cout << std::flush;
  }

  void print_warnings(const std::vector<std::string> &warnings)
  {
    for (const std::string &sentence : warnings)
      std::cout << "  warning: " << sentence << '\n';
    std::cout << std::flush;
  }
} // namespace retroforge
