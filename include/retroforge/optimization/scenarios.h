// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>
#include <retroforge/optimization/journal.h>

#include <memory>
#include <optional>

namespace retroforge
{
  /// The forgings that each design is judged by: the main case, and others with billets, dies and presses of
  /// their own, that have parameters of the design in common with it by name, as measures of the same tools.
  /// Parameter files call them operations.
  class Scenarios
  {
  public:
    /// @param main    must live as long
    /// @param others  commands of the others, on the same ranks
    /// @throws Error  for a case that is wrong, names that are the same, or a scenario that no design
    /// changes
    Scenarios(const Case &main, const std::vector<CommandLine> &others, Timings &timings);

    std::size_t size() const { return others_.size() + 1; }
    /// The first is the main case.
    const Case &at(const std::size_t o) const { return o == 0 ? *main_ : *others_[o - 1]; }
    /// The main case from here on, which must live as long: the same but for its first mesh.
    void use_main(const Case &main) { main_ = &main; }
    /// Returns the name of its file; of the main case an empty one.
    const std::string &name(const std::size_t o) const { return names_[o]; }
    /// Returns a name for a file of results: `best`, `best_NAME`.
    std::string titled(const std::string &what, const std::size_t o) const
    {
      return what + (o == 0 ? "" : "_" + name(o));
    }
    /// Parameters that it has in common with the design.
    std::vector<std::string> common(std::size_t o) const;

    /// Returns the objectives of all, those of others as `energy of NAME`; the dies and billets they look at
    /// are those of the cases.
    Objectives objectives() const;

    /// Design parameters of a scenario: those in common are the design's, others keep their values.
    std::vector<double> values(std::size_t o, const std::vector<double> &mu) const;

    /// Joins what came of a design in each scenario, up to the first that failed: all
    /// objectives, and their gradients by the design.
    Evaluation joined(const std::vector<double> &mu, const std::vector<Evaluation> &each) const;

  private:
    void add(const CommandLine &command, Timings &timings);
    /// Derivative by the design from that by the parameters of a scenario.
    std::vector<double> pull_back(std::size_t o, const std::vector<double> &by_own) const;

    const Case                              *main_;
    std::vector<std::unique_ptr<const Case>> others_;
    std::vector<std::string>                 names_;
    /// For each scenario and each of its parameters, the parameter's number in the design, if it is there.
    std::vector<std::vector<std::optional<std::size_t>>> places_;
  };

  /// Commands that Optimisation/operations of a case asks for. Settings of the command line are of the main
  /// case alone.  @throws Error  for a file that is not there
  std::vector<CommandLine> commands_of_scenarios(const Case &main);
} // namespace retroforge
