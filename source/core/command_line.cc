// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/command_line.h>
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <utility>

namespace retroforge
{
  namespace
  {
    const std::vector<std::string> known_options = {"--set",
                                                    "--at",
                                                    "--output",
                                                    "--resume",
                                                    "--overwrite",
                                                    "--check",
                                                    "--print-parameters",
                                                    "--version",
                                                    "--help"};

    const EnumWords<Command> command_words = {{"simulate", Command::simulate},
                                              {"gradient", Command::gradient},
                                              {"check", Command::check},
                                              {"scan", Command::scan},
                                              {"optimize", Command::optimize},
                                              {"scene", Command::scene}};

    const std::string where = "command line";
    const std::string usage = "retroforge --help shows the usage";

    std::string did_you_mean(const std::string &wrong, const std::vector<std::string> &known)
    {
      const std::string nearest = nearest_name(wrong, known, tolerated_edits(wrong));
      return nearest.empty() ? usage : "did you mean '" + nearest + "'?";
    }

    /// The arguments one after another; `--option=value` counts as `--option` with its value attached.
    class Arguments
    {
    public:
      Arguments(const int argc, const char *const *argv) : words_(argv + std::min(argc, 1), argv + argc) {}

      bool empty() const { return next_ == words_.size(); }

      /// The next word, without an attached value.
      std::string take()
      {
        std::string word = words_[next_++];
        attached_.clear();
        const std::size_t equals = word.find('=');
        has_attached_            = word.rfind("--", 0) == 0 && equals != std::string::npos;
        if (has_attached_)
        {
          attached_ = word.substr(equals + 1);
          word.erase(equals);
        }
        return word;
      }

      /// The value of the option just taken.
      std::string value(const std::string &option, const std::string &meaning)
      {
        if (std::exchange(has_attached_, false) && !attached_.empty())
          return attached_;
        if (empty() || words_[next_].empty() || words_[next_].rfind("--", 0) == 0)
          throw Error(where, option + " has no value", "it needs " + meaning, usage);
        return words_[next_++];
      }

      void expect_no_value(const std::string &option) const
      {
        if (has_attached_)
          throw Error(
            where, option + " is given the value '" + attached_ + "'", "it takes none", "leave it out");
      }

    private:
      std::vector<std::string> words_;
      std::size_t              next_ = 0;
      std::string              attached_;
      bool                     has_attached_ = false;
    };

    std::pair<std::string, std::string> split_override(const std::string &assignment)
    {
      const std::size_t equals = assignment.find('=');
      if (equals == std::string::npos || equals == 0)
        throw Error(where,
                    "--set " + assignment + " is not an assignment",
                    "it must read Section/name=value",
                    "put quotes around it where it contains spaces: --set 'Section/some name=value'");
      return {assignment.substr(0, equals), assignment.substr(equals + 1)};
    }

    bool is_number(const std::string &text)
    {
      std::istringstream in(text);
      double             value = 0.;
      return (in >> value) && std::isfinite(value) && in.peek() == EOF;
    }

    /// The last value of a name counts.
    void take_design_value(CommandLine &line, const std::string &assignment)
    {
      const std::size_t equals = assignment.find('=');
      const std::string name   = assignment.substr(0, equals);
      const std::string value  = equals == std::string::npos ? "" : assignment.substr(equals + 1);
      if (name.empty() || name.find_first_of(",:") != std::string::npos || !is_number(value))
        throw Error(where,
                    "--at " + assignment + " gives no number to a design parameter",
                    "it must read NAME=VALUE, with names as in Design/parameters",
                    "write for instance --at billet/radius=20.5, in quotes where the name contains spaces");
      const auto same =
        std::find_if(line.at.begin(), line.at.end(), [&](const auto &other) { return other.first == name; });
      if (same == line.at.end())
        line.at.emplace_back(name, value);
      else
        same->second = value;
    }

    void take_option(CommandLine &line, Arguments &arguments, const std::string &option)
    {
      if (option == "--set")
        line.overrides.push_back(split_override(arguments.value(option, "an assignment Section/name=value")));
      else if (option == "--at")
        take_design_value(line, arguments.value(option, "a design parameter and its value, NAME=VALUE"));
      else if (option == "--output")
        line.output_directory = arguments.value(option, "the folder of the results");
      else if (option == "--resume")
        line.resume = true;
      else if (option == "--overwrite")
        line.overwrite = true;
      else if (option == "--check")
        line.check = true;
      else if (option == "--print-parameters")
        line.print_parameters = true;
      else if (option == "--version")
        line.version = true;
      else if (option == "--help" || option == "-h")
        line.help = true;
      else
        throw Error(where,
                    "unknown option '" + option + "'",
                    "the options are " + join(known_options),
                    did_you_mean(option, known_options));
      arguments.expect_no_value(option);
    }

    void take_operand(CommandLine &line, const std::string &word)
    {
      if (!line.command)
      {
        const std::vector<std::string> &commands = known_commands();
        const auto                      known    = std::find(commands.begin(), commands.end(), word);
        if (known == commands.end())
          throw Error(where,
                      "unknown command '" + word + "'",
                      "the commands are " + join(commands),
                      std::filesystem::path(word).extension() == ".prm"
                        ? "put one before the case: retroforge simulate " + word
                        : did_you_mean(word, commands));
        line.command = command_words[known - commands.begin()].second;
      }
      else if (line.case_file.empty())
        line.case_file = word;
      else
        throw Error(where,
                    "'" + word + "' follows the case file '" + line.case_file + "'",
                    "one case is run at a time",
                    "remove it, or put quotes around names with spaces");
    }

