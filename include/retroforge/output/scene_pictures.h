// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die.h>
#include <retroforge/mesh/tet_mesh.h>

#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Billet and dies as they stand at the start, for ParaView and the report: scene.pvd with
  /// scene_billet.vtu, if there is a billet, and scene_die_NAME.vtu. For one rank.
  class ScenePictures
  {
  public:
    explicit ScenePictures(std::string directory) : directory_(std::move(directory)) {}

    /// With the fields `gap`, the signed distance of the nodes from the nearest of the dies [mm], at most the
    /// billet's extent and negative inside a die, and `nearest_die`, its number from 1.
    /// @throws Error  if a file cannot be written
    void add_billet(const TetMesh                       &mesh,
                    const NodalVectors<double>          &X,
                    const std::vector<Die>              &dies,
                    const std::vector<DieState<double>> &states);

    /// @param around  what the picture of a plane covers     @throws Error
    void add_die(const Die &die, const Vec3 &displacement, const NodalVectors<double> &around);

    /// scene.pvd, of what was added.  @throws Error
    void write_list() const;

  private:
    std::string              directory_;
    std::vector<std::string> files_; ///< names
  };
} // namespace retroforge
