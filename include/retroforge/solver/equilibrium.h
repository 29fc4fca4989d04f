// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_areas.h>
#include <retroforge/contact/interface_law.h>
#include <retroforge/contact/surface_rates.h>
#include <retroforge/discretization/field.h>
#include <retroforge/element/semi_analytic.h>
#include <retroforge/material/heat_law.h>
#include <retroforge/material/material.h>

#include <optional>

namespace retroforge
{
  /// What does not move: the mesh, the spaces on it, and the shapes of the dies.
  struct Scene
  {
    TetMesh           mesh;
    Topology          topology;
    Discretization<3> discretization;
    std::vector<Die>  dies;

    Scene(TetMesh made_mesh, const DiscretizationChoice &choice, std::vector<Die> dies, MPI_Comm comm)
        : mesh(std::move(made_mesh))
        , topology(mesh)
        , discretization(mesh, choice, comm)
        , dies(std::move(dies))
    {
    }
    Scene(const Scene &) = delete; // a discretisation is not copied

    /// Whether what acts on a point acts on a velocity of this rank.
    bool sees(const ContactPoint &point) const
    {
      bool seen = false;
      for (unsigned int i = 0; i < point.n_velocity_nodes(); ++i)
        seen = seen || discretization.owns(point.velocity_node_at(i));
      return seen;
    }

    /// With dies and nodes there. What is passed must live as long.
    /// @param velocity  of the nodes in the increment before; null or empty where it is not known
    template <typename Number>
    ContactView<Number> view(const std::vector<DieState<Number>> &states,
                             const NodalVectors<Number>          &X,
                             const NodalVectors<Number>          *velocity = nullptr) const
    {
      return {mesh, topology, dies, states, X, discretization.middles(), discretization.comm(), velocity};
    }
  };

