// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Who owns what. Proved, on one and on two ranks: every node and cell has one owner; numbers in matrices
// follow each other rank by rank; what is gathered and what neighbours send is what the owner knows, and
// nothing else changes; parts of sums come together at the owner; METIS' parts are of equal size, and fewer
// nodes are read from others than when numbers are cut into ranges.

#include <deal.II/base/mpi.h>

#include <retroforge/mesh/partition.h>

#include <iostream>
#include <numeric>

#include "../remeshing/remeshing_test_tools.h"

using namespace retroforge;

namespace
{
  unsigned int rank()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  }
  unsigned int n_ranks()
  {
    return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  }
  unsigned int sum(const unsigned int n)
  {
    return dealii::Utilities::MPI::sum(n, MPI_COMM_WORLD);
  }

  void say(const std::string &what, const bool right)
  {
    const bool everywhere = sum(right ? 0 : 1) == 0;
    if (rank() == 0)
      std::cout << what << ": " << (everywhere ? "yes" : "NO") << '\n';
  }

  /// Of an entry and a component, as its owner knows it.
  double known(const unsigned int entry, const unsigned int i)
  {
    return 10. * entry + i + 0.5;
  }

  void check_numbers(const Ownership &ownership, const unsigned int n, const std::string &of)
  {
    const NodeRange          &range = ownership.range();
    std::vector<unsigned int> met(n, 0);
    bool                      right = range.n == n && range.n_owned() == ownership.owned().size();
    for (unsigned int entry = 0; entry < n; ++entry)
      ++met[ownership.number(entry)];
    right = right && met == std::vector<unsigned int>(n, 1);
    for (unsigned int local = 0; local < ownership.owned().size(); ++local)
    {
      const unsigned int entry = ownership.owned()[local];
      right                    = right && ownership.owns(entry) && ownership.local(entry) == local &&
              ownership.number(entry) == range.begin + local &&
              (local == 0 || entry > ownership.owned()[local - 1]);
    }
    right = right && !ownership.owns(invalid_index);
    say("numbers of " + of + " follow each other", right && sum(range.n_owned()) == n);
  }

  void check_exchange(const Ownership &ownership, const std::vector<unsigned int> &read)
  {
    constexpr unsigned int width = 3;
    constexpr double       stale = -1.;
    const unsigned int     n     = ownership.range().n;
    std::vector<double>    mine(width * n, stale);
    for (const unsigned int entry : ownership.owned())
      for (unsigned int i = 0; i < width; ++i)
        mine[width * entry + i] = known(entry, i);

    std::vector<double> all = mine;
    ownership.gather(all.data(), width);
    bool right = true;
    for (unsigned int e = 0; e < width * n; ++e)
      right = right && all[e] == known(e / width, e % width);
    say("gathered is what the owners know", right);

    std::vector<bool> reads(n, false);
    for (const unsigned int entry : read)
      reads[entry] = true;
    std::vector<double> near = mine;
    const GhostExchange exchange(ownership, read, width);
    exchange.update(near.data());
    right               = true;
    unsigned int n_read = 0;
    for (unsigned int entry = 0; entry < n; ++entry)
    {
      const bool there = ownership.owns(entry) || reads[entry];
      n_read += reads[entry] && !ownership.owns(entry);
      for (unsigned int i = 0; i < width; ++i)
        right = right && near[width * entry + i] == (there ? known(entry, i) : stale);
    }
    say("sent is what is read, and nothing else changes", right && exchange.size() == n_read);

    // Each rank that has an entry adds one more than its number: the owner gets all of it.
    std::vector<double> part(width * n), whole(width * n, 0.);
    for (unsigned int e = 0; e < width * n; ++e)
      if (ownership.owns(e / width) || reads[e / width])
        whole[e] = part[e] = known(e / width, e % width) * (rank() + 1);
    dealii::Utilities::MPI::sum(whole, MPI_COMM_WORLD, whole);
    exchange.collect(part.data());
    right = true;
    for (const unsigned int entry : ownership.owned())
      for (unsigned int i = 0; i < width; ++i)
        right = right && part[width * entry + i] == whole[width * entry + i];
    say("collected are the sums of those that read", right);

    // The same with the entries that are there one behind the other.
    std::vector<unsigned int> place(n, invalid_index), there;
    for (unsigned int entry = 0; entry < n; ++entry)
      if (ownership.owns(entry) || reads[entry])
      {
        place[entry] = there.size();
        there.push_back(entry);
      }
    std::vector<double> dense;
    for (const unsigned int entry : there)
      dense.insert(dense.end(), &mine[width * entry], &mine[width * entry] + width);
    GhostExchange(ownership, read, width, [&](const unsigned int e) {
      return place[e];
    }).update(dense.data());
    right = true;
    for (unsigned int e = 0; e < dense.size(); ++e)
      right = right && dense[e] == known(there[e / width], e % width);
    say("without room for others the same", right);
  }

  /// How many nodes of other ranks all ranks read together, when `owner` says whose nodes are.
  unsigned int n_read_from_others(const Topology &topology, const std::vector<unsigned int> &owner)
  {
    unsigned int n = 0;
    for (unsigned int r = 0; r < n_ranks(); ++r)
      for (NodeIndex k = 0; k < owner.size(); ++k)
      {
        const auto neighbours = topology.neighbours[k];
        n += owner[k] != r && std::any_of(neighbours.begin(), neighbours.end(), [&](const NodeIndex other) {
               return owner[other] == r;
             });
      }
    return n;
  }
} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                                  mesh = kuhn_box(9, 0.1);
  const Topology                                 topology(mesh);
  const Partition                                partition(mesh, topology, MPI_COMM_WORLD);
  check_numbers(partition.nodes(), mesh.n_nodes(), "nodes");
  check_numbers(partition.cells(), mesh.n_cells(), "cells");
  std::vector<NodeIndex> read;
  for (const CellIndex c : partition.visited_cells)
    read.insert(read.end(), mesh.cells[c].begin(), mesh.cells[c].end());
  check_exchange(partition.nodes(), read);
  check_exchange(partition.nodes(), {mesh.n_nodes() / 2, 0, mesh.n_nodes() - 1, 0});
  check_exchange(partition.cells(), {});

  bool visits = true;
  for (const CellIndex c : partition.cells().owned())
    visits = visits && std::binary_search(partition.visited_cells.begin(), partition.visited_cells.end(), c);
  say("owned cells are visited", visits);
  const double share = mesh.n_nodes() / double(n_ranks());
  say("parts are equal to 5 %", std::abs(partition.nodes().range().n_owned() - share) < 0.05 * share);

  // Numbers of this box run along one of its edges fastest: ranges of them are plates, too, and as good.
  const auto               &owner = partition.owner_of_nodes();
  std::vector<unsigned int> ranges(mesh.n_nodes()), odd(mesh.n_nodes());
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    ranges[k] = k * n_ranks() / mesh.n_nodes(), odd[k] = k % n_ranks();
  const unsigned int n_metis = n_read_from_others(topology, owner);
  say("read from others: less than a quarter of what a random split takes",
      4 * n_metis <= n_read_from_others(topology, odd));
  say("and not more than a quarter above that of plates",
      n_metis <= 1.25 * n_read_from_others(topology, ranges));

  const TetMesh   small = kuhn_box(1, 0.);
  const Topology  small_topology(small);
  const Partition of_few(small, small_topology, MPI_COMM_WORLD);
  say("of eight nodes each rank has some", of_few.nodes().range().n_owned() > 0);
}
