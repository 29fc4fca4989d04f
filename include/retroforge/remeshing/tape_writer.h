// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/position_tape.h>
#include <retroforge/remeshing/volume_correction.h>

#include <map>

namespace retroforge
{
  /// Writes a PositionTape while a mesh is remade, and knows the values of its vectors.
  ///
  /// Remeshing numbers the nodes of the mesh that it works on, from pass to pass; the writer knows which vector is the
  /// position of each, now and at the start of the pass, when the surface was that which new nodes are put on.
  class TapeWriter
  {
  public:
    /// The number of a vector.
    using Slot = unsigned int;

    explicit TapeWriter(const NodalVectors<double> &X);

    /// Appends an operation, and returns its vector.
    Slot add(PlacingRule                      rule,
             const std::vector<unsigned int> &arguments,
             const std::vector<double>       &numbers = {});

    /// Appends one whose value the writer cannot know.
    Slot add(PlacingRule                      rule,
             const std::vector<unsigned int> &arguments,
             const std::vector<double>       &numbers,
             const Vec3                      &value);

    const Vec3 &value(const Slot slot) const { return values_[slot]; }

    /// Returns the position of a node, now or when the pass began.
    Slot node(const NodeIndex node) const { return now_[node]; }
    Slot node_at_start(const NodeIndex node) const { return at_start_[node]; }

    /// Says where a node is from now on. A new one comes after all others.
    void place(NodeIndex node, Slot slot);

    /// Says where all nodes of another mesh are.
    void place(std::vector<Slot> nodes);

    /// Says that the surface is to stay what it is now, while nodes are moved on it.
    void begin_pass();

    /// Returns where nodes are by their numbers.
    std::vector<Slot> nodes(const std::vector<NodeIndex> &numbers) const;

    /// Returns the number of a plane.
    unsigned int plane(const Plane &plane);

    /// Returns a vector that is asked for by a key of its kind time and again in a pass.
    template <typename Make>
    Slot once(const unsigned int kind, const unsigned int a, const unsigned int b, const Make &make)
    {
      const std::array<unsigned int, 3> key = {{kind, a, b}};
      if (const auto found = made_.find(key); found != made_.end())
        return found->second;
      const Slot slot = make();
      made_.emplace(key, slot);
      return slot;
    }

    /// Shifts nodes so that the volume is kept; the nodes' values are where they are after that.
    void keep_volume(const std::vector<BoundaryFace> &faces, const VolumeCorrection &correction);

    /// Returns the tape, whose results are nodes in an order.
    PositionTape tape(const std::vector<NodeIndex> &order) const;

  private:
    /// Writes the directions in which nodes are shifted; invalid_index where they are not.
    std::vector<Slot> directions(const std::vector<BoundaryFace> &faces, const VolumeCorrection &correction);

    PositionTape                                tape_;
    NodalVectors<double>                        values_;
    std::vector<Slot>                           now_, at_start_;
    Slot                                        kept_volume_ = invalid_index; ///< of the mesh as it is now
    std::map<std::array<unsigned int, 3>, Slot> made_;
  };
} // namespace retroforge
