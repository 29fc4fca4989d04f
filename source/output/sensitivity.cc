// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/sensitivity.h>
#include <retroforge/output/vtu_writer.h>

#include <cctype>

namespace retroforge
{
  namespace
  {
    /// For names of fields.
    std::string as_identifier(std::string name)
    {
      for (char &c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0)
          c = '_';
      return name;
    }
  } // namespace

  void write_sensitivity(const std::string          &directory,
                         const TetMesh              &billet,
                         const NodalVectors<double> &X_0,
                         const std::vector<Die>     &dies,
                         const std::vector<Judged>  &judged)
  {
    std::vector<VectorField> fields;
    for (const Judged &objective : judged)
      fields.push_back({"d" + as_identifier(objective.name) + "_dX0", objective.shape.X_0});
    write_vtu(directory + "/sensitivity.vtu", billet, X_0, {}, fields, {});
    for (std::size_t d = 0; d < dies.size(); ++d)
      if (const TriangleSurface *surface = dies[d].surface())
      {
        fields.clear();
        for (const Judged &objective : judged)
          fields.push_back({"d" + as_identifier(objective.name) + "_dXdie", objective.shape.dies[d]});
        write_vtu(directory + "/sensitivity_die_" + dies[d].name + ".vtu", *surface, fields);
      }
  }
} // namespace retroforge
