// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/case.h>
#include <retroforge/case/case_messages.h>
#include <retroforge/case/restart_rules.h>
#include <retroforge/case/scene_checks.h>
#include <retroforge/case/scene_estimate.h>
#include <retroforge/core/error.h>
#include <retroforge/core/interrupt_message.h>
#include <retroforge/core/text.h>
#include <retroforge/core/version.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/scan/scan.h>
#include <retroforge/time/mesh_epoch.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <set>
#include <sstream>
#include <thread>

namespace retroforge
{
  namespace
  {
    std::string all_digits(const double x)
    {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g", x);
      return text;
    }

    /// For a shell.
    std::string quoted_for_shell(const std::string &word)
    {
      if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._=+-") ==
          std::string::npos)
        return word;
      std::string result = "'";
      for (const char c : word)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
      return result + "'";
    }

    std::string this_program()
    {
      std::error_code             error;
      const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
      if (error)
        throw Error("scan",
                    "does not find its own program: " + error.message(),
                    "it runs the program once for each point, and asks /proc/self/exe for it",
                    "run it where /proc is mounted");
      return program.string();
    }
  } // namespace

  Scan::Scan(const CommandLine &command, std::vector<std::string> environment, MPI_Comm comm)
      : command_(command), environment_(std::move(environment))
  {
    bool under_mpirun = dealii::Utilities::MPI::n_mpi_processes(comm) > 1;
    for (const std::string &variable : environment_)
      for (const char *name : {"OMPI_COMM_WORLD_SIZE=", "PMIX_RANK=", "PMI_RANK="})
        under_mpirun |= variable.rfind(name, 0) == 0;
    if (under_mpirun)
      throw Error("command line",
                  "scan was started by mpirun",
                  "it starts runs of one rank each by itself, side by side",
                  "leave mpirun out; Scan/processes says how many run at a time");
    // A scene of which nothing can come is refused here, once, and not by each of its runs.
    CommandLine one_run = command_;
    one_run.resume      = false;
    Timings    timings;
    const Case scene(one_run, timings, comm);
    check_scene(
      scene.parameters, MeshEpoch(scene.billet, scene.model, timings).scene, scene.process, scene.X_0);
    warnings_   = estimate_scene(scene).warnings;
    echo_       = scene.echo;
    parameters_ = scene.parameters;
    make_lines(scene);
  }

  void Scan::make_lines(const Case &scene)
  {
    const std::string       &chosen = parameters_.scan.parameter;
    std::vector<std::string> names  = parameters_.design.all_names();
    if (!chosen.empty() && std::find(names.begin(), names.end(), chosen) == names.end())
      names.push_back(chosen);
    const Design                   design(names,
                        parameters_.billet,
                        parameters_.dies,
                        scene.nominal,
                        parameters_.open_contact(scene.size()),
                        scene.first);
    const std::vector<double>      mu     = design.at(parameters_.design.at);
    const std::vector<std::string> listed = design.expanded(parameters_.design.names);
    std::set<std::string>          folders;
    for (std::size_t j = 0; j < mu.size(); ++j)
    {
      const DesignParameter &parameter = design.parameters()[j];
      if (chosen.empty() ? std::find(listed.begin(), listed.end(), parameter.name) == listed.end()
                         : parameter.name != chosen)
        continue;
      std::string folder = as_identifier(parameter.name);
      while (!folders.insert(folder).second)
        folder += "_";
      lines_.push_back({parameter.name, parameter.unit, mu[j], {}});
      for (const double value : parameters_.scan.values(mu[j], parameter.scale))
      {
        char number[16];
        std::snprintf(
          number, sizeof number, "_%03u", static_cast<unsigned int>(lines_.back().points.size() + 1));
        ScanPoint point;
        point.parameter = parameter.name;
        point.value     = value;
        point.directory = command_.output_directory + "/points/" + folder + number;
        lines_.back().points.push_back(point);
      }
    }
  }

  CommandLine Scan::command_in(const std::string &name, const Command chosen) const
  {
    CommandLine run;
    run.command          = chosen;
    run.case_file        = command_.case_file;
    run.output_directory = command_.output_directory + "/points/" + name;
    run.overrides        = command_.overrides;
    run.overrides.emplace_back("Output/fields every", "0");
    return run;
  }

  CommandLine Scan::command_of_nominal() const
  {
    CommandLine run = command_in("nominal", Command::simulate);
    run.overrides.emplace_back("Output/record", "false");
    for (const auto &[name, value] : parameters_.design.at)
      run.at.emplace_back(name, all_digits(value));
    return run;
  }

  CommandLine Scan::command_of(const ScanPoint &point) const
  {
    CommandLine run = command_in(std::filesystem::path(point.directory).filename().string(),
                                 parameters_.scan.gradients ? Command::gradient : Command::simulate);
    if (!steps_.empty())
      run.overrides.emplace_back("Press/steps", steps_);
    for (const auto &[name, value] : parameters_.design.at)
      if (name != point.parameter)
        run.at.emplace_back(name, all_digits(value));
    run.at.emplace_back(point.parameter, all_digits(point.value));
    return run;
  }

  std::vector<std::string> Scan::words_of(const CommandLine &command) const
  {
    std::vector<std::string> words = {this_program(), word_of(command.command.value()), command.case_file};
    for (const auto &[name, value] : command.overrides)
      words.insert(words.end(), {"--set", name + "=" + value});
    for (const auto &[name, value] : command.at)
      words.insert(words.end(), {"--at", name + "=" + value});
    words.insert(words.end(), {"--output", command.output_directory, "--overwrite"});
    return words;
  }

  bool Scan::is_finished(const CommandLine &run, ScanPoint &design) const
  {
    const std::string file = run.output_directory + "/parameters.prm";
    if (!std::filesystem::is_regular_file(file))
      return false;
    std::string parameters;
    Parameters::read(run, parameters);
    return make_same_results(read_file(file), parameters) &&
           design.read_summary(word_of(run.command.value()));
  }

  std::vector<ScanPoint *> Scan::to_do()
  {
    std::vector<ScanPoint *> points;
    for (ScanLine &line : lines_)
      for (ScanPoint &point : line.points)
      {
        point.reused = command_.resume && is_finished(command_of(point), point);
        if (!point.reused)
          points.push_back(&point);
      }
    return points;
  }

  unsigned int Scan::at_a_time() const
  {
    const unsigned int wanted = parameters_.scan.processes;
    return wanted > 0 ? wanted : std::max(1u, std::thread::hardware_concurrency());
  }

  void Scan::prepare_folder() const
  {
    const std::string &folder = command_.output_directory;
    if (!command_.resume)
      make_results_folder(folder, command_.overwrite, echo_);
    else if (std::filesystem::exists(folder + "/history.csv"))
      throw Error(folder,
                  "holds the results of a run",
                  "only a scan can be resumed as a scan",
                  "choose another folder with --output DIR");
    make_directory(folder);
  }

  int Scan::run()
  {
    prepare_folder();
    for (const char *file : {"parameters.prm", "scan.csv", "scan.json"})
      check_writable(command_.output_directory + "/" + file);
    write_file(command_.output_directory + "/parameters.prm", echo_);
    const std::size_t all = lines_.size() * parameters_.scan.points;
    std::printf("Retroforge %s %s, scan of %zu parameter(s), %u points each: %zu runs, %u at a time\n",
                version,
                commit,
                lines_.size(),
                parameters_.scan.points,
                all,
                at_a_time());
    for (const std::string &sentence : parameters_.without_effect)
      std::printf("  note: %s\n", sentence.c_str());
    std::fflush(stdout);
    print_warnings(warnings_);
    set_interrupt_message("stopped; the same command with --resume keeps the points that are finished");
    run_nominal();
    const std::vector<ScanPoint *> points = to_do();
    if (command_.resume)
      std::printf("  %zu of them are finished and reused\n", all - points.size());
    std::fflush(stdout);
    run_points(points);
    const ScanResults results(lines_, parameters_.scan.degree);
    results.write_csv(command_.output_directory + "/scan.csv");
    results.write_json(command_.output_directory + "/scan.json");
    results.print(std::cout);
    std::cout << "\n  " << all << " points, " << results.n_failed() << " failed\n  results in "
              << command_.output_directory << std::endl;
    return results.n_failed() == all ? 1 : 0;
  }

  ChildProcess Scan::prepared(const CommandLine &run) const
  {
    const std::string &folder = run.output_directory;
    make_results_folder(folder, true, echo_); // what is there of an earlier run is not this one's
    ChildProcess process{words_of(run), folder + "/log.txt"};
    std::string  line;
    for (const std::string &word : process.command)
      line += (line.empty() ? "" : " ") + quoted_for_shell(word);
    write_file(folder + "/command.txt", line + "\n");
    return process;
  }

  void Scan::run_nominal()
  {
    if (!parameters_.repeats_steps())
      return;
    const CommandLine run = command_of_nominal();
    // Relative, it would be looked for beside the case's file first.
    const auto history = std::filesystem::absolute(run.output_directory) / "history.csv";
    ScanPoint  nominal;
    nominal.directory = run.output_directory;
    bool done         = command_.resume && is_finished(run, nominal);
    if (!done)
      run_side_by_side({prepared(run)}, environment_, 1, [&](std::size_t, const ExitStatus &end) {
        done = end.status == 0 && end.signal == 0 && nominal.read_summary("simulate");
        if (!done)
          nominal.read_failure(run.output_directory + "/log.txt", end.status, end.signal);
      });
    if (done)
      steps_ = history.lexically_normal().string();
    std::printf("  nominal design: %s\n",
                done ? (std::to_string(nominal.increments) + " increments, which are repeated").c_str()
                     : ("each point chooses its own increments, as it failed: " + nominal.failure).c_str());
    std::fflush(stdout);
  }

  void Scan::run_points(const std::vector<ScanPoint *> &points)
  {
    std::vector<ChildProcess> runs;
    for (const ScanPoint *point : points)
      runs.push_back(prepared(command_of(*point)));
    const auto  begin = std::chrono::steady_clock::now();
    std::size_t done  = 0;
    run_side_by_side(runs, environment_, at_a_time(), [&](const std::size_t i, const ExitStatus &end) {
      ScanPoint &point = *points[i];
      finish(point, end);
      ++done;
      const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      std::printf("%5zu/%zu  %s = %.9g  ", done, points.size(), point.parameter.c_str(), point.value);
      if (point.objectives.empty())
        std::printf("failed: %s", point.failure.c_str());
      else
        std::printf("%s %.9g", point.objectives[0].name.c_str(), point.objectives[0].value);
      if (!point.objectives.empty() && !std::isnan(point.objectives[0].slope))
        std::printf(", slope %.6g", point.objectives[0].slope);
      std::printf("  %.1f s, %.0f s left\n", end.seconds, spent / done * (points.size() - done));
      std::fflush(stdout);
    });
  }

  void Scan::finish(ScanPoint &point, const ExitStatus &end) const
  {
    if (end.status != 0 || end.signal != 0 || !point.read_summary(word_of(command_of(point).command.value())))
      point.read_failure(point.directory + "/log.txt", end.status, end.signal);
    std::error_code ignored; // the record is as large as all else of many runs together
    std::filesystem::remove_all(point.directory + "/record", ignored);
    std::filesystem::remove(point.directory + "/record.h5", ignored);
  }
} // namespace retroforge
