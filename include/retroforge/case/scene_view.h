// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>
#include <retroforge/output/scene_summary.h>

#include <functional>

namespace retroforge
{
  /// The command scene: how billet and dies stand before the first increment, checked as for a run, listed
  /// and drawn: scene.json, and scene.pvd with scene_billet.vtu and scene_die_NAME.vtu. Of a scene that is
  /// refused, all that can be made.
  ///
  /// The first rank does it alone: on several ranks the files are those of one.
  class SceneView
  {
  public:
    SceneView(const CommandLine &command, MPI_Comm comm);

    /// @return the exit status, 0
    /// @throws Error  what a run would be refused for, once all is written
    int run();

  private:
    /// What could be made of the case: all of it, or some.
    struct Parts
    {
      Parameters             parameters; ///< of the dies that could be made
      std::optional<TetMesh> mesh;
      NodalVectors<double>   X; ///< of its nodes [mm]
      std::vector<Die>       dies;
      Process<double>        process; ///< of these
      std::string            leading_die;
      Vec3                   path;         ///< of that die over the stroke [mm]
      double                 seconds = 0.; ///< that it takes
    };

    void look();
    /// @return whether it threw nothing; what it threw is a refusal, each told once
    bool attempt(const std::function<void()> &make);
    void make_all(const Case &made);
    void make_some();

    /// Who leads, how far and how long, while all dies are there.
    static void lead(Parts &parts);
    /// Whether the number of increments is left to the program.
    bool chooses_increments() const;
    void warn(const std::vector<std::string> &warnings);

    void estimate(const Scene &scene);
    void describe_billet();
    void describe_dies();
    void describe_approaches(const Scene &scene);
    void describe_sizes();
    /// What pictures of planes cover.
    NodalVectors<double> drawn_around() const;
    void                 draw() const;

    const CommandLine    command_;
    const MPI_Comm       comm_;
    Timings              timings_;
    std::optional<Parts> parts_; ///< none where the parameters cannot be read
    SceneSummary         summary_;
  };
} // namespace retroforge
