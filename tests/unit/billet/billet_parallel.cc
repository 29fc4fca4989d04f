// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The billet on several ranks. Proved: two meshings in one process are the same, bit for bit; all ranks hold
// the same mesh; an error found on rank 0 (a mesh file that is not there) is thrown on all ranks with one
// message.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

#include <cstring>

using namespace retroforge;

// FNV-1a over the bits of all arrays.
unsigned long fingerprint(const TetMesh &mesh)
{
  unsigned long hash = 1469598103934665603ul;
  const auto    add  = [&](const void *data, const std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      hash = (hash ^ static_cast<const unsigned char *>(data)[i]) * 1099511628211ul;
  };
  add(mesh.X.data(), mesh.X.size() * sizeof(mesh.X[0]));
  add(mesh.cells.data(), mesh.cells.size() * sizeof(mesh.cells[0]));
  add(mesh.faces.data(), mesh.faces.size() * sizeof(mesh.faces[0]));
  for (const auto &patch : mesh.patches)
  {
    add(patch.name.data(), patch.name.size());
    if (patch.symmetry)
      add(&*patch.symmetry, sizeof(Plane));
  }
  return hash;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize               mpi(argc, argv, 1);
  const std::vector<std::pair<std::string, std::string>> entries = {
    {"shape", "cylinder"}, {"element size", "5"}, {"sector angle", "72"}};
  const TetMesh first = billet(entries);
  billet({{"element size", "9"}}); // another mesh in between leaves no trace
  const TetMesh       second = billet(entries);
  const unsigned long hash   = fingerprint(first);
  const bool          same   = hash == fingerprint(second);
  const bool          shared =
    dealii::Utilities::MPI::max(hash, MPI_COMM_WORLD) == dealii::Utilities::MPI::min(hash, MPI_COMM_WORLD);
  check_mesh(first, "this rank's mesh");

  std::string message;
  try
  {
    billet({{"shape", "file"}, {"file name", "not_there.msh"}});
  }
  catch (const Error &error)
  {
    message = error.what();
  }
  const auto messages = dealii::Utilities::MPI::gather(MPI_COMM_WORLD, message);
  const bool all_same = dealii::Utilities::MPI::min(static_cast<int>(same), MPI_COMM_WORLD);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
  {
    std::cout << "two meshings are identical: " << yes(all_same)
              << "\nranks hold the same mesh: " << yes(shared) << "\n";
    for (const auto &text : messages)
      std::cout << text << "\n";
  }
}
