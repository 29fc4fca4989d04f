// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>
#include <retroforge/heat/skin.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Positions of the nodes, in the geometry space [mm]. At a change of mesh they follow a PositionTape.
  template <int dim, typename Number>
  using NodalPositions = std::vector<dealii::Tensor<1, dim, Number>>;

  /// One number per node, or none at all where it is not followed. At a change of mesh it follows  q' = J q,  within
  /// the range of the values that a row of J takes.
  template <typename Number>
  struct NodeField : std::vector<Number>
  {
    using std::vector<Number>::vector;
    NodeField(std::vector<Number> values) : std::vector<Number>(std::move(values)) {}
  };

  /// One vector per node, or none at all where it is not known. At a change of mesh it follows  v' = J v.
  template <int dim, typename Number>
  struct NodeVectorField : std::vector<dealii::Tensor<1, dim, Number>>
  {
    using std::vector<dealii::Tensor<1, dim, Number>>::vector;
    NodeVectorField(std::vector<dealii::Tensor<1, dim, Number>> values)
        : std::vector<dealii::Tensor<1, dim, Number>>(std::move(values))
    {
    }
  };

  /// One number per cell, not negative, or none at all where it is not followed. At a change of mesh it follows transfer_cells().
  template <typename Number>
  struct CellField : std::vector<Number>
  {
    using std::vector<Number>::vector;
    CellField(std::vector<Number> values) : std::vector<Number>(std::move(values)) {}
  };

  /// What flows from increment to increment, and nothing else: complete on every rank. The derivatives of a
  /// scalar in it, its costate, are another such aggregate. Each member tells by its type how it reaches
  /// another mesh (steps/change_of_mesh.h).
  template <int dim, typename Number>
  struct WorkpieceState
  {
    NodalPositions<dim, Number> X;      ///< [mm]
    CellField<Number>           strain; ///< accumulated equivalent strain q, dimensionless
    /// Of the nodes in the increment before, by which contact knows how fast metal comes to a die [mm/s]. None
    /// before the first increment of an operation.
    NodeVectorField<dim, Number> velocity;
    NodeField<Number>            temperature; ///< [C]; none where the metal keeps that before the stroke
    /// Of the layers that contacts have chilled, or none at all where heat does not flow. At a change of mesh its modes
    /// follow J as a NodeField does.
    NodeSkins<Number> skin;
    /// Heat that friction made in the increment before, per area and time [mW/mm^2]; none before the first increment of an
    /// operation, and none at all where heat does not flow.
    NodeField<Number> friction_flux;
    CellField<Number> damage; ///< dimensionless; none where it is not followed

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[X, strain, velocity, temperature, skin, friction_flux, damage] = self;
      return std::tie(X, strain, velocity, temperature, skin, friction_flux, damage);
    }
  };

  /// Returns metal in its initial state: X is where its nodes are, and it has no history.
  template <int dim, typename Number>
  WorkpieceState<dim, Number> initial_state(NodalPositions<dim, Number> X, const std::size_t n_cells)
  {
    return {std::move(X), CellField<Number>(n_cells, Number(0.)), {}, {}, {}, {}, {}};
  }

  /// Returns zero derivatives in the state of a mesh.
  /// @param warms    whether it has temperatures
  /// @param skins    zero ones, or none where heat does not flow
  /// @param damages  whether its damage is followed
  template <int dim>
  WorkpieceState<dim, double> zero_costate(const std::size_t n_nodes,
                                           const std::size_t n_cells,
                                           const bool        warms   = false,
                                           NodeSkins<double> skins   = {},
                                           const bool        damages = false)
  {
    const std::size_t n_skins = skins.metal.size();
    return {NodalPositions<dim, double>(n_nodes),
            CellField<double>(n_cells, 0.),
            NodeVectorField<dim, double>(n_nodes),
            NodeField<double>(warms ? n_nodes : 0, 0.),
            std::move(skins),
            NodeField<double>(n_skins, 0.),
            CellField<double>(damages ? n_cells : 0, 0.)};
  }

  /// Returns what of a state does not follow from the velocities that are recorded: all but positions and
  /// velocity.
  template <int dim, typename Number>
  WorkpieceState<dim, Number> without_motion(WorkpieceState<dim, Number> state)
  {
    state.X.clear();
    state.velocity.clear();
    return state;
  }

  /// A state that is kept for the way back: without its motion, and skins where there are any.
  class KeptState
  {
  public:
    KeptState() = default;
    explicit KeptState(WorkpieceState<3, double> state)
        : state_(without_motion(std::move(state))), skin_(std::exchange(state_.skin, {}))
    {
    }

    WorkpieceState<3, double> get() const
    {
      WorkpieceState<3, double> state = state_;
      state.skin                      = skin_.all();
      return state;
    }

  private:
    WorkpieceState<3, double> state_;
    KeptSkins                 skin_;
  };

  /// Returns whether an objective, and what came after, take nothing from a field.
  template <typename Value>
  bool is_zero(const std::vector<Value> &field)
  {
    return std::all_of(field.begin(), field.end(), [](const Value &x) { return x == Value(); });
  }
  inline bool is_zero(const NodeSkins<double> &skins)
  {
    return is_zero(skins.metal) &&
           std::all_of(skins.dies.begin(), skins.dies.end(), [](const auto &die) { return is_zero(die); });
  }
} // namespace retroforge
