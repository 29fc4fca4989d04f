// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>
#include <deal.II/grid/reference_cell.h>

#include <retroforge/output/field_file.h>
#include <retroforge/output/safe_file.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <tuple>

namespace retroforge
{
  namespace
  {
    namespace Interpretation = dealii::DataComponentInterpretation;

    /// Two runs of the same input write the same bytes.
    dealii::DataOutBase::VtkFlags vtk_flags()
    {
      dealii::DataOutBase::VtkFlags flags;
      flags.print_date_and_time = false;
      flags.compression_level   = dealii::DataOutBase::VtkFlags::best_speed;
      return flags;
    }
    /// The pieces of all ranks in their order, on the first. deal.II's gather() would compress once more what
    /// is compressed.
    std::string joined(const MPI_Comm comm, std::string piece)
    {
      const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
      if (dealii::Utilities::MPI::this_mpi_process(comm) > 0)
      {
        const int error = MPI_Send(piece.data(), piece.size(), MPI_CHAR, 0, 0, comm);
        AssertThrowMPI(error);
        return "";
      }
      for (unsigned int rank = 1; rank < n_ranks; ++rank)
      {
        MPI_Status status;
        int        size  = 0;
        int        error = MPI_Probe(rank, 0, comm, &status);
        AssertThrowMPI(error);
        error = MPI_Get_count(&status, MPI_CHAR, &size);
        AssertThrowMPI(error);
        const std::size_t begin = piece.size();
        piece.resize(begin + size);
        error = MPI_Recv(&piece[begin], size, MPI_CHAR, rank, 0, comm, MPI_STATUS_IGNORE);
        AssertThrowMPI(error);
      }
      return piece;
    }
  } // namespace

  namespace
  {
    template <int dim>
    std::vector<std::array<NodeIndex, dim + 1>> cells_of(const dealii::Triangulation<dim, 3> &triangulation)
    {
      std::vector<std::array<NodeIndex, dim + 1>> cells(triangulation.n_active_cells());
      for (const auto &cell : triangulation.active_cell_iterators())
        for (unsigned int a = 0; a <= dim; ++a)
          cells[cell->active_cell_index()][a] = cell->vertex_index(a);
      return cells;
    }

    /// Ends of the edges, in the order of deal.II's and VTK's quadratic simplices.
    constexpr std::array<std::array<unsigned int, 2>, 6> edge_ends = {
      {{{0, 1}}, {{1, 2}}, {{2, 0}}, {{0, 3}}, {{1, 3}}, {{2, 3}}}};
  } // namespace

