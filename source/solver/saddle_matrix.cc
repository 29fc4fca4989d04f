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
      : scene_(scene), velocities_(scene.velocities), pressures_(scene.partition.nodes())
  {
    make_patterns();
    sums_ = std::make_unique<TangentSums>(scene, system_.A->pattern());
  }

  void SaddleMatrix::assemble(const Stage<double> &stage,
                              const Field<double> &W,
                              const ActiveSet     &active,
                              const Linearisation  linearisation)
  {
    const ActiveSet chosen = active.empty() ? stage.decide_active(W) : active;
    system_.symmetric      = stage.has_potential();
    frames_                = make_frames(scene_, stage.contact, chosen);
    sums_->assemble(stage, W, linearisation);
    pressure_scale_                           = sums_->viscosity_over_edge();
    const std::vector<double>         viscous = viscous_diagonal();
    const std::vector<ContactEntries> contact = contact_entries(stage, W, chosen);
    choose_scales(viscous, contact);
    write_sums();
    add_contact(contact);
    put_diagonals_of_fixed(viscous);
    describe_rows();
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
          total[3 * velocities_.local(of.row) + i] += of.tangent[i][i];
    scale_.assign(3 * frames_.size(), 1.);
    for (unsigned int row = 0; row < viscous.size(); ++row)
      scale_[3 * velocities_.owned()[row / 3] + row % 3] = std::sqrt(viscous[row] / total[row]);
    scene_.exchange.update_components(scale_);
    unknown_scale_ = scale_;
    for (NodeIndex k = 0; k < frames_.size(); ++k)
      std::fill_n(&unknown_scale_[3 * k], frames_[k].n_fixed, 0.);
  }

  void SaddleMatrix::put_diagonals_of_fixed(const std::vector<double> &viscous) const
  {
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
      for (unsigned int i = 0; i < frames_[velocities_.owned()[local]].n_fixed; ++i)
        system_.A->entry(local, i, diagonal_[local])[i] = viscous[3 * local + i];
  }

  void SaddleMatrix::describe_rows()
  {
    const unsigned int n_rows = 3 * velocities_.range().n_owned();
    system_.penalised.clear();
    system_.translations.assign(3 * n_rows, 0.);
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeIndex  k     = velocities_.owned()[local];
      const NodeFrame &frame = frames_[k];
      for (unsigned int i = frame.n_fixed; i < 3; ++i)
      {
        const unsigned int row   = 3 * local + i;
        const double       scale = scale_[3 * k + i];
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

  void SaddleMatrix::fill_interpolation()
  {
    // Of velocities it is the mean of an edge's ends; so of unknowns, that between frames and scales.
    system_.P->clear();
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeIndex k = velocities_.owned()[local];
      if (k < scene_.mesh.n_nodes())
      {
        for (unsigned int i = 0; i < 3; ++i)
          system_.P->entry(local, i, 0)[i] = 1.;
        continue;
      }
      for (const NodeIndex end : scene_.spaces.edges()->nodes[k - scene_.mesh.n_nodes()])
      {
        const unsigned int position = system_.P->pattern().position(local, pressures_.number(end));
        const Tensor<2, 3> turn     = frames_[k].axes * transpose(frames_[end].axes);
        for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
          if (scale_[3 * k + i] >= penalised)
            for (unsigned int j = frames_[end].n_fixed; j < 3; ++j)
              system_.P->entry(local, i, position)[j] =
                0.5 * turn[i][j] * scale_[3 * end + j] / scale_[3 * k + i];
      }
    }
  }

  std::pair<double, double> SaddleMatrix::residual_norm(const Field<double> &r) const
  {
    double momentum2 = 0., continuity2 = 0.;
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeIndex k = velocities_.owned()[local];
      const Vec3      v = frames_[k].to_tests(r.V[k]);
      for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
        momentum2 += std::pow(scale_[3 * k + i] * v[i], 2);
    }
    for (const NodeIndex k : pressures_.owned())
      continuity2 += r.P[k] * r.P[k];
    return {std::sqrt(scene_.partition.sum(momentum2)), std::sqrt(scene_.partition.sum(continuity2))};
  }

  unsigned int SaddleMatrix::n_eliminated() const
  {
    return sums_->eliminations().empty() ? 0 : scene_.partition.visited_cells.size();
  }

  la::BlockVector SaddleMatrix::vector() const
  {
    return la::BlockVector({velocities_.range().dofs(3), pressures_.range().dofs(1)}, scene_.partition.comm);
  }

  Field<double> SaddleMatrix::condensed(const Field<double> &rhs) const
  {
    const Partition &partition = scene_.partition;
    Field<double>    result    = rhs;
    for (unsigned int v = 0; v < n_eliminated(); ++v)
    {
      const CellIndex    c    = partition.visited_cells[v];
      CellValues<double> cell = {};
      cell.beta               = rhs.beta[scene_.spaces.bubble(c)];
      sums_->eliminations()[v].condense(cell);
      MiniPair::add(scene_.spaces, cell, c, result);
    }
    return result;
  }

  void
  SaddleMatrix::load(const Field<double> &rhs, const Transposition transposition, la::BlockVector &b) const
  {
    const Field<double> from       = condensed(rhs);
    double             *momentum   = b.block(0).begin();
    double             *continuity = b.block(1).begin();
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeIndex k = velocities_.owned()[local];
      const Vec3      v = transposition == Transposition::plain ? frames_[k].to_tests(from.V[k])
                                                                : frames_[k].to_frame(from.V[k]);
      for (unsigned int i = 0; i < 3; ++i)
        momentum[3 * local + i] = i < frames_[k].n_fixed ? 0. : scale_[3 * k + i] * v[i];
    }
    for (unsigned int local = 0; local < pressures_.range().n_owned(); ++local)
      continuity[local] = pressure_scale_ * from.P[pressures_.owned()[local]];
  }

  void SaddleMatrix::unload(const la::BlockVector &x,
                            const Field<double>   &rhs,
                            const Transposition    transposition,
                            Field<double>         &solution) const
  {
    solution               = Field<double>(scene_.spaces);
    const double *velocity = x.block(0).begin();
    const double *pressure = x.block(1).begin();
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeIndex k = velocities_.owned()[local];
      Vec3            v;
      for (unsigned int i = frames_[k].n_fixed; i < 3; ++i)
        v[i] = scale_[3 * k + i] * velocity[3 * local + i];
      solution.V[k] =
        transposition == Transposition::plain ? frames_[k].to_space(v) : frames_[k].from_tests(v);
    }
    for (unsigned int local = 0; local < pressures_.range().n_owned(); ++local)
      solution.P[pressures_.owned()[local]] = pressure_scale_ * pressure[local];
    scene_.exchange.update(solution);
    for (unsigned int v = 0; v < n_eliminated(); ++v)
    {
      const CellIndex          c      = scene_.partition.visited_cells[v];
      const unsigned int       bubble = scene_.spaces.bubble(c);
      const CellValues<double> w      = MiniPair::on_cell(scene_.spaces, solution, c);
      solution.beta[bubble]           = sums_->eliminations()[v].recover_bubble(rhs.beta[bubble], w.V, w.P);
    }
  }

  void SaddleMatrix::load_guess(const Field<double> &guess,
                                const Transposition  transposition,
                                la::BlockVector     &x) const
  {
    double *velocity = x.block(0).begin();
    double *pressure = x.block(1).begin();
    for (unsigned int local = 0; local < velocities_.range().n_owned(); ++local)
    {
      const NodeIndex k = velocities_.owned()[local];
      const Vec3      v = transposition == Transposition::plain || system_.symmetric
                            ? frames_[k].to_frame(guess.V[k])
                            : Vec3(transpose(invert(frames_[k].tests)) * guess.V[k]);
      for (unsigned int i = 0; i < 3; ++i)
        velocity[3 * local + i] = i < frames_[k].n_fixed ? 0. : v[i] / scale_[3 * k + i];
    }
    for (unsigned int local = 0; local < pressures_.range().n_owned(); ++local)
      pressure[local] = guess.P[pressures_.owned()[local]] / pressure_scale_;
  }
} // namespace retroforge
