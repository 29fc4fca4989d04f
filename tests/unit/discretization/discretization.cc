// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The spaces of a mesh as deal.II defines them, in three and in two dimensions, for both pairs, on shared and
// fully distributed triangulations, with linear and with quadratic geometry. Proved, on one and on two ranks:
// - the degrees of freedom that a DoFHandler gives to a cell are those of the tables kernels work on, in the
//   order of the element's shape functions; each node has one owner, and rows follow each other rank by rank;
// - nodes of the positions are where the geometry's element has its support points on straight cells, and
// have
//   a degree of freedom for each component;
// - middles of edges are as many as Euler's formula asks for, and those of Topology on the surface;
// - velocities at the nodes meet, in the pattern, as the cells say, and by no cell else;
// - a rank reads the velocities of the whole surface; what is sent to ghosts is what owners know; what is
//   added at ghosts comes together at the owner; complete() and take() are each other's reverse;
// - a field that AffineConstraints complete keeps to planes of symmetry of any orientation, and one that
//   keeps to them is left alone; fixed_directions() span their normals;
// - METIS' parts are of equal size to 10 %.

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <retroforge/discretization/element_pairs.h>
#include <retroforge/mesh/topology.h>
#include <retroforge/solver/velocity_pattern.h>

#include <iostream>
#include <map>
#include <set>

#include "../random_numbers.h"
#include "../remeshing/remeshing_test_tools.h"

using namespace retroforge;

namespace
{
  const MPI_Comm comm = MPI_COMM_WORLD;

  void say(const std::string &what, const bool right)
  {
    const bool everywhere = dealii::Utilities::MPI::min(right ? 1 : 0, comm) == 1;
    if (dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      std::cout << "  " << what << ": " << (everywhere ? "yes" : "NO") << '\n';
  }

  unsigned int sum(const unsigned int n)
  {
    return dealii::Utilities::MPI::sum(n, comm);
  }

  dealii::Tensor<1, 2> direction(const double angle)
  {
    dealii::Tensor<1, 2> n;
    n[0] = -std::cos(angle);
    n[1] = -std::sin(angle);
    return n;
  }

  /// A sheared grid of n x n squares, two triangles each: symmetry lines at its lower and left sides, at 75
  /// degrees to each other.
  SimplexMesh<2> sheared_square(const unsigned int n)
  {
    SimplexMesh<2> mesh;
    const double   shear = std::tan(dealii::numbers::PI / 12.);
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
        mesh.X.push_back(dealii::Point<2>((i + shear * j) / n, double(j) / n));
    mesh.patches  = {{"free", {}},
                     {"lower", Hyperplane<2>{{}, direction(dealii::numbers::PI / 2.)}},
                     {"left", Hyperplane<2>{{}, direction(-dealii::numbers::PI / 12.)}}};
    const auto at = [n](const unsigned int i, const unsigned int j) { return j * (n + 1) + i; };
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        mesh.cells.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
        mesh.cells.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
      }
    for (unsigned int i = 0; i < n; ++i)
    {
      mesh.faces.push_back({{{at(i, 0), at(i + 1, 0)}}, 1});
      mesh.faces.push_back({{{at(n, i), at(n, i + 1)}}, 0});
      mesh.faces.push_back({{{at(i + 1, n), at(i, n)}}, 0});
      mesh.faces.push_back({{{at(0, i + 1), at(0, i)}}, 2});
    }
    return mesh;
  }

