// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/output/field_file.h>
#include <retroforge/output/sensitivity.h>

namespace retroforge
{
  namespace
  {
  } // namespace

  void write_sensitivity(const std::string                       &directory,
                         const TetMesh                           &billet,
                         const NodalVectors<double>              &X_0,
                         const std::vector<Die>                  &dies,
                         const std::vector<ObjectiveSensitivity> &sensitivities)
  {
    FieldFile<3> of_billet(X_0, billet.cells);
    for (const ObjectiveSensitivity &objective : sensitivities)
      of_billet.add_linear("d" + as_identifier(objective.name) + "_dX0", "", objective.shape.X_0);
    of_billet.add_symmetry_planes(symmetry_planes(billet));
    of_billet.write(directory + "/sensitivity.vtu");
    for (std::size_t d = 0; d < dies.size(); ++d)
      if (const TriangleSurface *surface = dies[d].surface())
      {
        FieldFile<2> of_die(surface->vertices(), surface->triangles());
        for (const ObjectiveSensitivity &objective : sensitivities)
          of_die.add_linear("d" + as_identifier(objective.name) + "_dXdie", "", objective.shape.dies[d]);
        of_die.write(directory + "/sensitivity_die_" + dies[d].name + ".vtu");
      }
  }
} // namespace retroforge
