// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/design/billet_map.h>
#include <retroforge/design/mesh_anew.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/transfer/transfer.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    const std::string prefix = "billet/", where = "Design/meshed at";

    /// Returns the names of the parameters that keep the planes of symmetry, and of the one that holds the
    /// volume.
    std::vector<std::string> names_of(const BilletParameters &billet, const BilletMap &map)
    {
      std::vector<std::string> names;
      for (const ShapeParameter &parameter : map.parameters())
        names.push_back(prefix + parameter.name);
      if (!billet.volume_held_by.empty())
        names.push_back(prefix + billet.volume_held_by);
      return names;
    }

    void check_names(const std::vector<std::string> &known, const ShapeValues &given)
    {
      for (const auto &[name, value] : given)
      {
        if (given.count(name) > 1)
          throw Error(
            where, "'" + name + "' stands twice", "each parameter has one value", "leave one of them out");
        if (std::find(known.begin(), known.end(), name) != known.end())
          continue;
        const std::string near = nearest_name(name, known, 6);
        throw Error(where,
                    "'" + name + "' is not a parameter of the billet's shape",
                    known.empty() ? "this billet has none" : "those are " + join(known),
                    near.empty() ? "name some of these" : "did you mean '" + near + "'?");
      }
    }
  } // namespace

  bool has_measures(const BilletParameters &billet)
  {
    return !billet.is_from_file() && billet.free_form.modes == 0;
  }

  std::vector<double>
  shape_values(const BilletParameters &billet, const FirstMesh &first, const ShapeValues &given)
  {
    const BilletMap map(billet, first);
    check_names(names_of(billet, map), given);
    std::vector<double> mu;
    for (const ShapeParameter &parameter : map.parameters())
    {
      const auto found = given.find(prefix + parameter.name);
      mu.push_back(found == given.end() ? parameter.nominal : found->second);
    }
    std::vector<double> all  = map.all_values(mu);
    const auto          held = given.find(prefix + billet.volume_held_by);
    for (std::size_t j = 0; j < all.size(); ++j)
      if (held != given.end() && first.shapes.parameters[j].name == billet.volume_held_by)
        all[j] = held->second;
    if (first.shapes.complaint)
      if (const std::string complaint = first.shapes.complaint(all); !complaint.empty())
        throw Error(where,
                    complaint,
                    "no portion of the contour may vanish or cross another, and radii are positive",
                    "stay closer to the nominal values");
    return all;
  }

  namespace
  {
    void check_patches(const TetMesh &before, const TetMesh &after)
    {
      const auto is_same = [](const Patch &a, const Patch &b) {
        return a.name == b.name && a.symmetry.has_value() == b.symmetry.has_value();
      };
      if (!std::equal(before.patches.begin(),
                      before.patches.end(),
                      after.patches.begin(),
                      after.patches.end(),
                      is_same))
        throw Error(where,
                    "makes a billet with other patches than the nominal one",
                    "objectives know the billet by its patches",
                    "stay closer to the nominal values");
    }
  } // namespace

  FirstMesh meshed_anew(const FirstMesh                                        &first,
                        const std::vector<double>                              &values,
                        const std::function<TetMesh(const BilletParameters &)> &make)
  {
    const BilletParameters measured = first.shapes.measured(values);
    measured.check();
    FirstMesh anew{make(measured), first.shapes, values};
    check_patches(first.mesh, anew.mesh);
    const std::vector<ShapeParameter> there = shape_parameters(measured, anew.mesh.X);
    for (std::size_t j = 0; j < there.size(); ++j)
      anew.shapes.parameters[j].direction = there[j].direction;
    return anew;
  }

  namespace
  {
    NodalVectors<double> positions(const FirstMesh &first, const std::vector<double> &values)
    {
      NodalVectors<double> X = first.mesh.X;
      for (std::size_t j = 0; j < values.size(); ++j)
        for (std::size_t k = 0; k < X.size(); ++k)
          X[k] += (values[j] - first.at[j]) * first.shapes.parameters[j].direction[k];
      return X;
    }

    double mean_edge(const TetMesh &mesh, const std::array<NodeIndex, 4> &cell)
    {
      double sum = 0.;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b < a; ++b)
          sum += (mesh.X[cell[a]] - mesh.X[cell[b]]).norm();
      return sum / 6.;
    }

    /// Returns the sizes of the cells as made, at the present positions of the cells.
    OptimalSizes sizes_as_made(const TetMesh &mesh, const NodalVectors<double> &X)
    {
      OptimalSizes sizes;
      for (const auto &cell : mesh.cells)
      {
        const TetCorners x = corners(cell, X);
        sizes.centre.push_back(0.25 * (x[0] + x[1] + x[2] + x[3]));
        sizes.volume.push_back(tet_volume(x));
        sizes.size.push_back(mean_edge(mesh, cell));
      }
      return sizes;
    }

    /// Returns the edge length of a uniform mesh with as many cells.
    double uniform_size(const OptimalSizes &sizes)
    {
      double volume = 0., number = 0.;
      for (std::size_t c = 0; c < sizes.size.size(); ++c)
      {
        volume += sizes.volume[c];
        number += sizes.volume[c] / std::pow(sizes.size[c], 3);
      }
      return std::cbrt(volume / number);
    }
  } // namespace

  FirstMesh remeshed(const FirstMesh           &first,
                     const std::vector<double> &values,
                     const RemesherParameters  &parameters,
                     Timings                   &timings,
                     MPI_Comm                   comm)
  {
    const NodalVectors<double> X = positions(first, values);
    if (!(minimum_quality(first.mesh.cells, X) > 0.))
      throw Error(where,
                  "turns a tetrahedron of the mesh inside out",
                  "a billet without measures is known by its mesh, which must be able to follow",
                  "go there by a design in between: `DESIGN; DESIGN'");
    const OptimalSizes           sizes = sizes_as_made(first.mesh, X);
    const std::vector<Die>       none; // the shape is to stay, whatever stands in its way
    const Remesher               remesher(parameters, uniform_size(sizes), none, first.mesh.patches, comm);
    const auto                   made = remesher.remesh(first.mesh, X, {}, sizes, 0., timings);
    const std::vector<NodeIndex> all_are_new(made->mesh.n_nodes(), invalid_index);
    const TransferOperator J = make_transfer(first.mesh, X, made->mesh, all_are_new, Interpolation::linear);
    FirstMesh              anew{made->mesh, first.shapes, values};
    for (ShapeParameter &parameter : anew.shapes.parameters)
      parameter.direction = J.apply(parameter.direction);
    return anew;
  }
} // namespace retroforge
