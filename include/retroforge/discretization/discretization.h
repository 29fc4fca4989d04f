// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>

#include <retroforge/core/rows.h>
#include <retroforge/discretization/middle_nodes.h>
#include <retroforge/discretization/node_numbering.h>
#include <retroforge/discretization/triangulation.h>
#include <retroforge/element/reference_element.h>

#include <memory>

namespace retroforge
{
  /// Pairs of finite elements for velocity and pressure.
  enum class ElementPair
  {
    mini,       ///< P1 and a bubble; P1  (element/mini_element.h)
    taylor_hood ///< P2; P1  (element/taylor_hood.h)
  };

  /// The way in which integrals over cells are computed.
  enum class Assembly
  {
    closed_form, ///< by the kernels of the pair
    quadrature   ///< by those of any element (element/quadrature_cell.h), which are slower
  };

  /// The choices that define a discretisation, besides the mesh.
  struct DiscretizationChoice
  {
    ElementPair       pair          = ElementPair::mini;
    TriangulationKind triangulation = TriangulationKind::by_ranks;
    Assembly          assembly      = Assembly::closed_form;
    Kinematics        kinematics    = Kinematics::three_dimensions;
    /// Of positions as functions on a cell. Of degree 2 they have nodes in the middles of edges, too.
    unsigned int geometry_degree = 1;
  };

  /// Checks that the choice can be had in dim dimensions: three-dimensional kinematics there and the others
  /// in the plane; closed forms of tetrahedra only, and of straight ones.
  /// @throws Error  if it cannot
  template <int dim>
  void check_choice(const DiscretizationChoice &choice);

  /// A mesh and the spaces on it, as deal.II defines them: a triangulation whose cells METIS gives to ranks;
  /// the velocities, FESystem(FE_SimplexHat, dim) or FESystem(FE_SimplexP(2), dim), the pressures,
  /// FE_SimplexP(1), each with its DoFHandler, and the positions, each component of FE_SimplexP(k) with the
  /// degree k of the choice; and the constraints of the symmetry planes. Made anew for each mesh of a run.
  ///
  /// Of an axisymmetric flow the axis is the line x = 0, which needs no plane of symmetry: nodes on it do not
  /// move away from it.
  ///
  /// Kernels work on tables that are taken from these once. Cells have the index of the mesh. This rank
  /// *visits* the cells that touch one of its nodes, and keeps what falls on its own nodes, so that sums are
  /// formed in the same order on any number of ranks.
  template <int dim>
  class Discretization
  {
  public:
    /// @param mesh  the same on all ranks, its cells sound (deal.II does not look)
    /// Collective.
    /// @throws Error  if the choice cannot be had, or metal lies beyond the axis
    Discretization(const SimplexMesh<dim> &mesh, const DiscretizationChoice &choice, MPI_Comm comm);

    /// @name deal.II's objects
    /// @{
    const dealii::Triangulation<dim> &triangulation() const { return *triangulation_; }
    const dealii::DoFHandler<dim>    &velocity_dofs() const { return velocity_dofs_; }
    const dealii::DoFHandler<dim>    &pressure_dofs() const { return pressure_dofs_; }
    /// Of each component of the positions. Linear ones are as pressures are, whose degrees of freedom serve
    /// here, too.
    const dealii::DoFHandler<dim> &geometry_dofs() const
    {
      return quadratic_geometry_dofs_ ? *quadratic_geometry_dofs_ : pressure_dofs_;
    }
    /// v·n = 0 on the planes of symmetry, v_r = 0 on an axis, of the velocities that this rank owns or reads.
    const dealii::AffineConstraints<double> &symmetry() const { return symmetry_; }
    /// @}

    ElementPair pair() const { return choice_.pair; }
    MPI_Comm    comm() const { return comm_; }
    /// The pair at the points of a quadrature rule; null where cells are integrated in closed form.
    const ReferenceElement<dim> *quadrature() const { return quadrature_.get(); }

    /// @name Nodes
    /// @{
    /// Nodes of the velocities, bubbles last.
    const std::shared_ptr<const NodeNumbering> &velocity_nodes() const { return velocity_nodes_; }
    /// Nodes of the velocities without bubbles, which are eliminated in their cells: the nodes of matrices.
    /// This rank's nodes have the same places in both numberings.
    const std::shared_ptr<const NodeNumbering> &condensed_nodes() const { return condensed_nodes_; }
    const std::shared_ptr<const NodeNumbering> &pressure_nodes() const { return pressure_nodes_; }
    unsigned int                                n_vertices() const { return n_vertices_; }
    /// Returns whether a velocity node is this rank's.
    bool owns(const NodeIndex k) const { return velocity_nodes_->owns(k); }
    /// Null where velocities are linear.
    const MiddleNodes *middles() const { return choice_.pair == ElementPair::mini ? nullptr : &edges_; }
    bool               has_bubbles() const { return choice_.pair == ElementPair::mini; }
    /// The velocity node of a cell's bubble.
    NodeIndex bubble(const CellIndex c) const { return condensed_nodes_->n() + c; }
    /// Orthonormal directions in which symmetry planes hold the velocity at a place of condensed_nodes(), as
    /// symmetry() says.
    dealii::ArrayView<const dealii::Tensor<1, dim>> fixed_directions(const unsigned int place) const
    {
      return fixed_directions_[place];
    }
    /// @}

