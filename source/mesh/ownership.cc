// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/mesh/ownership.h>

#include <algorithm>

namespace retroforge
{
  Ownership::Ownership(const std::vector<unsigned int> &owner, MPI_Comm comm)
      : number_(owner.size()), begin_(dealii::Utilities::MPI::n_mpi_processes(comm) + 1, 0), comm_(comm)
  {
    for (const unsigned int rank : owner)
      ++begin_[rank + 1];
    for (std::size_t r = 1; r < begin_.size(); ++r)
      begin_[r] += begin_[r - 1];
    const unsigned int        mine = dealii::Utilities::MPI::this_mpi_process(comm);
    std::vector<unsigned int> next = begin_;
    for (unsigned int entry = 0; entry < owner.size(); ++entry)
    {
      number_[entry] = next[owner[entry]]++;
      if (owner[entry] == mine)
        owned_.push_back(entry);
    }
    range_ = {begin_[mine], begin_[mine + 1], begin_.back()};
  }

  void Ownership::gather(double *values, const unsigned int width) const
  {
    const unsigned int n_ranks = begin_.size() - 1;
    if (n_ranks == 1)
      return;
    std::vector<int> counts(n_ranks), offsets(n_ranks);
    for (unsigned int r = 0; r < n_ranks; ++r)
    {
      counts[r]  = width * (begin_[r + 1] - begin_[r]);
      offsets[r] = width * begin_[r];
    }
    std::vector<double> by_number(width * range_.n);
    for (const unsigned int entry : owned_)
      std::copy_n(values + width * entry, width, &by_number[width * number_[entry]]);
    MPI_Allgatherv(
      MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, by_number.data(), counts.data(), offsets.data(), MPI_DOUBLE, comm_);
    for (std::size_t entry = 0; entry < number_.size(); ++entry)
      std::copy_n(&by_number[width * number_[entry]], width, values + width * entry);
  }

  namespace
  {
    std::vector<unsigned int> of_others(const Ownership &ownership, std::vector<unsigned int> entries)
    {
      const auto owned = [&](const unsigned int entry) { return ownership.owns(entry); };
      entries.erase(std::remove_if(entries.begin(), entries.end(), owned), entries.end());
      std::sort(entries.begin(), entries.end(), [&](const unsigned int a, const unsigned int b) {
        return ownership.number(a) < ownership.number(b);
      });
      entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
      return entries;
    }

    dealii::IndexSet
    dofs_of(const Ownership &ownership, const std::vector<unsigned int> &entries, const unsigned int width)
    {
      dealii::IndexSet set(width * ownership.range().n);
      for (const unsigned int entry : entries)
        set.add_range(width * ownership.number(entry), width * (ownership.number(entry) + 1));
      return set;
    }
  } // namespace

  GhostExchange::GhostExchange(const Ownership                 &ownership,
                               const std::vector<unsigned int> &ghosts,
                               const unsigned int               width,
                               const Place                     &place)
      : owned_(ownership.owned())
      , ghosts_(of_others(ownership, ghosts))
      , width_(width)
      , partitioner_(ownership.range().dofs(width), dofs_of(ownership, ghosts_, width), ownership.comm())
  {
    if (place)
      for (auto *entries : {&owned_, &ghosts_})
        std::transform(entries->begin(), entries->end(), entries->begin(), place);
  }

  namespace
  {
    std::vector<double>
    packed(const std::vector<unsigned int> &places, const unsigned int width, const double *values)
    {
      std::vector<double> packed;
      packed.reserve(width * places.size());
      for (const unsigned int place : places)
        packed.insert(packed.end(), values + width * place, values + width * (place + 1));
      return packed;
    }

    void unpack(const std::vector<double>       &packed,
                const std::vector<unsigned int> &places,
                const unsigned int               width,
                double                          *values)
    {
      for (std::size_t i = 0; i < places.size(); ++i)
        std::copy_n(&packed[width * i], width, values + width * places[i]);
    }
  } // namespace

  void GhostExchange::update(double *values) const
  {
    if (partitioner_.n_mpi_processes() == 1)
      return;
    const std::vector<double> owned = packed(owned_, width_, values);
    std::vector<double>       to_neighbours(partitioner_.n_import_indices()), ghosts(width_ * ghosts_.size());
    std::vector<MPI_Request>  requests;
    partitioner_.export_to_ghosted_array_start<double, dealii::MemorySpace::Host>(
      0,
      dealii::ArrayView<const double>(owned.data(), owned.size()),
      dealii::ArrayView<double>(to_neighbours.data(), to_neighbours.size()),
      dealii::ArrayView<double>(ghosts.data(), ghosts.size()),
      requests);
    partitioner_.export_to_ghosted_array_finish<double, dealii::MemorySpace::Host>(
      dealii::ArrayView<double>(ghosts.data(), ghosts.size()), requests);
    unpack(ghosts, ghosts_, width_, values);
  }

  void GhostExchange::collect(double *values) const
  {
    if (partitioner_.n_mpi_processes() == 1)
      return;
    std::vector<double>      owned = packed(owned_, width_, values), ghosts = packed(ghosts_, width_, values);
    std::vector<double>      from_neighbours(partitioner_.n_import_indices());
    std::vector<MPI_Request> requests;
    const auto               sum = dealii::VectorOperation::add;
    partitioner_.import_from_ghosted_array_start<double, dealii::MemorySpace::Host>(
      sum,
      0,
      dealii::ArrayView<double>(ghosts.data(), ghosts.size()),
      dealii::ArrayView<double>(from_neighbours.data(), from_neighbours.size()),
      requests);
    partitioner_.import_from_ghosted_array_finish<double, dealii::MemorySpace::Host>(
      sum,
      dealii::ArrayView<const double>(from_neighbours.data(), from_neighbours.size()),
      dealii::ArrayView<double>(owned.data(), owned.size()),
      dealii::ArrayView<double>(ghosts.data(), ghosts.size()),
      requests);
    unpack(owned, owned_, width_, values);
  }
} // namespace retroforge
