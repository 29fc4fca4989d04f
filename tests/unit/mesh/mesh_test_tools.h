// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/billet.h>
#include <retroforge/core/error.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/mesh/mesh_quality.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <string>

namespace retroforge
{
  inline std::string yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  /// Billet from pairs of parameter name and value.
  inline BilletParameters billet_parameters(const std::vector<std::pair<std::string, std::string>> &entries)
  {
    BilletParameters         parameters;
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm);
    prm.enter_subsection("Billet");
    for (const auto &[name, value] : entries)
      prm.set(name, value);
    prm.leave_subsection();
    return parameters;
  }

  inline TetMesh billet(const std::vector<std::pair<std::string, std::string>> &entries)
  {
    return make_billet(billet_parameters(entries), MPI_COMM_WORLD);
  }

  /// Twice the outward area vector of a face.
  inline Vec3 face_normal(const TetMesh &mesh, const BoundaryFace &face)
  {
    const Vec3 &a = mesh.X[face.nodes[0]];
    return cross_product_3d(mesh.X[face.nodes[1]] - a, mesh.X[face.nodes[2]] - a);
  }

  inline double patch_area(const TetMesh &mesh, const unsigned int patch)
  {
    double area = 0;
    for (const auto &face : mesh.faces)
      if (face.patch == patch)
        area += face_normal(mesh, face).norm() / 2;
    return area;
  }

  /// Farthest a node of a symmetry patch is from its plane, and a face's unit normal from the plane's.
  inline double symmetry_defect(const TetMesh &mesh)
  {
    double defect = 0;
    for (const auto &face : mesh.faces)
      if (const auto &plane = mesh.patches[face.patch].symmetry)
      {
        for (const NodeIndex node : face.nodes)
          defect = std::max(defect, std::abs((mesh.X[node] - plane->point) * plane->normal));
        const Vec3 normal = face_normal(mesh, face);
        defect            = std::max(defect, (normal / normal.norm() - plane->normal).norm());
      }
    return defect;
  }

  /// What an action throws, on one line.
  /// @param shown  makes of the message what is printed of it
  template <typename Action>
  void print_error(
    const std::string                                     &title,
    const Action                                          &action,
    const std::function<std::string(const std::string &)> &shown = [](const std::string &text) {
      return text;
    })
  {
    std::cout << title << " -> ";
    try
    {
      action();
      std::cout << "nothing thrown" << std::endl;
    }
    catch (const Error &error)
    {
      std::cout << shown(error.what()) << std::endl;
    }
  }
} // namespace retroforge
