// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/output/contact_fields.h>
#include <retroforge/output/die_pictures.h>
#include <retroforge/output/field_file.h>
#include <retroforge/output/field_writer.h>

#include <cstdio>

namespace retroforge
{
  /// What is drawn of it.
  struct FieldWriter::Workpiece
  {
    const TetMesh              &mesh;
    const MiddleNodes          *middles; ///< null where velocities are linear
    const NodalVectors<double> &X;
    const NodalVectors<double> &position; ///< where V and P are an equilibrium
    const NodalVectors<double> &V;        ///< of velocity nodes but bubbles, on this rank all
    const std::vector<double>  &P;
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

    void recover_bubble(const CellGeometry<double> &geometry,
                        const MaterialLaw<double>  &law,
                        CellValues<double>         &w)
    {
      w.beta = solve_bubble(geometry, w, law);
    }

    void recover_bubble(const CellGeometry<double> &, const MaterialLaw<double> &, TaylorHoodValues<double> &)
    {
    }

    /// Bubbles follow from V and P.
    template <typename Values>
    void
    add_cell(const CellGeometry<double> &geometry, Values w, const MaterialLaw<double> &law, CellFields &to)
    {
      recover_bubble(geometry, law, w);
      to.strain_rate.push_back(cell_strain_rate(geometry, w));
      to.stress.push_back(cell_deviatoric_stress(geometry, w, law));
      to.von_mises.push_back(von_mises(to.stress.back()));
    }

    CellFields cell_fields(const TetMesh              &mesh,
                           const MiddleNodes          *middles,
                           const NodalVectors<double> &X,
                           const NodalVectors<double> &V,
                           const std::vector<double>  &P,
                           const Material<double>     &material,
                           const std::vector<double>  &strain)
    {
      CellFields fields;
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      {
        const auto              &nodes = mesh.cells[c];
        const auto               law   = material.at({strain[c]});
        Four<Vec3>               x;
        CellValues<double>       linear;
        TaylorHoodValues<double> quadratic;
        for (unsigned int a = 0; a < 4; ++a)
        {
          x[a]        = X[nodes[a]];
          linear.V[a] = quadratic.V[a] = V[nodes[a]];
          linear.P[a] = quadratic.P[a] = P[nodes[a]];
        }
        if (middles)
          for (unsigned int e = 0; e < 6; ++e)
          {
            const auto [a, b]  = tet_edge_corners[e];
            quadratic.V[4 + e] = V[middles->between(nodes[a], nodes[b])];
          }
        if (middles)
          add_cell(cell_geometry(x), quadratic, law, fields);
        else
          add_cell(cell_geometry(x), linear, law, fields);
      }
      return fields;
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
    const TetMesh   &mesh  = workpiece.mesh;
    const CellFields cells = cell_fields(mesh,
                                         workpiece.middles,
                                         workpiece.position,
                                         workpiece.V,
                                         workpiece.P,
                                         process_.material,
                                         workpiece.strain);
    FieldFile<3>     picture(workpiece.X, mesh.cells);
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
    picture.add_constant("strain_rate", "1/s", cells.strain_rate);
    picture.add_constant("von_mises_stress", "MPa", cells.von_mises);
    picture.add_constant("deviatoric_stress", "MPa", cells.stress);
    picture.add_symmetry_planes(symmetry_planes(mesh));
    picture.write(directory_ + "/" + file);
  }

  std::string FieldWriter::write_die(const unsigned int          d,
                                     const double                stroke,
                                     const std::string          &suffix,
                                     const NodalVectors<double> &X) const
  {
    const Die        &die   = model_.dies[d];
    const bool        still = die.surface() && process_.dies[d].velocity.norm() == 0.;
    const std::string file  = "die_" + die.name + "_" + (still ? six_digits(0) : suffix) + ".vtu";
    if (!still || stroke == 0.)
    {
      const TriangleSurface picture = die_picture(die, process_.at_stroke(stroke).dies[d].displacement, X);
      FieldFile<2>(picture.vertices(), picture.triangles()).write(directory_ + "/" + file);
    }
    return file;
  }

  void FieldWriter::add_step(const double                stroke,
                             const std::string          &file,
                             const std::string          &suffix,
                             const NodalVectors<double> &X)
  {
    if (!is_first_)
      return;
    std::vector<std::string> pictures = {file};
    for (unsigned int d = 0; d < model_.dies.size(); ++d)
      pictures.push_back(write_die(d, stroke, suffix, X));
    series_.add(process_.time(stroke), pictures);
  }

  void FieldWriter::write_billet() const
  {
    const Discretization<3>    discretization(billet_, model_.discretization, MPI_COMM_SELF);
    const std::vector<double>  zero(billet_.n_nodes(), 0.), strain(billet_.n_cells(), 0.);
    const NodalVectors<double> still(billet_.n_nodes()), at_rest(discretization.condensed_nodes()->n());
    const ContactFields        contact{zero, zero, still};
    write(fields_file(0),
          {billet_, discretization.middles(), X_0_, X_0_, at_rest, zero, strain, &still, &contact});
  }

  void FieldWriter::add_billet()
  {
    if (is_first_)
      write_billet();
    add_step(0., fields_file(0), six_digits(0), X_0_);
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
    if (is_first_)
    {
      const ContactFields contact = contact_fields(last.stage, last.W, last.active);
      write(fields_file(run.increments),
            {scene.mesh,
             scene.discretization.middles(),
             run.workpiece.X,
             last.X,
             run.solution->V,
             run.solution->P,
             run.workpiece.strain,
             &displacement_,
             &contact});
    }
    add_step(run.stroke, fields_file(run.increments), six_digits(run.increments), run.workpiece.X);
  }

  void FieldWriter::add_failed(const ForgingState &state)
  {
    // The increment that failed may have begun with a remeshing, which nobody was told of.
    const auto *displacement = state.remeshed.size() == n_remeshings_ ? &displacement_ : nullptr;
    if (series_.empty())
    {
      write_billet();
      add_step(0., fields_file(0), six_digits(0), X_0_);
    }
    const auto        &discretization = state.epoch->scene.discretization;
    const LastSolution at_rest        = {NodalVectors<double>(discretization.condensed_nodes()->n()),
                                         std::vector<double>(discretization.n_vertices(), 0.)};
    const LastSolution solution       = state.solution.value_or(at_rest);
    write("failed.vtu",
          {state.epoch->scene.mesh,
           discretization.middles(),
           state.workpiece.X,
           state.workpiece.X,
           solution.V,
           solution.P,
           state.workpiece.strain,
           displacement,
           nullptr});
    add_step(state.stroke, "failed.vtu", "failed", state.workpiece.X);
  }
} // namespace retroforge
