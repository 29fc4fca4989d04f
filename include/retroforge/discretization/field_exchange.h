// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/field.h>
#include <retroforge/mesh/partition.h>

#include <optional>

namespace retroforge
{
  /// Whose velocity nodes are: those of the mesh are the partition's, the middle of an edge goes with its
  /// smaller node.
  Ownership velocity_ownership(const Spaces &spaces, const Partition &partition);

  /// Completes velocities and pressures whose owned entries are right, and sums. Bubbles are the cells' own:
  /// each rank knows those of the cells it visits.
  class FieldExchange
  {
  public:
    /// What is passed must live as long.
    FieldExchange(const TetMesh   &mesh,
                  const Topology  &topology,
                  const Spaces    &spaces,
                  const Partition &partition,
                  const Ownership &velocities);

    /// What this rank works with: at the nodes of the cells it visits, and velocities on the whole surface,
    /// where each rank decides of all contacts. Collective.
    void update(Field<double> &W) const
    {
      update(W.V);
      pressure_ghosts_.update(W.P.data());
    }
    void update(NodalVectors<double> &V) const { velocity_ghosts_.update(V.data()->begin_raw()); }

    /// The same of an array of three doubles per velocity node.
    void update_components(std::vector<double> &x) const { velocity_ghosts_.update(x.data()); }

    /// Velocities and pressures on all ranks: positions, the record and new meshes need all of them. Bubbles
    /// follow from them. Collective.
    void gather(Field<double> &W) const
    {
      velocities_.gather(W.V.data()->begin_raw(), 3);
      pressures_.gather(W.P.data(), 1);
    }

    /// Of what each rank has summed over its own cells and contacts, the whole sums, at owned nodes and in
    /// visited cells; elsewhere nothing is right. Collective.
    void collect(Field<double> &sums) const
    {
      velocity_ghosts_.collect(sums.V.data()->begin_raw());
      pressure_ghosts_.collect(sums.P.data());
      if (bubble_ghosts_)
        bubble_ghosts_->update(sums.beta.data()->begin_raw());
    }

  private:
    const Ownership             &velocities_, &pressures_;
    GhostExchange                velocity_ghosts_, pressure_ghosts_;
    std::optional<GhostExchange> bubble_ghosts_;
  };
} // namespace retroforge
