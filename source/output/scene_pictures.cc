// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/whole_part.h>
#include <retroforge/output/die_pictures.h>
#include <retroforge/output/field_file.h>
#include <retroforge/output/picture_series.h>
#include <retroforge/output/scene_pictures.h>

namespace retroforge
{
  void ScenePictures::add_billet(const TetMesh                       &mesh,
                                 const NodalVectors<double>          &X,
                                 const std::vector<Die>              &dies,
                                 const std::vector<DieState<double>> &states)
  {
    const auto [low, high] = bounding_box(X);
    std::vector<double> gap(X.size(), (high - low).norm()), nearest(X.size(), 0.);
    for (NodeIndex k = 0; k < X.size(); ++k)
      for (unsigned int d = 0; d < dies.size(); ++d)
        if (const double distance = dies[d].signed_distance(X[k], states[d].displacement); distance < gap[k])
        {
          gap[k]     = distance;
          nearest[k] = d + 1.;
        }
    FieldFile<3> picture(X, mesh.cells);
    picture.add_linear("gap", "mm", gap);
    picture.add_linear("nearest_die", "", nearest);
    picture.add_symmetry_planes(symmetry_planes(mesh));
    files_.push_back("scene_billet.vtu");
    picture.write(directory_ + "/" + files_.back());
  }

  void ScenePictures::add_die(const Die &die, const Vec3 &displacement, const NodalVectors<double> &around)
  {
    const TriangleSurface picture = die_picture(die, displacement, around);
    files_.push_back("scene_die_" + die.name + ".vtu");
    FieldFile<2>(picture.vertices(), picture.triangles()).write(directory_ + "/" + files_.back());
  }

  void ScenePictures::write_list() const
  {
    PictureSeries(directory_ + "/scene.pvd").add(0., files_);
  }
} // namespace retroforge
