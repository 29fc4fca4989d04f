// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include <retroforge/discretization/triangulation.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    template <int dim>
    std::vector<dealii::Point<dim>> points(const std::vector<dealii::Tensor<1, dim>> &X)
    {
      return {X.begin(), X.end()};
    }

    template <std::size_t n_corners>
    std::vector<dealii::CellData<n_corners - 1>>
    cell_data(const std::vector<std::array<unsigned int, n_corners>> &cells)
    {
      std::vector<dealii::CellData<n_corners - 1>> data(cells.size(),
                                                        dealii::CellData<n_corners - 1>(n_corners));
      for (std::size_t c = 0; c < cells.size(); ++c)
        std::copy(cells[c].begin(), cells[c].end(), data[c].vertices.begin());
      return data;
    }
  } // namespace

  SharedTriangulation::SharedTriangulation(const MPI_Comm comm)
      : dealii::parallel::shared::Triangulation<3>(comm, none, false, partition_custom_signal)
  {
    const std::uint64_t n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    signals.create.connect([this, n_ranks] {
      for (const auto &cell : active_cell_iterators())
        cell->set_subdomain_id(cell->active_cell_index() * n_ranks / n_active_cells());
    });
  }

  template <int dim>
  void make_triangulation(const SimplexMesh<dim>                    &mesh,
                          const std::vector<dealii::Tensor<1, dim>> &X,
                          dealii::Triangulation<dim>                &triangulation)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    dealii::SubCellData boundary;
    const auto          add = [](const SimplexFace<dim> &face, auto &faces) {
      auto &data = faces.emplace_back(dim);
      std::copy(face.nodes.begin(), face.nodes.end(), data.vertices.begin());
      data.boundary_id = face.patch;
    };
    for (const SimplexFace<dim> &face : mesh.faces)
      if constexpr (dim == 3)
        add(face, boundary.boundary_quads);
      else
        add(face, boundary.boundary_lines);
    triangulation.create_triangulation(points<dim>(X), cell_data(mesh.cells), boundary);
  }

  void make_triangulation(const TriangleSurface &surface, dealii::Triangulation<2, 3> &triangulation)
  {
    triangulation.create_triangulation(points<3>(surface.vertices()), cell_data(surface.triangles()), {});
  }

  namespace
  {
    /// Gives the cells to ranks: parts of equal size with few faces between them.
    template <int dim>
    void assign_subdomains(dealii::Triangulation<dim> &triangulation, const unsigned int n_ranks)
    {
      dealii::GridTools::partition_triangulation(
        n_ranks, triangulation, dealii::SparsityTools::Partitioner::metis);
      std::vector<unsigned int> n_cells(n_ranks, 0);
      for (const auto &cell : triangulation.active_cell_iterators())
        ++n_cells[cell->subdomain_id()];
      // Of very few cells METIS gives some ranks none.
      if (std::find(n_cells.begin(), n_cells.end(), 0u) != n_cells.end())
        for (const auto &cell : triangulation.active_cell_iterators())
          cell->set_subdomain_id(static_cast<std::uint64_t>(cell->active_cell_index()) * n_ranks /
                                 triangulation.n_active_cells());
    }

    template <int dim>
    std::unique_ptr<dealii::Triangulation<dim>> shared_triangulation(const SimplexMesh<dim> &mesh,
                                                                     const MPI_Comm          comm)
    {
      using Shared = dealii::parallel::shared::Triangulation<dim>;
      auto triangulation =
        std::make_unique<Shared>(comm, Shared::none, true, Shared::partition_custom_signal);
      triangulation->signals.create.connect([tria = triangulation.get(), comm] {
        assign_subdomains(*tria, dealii::Utilities::MPI::n_mpi_processes(comm));
      });
      make_triangulation(mesh, mesh.X, *triangulation);
      return triangulation;
    }

    template <int dim>
    std::unique_ptr<dealii::Triangulation<dim>> fully_distributed_triangulation(const SimplexMesh<dim> &mesh,
                                                                                const MPI_Comm          comm)
    {
      dealii::Triangulation<dim> serial;
      make_triangulation(mesh, mesh.X, serial);
      assign_subdomains(serial, dealii::Utilities::MPI::n_mpi_processes(comm));
      auto triangulation = std::make_unique<dealii::parallel::fullydistributed::Triangulation<dim>>(comm);
      triangulation->create_triangulation(
        dealii::TriangulationDescription::Utilities::create_description_from_triangulation(serial, comm));
      return triangulation;
    }
  } // namespace

  template <int dim>
  std::unique_ptr<dealii::Triangulation<dim>>
  distributed_triangulation(const SimplexMesh<dim> &mesh, const TriangulationKind kind, const MPI_Comm comm)
  {
    const bool is_shared =
      kind == TriangulationKind::shared ||
      (kind == TriangulationKind::by_ranks && dealii::Utilities::MPI::n_mpi_processes(comm) == 1);
    return is_shared ? shared_triangulation(mesh, comm) : fully_distributed_triangulation(mesh, comm);
  }

#define RETROFORGE_INSTANTIATE(dim)                                                                       \
  template void make_triangulation(                                                                       \
    const SimplexMesh<dim> &, const std::vector<dealii::Tensor<1, dim>> &, dealii::Triangulation<dim> &); \
  template std::unique_ptr<dealii::Triangulation<dim>> distributed_triangulation(                         \
    const SimplexMesh<dim> &, TriangulationKind, MPI_Comm);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
