// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>

#include <retroforge/output/field_file.h>
#include <retroforge/output/safe_file.h>

#include <limits>
#include <sstream>

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

  template <int dim>
  std::string FieldFile<dim>::NamedDataOut::with_unit(const std::string &name) const
  {
    const auto unit = units.find(name);
    return unit == units.end() ? name : name + " [" + unit->second + "]";
  }

  template <int dim>
  std::vector<std::string> FieldFile<dim>::NamedDataOut::get_dataset_names() const
  {
    std::vector<std::string> names = Base::get_dataset_names();
    for (std::string &name : names)
      name = with_unit(name);
    return names;
  }

  template <int dim>
  std::vector<
    std::tuple<unsigned int, unsigned int, std::string, Interpretation::DataComponentInterpretation>>
  FieldFile<dim>::NamedDataOut::get_nonscalar_data_ranges() const
  {
    auto ranges = Base::get_nonscalar_data_ranges();
    for (auto &range : ranges)
      std::get<2>(range) = with_unit(std::get<2>(range));
    const std::vector<std::string> names = Base::get_dataset_names();
    for (const std::string &tensor : cell_tensors)
    {
      const unsigned int first =
        std::find(names.begin(), names.end(), tensor + "_0") - names.begin(); // the others follow it
      ranges.emplace_back(first, first + 8, with_unit(tensor), Interpretation::component_is_part_of_tensor);
    }
    return ranges;
  }

  template <int dim>
  std::string FieldFile<dim>::NamedDataOut::piece(const dealii::DataOutBase::VtkFlags &flags) const
  {
    std::ostringstream out;
    if (!this->get_patches().empty())
      dealii::DataOutBase::write_vtu_main(
        this->get_patches(), get_dataset_names(), get_nonscalar_data_ranges(), flags, out);
    return out.str();
  }

  template <int dim>
  FieldFile<dim>::FieldFile(const dealii::Triangulation<dim, 3> &triangulation)
      : triangulation_(triangulation)
  {
    data_out_.attach_triangulation(triangulation);
  }

  template <int dim>
  const dealii::DoFHandler<dim, 3> &FieldFile<dim>::dofs(const unsigned int degree,
                                                         const unsigned int n_components)
  {
    auto &handler = dofs_[{{degree, n_components}}];
    if (!handler.has_active_dofs())
    {
      handler.reinit(triangulation_);
      handler.distribute_dofs(dealii::FESystem<dim, 3>(dealii::FE_SimplexP<dim, 3>(degree), n_components));
    }
    return handler;
  }

  template <int dim>
  template <typename ValueAt>
  void FieldFile<dim>::add_field(const std::string &name,
                                 const std::string &unit,
                                 const unsigned int degree,
                                 const unsigned int n_components,
                                 const ValueAt     &value_at)
  {
    const auto                                  &handler = dofs(degree, n_components);
    const auto                                  &fe      = handler.get_fe();
    Values                                      &values  = values_.emplace_back(handler.locally_owned_dofs(),
                                          dealii::DoFTools::extract_locally_relevant_dofs(handler),
                                          triangulation_.get_communicator());
    std::vector<dealii::types::global_dof_index> of_cell(fe.dofs_per_cell);
    for (const auto &cell : handler.active_cell_iterators())
      if (!cell->is_artificial())
      {
        cell->get_dof_indices(of_cell);
        for (unsigned int i = 0; i < of_cell.size(); ++i)
          if (values.in_local_range(of_cell[i]))
          {
            const auto [component, point] = fe.system_to_component_index(i);
            values(of_cell[i])            = value_at(cell, point, component);
          }
      }
    values.update_ghost_values();
    if (!unit.empty())
      data_out_.units[name] = unit;
    degree_ = std::max(degree_, degree);
    data_out_.add_data_vector(handler,
                              values,
                              std::vector<std::string>(n_components, name),
                              std::vector<Interpretation::DataComponentInterpretation>(
                                n_components,
                                n_components == 1 ? Interpretation::component_is_scalar
                                                  : Interpretation::component_is_part_of_vector));
  }

  template <int dim>
  void FieldFile<dim>::add_linear(const std::string         &name,
                                  const std::string         &unit,
                                  const std::vector<double> &values)
  {
    add_field(name, unit, 1, 1, [&](const auto &cell, const unsigned int a, unsigned int) {
      return values.at(cell->vertex_index(a));
    });
  }

  template <int dim>
  void FieldFile<dim>::add_linear(const std::string          &name,
                                  const std::string          &unit,
                                  const NodalVectors<double> &values)
  {
    add_field(name, unit, 1, 3, [&](const auto &cell, const unsigned int a, const unsigned int component) {
      return values.at(cell->vertex_index(a))[component];
    });
  }

  template <int dim>
  void FieldFile<dim>::add_velocity(const std::string          &name,
                                    const std::string          &unit,
                                    const NodalVectors<double> &values,
                                    const Spaces               &spaces)
  {
    add_field(name,
              unit,
              spaces.edges() ? 2 : 1,
              3,
              [&](const auto &cell, const unsigned int a, const unsigned int component) {
                return values.at(spaces.velocity_nodes(cell->active_cell_index())[a])[component];
              });
  }

  template <int dim>
  void FieldFile<dim>::add_cell_field(const std::string &name, dealii::Vector<double> values)
  {
    AssertThrow(values.size() == triangulation_.n_active_cells(),
                dealii::ExcDimensionMismatch(values.size(), triangulation_.n_active_cells()));
    cell_values_.push_back(std::move(values));
    data_out_.add_data_vector(cell_values_.back(), name, NamedDataOut::type_cell_data);
  }

  template <int dim>
  void FieldFile<dim>::add_constant(const std::string         &name,
                                    const std::string         &unit,
                                    const std::vector<double> &values)
  {
    if (!unit.empty())
      data_out_.units[name] = unit;
    add_cell_field(name, dealii::Vector<double>(values.begin(), values.end()));
  }

  template <int dim>
  void FieldFile<dim>::add_constant(const std::string                  &name,
                                    const std::string                  &unit,
                                    const std::vector<SymmetricTensor> &values)
  {
    // of SymmetricTensor: xx, yy, zz, yz, xz, xy
    constexpr unsigned int entry[9] = {0, 5, 4, 5, 1, 3, 4, 3, 2};
    data_out_.units[name]           = unit;
    data_out_.cell_tensors.push_back(name);
    for (unsigned int k = 0; k < 9; ++k)
    {
      dealii::Vector<double> component(values.size());
      for (unsigned int c = 0; c < values.size(); ++c)
        component(c) = values[c][entry[k]];
      add_cell_field(name + "_" + std::to_string(k), std::move(component));
    }
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
  void FieldFile<dim>::write(const std::string &file)
  {
    data_out_.build_patches(degree_);
    const auto        flags  = vtk_flags();
    const MPI_Comm    comm   = triangulation_.get_communicator();
    const std::string pieces = joined(comm, data_out_.piece(flags));
    if (dealii::Utilities::MPI::this_mpi_process(comm) > 0)
      return;
    std::ostringstream out;
    dealii::DataOutBase::write_vtu_header(out, flags);
    out << planes_ << pieces;
    dealii::DataOutBase::write_vtu_footer(out);
    write_file(file, out.str());
  }

  template class FieldFile<2>;
  template class FieldFile<3>;
} // namespace retroforge
