// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>

#include <retroforge/core/error.h>
#include <retroforge/discretization/discretization.h>
#include <retroforge/element/fe_simplex_hat.h>
#include <retroforge/mesh/symmetry_directions.h>

#include <algorithm>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::unique_ptr<FiniteElement<dim>> velocity_element(const ElementPair pair)
    {
      if (pair == ElementPair::taylor_hood)
        return std::make_unique<FESystem<dim>>(FE_SimplexP<dim>(2), dim);
      return std::make_unique<FESystem<dim>>(FE_SimplexHat<dim>(), dim);
    }

    template <int dim>
    ReferenceElement<dim> reference_element(const DiscretizationChoice &choice)
    {
      return choice.pair == ElementPair::mini
               ? mini_reference<dim>(choice.geometry_degree, choice.kinematics)
               : taylor_hood_reference<dim>(choice.geometry_degree, choice.kinematics);
    }

    /// How near the axis metal is on it, over the largest radius.
    constexpr double axis_tolerance = 1e-10;

    template <int dim>
    double largest_radius(const SimplexMesh<dim> &mesh)
    {
      double largest = 0.;
      for (const auto &x : mesh.X)
        largest = std::max(largest, std::abs(x[0]));
      return largest;
    }

    /// The choice, if it can be had on the mesh.
    template <int dim>
    const DiscretizationChoice &checked(const DiscretizationChoice &choice, const SimplexMesh<dim> &mesh)
    {
      check_choice<dim>(choice);
      if (choice.kinematics != Kinematics::axisymmetric)
        return choice;
      const double bound = -axis_tolerance * largest_radius(mesh);
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
        if (mesh.X[k][0] < bound)
          throw Error("Mesh of an axisymmetric flow, node " + std::to_string(k),
                      "has the radius " + as_text(mesh.X[k][0]),
                      "the coordinate x is the distance from the axis, which is not negative",
                      "cut the section at the axis, or shift it");
      return choice;
    }

    /// The cell's index in the mesh.
    template <typename Cell>
    CellIndex index_of(const Cell &cell)
    {
      return cell->id().get_coarse_cell_id();
    }

    /// The vertices that a line of a cell joins, by their numbers in the mesh.
    template <int dim, typename Cell>
    MiddleNodes::Ends ends_of_line(const SimplexMesh<dim> &mesh, const Cell &cell, const unsigned int line)
    {
      const auto node_of = [&](const unsigned int vertex_index) {
        for (const unsigned int a : cell->vertex_indices())
          if (cell->vertex_index(a) == vertex_index)
            return mesh.cells[index_of(cell)][a];
        Assert(false, ExcInternalError());
        return invalid_index;
      };
      const NodeIndex a = node_of(cell->line(line)->vertex_index(0)),
                      b = node_of(cell->line(line)->vertex_index(1));
      return {{std::min(a, b), std::max(a, b)}};
    }
  } // namespace

  template <int dim>
  void check_choice(const DiscretizationChoice &choice)
  {
    const bool in_space = choice.kinematics == Kinematics::three_dimensions;
    if (in_space != (dim == 3))
      throw Error("Discretization/kinematics",
                  in_space ? "three-dimensional on a plane mesh" : "of a plane flow on a mesh in space",
                  "the flow must be one of the mesh's dimension",
                  dim == 2 ? "take plane strain or axisymmetric" : "take three-dimensional kinematics");
    if (choice.geometry_degree < 1 || choice.geometry_degree > 2)
      throw Error("Discretization/geometry degree",
                  "is " + std::to_string(choice.geometry_degree),
                  "positions are linear or quadratic on a cell",
                  "set it to 1 or 2");
    if (choice.assembly == Assembly::quadrature)
      return;
    if (dim == 2)
      throw Error("Discretization/assembly",
                  "is closed form on a plane mesh",
                  "closed forms are of tetrahedra",
                  "set assembly = quadrature");
    if (choice.geometry_degree > 1)
      throw Error("Discretization/geometry degree",
                  "is 2 with Discretization/assembly = closed form",
                  "closed forms know a cell by its corners",
                  "set assembly = quadrature, or geometry degree = 1");
  }

  template <int dim>
  Discretization<dim>::Discretization(const SimplexMesh<dim>     &mesh,
                                      const DiscretizationChoice &choice,
                                      const MPI_Comm              comm)
      : choice_(checked(choice, mesh))
      , comm_(comm)
      , n_vertices_(mesh.n_nodes())
      , triangulation_(distributed_triangulation(mesh, choice.triangulation, comm))
      , velocity_dofs_(*triangulation_)
      , pressure_dofs_(*triangulation_)
  {
    const auto             element = velocity_element<dim>(choice.pair);
    const FE_SimplexP<dim> geometry(choice.geometry_degree); // of each component
    if (element->dofs_per_line > 0 || geometry.dofs_per_line > 0)
      number_edges(mesh);
    if (choice.assembly == Assembly::quadrature)
      quadrature_ = std::make_unique<const ReferenceElement<dim>>(reference_element<dim>(choice));
    places_per_cell_    = element->dofs_per_cell / dim;
    nodes_per_cell_     = places_per_cell_ - (has_bubbles() ? 1 : 0);
    positions_per_cell_ = geometry.dofs_per_cell;

    std::vector<CellIndex> own_cells;
    for (const auto &cell : triangulation_->active_cell_iterators())
      if (cell->is_locally_owned())
        own_cells.push_back(index_of(cell));
    std::sort(own_cells.begin(), own_cells.end());
    cells_ = ReplicatedEntries(own_cells, mesh.n_cells(), comm);

    const std::vector<NodeIndex> velocities = distribute(mesh, *element, velocity_dofs_),
                                 pressures  = distribute(mesh, FE_SimplexP<dim>(1), pressure_dofs_);
    if (choice.geometry_degree > 1)
    {
      quadratic_geometry_dofs_ = std::make_unique<DoFHandler<dim>>(*triangulation_);
      distribute(mesh, geometry, *quadratic_geometry_dofs_);
    }
    visit_cells(mesh, velocities);

    std::vector<NodeIndex> read            = nodes_read(mesh);
    const auto             without_bubbles = [&](const std::vector<NodeIndex> &nodes) {
      std::vector<NodeIndex> rest;
      std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(rest), [&](const NodeIndex k) {
        return k < n_nodes();
      });
      return rest;
    };
    condensed_nodes_ = velocity_nodes_ = std::make_shared<const NodeNumbering>(
      dim, velocities, read, n_nodes() + (has_bubbles() ? mesh.n_cells() : 0), comm);
    if (has_bubbles())
      condensed_nodes_ = std::make_shared<const NodeNumbering>(
        dim, without_bubbles(velocities), without_bubbles(read), n_nodes(), comm);
    read.clear();
    for (const CellIndex c : visited_)
      read.insert(read.end(), mesh.cells[c].begin(), mesh.cells[c].end());
    pressure_nodes_ = std::make_shared<const NodeNumbering>(1, pressures, read, n_vertices_, comm);
    make_tables(mesh);
    constrain(mesh);
  }

  template <int dim>
  void Discretization<dim>::number_edges(const SimplexMesh<dim> &mesh)
  {
    std::vector<MiddleNodes::Ends> ends;
    for (const auto &cell : triangulation_->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int line : cell->line_indices())
          ends.push_back(ends_of_line(mesh, cell, line));
    const MiddleNodes own(n_vertices_, std::move(ends));
    ends.clear();
    for (const auto &of_rank : Utilities::MPI::all_gather(comm_, own.ends()))
      ends.insert(ends.end(), of_rank.begin(), of_rank.end());
    edges_ = MiddleNodes(n_vertices_, std::move(ends));
  }

  template <int dim>
  std::vector<NodeIndex> Discretization<dim>::nodes_of(const SimplexMesh<dim>   &mesh,
                                                       const FiniteElement<dim> &element,
                                                       const Cell               &cell) const
  {
    const CellIndex        c = index_of(cell);
    std::vector<NodeIndex> nodes(mesh.cells[c].begin(), mesh.cells[c].end());
    if (element.dofs_per_line > 0)
      for (const unsigned int line : cell->line_indices())
      {
        const auto [a, b] = ends_of_line(mesh, cell, line);
        nodes.push_back(edges_.between(a, b));
      }
    if (element.template n_dofs_per_object<dim>() > 0)
      nodes.push_back(n_nodes() + c);
    return nodes;
  }

  template <int dim>
  std::vector<NodeIndex> Discretization<dim>::distribute(const SimplexMesh<dim>   &mesh,
                                                         const FiniteElement<dim> &element,
                                                         DoFHandler<dim>          &dofs) const
  {
    dofs.distribute_dofs(element);
    const IndexSet &own = dofs.locally_owned_dofs();
    AssertThrow(own.is_contiguous(), ExcInternalError());
    const unsigned int width = element.n_components(), n_own = own.n_elements();
    const auto         begin = n_own > 0 ? own.nth_index_in_set(0) : 0;

    std::vector<std::pair<NodeIndex, unsigned int>> node_and_component(n_own);
    std::vector<types::global_dof_index>            of_cell(element.dofs_per_cell);
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
      {
        const auto nodes = nodes_of(mesh, element, cell);
        cell->get_dof_indices(of_cell);
        for (unsigned int i = 0; i < of_cell.size(); ++i)
          if (own.is_element(of_cell[i]))
          {
            const auto [component, shape]          = element.system_to_component_index(i);
            node_and_component[of_cell[i] - begin] = {nodes[shape], component};
          }
      }
    std::vector<NodeIndex> owned;
    for (const auto &[node, component] : node_and_component)
      if (component == 0)
        owned.push_back(node);
    std::sort(owned.begin(), owned.end());
    AssertThrow(owned.size() * width == n_own, ExcDimensionMismatch(owned.size() * width, n_own));

    std::vector<types::global_dof_index> numbers;
    numbers.reserve(n_own);
    for (const auto &[node, component] : node_and_component)
    {
      const auto at = std::lower_bound(owned.begin(), owned.end(), node) - owned.begin();
      numbers.push_back(begin + width * at + component);
    }
    dofs.renumber_dofs(numbers);
    return owned;
  }

  template <int dim>
  void Discretization<dim>::visit_cells(const SimplexMesh<dim> &mesh, const std::vector<NodeIndex> &owned)
  {
    const auto is_owned = [&](const NodeIndex k) {
      return std::binary_search(owned.begin(), owned.end(), k);
    };
    std::vector<std::pair<CellIndex, Cell>> visited;
    for (const auto &cell : velocity_dofs_.active_cell_iterators())
      if (!cell->is_artificial())
      {
        const auto nodes = nodes_of(mesh, velocity_dofs_.get_fe(), cell);
        if (cell->is_locally_owned() || std::any_of(nodes.begin(), nodes.end(), is_owned))
          visited.emplace_back(index_of(cell), cell);
      }
    std::sort(visited.begin(), visited.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    const auto append = [&](const FiniteElement<dim> &element, const Cell &cell, std::vector<NodeIndex> &to) {
      const auto nodes = nodes_of(mesh, element, cell);
      to.insert(to.end(), nodes.begin(), nodes.end());
    };
    visited_.reserve(visited.size());
    nodes_of_visited_.reserve(places_per_cell_ * visited.size());
    geometry_nodes_.reserve(positions_per_cell_ * visited.size());
    for (const auto &[c, cell] : visited)
    {
      visited_.push_back(c);
      append(velocity_dofs_.get_fe(), cell, nodes_of_visited_);
      append(geometry_dofs().get_fe(), cell, geometry_nodes_);
    }
    if (visited_.size() == mesh.n_cells())
      return;
    place_of_cell_.assign(mesh.n_cells(), invalid_index);
    for (unsigned int i = 0; i < visited_.size(); ++i)
      place_of_cell_[visited_[i]] = i;
  }

  template <int dim>
  std::vector<NodeIndex> Discretization<dim>::nodes_read(const SimplexMesh<dim> &mesh) const
  {
    // Each rank decides of all contacts: the velocities of the whole surface are read by all.
    std::vector<NodeIndex> read = nodes_of_visited_;
    for (const SimplexFace<dim> &face : mesh.faces)
      if (mesh.is_surface(face))
        for (unsigned int i = 0; i < dim; ++i)
        {
          read.push_back(face.nodes[i]);
          for (unsigned int j = 0; j < i && middles(); ++j)
            read.push_back(edges_.between(face.nodes[i], face.nodes[j]));
        }
    return read;
  }

  template <int dim>
  void Discretization<dim>::make_tables(const SimplexMesh<dim> &mesh)
  {
    velocity_places_.reserve(nodes_of_visited_.size());
    for (const NodeIndex k : nodes_of_visited_)
      velocity_places_.push_back(velocity_nodes_->place(k));
    nodes_of_visited_ = std::vector<NodeIndex>(); // gives its memory back
    pressure_places_.reserve((dim + 1) * visited_.size());
    for (const CellIndex c : visited_)
      for (const NodeIndex k : mesh.cells[c])
        pressure_places_.push_back(pressure_nodes_->place(k));
  }

  namespace
  {
    /// Solves  d·v = 0  for the components of v where the directions are largest.
    /// @param fixed  orthonormal; turned into rows with an entry of one, the pivot, where others have zero
    /// @return the pivots
    template <int dim>
    std::vector<unsigned int> eliminate(std::vector<Tensor<1, dim>> &fixed)
    {
      std::vector<unsigned int> pivots;
      for (unsigned int i = 0; i < fixed.size(); ++i)
      {
        unsigned int pivot = 0;
        for (unsigned int d = 1; d < dim; ++d)
          if (std::abs(fixed[i][d]) > std::abs(fixed[i][pivot]))
            pivot = d;
        fixed[i] /= fixed[i][pivot];
        for (unsigned int j = 0; j < fixed.size(); ++j)
          if (j != i)
          {
            fixed[j] -= fixed[j][pivot] * fixed[i];
            fixed[j][pivot] = 0.;
          }
        pivots.push_back(pivot);
      }
      return pivots;
    }
  } // namespace

  template <int dim>
  void Discretization<dim>::constrain(const SimplexMesh<dim> &mesh)
  {
    const auto nodes_of_face = [&](const SimplexFace<dim> &face) {
      std::vector<NodeIndex> nodes(face.nodes.begin(), face.nodes.end());
      for (unsigned int i = 0; i < dim && middles(); ++i)
        for (unsigned int j = 0; j < i; ++j)
          nodes.push_back(edges_.between(face.nodes[i], face.nodes[j]));
      return nodes;
    };
    const auto  directions  = symmetry_directions(mesh, condensed_nodes_->n(), nodes_of_face);
    const auto &partitioner = *velocity_nodes_->partitioner();
    IndexSet    here        = partitioner.locally_owned_range();
    here.add_indices(partitioner.ghost_indices());
    symmetry_.reinit(here);
    const auto is_near_axis = [&, bound = axis_tolerance * largest_radius(mesh)](const NodeIndex vertex) {
      return std::abs(mesh.X[vertex][0]) <= bound;
    };
    const auto on_axis = [&](const NodeIndex k) {
      if (choice_.kinematics != Kinematics::axisymmetric)
        return false;
      if (k < n_vertices_)
        return is_near_axis(k);
      const auto [a, b] = edges_.ends_of(k);
      return is_near_axis(a) && is_near_axis(b);
    };
    Tensor<1, dim> away;
    away[0] = 1.;
    for (unsigned int place = 0; place < condensed_nodes_->n_places(); ++place)
    {
      const NodeIndex             k = condensed_nodes_->node_at(place);
      std::vector<Tensor<1, dim>> fixed(directions[k].begin(), directions[k].end());
      if (on_axis(k))
        orthonormalise_into<dim>(fixed, 0, away);
      if (!fixed.empty())
      {
        const auto pivots = eliminate<dim>(fixed);
        const auto dof    = [&](const unsigned int d) {
          return partitioner.local_to_global(dim * velocity_nodes_->place(k) + d);
        };
        for (unsigned int i = 0; i < fixed.size(); ++i)
        {
          symmetry_.add_line(dof(pivots[i]));
          for (unsigned int d = 0; d < dim; ++d)
            if (d != pivots[i] && fixed[i][d] != 0.)
              symmetry_.add_entry(dof(pivots[i]), dof(d), -fixed[i][d]);
          orthonormalise_into<dim>(fixed_directions_.entries, fixed_directions_.begin.back(), fixed[i]);
        }
      }
      fixed_directions_.begin.push_back(fixed_directions_.entries.size());
    }
    symmetry_.close();
  }

  template <int dim>
  double Discretization<dim>::sum(const double x) const
  {
    return Utilities::MPI::sum(x, comm_);
  }

  template void check_choice<2>(const DiscretizationChoice &);
  template void check_choice<3>(const DiscretizationChoice &);
  template class Discretization<2>;
  template class Discretization<3>;
} // namespace retroforge
