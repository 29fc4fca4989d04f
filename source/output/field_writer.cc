// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/whole_part.h>
#include <retroforge/output/cell_fields.h>
#include <retroforge/output/contact_fields.h>
#include <retroforge/output/die_pictures.h>
#include <retroforge/output/field_file.h>
#include <retroforge/output/field_writer.h>
#include <retroforge/steps/heating.h>

#include <cstdio>

namespace retroforge
{
  /// What is drawn of it.
  struct FieldWriter::Workpiece
  {
    const TetMesh              &mesh;
    const MiddleNodes          *middles; ///< null where velocities are linear
    const NodalVectors<double> &X;
    const NodalVectors<double> &V; ///< of velocity nodes but bubbles, on this rank all
    const std::vector<double>  &P;
    const CellFields           &cells; ///< where V and P are an equilibrium
    const std::vector<double>  &strain;
    const std::vector<double>  &temperature; ///< empty: not followed
    /// Of the metal above its skins, and of the dies where they touch; empty: heat does not flow.
    std::array<std::vector<double>, 2> surface_temperatures;
    const std::vector<double>         &damage;       ///< empty: not followed
    const NodalVectors<double>        *displacement; ///< null: unknown
    const ContactFields               *contact;      ///< null: unknown
  };

  namespace
  {
    /// A flow known by its nodes, on this rank alone: bubbles follow from V and P.
    Field<double> with_bubbles(const Discretization<3>                             &discretization,
                               const NodalVectors<double>                          &X,
                               const LastSolution                                  &solution,
                               const std::function<MaterialLaw<double>(CellIndex)> &law)
    {
      Field<double> W(discretization);
      W.V.take(solution.V);
      W.P.take(solution.P);
      if (discretization.has_bubbles())
        dispatch_element(discretization, [&](const auto pair) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(pair)>, TaylorHoodPair>)
            for (const CellIndex c : discretization.visited_cells())
              W.V.at_place(discretization.velocity_places(c)[discretization.n_nodes_per_cell()]) =
                solve_bubble(cell_geometry(pair.positions(discretization, X, c)),
                             pair.on_cell(discretization, W, c),
                             law(c));
        });
      return W;
    }

    std::string six_digits(const unsigned int number)
    {
      char text[16];
      std::snprintf(text, sizeof text, "%06u", number);
      return text;
    }

    std::string fields_file(const unsigned int increment)
    {
      return "fields_" + six_digits(increment) + ".vtu";
    }
  } // namespace

  FieldWriter::FieldWriter(const MPI_Comm              comm,
                           const std::string          &directory,
                           const ForgingModel         &model,
                           const Process<double>      &process,
                           const TetMesh              &billet,
                           const NodalVectors<double> &X_0)
      : is_first_(dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      , directory_(directory)
      , model_(model)
      , process_(process)
      , billet_(billet)
      , X_0_(X_0)
      , displacement_(X_0.size())
      , series_(directory + "/fields.pvd")
  {
  }

  void FieldWriter::write(const std::string &file, const Workpiece &workpiece) const
  {
    const TetMesh    &mesh  = workpiece.mesh;
    const CellFields &cells = workpiece.cells;
    FieldFile<3>      picture(workpiece.X, mesh.cells);
    picture.add_linear("pressure", "MPa", workpiece.P);
    picture.add_velocity("velocity", "mm/s", workpiece.V, workpiece.middles);
    if (workpiece.displacement)
      picture.add_linear("displacement", "mm", *workpiece.displacement);
    if (workpiece.contact)
    {
      picture.add_linear("touching_die", "", workpiece.contact->die);
      picture.add_linear("contact_pressure", "MPa", workpiece.contact->pressure);
      picture.add_linear("slip_velocity", "mm/s", workpiece.contact->slip);
    }
    picture.add_constant("equivalent_strain", "", workpiece.strain);
    if (!workpiece.temperature.empty())
      picture.add_linear("temperature", "C", workpiece.temperature);
    if (const auto &[metal, die] = workpiece.surface_temperatures; !metal.empty())
    {
      picture.add_linear("surface_temperature", "C", metal);
      picture.add_linear("die_temperature", "C", die);
    }
    if (!workpiece.damage.empty())
      picture.add_constant("damage", "", workpiece.damage);
    picture.add_constant("strain_rate", "1/s", cells.strain_rate);
    picture.add_constant("von_mises_stress", "MPa", cells.von_mises);
    if (process_.material.depends_on_state())
      picture.add_constant("flow_stress", "MPa", cells.flow_stress);
    picture.add_constant("deviatoric_stress", "MPa", cells.stress);
    picture.add_symmetry_planes(symmetry_planes(mesh));
    picture.write(directory_ + "/" + file);
  }

  std::string FieldWriter::write_die(const unsigned int          d,
                                     const Vec3                 &displacement,
                                     const std::string          &suffix,
                                     const NodalVectors<double> &X)
  {
    const Die        &die   = model_.dies[d];
    const bool        still = die.surface() && process_.dies[d].velocity.norm() == 0.;
    const std::string file  = "die_" + die.name + "_" + (still ? six_digits(0) : suffix) + ".vtu";
    if (!still || drawn_still_.insert(d).second)
    {
      const TriangleSurface picture = die_picture(die, displacement, X);
      FieldFile<2>(picture.vertices(), picture.triangles()).write(directory_ + "/" + file);
    }
    return file;
  }

  void FieldWriter::add_step(const StrokeStep           &at,
                             const std::string          &file,
                             const std::string          &suffix,
                             const NodalVectors<double> &X)
  {
    if (!is_first_)
      return;
    std::vector<std::string> pictures = {file};
    const auto               dies     = process_.at_stroke(at.stroke, at.operation).dies;
    for (const unsigned int d : process_.operations[at.operation].dies)
      pictures.push_back(write_die(d, dies[d].displacement, suffix, X));
    series_.add(process_.whole_time(at.stroke, at.operation), pictures);
  }

  void FieldWriter::write_billet() const
  {
    const Discretization<3>    discretization(billet_, model_.discretization, MPI_COMM_SELF);
    const std::vector<double>  zero(billet_.n_nodes(), 0.), strain(billet_.n_cells(), 0.);
    const auto                 before = workpiece_before(process_, X_0_, billet_.n_cells());
    const NodalVectors<double> still(billet_.n_nodes()), at_rest(discretization.condensed_nodes()->n());
    const ContactFields        contact{zero, zero, still};
    // Before anything touches; none where heat does not flow.
    std::array<std::vector<double>, 2> at_surface;
    if (!before.skin.empty())
      at_surface = {{before.temperature, zero}};
    const CellFields cells = cell_fields(discretization, X_0_, Field<double>(discretization), [&](CellIndex) {
      return process_.material.initial_law();
    });
    write(fields_file(0),
          {billet_,
           discretization.middles(),
           X_0_,
           at_rest,
           zero,
           cells,
           strain,
           before.temperature,
           at_surface,
           before.damage,
           &still,
           &contact});
  }

  void FieldWriter::add_billet()
  {
    if (is_first_)
      write_billet();
    add_step({0., 0.}, fields_file(0), six_digits(0), X_0_);
  }

  void FieldWriter::follow(const IncrementEvent &event)
  {
    if (event.record.remesh)
      displacement_ = event.record.remesh->transfer.apply(displacement_);
    for (std::size_t k = 0; k < displacement_.size(); ++k)
      displacement_[k] += event.state.workpiece.X[k] - event.X_before[k];
    n_remeshings_ = event.state.remeshed.size();
  }

  void FieldWriter::add(const IncrementEvent &event)
  {
    const ForgingState &run   = event.state;
    const Scene        &scene = run.epoch->scene;
    const SolvedStage  &last  = event.solved.last();
    const CellFields    cells =
      cell_fields(scene.discretization, last.X, last.W, [&](const CellIndex c) { return last.stage.law(c); });
    if (is_first_)
    {
      const ContactFields contact = contact_fields(last.stage, last.W, last.active);
      write(fields_file(run.increments),
            {scene.mesh,
             scene.discretization.middles(),
             run.workpiece.X,
             run.solution->V,
             run.solution->P,
             cells,
             run.workpiece.strain,
             run.workpiece.temperature,
             surface_temperatures(scene, process_, place(event.record), run.workpiece),
             run.workpiece.damage,
             &displacement_,
             &contact});
    }
    add_step({run.stroke, 0., run.operation},
             fields_file(run.increments),
             six_digits(run.increments),
             run.workpiece.X);
  }

  void FieldWriter::add_failed(const ForgingState &state)
  {
    // The increment that failed may have begun with a remeshing, which nobody was told of.
    const auto *displacement = state.remeshed.size() == n_remeshings_ ? &displacement_ : nullptr;
    if (series_.empty())
    {
      write_billet();
      add_step({0., 0.}, fields_file(0), six_digits(0), X_0_);
    }
    const TetMesh              &mesh = state.epoch->scene.mesh;
    const NodalVectors<double> &X    = state.workpiece.X;
    const Discretization<3>     discretization(mesh, model_.discretization, MPI_COMM_SELF);
    const LastSolution          at_rest  = {NodalVectors<double>(discretization.condensed_nodes()->n()),
                                            std::vector<double>(discretization.n_vertices(), 0.)};
    const LastSolution          solution = state.solution.value_or(at_rest);
    const auto                  points   = point_states(mesh, process_.material.initial, state.workpiece);
    const auto                  law      = [&](const CellIndex c) { return process_.material.at(points[c]); };
    const CellFields            cells =
      cell_fields(discretization, X, with_bubbles(discretization, X, solution, law), law);
    write("failed.vtu",
          {mesh,
           discretization.middles(),
           X,
           solution.V,
           solution.P,
           cells,
           state.workpiece.strain,
           state.workpiece.temperature,
           {},
           state.workpiece.damage,
           displacement,
           nullptr});
    add_step({state.stroke, 0., state.operation}, "failed.vtu", "failed", state.workpiece.X);
  }
} // namespace retroforge
