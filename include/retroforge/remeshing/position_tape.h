// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die.h>
#include <retroforge/remeshing/placing_rules.h>

namespace retroforge
{
  /// The positions of the nodes of a new mesh as a function of those of the old one and of the dies: what remeshing
  /// did to positions, step by step, with all its decisions.
  ///
  /// Vectors are numbered: first the positions of the old nodes, then what each operation makes of vectors before it.
  /// Nodes that were not touched are old vectors, so that the tape is as long as the work that was done. The volume is
  /// kept by operations of the rule `distance`, each followed by the shifts x_k + d u_k that it serves: d is such that
  ///   V'(x + d u) = V(X) - rest,
  /// V' the volume inside the faces that its arguments name, those of the new mesh where it has none, V that of the
  /// old mesh. Its derivative is that of this one constraint,
  ///   d_dot = (∇V·X_dot - ∇V'·(x_dot + d u_dot)) / (∇V'·u).
  /// Decisions stay what they were: which face, edge or feature is closest, which way a search went, what moves.
  struct PositionTape
  {
    unsigned int               n_inputs = 0; ///< nodes of the old mesh
    std::vector<unsigned char> rules;        ///< PlacingRule of each operation
    /// Operation i has the entries begin[i] ... begin[i+1] - 1 of the lists below.
    std::vector<unsigned int> argument_begin = {0}, number_begin = {0};
    std::vector<unsigned int> arguments;
    std::vector<double>       numbers;
    std::vector<Plane>        planes;
    std::vector<unsigned int> results; ///< the vector that is the position of each new node

    std::size_t n_operations() const { return rules.size(); }
    PlacedBy    operation(std::size_t i) const;

    /// What positions are a function of, besides those of the old mesh.
    template <typename Number>
    struct Scene
    {
      const TetMesh                       &old_mesh, &new_mesh; ///< their connectivity
      const std::vector<Die>              &dies;
      const std::vector<DieState<Number>> &states;
    };

    /// Returns the positions of the new nodes [mm].
    template <typename Number>
    NodalVectors<Number> positions(const Scene<Number> &scene, const NodalVectors<Number> &X) const;

    /// Adds the pull-back of positions() to X_bar and dies_bar: to displacements, and to vertices where there are any.
    void reverse_positions(const Scene<double>           &scene,
                           const NodalVectors<double>    &X,
                           const NodalVectors<double>    &positions_bar,
                           NodalVectors<double>          &X_bar,
                           std::vector<DieState<double>> &dies_bar) const;

    /// Returns what is wrong with the numbering, of a tape that was read; empty where nothing is.
    /// @param die_facets  facets of each die
    std::string
    defect(unsigned int n_old, unsigned int n_new, const std::vector<unsigned int> &die_facets) const;

    /// Returns the tape without what no result follows from.
    PositionTape pruned() const;

    std::size_t memory_consumption() const;

  private:
    template <typename Number>
    NodalVectors<Number> all_vectors(const Scene<Number> &scene, const NodalVectors<Number> &X) const;
  };
} // namespace retroforge