    /// @name Cells
    /// @{
    const ReplicatedEntries &cells() const { return cells_; }
    /// Cells that touch a node of this rank, ascending.
    const std::vector<CellIndex> &visited_cells() const { return visited_; }
    /// Velocity nodes of a cell without its bubble.
    unsigned int n_nodes_per_cell() const { return nodes_per_cell_; }
    /// Places of a visited cell's velocities: at the vertices, then in the middles of the edges or of the
    /// bubble, as the element of velocity_dofs() has them.
    const unsigned int *velocity_places(const CellIndex c) const
    {
      return &velocity_places_[places_per_cell_ * place_of_cell(c)];
    }
    /// Places of a visited cell's pressures, at its vertices.
    const unsigned int *pressure_places(const CellIndex c) const
    {
      return &pressure_places_[(dim + 1) * place_of_cell(c)];
    }
    /// Nodes of the positions of a visited cell: its vertices, then the middles of its edges where the
    /// geometry is quadratic, as the element of geometry_dofs() has them.
    const NodeIndex *geometry_nodes(const CellIndex c) const
    {
      return &geometry_nodes_[positions_per_cell_ * place_of_cell(c)];
    }
    /// Returns the vertices between which a node of the positions is that is none.
    const MiddleNodes::Ends &ends_of_geometry_node(const NodeIndex k) const { return edges_.ends_of(k); }
    /// Returns the position of a visited cell in visited_cells().
    unsigned int place_of_cell(const CellIndex c) const
    {
      const unsigned int place = place_of_cell_.empty() ? c : place_of_cell_[c];
      Assert(place != invalid_index, dealii::ExcMessage("this rank does not visit the cell"));
      return place;
    }
    /// @}

    /// Sum over ranks of one number per rank.
    double sum(double x) const;

  private:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /// Nodes of a local cell in the order of an element's scalar shape functions.
    std::vector<NodeIndex>
    nodes_of(const SimplexMesh<dim> &mesh, const dealii::FiniteElement<dim> &element, const Cell &cell) const;
    void number_edges(const SimplexMesh<dim> &mesh);
    /// Of velocities, without bubbles.
    unsigned int n_nodes() const { return n_vertices_ + (middles() ? middles()->size() : 0); }
    /// Numbers a handler's degrees of freedom by nodes, and returns the nodes of this rank.
    std::vector<NodeIndex> distribute(const SimplexMesh<dim>           &mesh,
                                      const dealii::FiniteElement<dim> &element,
                                      dealii::DoFHandler<dim>          &dofs) const;
    void                   visit_cells(const SimplexMesh<dim> &mesh, const std::vector<NodeIndex> &owned);
    std::vector<NodeIndex> nodes_read(const SimplexMesh<dim> &mesh) const;
    void                   make_tables(const SimplexMesh<dim> &mesh);
    void                   constrain(const SimplexMesh<dim> &mesh);

    DiscretizationChoice choice_;
    MPI_Comm             comm_;
    unsigned int         n_vertices_, nodes_per_cell_, places_per_cell_, positions_per_cell_;
    std::unique_ptr<dealii::Triangulation<dim>> triangulation_;
    dealii::DoFHandler<dim>                     velocity_dofs_, pressure_dofs_;
    std::unique_ptr<dealii::DoFHandler<dim>>    quadratic_geometry_dofs_; ///< null where positions are linear
    std::unique_ptr<const ReferenceElement<dim>> quadrature_;
    MiddleNodes                                  edges_; ///< where a space has nodes in their middles
    ReplicatedEntries                            cells_;
    std::vector<CellIndex>                       visited_;
    std::vector<NodeIndex>                       nodes_of_visited_; ///< velocities, numbers
    std::vector<unsigned int>            place_of_cell_; ///< among the visited ones; empty: the cell's index
    std::shared_ptr<const NodeNumbering> velocity_nodes_, condensed_nodes_, pressure_nodes_;
    std::vector<unsigned int>            velocity_places_, pressure_places_;
    std::vector<NodeIndex>               geometry_nodes_;
    dealii::AffineConstraints<double>    symmetry_;
    Rows<dealii::Tensor<1, dim>>         fixed_directions_; ///< by place of condensed_nodes()
  };
} // namespace retroforge
