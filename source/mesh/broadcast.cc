// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/core/remote_error.h>
#include <retroforge/mesh/broadcast.h>

#include <cstring>
#include <string>
#include <type_traits>

namespace retroforge
{
  namespace
  {
    // Arrays of plain data, in pieces MPI can count.
    template <typename T>
    void broadcast_array(std::vector<T> &array, MPI_Comm communicator)
    {
      static_assert(sizeof(T) % sizeof(int) == 0, "Plain data without padding is sent as words.");
      unsigned long long n = array.size();
      MPI_Bcast(&n, 1, MPI_UNSIGNED_LONG_LONG, 0, communicator);
      array.resize(n);
      constexpr unsigned long long piece = 1u << 24;
      for (unsigned long long begin = 0; begin < n; begin += piece)
        MPI_Bcast(array.data() + begin,
                  static_cast<int>(std::min(piece, n - begin) * sizeof(T) / sizeof(int)),
                  MPI_INT,
                  0,
                  communicator);
    }

    void broadcast_text(std::string &text, MPI_Comm communicator)
    {
      std::vector<int> letters(text.begin(), text.end());
      broadcast_array(letters, communicator);
      text.assign(letters.begin(), letters.end());
    }

    void broadcast_patch(Patch &patch, MPI_Comm communicator)
    {
      broadcast_text(patch.name, communicator);
      std::vector<Plane> plane;
      if (patch.symmetry)
        plane.push_back(*patch.symmetry);
      broadcast_array(plane, communicator);
      if (!plane.empty())
        patch.symmetry = plane[0];
    }

    void broadcast_mesh(TetMesh &mesh, MPI_Comm communicator)
    {
      broadcast_array(mesh.X, communicator);
      broadcast_array(mesh.cells, communicator);
      broadcast_array(mesh.faces, communicator);
      unsigned int n_patches = mesh.patches.size();
      MPI_Bcast(&n_patches, 1, MPI_UNSIGNED, 0, communicator);
      mesh.patches.resize(n_patches);
      for (auto &patch : mesh.patches)
        broadcast_patch(patch, communicator);
      broadcast_array(mesh.of_file.tags, communicator);
      broadcast_array(mesh.of_file.nodes, communicator);
      broadcast_array(mesh.of_file.X, communicator);
    }
  } // namespace

  TetMesh make_on_root(const std::string              &where,
                       const std::function<TetMesh()> &make,
                       MPI_Comm                        communicator,
                       std::vector<NodeIndex>         *with_it)
  {
    TetMesh     mesh;
    std::string failure;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
      {
        mesh = make();
      }
      catch (const Error &error)
      {
        failure = error.what();
      }
      catch (const std::exception &error)
      {
        failure = where + ": " + error.what() + "; the mesh must be made; see the message";
      }
    broadcast_text(failure, communicator);
    if (!failure.empty())
      throw remote_error(failure);
    broadcast_mesh(mesh, communicator);
    if (with_it)
      broadcast_array(*with_it, communicator);
    return mesh;
  }
} // namespace retroforge