  /// A box whose sides x = 0 and z = 0 are planes of symmetry, turned about x by 0.3, then about y by 0.4:
  /// where they meet, constraints of single components are not orthogonal.
  TetMesh turned_box()
  {
    TetMesh mesh      = kuhn_box(4, 0.1);
    mesh.patches      = {{"free", {}}, {"x", Plane{}}, {"z", Plane{}}};
    const auto turned = [](const Vec3 &x) {
      const double y = std::cos(0.3) * x[1] - std::sin(0.3) * x[2],
                   z = std::sin(0.3) * x[1] + std::cos(0.3) * x[2];
      return Vec3({std::cos(0.4) * x[0] + std::sin(0.4) * z, y, -std::sin(0.4) * x[0] + std::cos(0.4) * z});
    };
    for (BoundaryFace &face : mesh.faces)
    {
      const auto on = [&](const unsigned int d) {
        return std::all_of(
          face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) { return mesh.X[k][d] == 0.; });
      };
      face.patch = on(0) ? 1 : on(2) ? 2 : 0;
    }
    mesh.patches[1].symmetry->normal = turned(Vec3({-1., 0., 0.}));
    mesh.patches[2].symmetry->normal = turned(Vec3({0., 0., -1.}));
    for (Vec3 &x : mesh.X)
      x = turned(x);
    return mesh;
  }

  template <int dim>
  void check_tables(const SimplexMesh<dim> &mesh, const Discretization<dim> &discretization)
  {
    bool                                         right = true;
    std::vector<dealii::types::global_dof_index> dofs;
    const auto                                   check =
      [&](const dealii::DoFHandler<dim> &handler, const NodeNumbering &nodes, const auto &places) {
        const auto        &element = handler.get_fe();
        const unsigned int width   = element.n_components();
        dofs.resize(element.dofs_per_cell);
        for (const auto &cell : handler.active_cell_iterators())
        {
          const CellIndex c = cell->is_artificial() ? invalid_index : cell->id().get_coarse_cell_id();
          if (c == invalid_index || !std::binary_search(discretization.visited_cells().begin(),
                                                        discretization.visited_cells().end(),
                                                        c))
            continue;
          cell->get_dof_indices(dofs);
          for (unsigned int i = 0; i < dofs.size(); ++i)
          {
            const auto [component, shape] = element.system_to_component_index(i);
            right =
              right && dofs[i] == nodes.partitioner()->local_to_global(width * places(c)[shape] + component);
          }
          for (unsigned int a = 0; a <= dim; ++a)
            right = right && nodes.node_at(places(c)[a]) == mesh.cells[c][a];
        }
      };
    check(discretization.velocity_dofs(), *discretization.velocity_nodes(), [&](const CellIndex c) {
      return discretization.velocity_places(c);
    });
    check(discretization.pressure_dofs(), *discretization.pressure_nodes(), [&](const CellIndex c) {
      return discretization.pressure_places(c);
    });
    say("a cell's degrees of freedom are those of the tables", right);

    const auto &condensed = *discretization.condensed_nodes();
    bool        rows      = sum(condensed.n_owned()) == condensed.n() &&
                sum(discretization.cells().owned().size()) == mesh.n_cells();
    for (unsigned int place = 0; place < condensed.n_places(); ++place)
      rows = rows && condensed.place_of_index(condensed.index_at(place)) == place &&
             condensed.place(condensed.node_at(place)) == place &&
             condensed.owns(condensed.node_at(place)) == (place < condensed.n_owned()) &&
             discretization.velocity_nodes()->owns(condensed.node_at(place)) == (place < condensed.n_owned());
    say("each node and cell has an owner, each row a node", rows && !condensed.owns(invalid_index));
  }

  template <int dim>
  void check_positions(const SimplexMesh<dim> &mesh, const Discretization<dim> &discretization)
  {
    const auto                    &dofs    = discretization.geometry_dofs();
    const auto                    &element = dofs.get_fe();
    const auto                    &support = element.base_element(0).get_unit_support_points();
    const dealii::FE_SimplexP<dim> linear(1);
    std::map<NodeIndex, dealii::types::global_dof_index> first;
    std::set<dealii::types::global_dof_index>            seen;
    std::vector<dealii::types::global_dof_index>         of_cell(element.dofs_per_cell);
    bool                                                 right = true;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const CellIndex  c     = cell->id().get_coarse_cell_id();
        const NodeIndex *nodes = discretization.geometry_nodes(c);
        cell->get_dof_indices(of_cell);
        for (unsigned int i = 0; i < of_cell.size(); ++i)
        {
          const auto [component, a] = element.system_to_component_index(i);
          const auto dof            = of_cell[i] - component;
          right                     = right && first.emplace(nodes[a], dof).first->second == dof;
          seen.insert(of_cell[i]);
        }
        for (unsigned int a = 0; a < support.size(); ++a)
        {
          auto off = position_of_node(discretization, mesh.X, nodes[a]);
          for (unsigned int b = 0; b <= dim; ++b)
            off -= linear.shape_value(b, support[a]) * mesh.X[mesh.cells[c][b]];
          right = right && off.norm() < 1e-14;
        }
      }
    say("positions are at the nodes of the geometry",
        right && seen.size() == element.n_components() * first.size());
  }

  /// Of a mesh without holes.
  template <int dim>
  void check_middles(const SimplexMesh<dim> &mesh, const Discretization<dim> &discretization)
  {
    const MiddleNodes *middles = discretization.middles();
    if (!middles)
      return;
    const int n_faces = ((dim + 1) * mesh.n_cells() + mesh.faces.size()) / 2,
              euler   = dim == 2 ? static_cast<int>(mesh.n_nodes() + mesh.n_cells()) - n_faces
                                 : static_cast<int>(mesh.n_nodes() + n_faces) -
                                   static_cast<int>(middles->size() + mesh.n_cells());
    bool right        = euler == 1 && (dim == 3 || static_cast<int>(middles->size()) == n_faces) &&
                 std::is_sorted(middles->ends().begin(), middles->ends().end());
    for (std::size_t e = 0; e < middles->size(); ++e)
    {
      const auto [a, b] = middles->ends()[e];
      right             = right && a < b && middles->between(b, a) == mesh.n_nodes() + e;
    }
    right = right && middles->between(0, 0) == invalid_index;
    if constexpr (dim == 3)
      for (const auto &[a, b] : Topology(mesh).surface_edges)
        right = right && middles->between(a, b) != invalid_index;
    say("edges are those of the mesh", right);
  }

  template <int dim>
  void check_pattern(const SimplexMesh<dim> &mesh, const Discretization<dim> &discretization)
  {
    // By hand, from all cells of the mesh.
    const MiddleNodes               *middles = discretization.middles();
    std::vector<std::set<NodeIndex>> met(discretization.condensed_nodes()->n());
    for (const auto &cell : mesh.cells)
    {
      std::vector<NodeIndex> nodes(cell.begin(), cell.end());
      for (unsigned int a = 0; a <= dim && middles; ++a)
        for (unsigned int b = 0; b < a; ++b)
          nodes.push_back(middles->between(cell[a], cell[b]));
      for (const NodeIndex a : nodes)
        met[a].insert(nodes.begin(), nodes.end());
    }
    const auto &nodes   = *discretization.condensed_nodes();
    const auto  pattern = velocity_pattern(discretization);
    bool        right   = pattern.size() == nodes.n_owned();
    for (unsigned int row = 0; row < pattern.size(); ++row)
    {
      std::set<NodeIndex> found;
      for (const unsigned int index : pattern[row])
        found.insert(nodes.node_at(nodes.place_of_index(index)));
      right =
        right && found == met[nodes.node_at(row)] && std::is_sorted(pattern[row].begin(), pattern[row].end());
    }
    say("the pattern is the cells'", right);
  }

  template <int dim>
  dealii::Tensor<1, dim> known(const NodeIndex k)
  {
    dealii::Tensor<1, dim> v;
    for (unsigned int i = 0; i < dim; ++i)
      v[i] = 10. * k + i + 0.5;
    return v;
  }

  /// Whatever rank owns them: each rank decides of all contacts.
  template <int dim>
  void check_surface(const SimplexMesh<dim> &mesh, const Discretization<dim> &discretization)
  {
    bool       right = true;
    const auto reads = [&](const NodeIndex k) {
      return discretization.velocity_nodes()->place(k) != invalid_index;
    };
    for (const auto &face : mesh.faces)
      if (mesh.is_surface(face))
        for (unsigned int i = 0; i < dim; ++i)
        {
          right = right && reads(face.nodes[i]);
          for (unsigned int j = 0; j < i && discretization.middles(); ++j)
            right = right && reads(discretization.middles()->between(face.nodes[i], face.nodes[j]));
        }
    say("all ranks read the velocities of the surface", right);
  }

  template <int dim>
  void check_exchange(const Discretization<dim> &discretization)
  {
    const auto of_both = [](FlowField<dim, double> &field, const auto &f) {
      f(field.V, [](const NodeIndex k) { return known<dim>(k); });
      f(field.P, [](const NodeIndex k) { return 10. * k + 0.25; });
    };
    FlowField<dim, double> field(discretization);
    of_both(field, [](auto &values, const auto &known_at) {
      const NodeNumbering &nodes = *values.numbering();
      for (unsigned int place = 0; place < nodes.n_owned(); ++place)
        values.at_place(place) = known_at(nodes.node_at(place));
    });
    field.update_ghosts();
    bool right = true;
    of_both(field, [&](auto &values, const auto &known_at) {
      for (unsigned int place = 0; place < values.size(); ++place)
        right = right && values.at_place(place) == known_at(values.numbering()->node_at(place));
    });
    const FlowField<dim, double> copy = field;
    right                             = right && std::equal(copy.V.begin(), copy.V.end(), field.V.begin()) &&
            std::equal(copy.P.begin(), copy.P.end(), field.P.begin());
    say("ghosts and copies are what owners know", right);

    // Each rank that has a node adds one more than its number.
    const auto                       rank = dealii::Utilities::MPI::this_mpi_process(comm);
    std::vector<std::vector<double>> sums;
    of_both(field, [&](auto &values, const auto &known_at) {
      const NodeNumbering &nodes = *values.numbering();
      sums.emplace_back(nodes.n(), 0.);
      for (unsigned int place = 0; place < nodes.n_places(); ++place)
      {
        const NodeIndex k      = nodes.node_at(place);
        values.at_place(place) = (rank + 1.) * known_at(k);
        sums.back()[k]         = rank + 1.;
      }
      dealii::Utilities::MPI::sum(sums.back(), comm, sums.back());
    });
    field.sum_ghosts();
    right      = true;
    auto whole = sums.begin();
    of_both(field, [&](auto &values, const auto &known_at) {
      for (unsigned int place = 0; place < values.size(); ++place)
      {
        const NodeIndex k = values.numbering()->node_at(place);
        right             = right && values.at_place(place) == (*whole)[k] * known_at(k);
      }
      ++whole;
    });
    say("sums come together", right);

    const auto            &nodes     = *discretization.velocity_nodes();
    const auto            &condensed = *discretization.condensed_nodes();
    FlowField<dim, double> again(discretization);
    const auto             all = copy.V.complete(condensed);
    again.V.take(all);
    right = all.size() == condensed.n();
    for (NodeIndex k = 0; k < all.size(); ++k)
      right =
        right && all[k] == known<dim>(k) && (nodes.place(k) == invalid_index || again.V[k] == known<dim>(k));
    say("complete, and back", right);
  }

  template <int dim>
  void check_symmetry(const SimplexMesh<dim> &mesh, const Discretization<dim> &discretization)
  {
    const auto &velocities = *discretization.velocity_nodes(), &condensed = *discretization.condensed_nodes();
    const auto &partitioner = *velocities.partitioner();
    RandomNumbers          random;
    dealii::Vector<double> numbers(partitioner.size());
    for (double &x : numbers)
      x = random.scalar();
    dealii::Vector<double> held = numbers;
    discretization.symmetry().distribute(held);
    dealii::Vector<double> twice = held;
    discretization.symmetry().distribute(twice);
    twice -= held;
    std::vector<std::set<unsigned int>> planes(condensed.n());
    for (const auto &face : mesh.faces)
      if (!mesh.is_surface(face))
        for (unsigned int i = 0; i < dim; ++i)
        {
          planes[face.nodes[i]].insert(face.patch);
          for (unsigned int j = 0; j < i && discretization.middles(); ++j)
            planes[discretization.middles()->between(face.nodes[i], face.nodes[j])].insert(face.patch);
        }
    double       through = 0., beside = 0.;
    unsigned int n_held = 0;
    for (unsigned int place = 0; place < condensed.n_places(); ++place)
    {
      const NodeIndex        k = condensed.node_at(place);
      dealii::Tensor<1, dim> v;
      for (unsigned int d = 0; d < dim; ++d)
        v[d] = held[partitioner.local_to_global(dim * velocities.place(k) + d)];
      const auto directions = discretization.fixed_directions(place);
      n_held += planes[k].size();
      through = std::max(through, directions.size() == planes[k].size() ? 0. : 1.);
      for (const unsigned int patch : planes[k])
      {
        dealii::Tensor<1, dim> normal = mesh.patches[patch].symmetry->normal;
        through                       = std::max(through, std::abs(v * normal));
        for (const auto &d : directions)
          normal -= (normal * d) * d;
        beside = std::max(beside, normal.norm());
      }
    }
    say("planes of symmetry hold",
        n_held > 0 && through < 1e-14 && beside < 1e-14 && twice.l2_norm() < 1e-13);
  }

  template <int dim>
  void check(const SimplexMesh<dim> &mesh, const DiscretizationChoice &choice)
  {
    if (dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      std::cout << dim << "D, " << (choice.pair == ElementPair::mini ? "mini" : "P2-P1") << ", "
                << (choice.triangulation == TriangulationKind::shared ? "shared" : "fully distributed")
                << '\n';
    const Discretization<dim> discretization(mesh, choice, comm);
    check_tables(mesh, discretization);
    check_positions(mesh, discretization);
    check_middles(mesh, discretization);
    check_pattern(mesh, discretization);
    check_surface(mesh, discretization);
    check_exchange(discretization);
    check_symmetry(mesh, discretization);
    const double share = discretization.cells().owned().size() *
                         dealii::Utilities::MPI::n_mpi_processes(comm) / double(mesh.n_cells());
    say("parts are of equal size", std::abs(share - 1.) < 0.1);
  }
} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const auto triangulation : {TriangulationKind::shared, TriangulationKind::fully_distributed})
    for (const auto pair : {ElementPair::mini, ElementPair::taylor_hood})
    {
      const unsigned int degree   = triangulation == TriangulationKind::shared ? 1 : 2;
      const auto         assembly = degree == 1 ? Assembly::closed_form : Assembly::quadrature;
      check(turned_box(), {pair, triangulation, assembly, Kinematics::three_dimensions, degree});
      check(sheared_square(6), {pair, triangulation, Assembly::quadrature, Kinematics::plane_strain, degree});
    }
}
