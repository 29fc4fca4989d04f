// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/solver/saddle_matrix.h>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// Scales of a velocity's components below this are those of a penalty that holds it.
    constexpr double penalised = 0.1;
  } // namespace

  SaddleMatrix::SaddleMatrix(const Scene &scene)
      : scene_(scene)
      , velocities_(*scene.discretization.condensed_nodes())
      , pressures_(*scene.discretization.pressure_nodes())
  {
    make_patterns();
    cell_tangents_ = std::make_unique<CellTangentAssembler>(scene, system_.A->pattern());
  }

  void SaddleMatrix::assemble(const Equilibrium<double> &stage,
                              const Field<double>       &W,
                              const ActiveChoice        &active,
                              const Linearisation        linearisation)
  {
    Assert(&stage.scene == &scene_, ExcMessage("the stage is of another scene than the matrix"));
    Assert(active.fits(stage.contact.pairs.size()),
           ExcMessage("a choice of active contacts has an entry for each pair"));
    const ActiveSet chosen = active.is_given() ? *active : stage.decide_active(W);
    system_.symmetric      = stage.has_potential();
    frames_                = make_frames(scene_, stage.contact, chosen);
    cell_tangents_->assemble(stage, W, linearisation);
    pressure_scale_                           = cell_tangents_->viscosity_over_edge();
    const std::vector<double>         viscous = viscous_diagonal();
    const std::vector<ContactEntries> contact = contact_entries(stage, W, chosen);
    choose_scales(viscous, contact);
    write_cell_tangents();
    add_contact(contact);
    put_diagonals_of_fixed(viscous);
    describe_rows();
    describe_hold(stage);
    if (system_.P)
      fill_interpolation();
  }

  void SaddleMatrix::choose_scales(const std::vector<double>         &viscous,
                                   const std::vector<ContactEntries> &contact)
  {
    std::vector<double> total = viscous;
    for (const ContactEntries &of : contact)
      if (of.row == of.column)
        for (unsigned int i = 0; i < 3; ++i)
          total[3 * of.row + i] += of.tangent[i][i];
    scale_ = NodeVector<3, double>(scene_.discretization.condensed_nodes());
    for (unsigned int row = 0; row < viscous.size(); ++row)
      scale_.at_place(row / 3)[row % 3] = std::sqrt(viscous[row] / total[row]);
    scale_.update_ghosts();
    unknown_scale_ = scale_;
    for (unsigned int place = 0; place < frames_.size(); ++place)
      for (unsigned int i = 0; i < frames_[place].n_fixed; ++i)
        unknown_scale_.at_place(place)[i] = 0.;
  }

  void SaddleMatrix::put_diagonals_of_fixed(const std::vector<double> &viscous) const
  {
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
      for (unsigned int i = 0; i < frames_[local].n_fixed; ++i)
        system_.A->entry(local, i, diagonal_[local])[i] = viscous[3 * local + i];
  }

  void SaddleMatrix::describe_rows()
  {
    const unsigned int n_rows = 3 * velocities_.n_owned();
    system_.penalised.clear();
    system_.translations.assign(3 * n_rows, 0.);
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      const NodeFrame &frame = frames_[local];
      for (unsigned int i = frame.n_fixed; i < 3; ++i)
      {
        const unsigned int row   = 3 * local + i;
        const double       scale = scale_.at_place(local)[i];
        if (scale < penalised)
          system_.penalised.push_back(row);
        else
          for (unsigned int mode = 0; mode < 3; ++mode)
          {
            system_.translations[mode * n_rows + row] = frame.axes[i][mode] / scale;
          }
      }
    }
  }

  void SaddleMatrix::describe_hold(const Equilibrium<double> &stage)
  {
    const RigidHold &hold = stage.contact.hold;
    system_.held.clear();
    for (const RigidMotion &motion : hold.motions)
    {
      la::BlockVector row = vector(), column = vector();
      for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
        if (const NodeIndex k = velocities_.node_at(local); k < scene_.mesh.n_nodes())
        {
          const Vec3 u    = std::sqrt(hold.drag) / stage.X.size() * motion.at(stage.X[k]);
          const Vec3 test = frames_[local].to_tests(u), trial = frames_[local].to_frame(u);
          for (unsigned int i = 0; i < 3; ++i)
          {
            row.block(0).begin()[3 * local + i]    = unknown_scale_.at_place(local)[i] * test[i];
            column.block(0).begin()[3 * local + i] = unknown_scale_.at_place(local)[i] * trial[i];
          }
        }
      system_.held.emplace_back(row.block(0), column.block(0));
    }
  }

  void SaddleMatrix::fill_interpolation()
  {
    // Of velocities it is the mean of an edge's ends; so of unknowns, that between frames and scales.
    system_.P->clear();
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      const NodeIndex k = velocities_.node_at(local);
      if (k < scene_.discretization.n_vertices())
      {
        for (unsigned int i = 0; i < 3; ++i)
          system_.P->entry(local, i, 0)[i] = 1.;
        continue;
      }
      for (const NodeIndex vertex : scene_.discretization.middles()->ends_of(k))
      {
        const unsigned int end = velocities_.place(vertex);
        const unsigned int position =
          system_.P->pattern().position(local, pressures_.index_at(pressures_.place(vertex)));
        const Tensor<2, 3> turn    = frames_[local].axes * transpose(frames_[end].axes);
        const Vec3        &scale_k = scale_.at_place(local), &scale_end = scale_.at_place(end);
        for (unsigned int i = frames_[local].n_fixed; i < 3; ++i)
          if (scale_k[i] >= penalised)
            for (unsigned int j = frames_[end].n_fixed; j < 3; ++j)
              system_.P->entry(local, i, position)[j] = 0.5 * turn[i][j] * scale_end[j] / scale_k[i];
      }
    }
  }

  std::pair<double, double> SaddleMatrix::residual_norm(const Field<double> &r) const
  {
    check_field(r);
    double momentum2 = 0., continuity2 = 0.;
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      const Vec3 v = frames_[local].to_tests(r.V.at_place(local));
      for (unsigned int i = frames_[local].n_fixed; i < 3; ++i)
        momentum2 += std::pow(scale_.at_place(local)[i] * v[i], 2);
    }
    for (unsigned int local = 0; local < pressures_.n_owned(); ++local)
      continuity2 += r.P.at_place(local) * r.P.at_place(local);
    return {std::sqrt(scene_.discretization.sum(momentum2)),
            std::sqrt(scene_.discretization.sum(continuity2))};
  }

  unsigned int SaddleMatrix::n_eliminated() const
  {
    return cell_tangents_->eliminations().empty() ? 0 : scene_.discretization.visited_cells().size();
  }

  la::BlockVector SaddleMatrix::vector() const
  {
    return la::BlockVector({velocities_.range().dofs(3), pressures_.range().dofs(1)},
                           scene_.discretization.comm());
  }

  void SaddleMatrix::check_field([[maybe_unused]] const Field<double> &field) const
  {
    Assert(!scale_.empty(), ExcMessage("the matrix is to be assembled first"));
    Assert(field.belongs_to(scene_.discretization),
           ExcMessage("the field is of another discretisation than the matrix"));
  }

  void SaddleMatrix::check_vector([[maybe_unused]] const la::BlockVector &x) const
  {
    AssertDimension(x.n_blocks(), 2);
    AssertDimension(x.block(0).locally_owned_size(), 3 * velocities_.n_owned());
    AssertDimension(x.block(1).locally_owned_size(), pressures_.n_owned());
  }

  Field<double> SaddleMatrix::condensed(const Field<double> &rhs) const
  {
    const auto   &discretization = scene_.discretization;
    Field<double> result         = rhs;
    for (unsigned int v = 0; v < n_eliminated(); ++v)
    {
      const CellIndex    c    = discretization.visited_cells()[v];
      CellValues<double> cell = {};
      cell.beta               = MiniPair::bubble(discretization, rhs, c);
      cell_tangents_->eliminations()[v].condense(cell);
      MiniPair::add(discretization, cell, c, result);
    }
    return result;
  }

  void
  SaddleMatrix::load(const Field<double> &rhs, const Transposition transposition, la::BlockVector &b) const
  {
    check_field(rhs);
    check_vector(b);
    const Field<double> from       = condensed(rhs);
    double             *momentum   = b.block(0).begin();
    double             *continuity = b.block(1).begin();
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      const Vec3 v = transposition == Transposition::plain ? frames_[local].to_tests(from.V.at_place(local))
                                                           : frames_[local].to_frame(from.V.at_place(local));
      for (unsigned int i = 0; i < 3; ++i)
        momentum[3 * local + i] = i < frames_[local].n_fixed ? 0. : scale_.at_place(local)[i] * v[i];
    }
    for (unsigned int local = 0; local < pressures_.n_owned(); ++local)
      continuity[local] = pressure_scale_ * from.P.at_place(local);
  }

  void SaddleMatrix::unload(const la::BlockVector &x,
                            const Field<double>   &rhs,
                            const Transposition    transposition,
                            Field<double>         &solution) const
  {
    check_field(rhs);
    check_vector(x);
    const auto &discretization = scene_.discretization;
    solution                   = Field<double>(discretization);
    const double *velocity     = x.block(0).begin();
    const double *pressure     = x.block(1).begin();
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      Vec3 v;
      for (unsigned int i = frames_[local].n_fixed; i < 3; ++i)
        v[i] = scale_.at_place(local)[i] * velocity[3 * local + i];
      solution.V.at_place(local) =
        transposition == Transposition::plain ? frames_[local].to_space(v) : frames_[local].from_tests(v);
    }
    for (unsigned int local = 0; local < pressures_.n_owned(); ++local)
      solution.P.at_place(local) = pressure_scale_ * pressure[local];
    solution.update_ghosts();
    for (unsigned int v = 0; v < n_eliminated(); ++v)
    {
      const CellIndex          c = discretization.visited_cells()[v];
      const CellValues<double> w = MiniPair::on_cell(discretization, solution, c);
      MiniPair::bubble(discretization, solution, c) =
        cell_tangents_->eliminations()[v].recover_bubble(MiniPair::bubble(discretization, rhs, c), w.V, w.P);
    }
  }

  void SaddleMatrix::load_guess(const Field<double> &guess,
                                const Transposition  transposition,
                                la::BlockVector     &x) const
  {
    check_field(guess);
    check_vector(x);
    double *velocity = x.block(0).begin();
    double *pressure = x.block(1).begin();
    for (unsigned int local = 0; local < velocities_.n_owned(); ++local)
    {
      const Vec3 v = transposition == Transposition::plain || system_.symmetric
                       ? frames_[local].to_frame(guess.V.at_place(local))
                       : Vec3(transpose(invert(frames_[local].tests)) * guess.V.at_place(local));
      for (unsigned int i = 0; i < 3; ++i)
        velocity[3 * local + i] = i < frames_[local].n_fixed ? 0. : v[i] / scale_.at_place(local)[i];
    }
    for (unsigned int local = 0; local < pressures_.n_owned(); ++local)
      pressure[local] = guess.P.at_place(local) / pressure_scale_;
  }
} // namespace retroforge
