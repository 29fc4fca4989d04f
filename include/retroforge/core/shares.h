// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstddef>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include <mpi.h>

/// @file
/// Lists whose entries ranks work out in equal parts, one behind the other, so that the whole has the order
/// that one rank would give it.
namespace retroforge
{
  /// Entries that this rank works on, of n known to all: begin and end.
  std::pair<std::size_t, std::size_t> share_of_rank(std::size_t n, MPI_Comm comm);

  /// The parts of all ranks one behind the other, on each of them. Collective.
  template <typename T>
  std::vector<T> joined(std::vector<T> part, MPI_Comm comm)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    int n_ranks;
    MPI_Comm_size(comm, &n_ranks);
    if (n_ranks == 1)
      return part;
    const int        size = part.size() * sizeof(T);
    std::vector<int> sizes(n_ranks), begins(n_ranks);
    MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, comm);
    std::exclusive_scan(sizes.begin(), sizes.end(), begins.begin(), 0);
    std::vector<T> whole((begins.back() + sizes.back()) / sizeof(T));
    MPI_Allgatherv(part.data(), size, MPI_BYTE, whole.data(), sizes.data(), begins.data(), MPI_BYTE, comm);
    return whole;
  }
} // namespace retroforge
