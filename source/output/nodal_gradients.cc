// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/nodal_gradients.h>
#include <retroforge/output/safe_file.h>

#include <functional>
#include <sstream>

namespace retroforge
{
  namespace
  {
    /// Rows of a number, a position, and a vector of each objective.
    class NodalTable
    {
    public:
      NodalTable(const std::string &nodes, const std::vector<ObjectiveSensitivity> &sensitivities)
      {
        text_.precision(17);
        text_ << nodes << ",x,y,z";
        for (const ObjectiveSensitivity &objective : sensitivities)
          for (const char *direction : {"dx", "dy", "dz"})
            text_ << ',' << objective.name << ' ' << direction;
        text_ << '\n';
      }

      /// @param derivative  of the objective with that number
      void add(const std::size_t                               number,
               const Vec3                                     &X,
               const std::size_t                               n_objectives,
               const std::function<Vec3(const std::size_t j)> &derivative)
      {
        text_ << number;
        append(X);
        for (std::size_t j = 0; j < n_objectives; ++j)
          append(derivative(j));
        text_ << '\n';
      }

      void write(const std::string &file) const { write_file(file, text_.str()); }

    private:
      std::ostringstream text_;

      void append(const Vec3 &x)
      {
        for (unsigned int i = 0; i < 3; ++i)
          text_ << ',' << x[i];
      }
    };

    NodalTable table_of_billet(const TetMesh                           &billet,
                               const NodalVectors<double>              &X_0,
                               const std::vector<ObjectiveSensitivity> &sensitivities)
    {
      NodalTable table("node", sensitivities);
      const auto add = [&](const std::size_t number, const NodeIndex k) {
        table.add(number, X_0[k], sensitivities.size(), [&](const std::size_t j) {
          return sensitivities[j].shape.X_0[k];
        });
      };
      const FileNodes &file = billet.of_file;
      for (std::size_t i = 0; i < file.tags.size(); ++i)
        if (file.nodes[i] != invalid_index)
          add(file.tags[i], file.nodes[i]);
        else
          table.add(file.tags[i], file.X[i], sensitivities.size(), [](const std::size_t) { return Vec3(); });
      if (file.tags.empty())
        for (NodeIndex k = 0; k < X_0.size(); ++k)
          add(k + 1, k);
      return table;
    }
  } // namespace

  void write_nodal_gradients(const std::string                       &directory,
                             const TetMesh                           &billet,
                             const NodalVectors<double>              &X_0,
                             const std::vector<Die>                  &dies,
                             const Process<double>                   &process,
                             const std::vector<ObjectiveSensitivity> &sensitivities)
  {
    table_of_billet(billet, X_0, sensitivities).write(directory + "/sensitivity_nodes.csv");
    for (std::size_t d = 0; d < dies.size(); ++d)
      if (const TriangleSurface *surface = dies[d].surface())
      {
        NodalTable table("node", sensitivities);
        for (std::size_t k = 0; k < surface->vertices().size(); ++k)
          table.add(k + 1,
                    surface->vertices()[k] + process.dies[d].displacement,
                    sensitivities.size(),
                    [&](const std::size_t j) { return sensitivities[j].shape.dies[d][k]; });
        table.write(directory + "/sensitivity_die_" + dies[d].name + "_nodes.csv");
      }
  }
} // namespace retroforge
