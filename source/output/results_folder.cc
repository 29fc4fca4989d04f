// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/parameter_input.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>

#include <algorithm>
#include <filesystem>
#include <regex>

namespace retroforge
{
  namespace
  {
    namespace fs = std::filesystem;

    /// Of files a run, a scan, a look at a scene or the report writes.
    const std::regex file_names(
      "(parameters|best)(_.*)?\\.prm|summary\\.json|check\\.json|(history|objectives|scan)\\.csv|scan\\.json|"
      "fields\\.pvd|fields_[0-9]{6,}\\.vtu|failed\\.vtu|failure\\.txt|"
      "(journal|confirmation)\\.jsonl|optimisation\\.(csv|json)|steps(_.*)?\\.csv|"
      "scene\\.(json|pvd)|scene_(billet|die_.*)\\.vtu|"
      "sensitivity(_die_.*)?(\\.vtu|_nodes\\.csv)|billet\\.msh|forged\\.(msh|stl)|"
      "die_.*\\.(stl|vtu)|map_.*\\.csv|record\\.h5|report\\.html");

    bool is_result(const fs::path &path)
    {
      std::error_code   ignored;
      const std::string name = path.filename().string();
      if (!fs::is_directory(path, ignored))
        return std::regex_match(name, file_names);
      // Of an optimisation, which goes where its journal does.
      if (name == "designs")
        return fs::exists(path / "start_billet.msh", ignored) || fs::is_empty(path, ignored);
      return (name == "record" && (fs::exists(path / "header.h5", ignored) ||
                                   fs::exists(path / "increment_000000.h5", ignored))) ||
             (name == "pictures" && fs::exists(path.parent_path() / "report.html", ignored));
    }

    void append_results(const fs::path &folder,
                        bool (*const chosen)(const fs::path &),
                        const std::string        &prefix,
                        std::vector<std::string> &names)
    {
      std::error_code error;
      for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (chosen(entry->path()))
          names.push_back(prefix + entry->path().filename().string());
    }

    /// The points of a scan, each in a folder of its own.
    bool is_point(const fs::path &folder)
    {
      std::error_code ignored;
      return fs::exists(folder / "command.txt", ignored);
    }

    void remove(const std::string &directory, const std::vector<std::string> &names)
    {
      for (const std::string &name : names)
      {
        std::error_code error;
        fs::remove_all(fs::path(directory) / name, error);
        if (error)
          throw_write_error(directory + "/" + name, error.value());
      }
    }
  } // namespace

  std::vector<std::string> results_in(const std::string &directory)
  {
    std::vector<std::string> names;
    append_results(directory, is_result, "", names);
    append_results(fs::path(directory) / "points", is_point, "points/", names);
    std::sort(names.begin(), names.end());
    return names;
  }

  namespace
  {
    /// Whatever parameter names one of the results: the billet, a die, a target.
    void check_not_read(const std::string              &directory,
                        const std::vector<std::string> &names,
                        const std::string              &parameters)
    {
      for (const auto &[parameter, value] : parameter_values(parameter_lines_of(parameters, "parameters")))
        if (std::error_code ignored; fs::exists(value, ignored)) // which most are not
          for (const std::string &name : names)
            if (fs::equivalent(value, fs::path(directory) / name, ignored))
              throw Error(parameter,
                          "is " + value + ", a result that --overwrite would remove",
                          "a run does not remove what it reads",
                          "write to another folder with --output DIR");
    }
  } // namespace

  void make_results_folder(const std::string &directory, const bool overwrite, const std::string &parameters)
  {
    make_directory(directory);
    const std::vector<std::string> names = results_in(directory);
    if (!names.empty() && !overwrite)
      throw Error(directory,
                  "holds results already (" + names.front() +
                    (names.size() > 1 ? " and " + std::to_string(names.size() - 1) + " more" : "") + ")",
                  "no run writes over another unless told to",
                  "go on with that run with --resume, replace it with --overwrite, or choose another folder "
                  "with --output DIR");
    check_not_read(directory, names, parameters);
    remove(directory, names);
  }

  void remove_all_but_record(const std::string &directory, const bool keep_check)
  {
    std::vector<std::string> names = results_in(directory);
    names.erase(std::remove_if(names.begin(),
                               names.end(),
                               [&](const std::string &name) {
                                 return name == "record" || name == "record.h5" ||
                                        (keep_check && name == "check.json");
                               }),
                names.end());
    remove(directory, names);
  }
} // namespace retroforge
