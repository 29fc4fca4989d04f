// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/objective_sensitivity.h>
#include <retroforge/run/forward_run.h>
#include <retroforge/run/run_output.h>

namespace retroforge
{
  /// The commands simulate and gradient: a case forged forwards and differentiated backwards. The command
  /// check is made on top of it. Members stand in the order in which data flows through them.
  class Simulation
  {
  public:
    Simulation(const CommandLine &command, MPI_Comm comm);
    virtual ~Simulation() = default;

    /// @return the exit status: 0, or 1 when a check failed
    int run();

  protected:
    /// Is called once objectives and gradients are known.  @return whether a check passed, or there was none
    virtual bool verify() { return true; }

    void        write_summary();
    std::string path_of(const std::string &file) const { return case_.command.output_directory + "/" + file; }

  private:
    /// Makes sure that nothing of another run is lost or mixed with this one.  @throws Error
    void prepare_folder() const;
    /// Results that cannot be written are no reason to stop at the end of a run.  @throws Error
    void check_outputs() const;
    /// The parameters, and the surfaces of the dies that are no planes, at the start of the run.
    void write_inputs() const;
    /// @return whether a check passed, or there was none
    bool forge_and_judge();
    /// The shape at the end of the stroke, for other programs, and as the billet of another case.
    void write_forged() const;
    /// Leaves the reason why the run failed, which is being thrown, and the workpiece there.
    void keep_failure();

    void forge();
    /// To the state after the last increment of the record in the output folder, which the run goes on from.
    void resume();
    /// Solves what is left of the stroke.
    void forge_on();

    void differentiate();
    void sweep_back();
    void differentiate_directly();

  protected:
    Timings    timings_;
    Case       case_;
    const bool root_; ///< this rank writes

    ForwardRun                        run_;
    const std::vector<std::string>    warnings_; ///< what is doubtful about the scene
    std::unique_ptr<RunOutput>        output_;
    std::vector<double>               values_;               ///< of the objectives
    std::vector<ObjectiveSensitivity> sensitivities_;        ///< each combination that was differentiated
    double                            forging_seconds_ = 0.; ///< 0: unknown, the run was resumed
    Summary                           summary_;
  };
} // namespace retroforge
