// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/case.h>
#include <retroforge/case/case_messages.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    std::vector<Die> make_dies(const std::vector<DieParameters> &parameters)
    {
      std::vector<Die> dies;
      for (const auto &die : parameters)
        dies.push_back(die.die());
      return dies;
    }

    /// Those of a changed design: what the run decides, it decides on them as they are there.
    std::vector<Die> make_dies(const Parameters &parameters, const Process<double> &process)
    {
      std::vector<Die> dies = make_dies(parameters.dies);
      if (!parameters.design.at.empty())
        for (std::size_t d = 0; d < dies.size(); ++d)
          if (!process.dies[d].vertices.empty())
            dies[d] = dies[d].moved(process.dies[d].vertices);
      return dies;
    }

    TetMesh make_mesh(const Parameters &parameters, Timings &timings, MPI_Comm comm)
    {
      const TetMesh mesh = make_billet(parameters.billet, comm);
      if (!parameters.remeshing.first_mesh)
        return mesh;
      const std::vector<Die>        dies = make_dies(parameters.dies);
      std::vector<DieState<double>> states;
      for (const DieParameters &die : parameters.dies)
        states.push_back(initial_state(die));
      TetMesh remade = Remesher(parameters.remeshing, parameters.edge_length(mesh), dies, mesh.patches, comm)
                         .remesh(mesh, mesh.X, states, {}, 0., timings)
                         ->mesh;
      remade.remarks = mesh.remarks;
      return remade;
    }

    TetMesh make_nominal_mesh(const Parameters &parameters, Timings &timings, MPI_Comm comm)
    {
      // The first rank of all that the program has: groups of them may each make the mesh.
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        print_meshing(parameters);
      return make_mesh(parameters, timings, comm);
    }

    /// Meshed anew at each of the designs in Design/meshed at, if any.
    FirstMesh
    make_first_mesh(const Parameters &parameters, const TetMesh &nominal, Timings &timings, MPI_Comm comm)
    {
      const BilletParameters &billet = parameters.billet;
      FirstMesh               first  = first_mesh(billet, nominal);
      const auto              make   = [&](const BilletParameters &measured) {
        Parameters there = parameters;
        there.billet     = measured;
        // Those that follow the billet are elsewhere then.
        there.dies.erase(std::remove_if(there.dies.begin(),
                                        there.dies.end(),
                                        [](const DieParameters &die) { return die.follows_billet; }),
                         there.dies.end());
        return make_mesh(there, timings, comm);
      };
      for (const ShapeValues &given : parameters.design.meshed_at)
      {
        const std::vector<double> values = shape_values(billet, first, given);
        first                            = has_measures(billet) ? meshed_anew(first, values, make)
                                                                : remeshed(first, values, parameters.remeshing, timings, comm);
      }
      return first;
    }

    bool takes_derivatives(const CommandLine &command)
    {
      const auto chosen = command.command;
      return chosen == Command::gradient || chosen == Command::check || chosen == Command::scan ||
             chosen == Command::optimize;
    }

    /// "check" solves all systems as well as they can be, or differences would measure the solvers.
    Parameters as_solved(Parameters parameters, const CommandLine &command)
    {
      if (command.command == Command::check)
      {
        parameters.newton.tolerance  = std::min(parameters.newton.tolerance, 1e-12);
        parameters.adjoint.tolerance = std::min(parameters.adjoint.tolerance, 1e-14);
      }
      return parameters;
    }

    Parameters read(const CommandLine &command, std::string &echo)
    {
      Parameters parameters = Parameters::read(command, echo);
      if (!takes_derivatives(command))
        parameters.leave_out_idle_parameters();
      return as_solved(std::move(parameters), command);
    }

    std::optional<Resumption>
    resumption_of(const CommandLine &command, const std::string &echo, const Parameters &parameters)
    {
      if (!command.resume)
        return {};
      return Resumption(command.output_directory, echo, parameters.press.stroke);
    }

    /// Those the run began with: what made the billet may have changed since.
    Parameters first_parameters(const Parameters &parameters, const std::optional<Resumption> &resumption)
    {
      return resumption ? Parameters::of_record(resumption->header.parameters) : parameters;
    }

    std::vector<NumericsSegment> make_segments(const Case &made)
    {
      std::vector<NumericsSegment> segments;
      if (!made.resumption)
      {
        segments.emplace_back();
        segments.back().input.parameters = made.echo;
        segments.back().parameters       = made.parameters;
        return segments;
      }
      for (const RecordedInput &input : made.resumption->inputs)
      {
        segments.push_back({input, as_solved(Parameters::of_record(input.parameters), made.command)});
        segments.back().parameters.resolve_defaults(made.size());
      }
      return segments;
    }
  } // namespace

  Case::Case(const CommandLine &asked, Timings &timings, MPI_Comm communicator)
      : command(asked)
      , comm(communicator)
      , parameters(read(command, echo))
      , resumption(resumption_of(command, echo, parameters))
      , nominal_billet(make_nominal_mesh(first_parameters(parameters, resumption), timings, comm))
      , first(make_first_mesh(first_parameters(parameters, resumption), nominal_billet, timings, comm))
      , billet(first.mesh)
      , nominal(parameters.resolve_defaults(size()).process(size()))
      , design(parameters.design.all_names(),
               parameters.billet,
               parameters.dies,
               nominal,
               parameters.open_contact(size()),
               first)
      , mu(design.at(parameters.design.at))
      , process(design.process(mu))
      , X_0(design.positions(mu))
      , model{parameters.discretization.choice,
              make_dies(parameters, process),
              parameters.step_model(),
              parameters.newton,
              parameters.linear_solver,
              comm}
      , objectives(parameters.make_objectives(model.dies, billet))
      , combinations(parameters.combinations(objectives))
      , segments(make_segments(*this))
  {
    if (!parameters.scan.parameter.empty())
      design.check_offered(parameters.scan.parameter, "Scan/parameter");
  }
} // namespace retroforge