  /// The numbers of the laws and the state of the dies during one increment.
  template <typename Number>
  struct Physics
  {
    Material<Number>              material;
    ContactLaw<Number>            contact;
    std::vector<DieState<Number>> dies;
    HeatLaw<Number>               heat = {};

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[material, contact, dies, heat] = self;
      return std::tie(material, contact, dies, heat);
    }
  };

  /// Zero derivatives in the states of dies, their vertices included.
  std::vector<DieState<double>> no_derivatives(const std::vector<Die> &dies);

  /// Derivatives of a scalar in what Physics holds, in the increment's times (dt, approach time, and the time
  /// at its start), and in the state of the metal in each cell, of the cells this rank owns; empty: none.
  struct PhysicsBar : Physics<double>
  {
    double                          dt = 0., tau = 0., time = 0.;
    std::vector<PointState<double>> points;

    explicit PhysicsBar(const std::vector<Die> &dies) { this->dies = no_derivatives(dies); }
  };

  /// Which pairs are pressed.
  using ActiveSet = std::vector<char>;

  /// A set that is given, as a replay has it, or none: then the velocity decides. Refers to the set.
  class ActiveChoice
  {
  public:
    ActiveChoice() = default;
    ActiveChoice(const ActiveSet &given) : given_(&given) {}
    ActiveChoice(const std::optional<ActiveSet> &given) : given_(given ? &*given : nullptr) {}

    bool             is_given() const { return given_ != nullptr; }
    const ActiveSet &operator*() const { return *given_; }

    /// Returns whether it may be a choice between so many pairs.
    bool fits(const std::size_t n_pairs) const { return !given_ || given_->size() == n_pairs; }

  private:
    const ActiveSet *given_ = nullptr;
  };

  /// Metal in its initial state.
  template <typename Number>
  const std::vector<PointState<Number>> &initial_points()
  {
    static const std::vector<PointState<Number>> none;
    return none;
  }

  /// Equilibrium at given positions: the sums over cells and contact nodes of value, residual, tangent data,
  /// and their reverse. Entries of results are right on owned nodes and in visited cells;
  /// Field::update_ghosts completes them.
  template <typename Number>
  class Equilibrium
  {
  public:
    /// What is passed must live as long.
    /// @param points  state of the metal in each cell; empty: that before the stroke
    Equilibrium(const Scene                           &scene,
                const Physics<Number>                 &physics,
                const ContactSet<Number>              &contact,
                const NodalVectors<Number>            &X,
                const std::vector<PointState<Number>> &points = initial_points<Number>());

    /// The law of the metal in a cell.
    MaterialLaw<Number> law(const CellIndex c) const { return laws_.empty() ? initial_law_ : laws_[c]; }

    /// The state of the metal in a cell.
    PointState<Number> state(CellIndex c) const;

    /// The law of the metal behind pair p, at the mean state of the cells there (contact/surface_rates.h).
    const MaterialLaw<Number> &surface_law(const unsigned int p) const
    {
      return surface_laws_.empty() ? initial_law_ : surface_laws_[p];
    }

    /// The mean state of the cells behind pair p, and these.
    std::pair<PointState<Number>, std::vector<CellIndex>> surface_state(unsigned int p) const;

    /// Pair p as its force sees it, pressed as chosen or by its own h > 0.
    ContactNode<Number>
    contact_node(unsigned int p, const Field<Number> &W, const ActiveChoice &active) const;

    Field<Number> residual(const Field<Number> &W, const ActiveChoice &active) const;

    /// Deformation and friction power [mJ/s], this rank's part of the sums.
    std::pair<Number, Number> power(const Field<Number> &W, const ActiveChoice &active) const;

    /// Whether the residual is the gradient of a power functional in V, and the Newton matrix symmetric:
    /// where the friction of all dies is.
    bool has_potential() const;

    /// Whether forces are proportional to velocities, but for what is pressed: the metal's, and the friction of
    /// all dies.
    bool is_linear() const;

    /// Which pairs are pressed: those with h > 0, and what they hold (ContactSet::middles_around).
    ActiveSet decide_active(const Field<Number> &W) const;

    const Scene                           &scene;
    const Physics<Number>                 &physics;
    const ContactSet<Number>              &contact;
    const NodalVectors<Number>            &X;
    const std::vector<PointState<Number>> &points;
    ContactAreas<Number>                   areas;

  private:
    MaterialLaw<Number>              initial_law_;
    std::vector<MaterialLaw<Number>> laws_;         ///< in the cells this rank visits, where they differ
    std::vector<MaterialLaw<Number>> surface_laws_; ///< of each pair; empty: that of the initial state
  };

  /// Sum over the nodes of the norms of the cells' forces, the scale a residual is measured against, as a
  /// root of squares over nodes: (momentum [N], continuity [mm^3/s]).
  std::pair<double, double> residual_scale(const Equilibrium<double> &stage, const Field<double> &W);

  /// Force of each die on the workpiece [N], contact and friction.
  std::vector<Vec3>
  die_forces(const Equilibrium<double> &stage, const Field<double> &W, const ActiveSet &active);

  /// The equilibrium of bubbles at given velocities of the nodes and P, in the cells this rank visits; they
  /// start where they are.
  void solve_bubbles(const Equilibrium<double> &stage, Field<double> &W);

  /// The same from the velocities at nodes and P alone: bubbles start from nothing.
  void recover_bubbles(const Equilibrium<double> &stage, Field<double> &W);

  /// A stage and its solution.
  template <typename Number>
  struct EquilibriumView
  {
    const Equilibrium<Number> &stage;
    const Field<Number>       &W;
    const ActiveSet           &active;
    double                     weight = 1.; ///< in integrals over the increment
  };

  /// Where derivatives go. Sums are this rank's part, completed by the caller once per increment.
  struct EquilibriumBar
  {
    Field<double>        &W;
    NodalVectors<double> &X; ///< positions of the stage
    ContactSetBar        &contact;
    PhysicsBar           &physics;
    ShapeDerivatives      shape = {}; ///< how derivatives of cells in X are found
  };

  /// Reverse of Equilibrium::law(): adds the derivatives in the numbers of the metal and in the state of a cell.
  /// @param law_bar  derivatives in the law of the cell
  void reverse_law(const Equilibrium<double> &stage,
                   CellIndex                  c,
                   const MaterialLaw<double> &law_bar,
                   PhysicsBar                &bar);

  /// The same of Equilibrium::surface_law().
  void reverse_surface_law(const Equilibrium<double> &stage,
                           unsigned int               p,
                           const MaterialLaw<double> &law_bar,
                           PhysicsBar                &bar);

  /// Adds the derivatives of  lambda·residual  at fixed W to all but bar.W.
  void
  reverse_residual(const EquilibriumView<double> &view, const Field<double> &lambda, EquilibriumBar &bar);

  /// Adds the derivatives of  deformation * (deformation power) + friction * (friction power).
  void reverse_power(const EquilibriumView<double> &view,
                     double                         deformation,
                     double                         friction,
                     EquilibriumBar                &bar);

  template <typename Number>
  Equilibrium<Number>::Equilibrium(const Scene                           &scene,
                                   const Physics<Number>                 &physics,
                                   const ContactSet<Number>              &contact,
                                   const NodalVectors<Number>            &X,
                                   const std::vector<PointState<Number>> &points)
      : scene(scene)
      , physics(physics)
      , contact(contact)
      , X(X)
      , points(points)
      , areas(contact_areas(scene.mesh, scene.topology, contact, X)) // asks for a position of each node
      , initial_law_(physics.material.initial_law())
  {
    Assert(physics.dies.size() == scene.dies.size(),
           dealii::ExcDimensionMismatch(physics.dies.size(), scene.dies.size()));
    Assert(contact.ramps.size() == contact.pairs.size(),
           dealii::ExcDimensionMismatch(contact.ramps.size(), contact.pairs.size()));
    Assert(points.size() == scene.mesh.n_cells() || (points.empty() && !physics.material.depends_on_state()),
           dealii::ExcDimensionMismatch(points.size(), scene.mesh.n_cells()));
    if (!points.empty() && physics.material.depends_on_state())
    {
      laws_.resize(points.size());
      for (const CellIndex c : scene.discretization.visited_cells())
        laws_[c] = physics.material.at(points[c]);
    }
    if (physics.material.depends_on_state())
      for (unsigned int p = 0; p < contact.pairs.size(); ++p)
        surface_laws_.push_back(physics.dies[contact.pairs[p].die].rubs()
                                  ? physics.material.at(surface_state(p).first)
                                  : initial_law_);
  }

  template <typename Number>
  PointState<Number> Equilibrium<Number>::state(const CellIndex c) const
  {
    return points.empty() ? physics.material.initial : points[c];
  }
} // namespace retroforge
