// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/design/first_mesh.h>
#include <retroforge/design/free_form.h>

namespace retroforge
{
  namespace
  {
    NodalVectors<double> in_own_axes(const BilletParameters &billet, const NodalVectors<double> &X)
    {
      const auto           back = transpose(billet.rotations.matrix());
      NodalVectors<double> own;
      for (const Vec3 &x : X)
        own.push_back(back * (x - billet.translation) - billet.base_centre);
      return own;
    }

    /// In the axes of the mesh.
    BilletShapes shapes_of_kind(const BilletParameters &billet, const NodalVectors<double> &X)
    {
      const NodalVectors<double> own      = in_own_axes(billet, X);
      const auto                 rotation = billet.rotations.matrix();
      BilletShapes shapes = billet.shape == BilletParameters::Shape::box        ? box_shapes(billet, own)
                            : billet.shape == BilletParameters::Shape::cylinder ? cylinder_shapes(billet, own)
                            : billet.shape == BilletParameters::Shape::ring     ? ring_shapes(billet, own)
                            : billet.shape == BilletParameters::Shape::profile  ? profile_shapes(billet, own)
                                                                                : BilletShapes();
      for (ShapeParameter &parameter : shapes.parameters)
        for (Vec3 &d : parameter.direction)
          d = rotation * d;
      return shapes;
    }
  } // namespace

  FirstMesh first_mesh(const BilletParameters &billet, const TetMesh &mesh)
  {
    FirstMesh         first{mesh, shapes_of_kind(billet, mesh.X), {}};
    const std::size_t n = first.shapes.parameters.size();
    // The kind knows nothing of free forms.
    if (const auto complaint = first.shapes.complaint)
      first.shapes.complaint = [complaint, n](std::vector<double> values) {
        values.resize(n);
        return complaint(values);
      };
    for (ShapeParameter &parameter : free_form_shapes(billet.free_form, mesh))
      first.shapes.parameters.push_back(std::move(parameter));
    for (const ShapeParameter &parameter : first.shapes.parameters)
      first.at.push_back(parameter.nominal);
    return first;
  }

  std::vector<ShapeParameter> shape_parameters(const BilletParameters &billet, const NodalVectors<double> &X)
  {
    return shapes_of_kind(billet, X).parameters;
  }
} // namespace retroforge
