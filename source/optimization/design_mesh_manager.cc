// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/optimization/design_mesh_manager.h>

#include <cstdio>

namespace retroforge
{
  namespace
  {
    /// A new mesh is worth its forging when its worst cell is better by so much.
    constexpr double worthwhile = 1.5;
    /// So many designs in a row whose cells turn inside out, each a quarter as far as the one before, are no
    /// accident of one long step.
    constexpr unsigned int most_inverted = 3;

    /// With few digits: a mesher makes another mesh of a shape that differs in the last ones, as the search's
    /// does on another number of ranks, and the mesh is moved to the design itself.
    template <typename Values>
    std::string as_design(const Values &values)
    {
      std::string text;
      for (const auto &[name, value] : values)
      {
        char number[32];
        std::snprintf(number, sizeof number, "%.5g", value);
        text += (text.empty() ? "" : ", ") + name + ": " + number;
      }
      return text;
    }
  } // namespace

  std::unique_ptr<const Case>
  make_case(CommandLine command, const std::string &meshed_at, const MPI_Comm comm)
  {
    command.resume = false;
    if (!meshed_at.empty())
      command.overrides.emplace_back("Design/meshed at", meshed_at);
    Timings timings;
    return std::make_unique<const Case>(command, timings, comm);
  }

  DesignMeshManager::DesignMeshManager(const Case &first, const double least_quality)
      : first_(first), least_quality_(least_quality)
  {
  }

  double DesignMeshManager::volume_at(const std::vector<double> &mu) const
  {
    return volume(now().billet.cells, now().design.positions(mu));
  }

  void DesignMeshManager::tell(const std::vector<double> &mu, const bool accepted, const bool failed)
  {
    if (accepted)
      n_inverted_ = 0;
    if (!failed)
      return;
    try
    {
      n_inverted_ += quality(mu) <= 0. ? 1 : 0;
    }
    catch (const Error &)
    {
      // A shape that cannot be, on any mesh.
    }
  }

  bool DesignMeshManager::due(const std::vector<double> &mu)
  {
    complaint_.clear();
    if (least_quality_ == 0. || mu == settled_at_)
      return false;
    const double before = quality(mu);
    if (before >= least_quality_ && n_inverted_ < most_inverted)
      return false;
    try
    {
      make_candidate(mu);
      const double after = candidate_.made->design.mesh_quality(mu);
      if (after > worthwhile * before)
        return true;
      complaint_ =
        "its worst cell would not be much better, of quality " + as_text(after) + " after " + as_text(before);
    }
    catch (const Error &error)
    {
      complaint_ = error.what();
    }
    refuse_candidate(mu);
    return false;
  }

  std::string DesignMeshManager::meshed_at(const std::vector<double> &mu) const
  {
    std::string text;
    // What is known by its mesh only comes by the meshes before.
    if (!has_measures(first_.parameters.billet))
      for (const ShapeValues &values : now().parameters.design.meshed_at)
        text += as_design(values) + "; ";
    return text + as_design(now().design.billet_at(mu));
  }

  void DesignMeshManager::make_candidate(const std::vector<double> &mu)
  {
    candidate_          = {};
    candidate_.made_at  = meshed_at(mu);
    CommandLine command = first_.command;
    command.case_text   = first_.echo;
    candidate_.made     = make_case(std::move(command), candidate_.made_at, first_.comm);
  }

  void DesignMeshManager::use_candidate()
  {
    now_        = std::move(candidate_.made);
    made_at_    = candidate_.made_at;
    candidate_  = {};
    n_inverted_ = 0;
    ++number_;
  }

  void DesignMeshManager::refuse_candidate(const std::vector<double> &mu)
  {
    candidate_  = {};
    settled_at_ = mu;
  }
} // namespace retroforge
