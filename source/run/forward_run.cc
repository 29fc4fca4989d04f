// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/restart_rules.h>
#include <retroforge/case/scene_checks.h>
#include <retroforge/core/error.h>
#include <retroforge/core/version.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/run/forward_run.h>

#include <cmath>
#include <utility>

namespace retroforge
{
  namespace
  {
    /// With dies of the shape that a process gives them; the process is left without.
    ForgingModel with_dies(ForgingModel model, Process<double> &process)
    {
      for (std::size_t d = 0; d < model.dies.size(); ++d)
        if (auto vertices = std::exchange(process.dies[d].vertices, {}); !vertices.empty())
          model.dies[d] = model.dies[d].moved(std::move(vertices));
      return model;
    }

    void set_numerics(const Parameters &numerics, ForgingModel &model)
    {
      model.step          = numerics.step_model();
      model.newton        = numerics.newton;
      model.linear_solver = numerics.linear_solver;
    }

    ForgingModel first_model(const Case &forging_case, Process<double> &process)
    {
      ForgingModel model = with_dies(forging_case.model, process);
      set_numerics(forging_case.segments.front().parameters, model);
      return model;
    }
  } // namespace

  ForwardRun::ForwardRun(const Case          &forging_case,
                         Process<double>      process,
                         NodalVectors<double> X_0,
                         const Keep           keep)
      : case_(forging_case)
      , X_0_(std::move(X_0))
      , model_(first_model(forging_case, process))
      , process_(std::move(process))
      , objectives_(forging_case.parameters.make_objectives(model_.dies, forging_case.billet))
      , trace_(objectives_, model_, process_)
      , first_leg_(std::make_shared<Leg>(forging_case.billet, model_, timings_))
      , keep_(keep)
      , recording_("", keep == Keep::increments)
  {
  }

  void ForwardRun::check() const
  {
    check_scene(case_.parameters, first_leg_->scene, process_, X_0_);
  }

  void ForwardRun::forge(const Forging::Watch &watch)
  {
    for (std::size_t s = 0; s < case_.segments.size(); ++s)
    {
      const Parameters &numerics = case_.segments[s].parameters;
      PressParameters   press    = numerics.press;
      if (s + 1 < case_.segments.size())
        press.stroke = case_.segments[s + 1].input.stroke;
      set_numerics(numerics, model_);
      const Remesher remesher = case_.remesher(numerics, model_.dies);
      const Forging  forging(model_, press, remesher, timings_);
      if (s == 0)
        state_ = forging.start(first_leg_, X_0_);
      else
        Forging::change_numerics({}, state_);
      forging.run(process_, state_, [&](const IncrementEvent &event) {
        recording_.keep(event.record);
        trace_.add(event);
        if (watch)
          watch(event);
      });
    }
  }

  std::vector<double> ForwardRun::values()
  {
    std::vector<double> values = trace_.values(state_, true);
    for (std::size_t j = 0; j < values.size(); ++j)
      if (!std::isfinite(values[j]))
        throw Error("Objective " + objectives_[j].name,
                    "its value is " + as_text(values[j]),
                    "results must be finite numbers",
                    "use values of the usual size, of exponents and sharpness in particular");
    return values;
  }

  void ForwardRun::write_record(const std::string &directory, const std::string &parameters) const
  {
    make_directory(directory);
    write_file(directory + "/parameters.prm", parameters);
    RecordWriter writer(
      directory,
      {version, commit, parameters, facets(model_.dies), case_.billet, X_0_, fingerprints(model_.dies)});
    const auto source = recording_.source();
    for (unsigned int i = 0; i < state_.increments; ++i)
      writer.write(source(i));
    writer.finish();
  }

  AdjointSweep ForwardRun::sweep(const std::vector<Combination> &combinations)
  {
    AssertThrow(keep_ == Keep::increments,
                dealii::ExcMessage("a run is swept back whose increments are not kept"));
    const RecordedForging recorded{
      model_, first_leg_, process_, recording_.source(), state_.increments, objectives_, timings_};
    return adjoint_sweep(recorded, trace_.rows(), state_, combinations);
  }
} // namespace retroforge
