// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/mesh/broadcast.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/rebuild.h>
#include <retroforge/mesh/remeshing/trigger.h>
#include <retroforge/mesh/renumber.h>
#include <retroforge/time/remesher.h>

namespace retroforge
{
  void RemesherParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Remeshing");
    prm.add_parameter("when",
                      when,
                      "quality: when an angle between two faces of a cell falls below the trigger angle, or an "
                      "increment would invert a cell. increments: that, and after every so many increments. "
                      "Units: none.",
                      Selection("never|quality|increments"));
    prm.add_parameter("every", every, "Increments between remeshings. Units: none.", Integer(1));
    prm.add_parameter("method",
                      method,
                      "local changes the mesh only where it is bad, and rebuilds it when cells are inverted; "
                      "rebuild makes the whole inside anew each time. Units: none.",
                      Selection("local|rebuild"));
    prm.add_parameter("element size",
                      element_size,
                      "Wanted length of the edges; 0 for that of the billet. Units: mm.",
                      Double(0.));
    prm.add_parameter("first mesh",
                      first_mesh,
                      "Improve the billet's mesh by one pass before the run begins. Units: none.");
    prm.leave_subsection();
    local.add_parameters(prm);
  }

  void RemesherParameters::check() const
  {
    local.check();
  }

  Remesher::Remesher(const RemesherParameters &parameters, const double element_size, MPI_Comm comm)
      : parameters_(parameters), element_size_(element_size), comm_(comm)
  {
  }

  bool Remesher::due(const TetMesh              &mesh,
                     const NodalVectors<double> &X,
                     const std::vector<bool>    &frozen,
                     const unsigned int          increments) const
  {
    if (increments == 0)
      return false;
    return (parameters_.when == "increments" && increments >= parameters_.every) ||
           needs_remeshing(mesh, X, parameters_.local, frozen);
  }

  std::vector<bool> Remesher::frozen(const TetMesh &mesh) const
  {
    return frozen_cells(mesh, parameters_.local);
  }

  RemeshedMesh Remesher::make(const TetMesh &mesh, const NodalVectors<double> &X) const
  {
    const SizeField size     = [h = element_size_](const Vec3 &) { return h; };
    const bool      inverted = minimum_quality(mesh.cells, X) <= 0.;
    if (parameters_.method == "local" && !inverted)
      return remesh_locally(mesh, X, size, parameters_.local);
    const RebuiltMesh rebuilt = rebuild_inside(mesh, X, size, "Remeshing");
    RemeshedMesh      local   = remesh_locally(rebuilt.mesh, rebuilt.mesh.X, size, parameters_.local);
    for (NodeIndex &k : local.old_node)
      if (k != invalid_index)
        k = rebuilt.old_node[k];
    return local;
  }

  std::shared_ptr<const RemeshRecord> Remesher::remesh(const TetMesh              &mesh,
                                                       const NodalVectors<double> &X) const
  {
    auto                   record = std::make_shared<RemeshRecord>();
    std::vector<NodeIndex> old_node;
    const auto             make_numbered = [&]() {
      RemeshedMesh made = make(mesh, X);
      check_mesh(made.mesh, "Remeshing");
      const std::vector<NodeIndex> number = renumber(made.mesh);
      old_node.resize(number.size());
      for (NodeIndex k = 0; k < number.size(); ++k)
        old_node[number[k]] = made.old_node[k];
      return std::move(made.mesh);
    };
    record->mesh     = make_on_root(make_numbered, comm_, &old_node);
    record->X_before = X;
    record->transfer = make_transfer(mesh, X, record->mesh, old_node);
    return record;
  }
} // namespace retroforge
