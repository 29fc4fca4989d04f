// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/optimization/journal.h>
#include <retroforge/output/safe_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace retroforge
{
  namespace
  {
    using Json = nlohmann::json;

    /// Hexadecimal: all bits, whatever the library.
    Json exact(const std::vector<double> &values)
    {
      Json json = Json::array();
      for (const double x : values)
      {
        char text[40];
        std::snprintf(text, sizeof text, "%a", x);
        json.push_back(text);
      }
      return json;
    }

    std::vector<double> numbers(const Json &json)
    {
      std::vector<double> values;
      for (const Json &entry : json)
      {
        const std::string text = entry.get<std::string>();
        char             *end  = nullptr;
        values.push_back(std::strtod(text.c_str(), &end));
        if (text.empty() || *end != '\0' || !std::isfinite(values.back()))
          throw std::runtime_error("'" + text + "' is no number");
      }
      return values;
    }

    std::string line_of(const Journal::Header &header)
    {
      Json json = {
        {"retroforge", header.program}, {"parameters", header.parameters}, {"surfaces", header.surfaces}};
      if (!header.operations.empty())
        json["operations"] = header.operations;
      return json.dump();
    }

    std::string line_of(const unsigned int mesh, const std::string &made_at)
    {
      return Json{{"new mesh", mesh}, {"made at", made_at}}.dump();
    }

    std::string line_of(const Evaluation &evaluation, const unsigned int mesh)
    {
      Json json = {
        {"mu", exact(evaluation.mu)}, {"increments", evaluation.increments}, {"seconds", evaluation.seconds}};
      if (!evaluation.operation.empty())
        json["operation"] = evaluation.operation;
      if (evaluation.failed())
        json["failure"] = legible(evaluation.failure);
      else
        json["values"] = exact(evaluation.values);
      if (!evaluation.steps.empty())
        json["steps"] = exact(evaluation.steps);
      if (mesh > 0)
        json["mesh"] = mesh;
      return json.dump();
    }

    std::string line_of(const std::size_t i, const std::vector<std::vector<double>> &gradients)
    {
      Json all = Json::array();
      for (const auto &gradient : gradients)
        all.push_back(exact(gradient));
      return Json{{"of", i}, {"gradients", all}}.dump();
    }

    Evaluation evaluation_of(const Json &json)
    {
      Evaluation evaluation;
      evaluation.mu         = numbers(json.at("mu"));
      evaluation.increments = json.at("increments");
      evaluation.seconds    = json.at("seconds");
      evaluation.operation  = json.value("operation", "");
      if (json.contains("failure"))
        evaluation.failure = json.at("failure");
      else
        evaluation.values = numbers(json.at("values"));
      if (json.contains("steps"))
        evaluation.steps = numbers(json.at("steps"));
      return evaluation;
    }

    void read_gradients(const Json &json, std::vector<Evaluation> &evaluations)
    {
      std::vector<std::vector<double>> gradients;
      for (const Json &gradient : json.at("gradients"))
        gradients.push_back(numbers(gradient));
      evaluations.at(json.at("of").get<std::size_t>()).gradients = gradients;
    }
  } // namespace

  Journal Journal::read(const std::string &file)
  {
    const std::string  contents = read_file(file);
    std::istringstream text(contents.substr(0, contents.rfind('\n') + 1));
    Journal            journal{Header()};
    std::string        line;
    unsigned int       n = 0;
    try
    {
      while (std::getline(text, line))
      {
        const Json json = Json::parse(line);
        if (++n == 1)
          journal.header_ = {json.at("retroforge"),
                             json.at("parameters"),
                             json.value("operations", std::map<std::string, std::string>()),
                             json.value("surfaces", std::map<std::string, std::uint64_t>())};
        else if (json.contains("gradients"))
          read_gradients(json, journal.evaluations_);
        else if (json.contains("new mesh"))
          journal.meshes_.push_back(json.at("made at"));
        else
        {
          journal.evaluations_.push_back(evaluation_of(json));
          journal.mesh_of_.push_back(json.contains("mesh") ? json.at("mesh").get<unsigned int>() : 0);
          journal.meshes_.at(journal.mesh_of_.back());
        }
      }
    }
    catch (const std::exception &problem)
    {
      const std::string what = problem.what();
      const std::size_t code = what.find("] "); // that of the library's exception
      throw Error(file + ", line " + std::to_string(std::max(n, 1u)),
                  "is not of a journal: " + (code == std::string::npos ? what : what.substr(code + 2)),
                  "it holds one line of JSON for each forging, as optimize wrote them",
                  "restore the file, or begin anew with --overwrite");
    }
    if (n == 0)
      throw Error(
        file, "is empty", "the first line of a journal tells its case", "begin anew with --overwrite");
    return journal;
  }

  std::size_t Journal::place_of(const std::vector<double> &mu, const std::string &operation) const
  {
    const unsigned int mesh = mesh_in(operation);
    std::size_t        i    = 0;
    while (i < size() &&
           !(mesh_of_[i] == mesh && evaluations_[i].mu == mu && evaluations_[i].operation == operation))
      ++i;
    return i;
  }

  const Evaluation *Journal::find(const std::vector<double> &mu, const std::string &operation) const
  {
    const std::size_t i = place_of(mu, operation);
    return i < size() ? &evaluations_[i] : nullptr;
  }

  const Evaluation *Journal::find_steps(const std::string &operation) const
  {
    for (std::size_t i = 0; i < size(); ++i)
      if (!evaluations_[i].steps.empty() && evaluations_[i].operation == operation &&
          mesh_of_[i] == mesh_in(operation))
        return &evaluations_[i];
    return nullptr;
  }

  unsigned int Journal::use_mesh(const std::string &made_at)
  {
    mesh_ = std::find(meshes_.begin(), meshes_.end(), made_at) - meshes_.begin();
    if (mesh_ == meshes_.size())
    {
      append(line_of(mesh_, made_at));
      meshes_.push_back(made_at);
    }
    return mesh_;
  }

  void Journal::write_to(const std::string &file)
  {
    std::string text = line_of(header_) + "\n";
    for (unsigned int m = 1; m < meshes_.size(); ++m)
      text += line_of(m, meshes_[m]) + "\n";
    for (std::size_t i = 0; i < evaluations_.size(); ++i)
    {
      text += line_of(evaluations_[i], mesh_of_[i]) + "\n";
      if (!evaluations_[i].gradients.empty())
        text += line_of(i, evaluations_[i].gradients) + "\n";
    }
    write_file(file, text);
    file_ = file;
  }

  std::size_t Journal::add(Evaluation evaluation)
  {
    const unsigned int mesh = mesh_in(evaluation.operation);
    append(line_of(evaluation, mesh));
    evaluations_.push_back(std::move(evaluation));
    mesh_of_.push_back(mesh);
    return evaluations_.size() - 1;
  }

  void Journal::add_gradients(const std::size_t i, std::vector<std::vector<double>> gradients)
  {
    append(line_of(i, gradients));
    evaluations_[i].gradients = std::move(gradients);
  }

  void Journal::append(const std::string &line) const
  {
    if (file_.empty())
      return;
    std::FILE *stream = std::fopen(file_.c_str(), "ab");
    if (stream == nullptr)
      throw_write_error(file_, errno);
    const std::string text  = line + "\n";
    int               error = std::fwrite(text.data(), 1, text.size(), stream) == text.size() ? 0 : errno;
    if (std::fclose(stream) != 0 && error == 0)
      error = errno;
    if (error != 0)
      throw_write_error(file_, error);
  }
} // namespace retroforge
