// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/surface_areas.h>
#include <retroforge/output/field_writer.h>
#include <retroforge/output/vtu_writer.h>

#include <cstdio>

namespace retroforge
{
  namespace
  {
    /// Mean equivalent strain rate of each cell [1/s].
    ScalarField strain_rates(const TetMesh &mesh, const NodalVectors<double> &X, const Field<double> &W)
    {
      ScalarField rate{"strain_rate", {}};
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      {
        const auto e = cell_strain_rates(cell_geometry(positions_of_cell(mesh, X, c)), W.on_cell(mesh, c));
        rate.values.push_back(0.25 * (e[0] + e[1] + e[2] + e[3]));
      }
      return rate;
    }

    /// Which die presses a node (its number, counted from 1, or 0), and how strongly.
    struct ContactFields
    {
      ScalarField state, pressure;
    };

    ContactFields contact_fields(const LastStage &last, const IncrementEvent &event)
    {
      const Stage<double> &stage   = last.stage;
      const TetMesh       &mesh    = event.state.leg->scene.mesh;
      const ActiveSet     &pressed = event.record.solves.back().active;
      std::vector<double>  state(mesh.n_nodes(), 0.), force(mesh.n_nodes(), 0.), pressure(mesh.n_nodes(), 0.);
      for (unsigned int p = 0; p < event.record.pairs.size(); ++p)
      {
        const auto          node  = stage.contact_node(p, event.state.W, pressed);
        const ContactPoint &point = event.record.pairs[p].point;
        if (node.active)
          for (unsigned int i = 0; i < point.n_nodes(); ++i)
          {
            const NodeIndex k = point.nodes[i];
            state[k]          = event.record.pairs[p].die + 1.;
            force[k] += point.weight() * stage.physics.contact.rho * node.S * approach_excess(node);
          }
      }
      const std::vector<double> area = lumped_areas(surface_triangles(mesh), stage.X);
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
        if (force[k] > 0.)
          pressure[k] = force[k] / area[k];
      return {{"contact_state", state}, {"contact_pressure", pressure}};
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
      , pvd_(directory + "/fields.pvd")
  {
  }

  void FieldWriter::add_billet()
  {
    if (!pvd_.steps().empty())
      return;
    write_vtu(directory_ + "/fields_000000.vtu", billet_, X_0_, {}, {}, {});
    pvd_.add(0., "fields_000000.vtu");
  }

  void FieldWriter::add(const IncrementEvent &event)
  {
    const ForgingState &run   = event.state;
    const Scene        &scene = run.leg->scene;
    const LastStage     last(scene, model_.step, process_, event.X_before, event.record);
    const auto          contact = contact_fields(last, event);
    char                name[32];
    std::snprintf(name, sizeof name, "fields_%06u.vtu", run.increments);
    add_billet();
    write_vtu(directory_ + "/" + name,
              scene.mesh,
              run.X,
              {{"pressure", run.W.P}, contact.state, contact.pressure},
              {{"velocity", run.W.V}},
              {strain_rates(scene.mesh, last.stage.X, run.W), {"equivalent_strain", run.strain}});
    pvd_.add(event.time, name);
  }

  void FieldWriter::add_failed(const ForgingState &state)
  {
    const TetMesh &mesh = state.leg->scene.mesh;
    add_billet();
    write_vtu(directory_ + "/failed.vtu",
              mesh,
              state.X,
              {{"pressure", state.W.P}},
              {{"velocity", state.W.V}},
              {strain_rates(mesh, state.X, state.W), {"equivalent_strain", state.strain}});
    pvd_.add(state.stroke / process_.speed(), "failed.vtu");
  }
} // namespace retroforge
