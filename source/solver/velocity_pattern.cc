// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <retroforge/solver/velocity_pattern.h>

namespace retroforge
{
  namespace
  {
    /// The first components of velocities that meet.
    template <int dim>
    dealii::DynamicSparsityPattern first_components(const dealii::DoFHandler<dim> &dofs, const MPI_Comm comm)
    {
      dealii::Table<2, dealii::DoFTools::Coupling> first(dim, dim);
      first.fill(dealii::DoFTools::none);
      first(0, 0) = dealii::DoFTools::always;
      dealii::IndexSet relevant;
      dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
      dealii::DynamicSparsityPattern met(dofs.n_dofs(), dofs.n_dofs(), relevant);
      dealii::DoFTools::make_sparsity_pattern(dofs, first, met);
      dealii::SparsityTools::distribute_sparsity_pattern(met, dofs.locally_owned_dofs(), comm, relevant);
      return met;
    }
  } // namespace

  template <int dim>
  Rows<unsigned int> velocity_pattern(const Discretization<dim> &discretization)
  {
    // All components of two nodes meet where the first ones do. Symmetry does not thin the pattern out: node
    // frames eliminate other components than the constraints.
    const auto           met        = first_components(discretization.velocity_dofs(), discretization.comm());
    const NodeNumbering &velocities = *discretization.velocity_nodes();
    const NodeNumbering &condensed  = *discretization.condensed_nodes();
    const auto          &partitioner = *velocities.partitioner();
    Rows<unsigned int>   pattern;
    for (unsigned int i = 0; i < condensed.n_owned(); ++i)
    {
      const auto row = partitioner.local_to_global(dim * i);
      for (auto entry = met.begin(row); entry != met.end(row); ++entry)
      {
        const NodeIndex k = velocities.node_at(partitioner.global_to_local(entry->column()) / dim);
        if (k < condensed.n())
          pattern.entries.push_back(condensed.index_at(condensed.place(k)));
      }
      pattern.begin.push_back(pattern.entries.size());
    }
    return pattern;
  }

  template Rows<unsigned int> velocity_pattern(const Discretization<2> &);
  template Rows<unsigned int> velocity_pattern(const Discretization<3> &);
} // namespace retroforge
