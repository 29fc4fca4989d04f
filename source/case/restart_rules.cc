// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/parameters.h>
#include <retroforge/case/restart_rules.h>
#include <retroforge/core/error.h>
#include <retroforge/core/fingerprint.h>
#include <retroforge/core/parameter_input.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace retroforge
{
  namespace
  {
    using Values = std::map<std::string, std::string>;

    Values values_of(const std::string &parameters)
    {
      return parameter_values(parameter_lines_of(parameters, "parameters of the record"));
    }

    /// A setting that nothing is said of is the scene's.
    SettingRole role_of(const std::string &path)
    {
      return Parameters::tags().role(path).value_or(SettingRole::scene);
    }

    bool is_same_number(const std::string &a, const std::string &b)
    {
      std::istringstream in_a(a), in_b(b);
      double             x = 0., y = 0.;
      return (in_a >> x) && (in_b >> y) && in_a.eof() && in_b.eof() && x == y;
    }

    std::vector<ChangedSetting>
    changed_settings(const std::string &before, const std::string &now, const SettingRole role)
    {
      const Values values_before = values_of(before), values_now = values_of(now);
      const auto   value = [](const Values &values, const std::string &path) {
        const auto found = values.find(path);
        return found == values.end() ? "(absent)" : found->second;
      };
      Values all = values_before;
      all.insert(values_now.begin(), values_now.end());
      std::vector<ChangedSetting> changes;
      for (const auto &[path, ignored] : all)
        if (role_of(path) == role)
          if (const std::string a = value(values_before, path), b = value(values_now, path);
              a != b && !is_same_number(a, b))
            changes.push_back({path, a, b});
      return changes;
    }

    bool a_die_follows(const Values &values)
    {
      const std::string name = "/follows billet";
      return std::any_of(values.begin(), values.end(), [&](const auto &entry) {
        const std::string &path = entry.first;
        return path.size() > name.size() && path.substr(path.size() - name.size()) == name &&
               entry.second == "true";
      });
    }

    const std::string untouched = "; nothing was changed there";
    const std::string anew      = ", or begin anew with --overwrite";
  } // namespace

  std::vector<ChangedSetting> changed_numerics(const std::string &before, const std::string &now)
  {
    return changed_settings(before, now, SettingRole::numerics);
  }

  Resumption::Resumption(const std::string &directory,
                         const std::string &parameters,
                         const double       press_stroke)
      : directory_(directory)
  {
    const RecordReader record(directory);
    header                         = record.header();
    inputs                         = record.inputs();
    n_increments                   = record.n_increments();
    const auto [operation, stroke] = record.end();
    changes                        = changed_numerics(inputs.back().parameters, parameters);
    std::string list;
    for (const ChangedSetting &setting : changed_settings(header.parameters, parameters, SettingRole::scene))
      list += (list.empty() ? "" : ", ") + setting.path + " is '" + setting.now + "' and was '" +
              setting.before + "'";
    // The stretch of its path, and so all times, would be other ones; or it is done.
    const std::string why = a_die_follows(values_of(parameters)) ? " with a die that follows the billet"
                            : operation > 0                      ? " and is done"
                                                                 : "";
    for (const ChangedSetting &setting : changes)
      if (setting.path == "Press/stroke" && !why.empty())
        list += (list.empty() ? "" : ", ") + setting.path + " is '" + setting.now + "' and was '" +
                setting.before + "'" + why;
    if (operation == 0 && stroke > press_stroke * (1. + 1e-9))
      list += (list.empty() ? "" : ", ") + std::string("Press/stroke is ") + as_text(press_stroke) +
              " mm and the record has come to " + as_text(stroke) + " mm";
    if (!list.empty())
      throw Error(directory,
                  "holds the record of another scene: " + list,
                  "a run goes on with the billet, dies, material and contact law it began with, from where "
                  "its record ends; only numerics may change (increments and halving, a stroke that goes on, "
                  "Newton, Linear solver, Remeshing)",
                  "restore these values" + anew + untouched);
  }

  void Resumption::check_increments() const
  {
    RecordReader(directory_).check_increments();
  }

  void Resumption::check_start(const TetMesh              &mesh,
                               const NodalVectors<double> &X_0,
                               const std::vector<Die>     &dies) const
  {
    const auto n = retroforge::facets(dies);
    const auto f = fingerprints(dies);
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (d >= header.die_facets.size() || header.die_facets[d] != n[d] || header.die_fingerprints[d] != f[d])
        throw Error("Die " + dies[d].name,
                    "its surface differs from that in the record of " + directory_,
                    "a run goes on with the dies it began with",
                    "restore the die's file" + anew + untouched);
    if (header.mesh.cells != mesh.cells || header.X_0 != X_0)
      throw Error("Billet",
                  "its mesh differs from that in the record of " + directory_,
                  "a run goes on with the billet it began with",
                  "use the same mesh file and the same version of the mesher" + anew + untouched);
  }

  std::vector<unsigned int> facets(const std::vector<Die> &dies)
  {
    std::vector<unsigned int> n;
    for (const Die &die : dies)
      n.push_back(die.n_facets());
    return n;
  }

  std::vector<std::uint64_t> fingerprints(const std::vector<Die> &dies)
  {
    std::vector<std::uint64_t> all;
    for (const Die &die : dies)
    {
      Fingerprint fingerprint;
      if (const TriangleSurface *surface = die.surface())
      {
        fingerprint.add(surface->vertices().data(), surface->vertices().size() * sizeof(Vec3));
        fingerprint.add(surface->triangles().data(), surface->triangles().size() * sizeof(Triangle));
      }
      all.push_back(fingerprint.value);
    }
    return all;
  }

  namespace
  {
    /// Whether all is equal but for settings of some roles.
    bool are_same_but_for(const std::vector<SettingRole> &roles, const std::string &a, const std::string &b)
    {
      const auto that_matter = [&](const std::string &text) {
        Values values = values_of(text);
        for (auto entry = values.begin(); entry != values.end();)
          entry = std::find(roles.begin(), roles.end(), role_of(entry->first)) == roles.end()
                    ? std::next(entry)
                    : values.erase(entry);
        return values;
      };
      return that_matter(a) == that_matter(b);
    }
  } // namespace

  bool make_same_results(const std::string &parameters, const std::string &others)
  {
    return are_same_but_for({SettingRole::check, SettingRole::report}, parameters, others);
  }

  bool make_same_check(const std::string &parameters, const std::string &others)
  {
    return are_same_but_for({SettingRole::report}, parameters, others);
  }
} // namespace retroforge