    void check_complete(const CommandLine &line)
    {
      if (!line.command)
        throw Error(where, "there is no command", "the commands are " + join(known_commands()), usage);
      if (line.case_file.empty())
        throw Error(where,
                    "there is no case file",
                    "'" + word_of(*line.command) + "' needs a parameter file",
                    "write retroforge " + word_of(*line.command) +
                      " CASE.prm; retroforge --print-parameters writes a template");
      if (line.check && line.command != Command::optimize)
        throw Error(where,
                    "holds --check with '" + word_of(*line.command) + "'",
                    "it is an option of optimize; gradients of a case are checked by the command check",
                    "leave it out, or write retroforge check " + line.case_file);
      if (line.resume && line.command == Command::scene)
        throw Error(where,
                    "holds --resume with 'scene'",
                    "a scene is looked at anew each time",
                    "leave it out, or replace what is in the folder with --overwrite");
      if (line.resume && line.overwrite)
        throw Error(where,
                    "holds --resume and --overwrite",
                    "a run goes on with what is in the folder, or replaces it",
                    "leave one of them out");
    }
  } // namespace

  const std::vector<std::string> &known_commands()
  {
    static const std::vector<std::string> commands = [] {
      std::vector<std::string> words;
      for (const auto &[word, command] : command_words)
        words.push_back(word);
      return words;
    }();
    return commands;
  }

  std::string word_of(const Command command)
  {
    return word_of(command, command_words);
  }

  CommandLine CommandLine::parse(const int argc, const char *const *argv)
  {
    CommandLine line;
    Arguments   arguments(argc, argv);
    while (!arguments.empty())
    {
      const std::string word = arguments.take();
      if (word.size() > 1 && word[0] == '-')
        take_option(line, arguments, word);
      else
        take_operand(line, word);
    }
    const bool is_question = line.print_parameters || line.version || line.help;
    if (!is_question)
      check_complete(line);
    // A scene that was looked at is no reason to refuse the run after it.
    if (line.output_directory.empty() && !line.case_file.empty())
      line.output_directory = std::filesystem::path(line.case_file).stem().string() +
                              (line.command == Command::scene ? "-scene" : "-results");
    return line;
  }

  std::vector<std::pair<std::string, std::string>> CommandLine::settings() const
  {
    auto        settings = overrides;
    std::string design;
    for (const auto &[name, value] : at)
      design += (design.empty() ? "" : ", ") + name + ": " + value;
    if (!at.empty())
      settings.emplace_back("Design/at", design);
    return settings;
  }

  std::string help_text()
  {
    return R"(Retroforge simulates hot metal forging in 3D and computes exact gradients of its results.

Usage:
  retroforge COMMAND CASE.prm [--set Section/name=value]... [--at NAME=VALUE]... [--output DIR] [--resume | --overwrite] [--check]
  mpirun -np N retroforge COMMAND CASE.prm ...    (not for scan)
  retroforge --print-parameters | --version | --help

Commands:
  simulate   run the forging and report its objectives
  gradient   simulate, then sweep back: gradients of the objectives with respect to the parameters
  check      compare these gradients with the tangent method and with finite differences
  scan       vary one design parameter after the other (section Scan), a run for each value, as many at a time as
             there are cores: how smooth the objectives are, and how true their local gradients
  optimize   forge one design after the other, each better by the gradient, within bounds and limits (section
             Optimisation)
  scene      run nothing, in seconds: check, list and draw billet, dies and symmetry planes as they stand, their gaps
             and overlaps, first touches, sizes, volumes, and the force to expect; also of a scene that is refused

Options:
  --set Section/name=value   replace a parameter of the case; may be repeated, the last one counts
  --at NAME=VALUE            change a design parameter (billet/radius, die upper/offset, ...) on the mesh of the
                             unchanged design; may be repeated; replaces Design/at
  --output DIR               folder of the results (default: CASE-results in the current folder, CASE-scene of scene)
  --resume                   go on with the run in that folder, to the same bits as if it had not been stopped,
                             or with other numerics (--set Press/increments=80, --set Remeshing/when=quality);
                             of a check, keep the directions that are done; of a scan or an optimisation, what is
                             forged
  --overwrite                replace the results that are in that folder; without it they are left alone, and the
                             command is refused
  --check                    of optimize: first compare the gradient with central differences along one direction
  --print-parameters         write all parameters with their meaning; a case to start from
  --version                  write version and commit
  --help                     write this text

Exit status:
  0   done; of optimize: with a design that keeps all limits
  1   an error, which is told; of check: a derivative did not pass; of scan: no point could be forged
  2   of optimize: the search has ended without a design that keeps all limits, or with none but the start that could
      be forged; the result says which, and results are written

Examples:
  retroforge scene upsetting.prm
  retroforge simulate upsetting.prm
  retroforge gradient upsetting.prm --set "Die upper/friction=0.4" --output rough-die
  retroforge gradient upsetting.prm --at billet/radius=20.2 --output wider
)";
  }
} // namespace retroforge
