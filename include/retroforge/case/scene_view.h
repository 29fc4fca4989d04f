// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>
#include <retroforge/output/scene_summary.h>

#include <functional>

namespace retroforge
{
  /// The command scene: billet and dies before the first increment, checked as for a run, listed and drawn:
  /// scene.json, and scene.pvd with scene_billet.vtu and scene_die_NAME.vtu. Of a scene that a run would
  /// reject, all that can be made.
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
    /// The parts of the case that could be made: all of it, or some.
    struct Parts
    {
      Parameters             parameters; ///< parameters of the dies that could be made
      std::optional<TetMesh> mesh;
      NodalVectors<double>   X; ///< positions of its nodes [mm]
      std::vector<Die>       dies;
      Process<double>        process; ///< process of these dies
      std::string            leading_die;
      Vec3                   path;         ///< path of the leading die over the stroke [mm]
      double                 seconds = 0.; ///< duration of the stroke [s]
    };

    void look();
    /// @return whether it threw nothing; what it threw is a refusal, each told once
    bool attempt(const std::function<void()> &make);
    void make_all(const Case &made);
    void make_some();

    /// Finds the leading die, its path and duration, while all dies are there.
    static void lead(Parts &parts);
    /// Returns whether the number of increments is left to the program.
    bool chooses_increments() const;
    void warn(const std::vector<std::string> &warnings);

    void estimate(const Scene &scene);
    void describe_billet();
    void describe_dies();
    void describe_approaches(const Scene &scene);
    void describe_sizes();
    /// Returns the points that pictures of planes cover.
    NodalVectors<double> drawn_around() const;
    void                 draw() const;

    const CommandLine    command_;
    const MPI_Comm       comm_;
    Timings              timings_;
    std::optional<Parts> parts_; ///< none where the parameters cannot be read
    SceneSummary         summary_;
  };
} // namespace retroforge
