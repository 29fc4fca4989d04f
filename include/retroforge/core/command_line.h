// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  enum class Command
  {
    simulate,
    gradient,
    check,
    scan,
    optimize,
    scene
  };

  /// Returns the word for a command.
  std::string word_of(Command command);

  /// The command line:  `retroforge COMMAND CASE.prm [--set Section/name=value]... [--output DIR] [--at
  /// NAME=VALUE]... [--resume | --overwrite]`.
  struct CommandLine
  {
    std::optional<Command> command; ///< none only with one of the three questions below
    std::string            case_file;

    /// Parameters that the case has instead of those of its file, which may change while a long run goes on;
    /// empty: those of the file.
    std::string case_text;

    /// Folder of the results. Without --output: the name of the case followed by `-results`, of the command
    /// scene by `-scene`, in the current folder (`prm/tutorial/upsetting.prm` -> `upsetting-results`).
    std::string output_directory;

    /// Full path of a parameter (`Contact/Friction/coefficient`) and its new value, in the order given.
    std::vector<std::pair<std::string, std::string>> overrides;

    /// Design parameters (`billet/radius`) and their values, each name once.
    std::vector<std::pair<std::string, std::string>> at;

    /// `overrides`, and `at` as the parameter Design/at: all that replaces what the case says.
    std::vector<std::pair<std::string, std::string>> settings() const;

    bool resume    = false; ///< asked to go on with what is in output_directory
    bool overwrite = false; ///< asked to replace what is there
    bool check     = false; ///< asked to compare the gradient with differences before it is used; of optimize

    bool print_parameters = false; ///< write the annotated parameters and stop
    bool version          = false; ///< write version and commit and stop
    bool help             = false; ///< write help_text() and stop

    /// @throws Error for unknown or incomplete arguments, naming the nearest known one.
    static CommandLine parse(int argc, const char *const *argv);
  };

  /// The commands, in the order of the help text.
  const std::vector<std::string> &known_commands();

  /// Returns the text that `--help` prints.
  std::string help_text();
} // namespace retroforge
