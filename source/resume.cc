// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/parameter_input.h>
#include <retroforge/resume.h>

#include <map>

namespace retroforge
{
  namespace
  {
    std::map<std::string, std::string> values_of(const std::string &parameters)
    {
      return parameter_values(parameter_lines_of(parameters, "parameters of the record"));
    }

    bool changes_the_run(const std::string &path)
    {
      if (path == "Design/at")
        return true;
      for (const char *section : {"Adjoint/", "Check/", "Design/", "Objective", "Output/", "Scan/"})
        if (path.rfind(section, 0) == 0)
          return false;
      return true;
    }
  } // namespace

  void check_resumable(const RecordHeader         &header,
                       const std::string          &parameters,
                       const TetMesh              &mesh,
                       const NodalVectors<double> &X_0,
                       const std::vector<Die>     &dies,
                       const std::string          &directory)
  {
    const auto recorded = values_of(header.parameters), now = values_of(parameters);
    const auto value = [](const std::map<std::string, std::string> &values, const std::string &path) {
      const auto found = values.find(path);
      return found == values.end() ? std::string("absent") : "'" + found->second + "'";
    };
    std::map<std::string, std::string> all = recorded;
    all.insert(now.begin(), now.end());
    for (const auto &[path, ignored] : all)
      if (changes_the_run(path) && value(recorded, path) != value(now, path))
        throw Error(path,
                    "is " + value(now, path) + ", in the record of " + directory + " it is " +
                      value(recorded, path),
                    "a run goes on with the parameters it began with",
                    "restore the value, or start anew without --resume");
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (d >= header.die_facets.size() || header.die_facets[d] != dies[d].n_facets())
        throw Error("Die " + dies[d].name,
                    "its surface has not the number of facets of that in the record of " + directory,
                    "a run goes on with the dies it began with",
                    "restore the die's file, or start anew without --resume");
    if (header.mesh.cells != mesh.cells || header.X_0 != X_0)
      throw Error(
        "Billet",
        "its mesh is another one than that in the record of " + directory,
        "a run goes on with the billet it began with",
        "use the same mesh file and the same version of the mesher, or start anew without --resume");
  }

  bool make_same_results(const std::string &parameters, const std::string &others)
  {
    const auto that_matter = [](const std::string &text) {
      auto values = values_of(text);
      for (auto entry = values.begin(); entry != values.end();)
      {
        const std::string section = entry->first.substr(0, entry->first.find('/'));
        const bool        matters = section != "Check" && section != "Output" && section != "Scan";
        entry                     = matters ? std::next(entry) : values.erase(entry);
      }
      return values;
    };
    return that_matter(parameters) == that_matter(others);
  }
} // namespace retroforge
