// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/restart_rules.h>
#include <retroforge/core/error.h>
#include <retroforge/core/fingerprint.h>
#include <retroforge/core/parameter_input.h>
#include <retroforge/core/version.h>
#include <retroforge/optimization/journal_rules.h>
#include <retroforge/output/safe_file.h>

#include <filesystem>

namespace retroforge
{
  namespace
  {
    /// What gives the same bits for the same design. @param comm  that it is forged on
    std::string program_on(MPI_Comm comm)
    {
      return std::string(version) + " " + commit + ", " +
             std::to_string(dealii::Utilities::MPI::n_mpi_processes(comm)) + " rank(s)";
    }

    std::map<std::string, std::string> parameters_of(const Scenarios &scenarios)
    {
      std::map<std::string, std::string> parameters;
      for (std::size_t o = 1; o < scenarios.size(); ++o)
        parameters[scenarios.name(o)] = scenarios.at(o).echo;
      return parameters;
    }

    /// What the parameters of all operations name, but do not tell.
    std::map<std::string, std::uint64_t> surfaces_of(const Scenarios &scenarios)
    {
      std::map<std::string, std::uint64_t> surfaces;
      for (std::size_t o = 0; o < scenarios.size(); ++o)
      {
        const Case       &forging_case = scenarios.at(o);
        const std::string tag          = o == 0 ? "" : " of operation " + scenarios.name(o);
        Fingerprint       billet;
        billet.add(forging_case.billet.cells.data(),
                   forging_case.billet.cells.size() * sizeof(forging_case.billet.cells[0]));
        billet.add(forging_case.billet.X.data(), forging_case.billet.X.size() * sizeof(Vec3));
        surfaces["mesh of the billet" + tag] = billet.value;
        const auto of_dies                   = fingerprints(forging_case.model.dies);
        for (std::size_t d = 0; d < of_dies.size(); ++d)
          surfaces["surface of die " + forging_case.model.dies[d].name + tag] = of_dies[d];
        const auto values = parameter_values(parameter_lines_of(forging_case.echo, "case"));
        for (const ObjectiveParameters &objective : forging_case.parameters.objectives.all)
          if (const auto target = values.find("Objective " + objective.name + "/target");
              target != values.end() && std::filesystem::is_regular_file(target->second))
          {
            const std::string contents = read_file(target->second);
            Fingerprint       of_file;
            of_file.add(contents.data(), contents.size());
            surfaces["target of objective " + objective.name + tag] = of_file.value;
          }
      }
      return surfaces;
    }
  } // namespace

  Journal::Header journal_header(const Scenarios &scenarios)
  {
    const Case &main = scenarios.at(0);
    return {program_on(main.comm), main.echo, parameters_of(scenarios), surfaces_of(scenarios)};
  }

  Journal resumed_journal(const Scenarios &scenarios)
  {
    const Case           &main   = scenarios.at(0);
    const std::string    &folder = main.command.output_directory, file = folder + "/journal.jsonl";
    const Journal::Header now = journal_header(scenarios);
    if (!std::filesystem::exists(file))
      throw Error(folder,
                  "holds no journal of an optimisation",
                  "--resume goes on with one",
                  "leave --resume out to begin, or name the folder with --output DIR");
    Journal         journal = Journal::read(file);
    Journal::Header header  = journal.header();
    if (header.program != now.program)
      throw Error(
        file,
        "was written by Retroforge " + journal.header().program + ", and this is " + now.program,
        "another version, or another number of ranks of a group, may give other values for the same design",
        "go on with that one, or begin anew with --overwrite");
    if (!make_same_results(journal.header().parameters, now.parameters))
      throw Error(
        file,
        "belongs to a case with other parameters",
        "an optimisation goes on with the case it began with; only the sections Optimisation, Check, "
        "Output and Scan may differ",
        "restore the parameters (" + folder + "/parameters.prm" +
          " has them), or begin anew with --overwrite");
    for (const auto &[name, parameters] : now.operations)
      if (!make_same_results(header.operations.emplace(name, parameters).first->second, parameters))
        throw Error(file,
                    "has forgings of another operation " + name,
                    "an optimisation goes on with the operations it began with, and may get more of them",
                    "restore its parameters (" + folder + "/parameters_" + name + ".prm" +
                      " has them), or begin anew with --overwrite");
    for (const auto &[name, fingerprint] : now.surfaces)
      if (header.surfaces.emplace(name, fingerprint).first->second != fingerprint)
        throw Error(file,
                    "has forgings with another " + name,
                    "an optimisation goes on with the billet, dies and targets it began with",
                    "restore its file, or the version of the mesher, or begin anew with --overwrite");
    journal.set_header(std::move(header));
    return journal;
  }

  Journal confirmation_journal(const Scenarios &fine, const std::string &file, const bool resumes)
  {
    Journal begun(journal_header(fine));
    if (resumes && std::filesystem::exists(file))
      if (Journal kept = Journal::read(file);
          make_same_results(kept.header().parameters, begun.header().parameters) &&
          kept.header().operations == begun.header().operations &&
          kept.header().surfaces == begun.header().surfaces)
        return kept;
    return begun;
  }
} // namespace retroforge