  template <int dim>
  FieldFile<dim>::FieldFile(const NodalVectors<double> &X, const Cells &cells, const MPI_Comm comm)
      : X_(X), cells_(cells), comm_(comm)
  {
    const std::uint64_t rank    = dealii::Utilities::MPI::this_mpi_process(comm);
    const std::uint64_t n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm), n = cells.size();
    // Those with  c n_ranks / n = rank.
    first_ = (rank * n + n_ranks - 1) / n_ranks;
    last_  = ((rank + 1) * n + n_ranks - 1) / n_ranks;
  }

  template <int dim>
  FieldFile<dim>::FieldFile(const dealii::Triangulation<dim, 3> &triangulation)
      : FieldFile({triangulation.get_vertices().begin(), triangulation.get_vertices().end()},
                  cells_of(triangulation),
                  triangulation.get_communicator())
  {
  }

  template <int dim>
  template <typename ValueAt>
  void FieldFile<dim>::add(const std::string &name,
                           const std::string &unit,
                           const unsigned int n_points,
                           const unsigned int n_components,
                           const ValueAt     &value_at)
  {
    const auto kind = n_components == 1   ? Interpretation::component_is_scalar
                      : n_components == 3 ? Interpretation::component_is_part_of_vector
                                          : Interpretation::component_is_part_of_tensor;
    Array      array{unit.empty() ? name : name + " [" + unit + "]", kind, n_points, n_components, {}};
    array.values.reserve(std::size_t(last_ - first_) * n_points * n_components);
    for (CellIndex c = first_; c < last_; ++c)
      for (unsigned int point = 0; point < n_points; ++point)
        for (unsigned int component = 0; component < n_components; ++component)
          array.values.push_back(value_at(c, point, component));
    arrays_.push_back(std::move(array));
    n_points_ = std::max(n_points_, n_points);
  }

  template <int dim>
  double FieldFile<dim>::value(const Array       &array,
                               const CellIndex    c,
                               const unsigned int point,
                               const unsigned int component) const
  {
    const auto at = [&](const unsigned int p) {
      return array.values[(std::size_t(c - first_) * array.n_points + p) * array.n_components + component];
    };
    if (array.n_points == 1)
      return at(0);
    if (point < array.n_points)
      return at(point);
    const auto [a, b] = edge_ends[point - (dim + 1)];
    return 0.5 * (at(a) + at(b));
  }

  template <int dim>
  void FieldFile<dim>::add_linear(const std::string         &name,
                                  const std::string         &unit,
                                  const std::vector<double> &values)
  {
    add(name, unit, dim + 1, 1, [&](const CellIndex c, const unsigned int a, unsigned int) {
      return values.at(cells_[c][a]);
    });
  }

  template <int dim>
  void FieldFile<dim>::add_linear(const std::string          &name,
                                  const std::string          &unit,
                                  const NodalVectors<double> &values)
  {
    add(name, unit, dim + 1, 3, [&](const CellIndex c, const unsigned int a, const unsigned int component) {
      return values.at(cells_[c][a])[component];
    });
  }

  template <int dim>
  void FieldFile<dim>::add_velocity(const std::string          &name,
                                    const std::string          &unit,
                                    const NodalVectors<double> &values,
                                    const MiddleNodes          *middles)
  {
    const unsigned int n_points = middles ? dim + 1 + edge_ends.size() : dim + 1;
    add(name,
        unit,
        n_points,
        3,
        [&](const CellIndex c, const unsigned int point, const unsigned int component) {
          if (point <= dim)
            return values.at(cells_[c][point])[component];
          const auto [a, b] = edge_ends[point - (dim + 1)];
          return values.at(middles->between(cells_[c][a], cells_[c][b]))[component];
        });
  }

  template <int dim>
  void FieldFile<dim>::add_constant(const std::string         &name,
                                    const std::string         &unit,
                                    const std::vector<double> &values)
  {
    add(name, unit, 1, 1, [&](const CellIndex c, unsigned int, unsigned int) { return values.at(c); });
  }

  template <int dim>
  void FieldFile<dim>::add_constant(const std::string                  &name,
                                    const std::string                  &unit,
                                    const std::vector<SymmetricTensor> &values)
  {
    // of SymmetricTensor: xx, yy, zz, yz, xz, xy
    constexpr unsigned int entry[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
    add(name, unit, 1, 9, [&](const CellIndex c, unsigned int, const unsigned int component) {
      return values.at(c)[entry[component]];
    });
  }

  template <int dim>
  void FieldFile<dim>::add_symmetry_planes(const std::vector<Plane> &planes)
  {
    if (planes.empty())
      return;
    std::ostringstream out;
    out.precision(std::numeric_limits<double>::max_digits10);
    out << R"(<FieldData>
<DataArray type="Float64" Name="symmetry_planes" NumberOfComponents="6" NumberOfTuples=")"
        << planes.size() << R"(" format="ascii">)";
    for (const Plane &plane : planes)
      out << ' ' << plane.point << ' ' << plane.normal;
    out << "</DataArray>\n</FieldData>\n";
    planes_ = out.str();
  }

  template <int dim>
  dealii::DataOutBase::Patch<dim, 3> FieldFile<dim>::patch(const CellIndex c) const
  {
    unsigned int n_rows = 0;
    for (const Array &array : arrays_)
      n_rows += array.n_components;
    dealii::DataOutBase::Patch<dim, 3> patch;
    patch.reference_cell       = dealii::ReferenceCells::get_simplex<dim>();
    patch.n_subdivisions       = n_points_ == dim + 1 ? 1 : 2;
    patch.patch_index          = c - first_;
    patch.points_are_available = true; // in the last rows
    patch.data.reinit(n_rows + 3, n_points_);
    for (unsigned int a = 0; a <= dim; ++a)
      patch.vertices[a] = dealii::Point<3>(X_[cells_[c][a]]);
    for (unsigned int point = 0; point < n_points_; ++point)
    {
      unsigned int row = 0;
      for (const Array &array : arrays_)
        for (unsigned int component = 0; component < array.n_components; ++component)
          patch.data(row++, point) = value(array, c, point, component);
      const dealii::Point<3> x = point <= dim ? patch.vertices[point]
                                              : patch.vertices[edge_ends[point - (dim + 1)][0]] +
                                                  0.5 * (patch.vertices[edge_ends[point - (dim + 1)][1]] -
                                                         patch.vertices[edge_ends[point - (dim + 1)][0]]);
      for (unsigned int d = 0; d < 3; ++d)
        patch.data(row++, point) = x[d];
    }
    return patch;
  }

  template <int dim>
  std::string FieldFile<dim>::piece() const
  {
    if (first_ == last_)
      return "";
    std::vector<dealii::DataOutBase::Patch<dim, 3>> patches;
    patches.reserve(last_ - first_);
    for (CellIndex c = first_; c < last_; ++c)
      patches.push_back(patch(c));
    std::vector<std::string> names;
    std::vector<
      std::tuple<unsigned int, unsigned int, std::string, Interpretation::DataComponentInterpretation>>
      ranges;
    for (const Array &array : arrays_)
    {
      if (array.n_components > 1)
        ranges.emplace_back(names.size(), names.size() + array.n_components - 1, array.name, array.kind);
      names.insert(names.end(), array.n_components, array.name);
    }
    std::ostringstream out;
    dealii::DataOutBase::write_vtu_main(patches, names, ranges, vtk_flags(), out);
    return out.str();
  }

  template <int dim>
  void FieldFile<dim>::write(const std::string &file)
  {
    const std::string pieces = joined(comm_, piece());
    if (dealii::Utilities::MPI::this_mpi_process(comm_) > 0)
      return;
    std::ostringstream out;
    dealii::DataOutBase::write_vtu_header(out, vtk_flags());
    out << planes_ << pieces;
    dealii::DataOutBase::write_vtu_footer(out);
    write_file(file, out.str());
  }

  template class FieldFile<2>;
  template class FieldFile<3>;
} // namespace retroforge
