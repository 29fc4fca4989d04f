// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/length_pass.h>
#include <retroforge/remeshing/local_remesher.h>
#include <retroforge/remeshing/quality_pass.h>
#include <retroforge/remeshing/volume_correction.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace retroforge
{
  namespace
  {
    void check_volumes(const TetMesh &mesh, const NodalVectors<double> &X)
    {
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        if (!(tet_volume(corners(mesh.cells[c], X)) > 0))
          throw Error("remeshing",
                      "tetrahedron " + std::to_string(c) + " has the volume " +
                        as_text(tet_volume(corners(mesh.cells[c], X))),
                      "local remeshing needs positive volumes",
                      "take smaller increments, remesh earlier, or rebuild the mesh from its surface");
    }

    // Corrects the volume and says which kept nodes moved, and how far.
    void restore_volume(const NodalVectors<double> &X,
                        const SizeField            &size,
                        const RemeshingParameters  &parameters,
                        const TouchesDie           &touches,
                        RemeshedMesh               &result,
                        TapeWriter                 *tape)
    {
      TetMesh         &mesh     = result.mesh;
      RemeshingReport &report   = result.report;
      report.volume_uncorrected = volume(mesh.cells, mesh.X);
      std::vector<bool> held(mesh.n_nodes(), false);
      if (touches)
        for (const BoundaryFace &face : mesh.faces)
          if (mesh.is_surface(face))
            for (const NodeIndex node : face.nodes)
              held[node] = held[node] || touches(mesh.X[node]);
      const VolumeCorrection made  = correct_volume(mesh, report.volume_before, held, parameters.ridge_angle);
      const double           moved = std::abs(made.distance);
      if (tape && !made.directions.empty())
        tape->keep_volume(mesh.faces, made);
      result.correction.resize(mesh.n_nodes());
      for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      {
        const double h            = moved > 0 ? size(mesh.X[node]) : 1;
        report.largest_correction = std::max(report.largest_correction, moved / h);
        if (result.old_node[node] == invalid_index)
          continue;
        result.correction[node] = mesh.X[node] - X[result.old_node[node]];
        if (result.correction[node].norm() > parameters.kept_move * h)
        {
          result.old_node[node]   = invalid_index;
          result.correction[node] = Vec3();
        }
      }
      report.volume_after = volume(mesh.cells, mesh.X);
    }

    struct Worst
    {
      double quality = 1, angle = 180;
    };

    // The sine in the quality is a bound for the angle, which costs more: few cells need it.
    Worst worst_cell(const TetMesh &mesh, const NodalVectors<double> &X)
    {
      Worst worst;
      for (const auto &cell : mesh.cells)
      {
        const TetCorners x       = corners(cell, X);
        const double     quality = tet_quality(x);
        worst.quality            = std::min(worst.quality, quality);
        if (worst.angle > 90 || quality < std::sin(worst.angle * M_PI / 180))
          worst.angle = std::min(worst.angle, minimum_dihedral_angle(x));
      }
      return worst;
    }

    void report_before(const TetMesh &mesh, const NodalVectors<double> &X, RemeshingReport &report)
    {
      const Worst worst     = worst_cell(mesh, X);
      report.n_nodes_before = mesh.n_nodes();
      report.volume_before  = volume(mesh.cells, X);
      report.quality_before = worst.quality;
      report.angle_before   = worst.angle;
    }

    void report_after(const RemeshedMesh &result, RemeshingReport &report)
    {
      const TetMesh &mesh  = result.mesh;
      const Worst    worst = worst_cell(mesh, mesh.X);
      report.n_nodes_after = mesh.n_nodes();
      report.n_cells_after = mesh.n_cells();
      report.n_nodes_kept =
        mesh.n_nodes() - std::count(result.old_node.begin(), result.old_node.end(), invalid_index);
      report.quality_after = worst.quality;
    }
  } // namespace

  RemeshedMesh remesh_locally(const TetMesh              &mesh,
                              const NodalVectors<double> &X,
                              const SizeField            &size,
                              const RemeshingParameters  &parameters,
                              const PushOut              &push_out,
                              const TouchesDie           &touches,
                              const std::optional<double> wanted_volume,
                              TapeWriter                 *tape)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    Assert(!wanted_volume || *wanted_volume > 0., dealii::ExcMessage("a volume is positive"));
    check_volumes(mesh, X);
    RemeshedMesh result;
    report_before(mesh, X, result.report);
    if (wanted_volume)
      result.report.volume_before = *wanted_volume;

    const SurfaceFeatures features(mesh, X, parameters.ridge_angle, parameters.corner_angle, push_out);
    const OldSurface      old_surface(mesh, X, features, push_out);
    EditableMesh          edited(mesh, X, features);
    if (tape)
      tape->begin_pass();
    RemeshingContext context = {edited, old_surface, size, parameters, tape};
    length_pass(context, result.report);
    QualityPass(context, result.report).run();

    result.mesh         = compacted(edited, features, result.old_node);
    result.mesh.patches = mesh.patches;
    if (tape)
      tape->place(tape->nodes(order_of_compacted(edited)));
    restore_volume(X, size, parameters, touches, result, tape);
    report_after(result, result.report);
    return result;
  }
} // namespace retroforge
