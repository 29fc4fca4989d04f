// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/output/contact_fields.h>
#include <retroforge/output/die_pictures.h>
#include <retroforge/output/field_writer.h>
#include <retroforge/output/vtu_writer.h>

#include <cstdio>

namespace retroforge
{
  /// What is drawn of it.
  struct FieldWriter::Workpiece
  {
    const TetMesh              &mesh;
    const Spaces               &spaces;
    const NodalVectors<double> &X;
    const NodalVectors<double> &position; ///< where W is an equilibrium
    const Field<double>        &W;
    const std::vector<double>  &strain;
    const NodalVectors<double> *displacement; ///< null: unknown
    const ContactFields        *contact;      ///< null: unknown
  };

  namespace
  {
    /// Of each cell: mean equivalent strain rate, von Mises stress, deviatoric stress.
    struct CellFields
    {
      std::vector<double>          strain_rate, von_mises;
      std::vector<SymmetricTensor> stress;
    };

    CellFields cell_fields(const TetMesh              &mesh,
                           const Spaces               &spaces,
                           const NodalVectors<double> &X,
                           const Field<double>        &W,
                           const MaterialLaw<double>  &law)
    {
      CellFields fields;
      with_pair(spaces, [&](const auto pair) {
        for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        {
          const auto geometry = geometry_of_cell(mesh, X, c);
          const auto w        = pair.on_cell(spaces, W, c);
          fields.strain_rate.push_back(cell_strain_rate(geometry, w));
          fields.stress.push_back(cell_deviatoric_stress(geometry, w, law));
          fields.von_mises.push_back(von_mises(fields.stress.back()));
        }
      });
      return fields;
    }

    std::string six_digits(const unsigned int number)
    {
      char text[16];
      std::snprintf(text, sizeof text, "%06u", number);
      return text;
    }
  } // namespace

  FieldWriter::FieldWriter(const std::string          &directory,
                           const ForgingModel         &model,
                           const Process<double>      &process,
                           const TetMesh              &billet,
                           const NodalVectors<double> &X_0)
      : directory_(directory)
      , model_(model)
      , process_(process)
      , billet_(billet)
      , X_0_(X_0)
      , displacement_(X_0.size())
      , pvd_(directory + "/fields.pvd")
  {
  }

  void FieldWriter::write(const std::string &file, const Workpiece &workpiece) const
  {
    const CellFields cells =
      cell_fields(workpiece.mesh, workpiece.spaces, workpiece.position, workpiece.W, process_.law);
    std::vector<ScalarField> scalars = {{"pressure [MPa]", workpiece.W.P}};
    std::vector<VectorField> vectors = {
      {"velocity [mm/s]", {workpiece.W.V.begin(), workpiece.W.V.begin() + workpiece.mesh.n_nodes()}}};
    if (workpiece.displacement)
      vectors.push_back({"displacement [mm]", *workpiece.displacement});
    if (workpiece.contact)
    {
      scalars.push_back({"touching_die", workpiece.contact->die});
      scalars.push_back({"contact_pressure [MPa]", workpiece.contact->pressure});
      vectors.push_back({"slip_velocity [mm/s]", workpiece.contact->slip});
    }
    write_vtu(directory_ + "/" + file,
              workpiece.mesh,
              workpiece.X,
              scalars,
              vectors,
              {{"equivalent_strain", workpiece.strain},
               {"strain_rate [1/s]", cells.strain_rate},
               {"von_mises_stress [MPa]", cells.von_mises}},
              {{"deviatoric_stress [MPa]", cells.stress}});
  }

  PvdWriter::Part FieldWriter::write_die(const unsigned int          d,
                                         const double                stroke,
                                         const std::string          &suffix,
                                         const NodalVectors<double> &X) const
  {
    const Die        &die   = model_.dies[d];
    const bool        still = die.surface() && process_.dies[d].velocity.norm() == 0.;
    const std::string file  = "die_" + die.name + "_" + (still ? six_digits(0) : suffix) + ".vtu";
    if (!still || stroke == 0.)
      write_vtu(directory_ + "/" + file,
                die_picture(die, process_.at_stroke(stroke).dies[d].displacement, X));
    return {"die " + die.name, file};
  }

  void FieldWriter::add_step(const double                stroke,
                             const std::string          &file,
                             const std::string          &suffix,
                             const NodalVectors<double> &X)
  {
    std::vector<PvdWriter::Part> parts = {{"workpiece", file}};
    for (unsigned int d = 0; d < model_.dies.size(); ++d)
      parts.push_back(write_die(d, stroke, suffix, X));
    pvd_.add(process_.time(stroke), parts);
  }

  void FieldWriter::add_billet()
  {
    if (!pvd_.steps().empty())
      return;
    const std::string          file = "fields_" + six_digits(0) + ".vtu";
    const Spaces               spaces(billet_, Topology(billet_), model_.element);
    const Field<double>        at_rest(spaces);
    const std::vector<double>  zero(billet_.n_nodes(), 0.), strain(billet_.n_cells(), 0.);
    const NodalVectors<double> still(billet_.n_nodes());
    const ContactFields        contact{zero, zero, still};
    write(file, {billet_, spaces, X_0_, X_0_, at_rest, strain, &still, &contact});
    add_step(0., file, six_digits(0), X_0_);
  }

  void FieldWriter::follow(const IncrementEvent &event)
  {
    if (event.record.remesh)
      displacement_ = event.record.remesh->transfer.apply(displacement_);
    for (std::size_t k = 0; k < displacement_.size(); ++k)
      displacement_[k] += event.state.X[k] - event.X_before[k];
    n_remeshings_ = event.state.remeshed.size();
  }

  void FieldWriter::add(const IncrementEvent &event)
  {
    const ForgingState &run     = event.state;
    const Scene        &scene   = run.leg->scene;
    const SolvedStage  &last    = event.solved.last();
    const ContactFields contact = contact_fields(last.stage, run.W, last.active);
    const std::string   number = six_digits(run.increments), file = "fields_" + number + ".vtu";
    add_billet();
    write(file, {scene.mesh, scene.spaces, run.X, last.X, run.W, run.strain, &displacement_, &contact});
    add_step(run.stroke, file, number, run.X);
  }

  void FieldWriter::add_failed(const ForgingState &state)
  {
    // The increment that failed may have begun with a remeshing, which nobody was told of.
    const auto *displacement = state.remeshed.size() == n_remeshings_ ? &displacement_ : nullptr;
    add_billet();
    write("failed.vtu",
          {state.leg->scene.mesh,
           state.leg->scene.spaces,
           state.X,
           state.X,
           state.W,
           state.strain,
           displacement,
           nullptr});
    add_step(state.stroke, "failed.vtu", "failed", state.X);
  }
} // namespace retroforge
