// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/change_of_mesh.h>

#include <type_traits>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    NodeField<Number> mode_of(const std::vector<Skin<Number>> &skins, const unsigned int j)
    {
      NodeField<Number> mode;
      for (const auto &skin : skins)
        mode.push_back(skin[j]);
      return mode;
    }

    template <typename Number>
    void set_mode(const unsigned int j, const NodeField<Number> &mode, std::vector<Skin<Number>> &skins)
    {
      skins.resize(mode.size());
      for (std::size_t k = 0; k < mode.size(); ++k)
        skins[k][j] = mode[k];
    }

    /// f(skins of the metal or of a die, ...) of each.
    template <typename F, typename First, typename... Others>
    void for_each_side(const F &f, First &first, Others &...others)
    {
      f(first.metal, others.metal...);
      for (std::size_t d = 0; d < first.dies.size(); ++d)
        f(first.dies[d], others.dies[d]...);
    }
  } // namespace

  template <typename Number>
  BasicTransfer<Number> moved_transfer(const TetMesh              &old_mesh,
                                       const RemeshRecord         &remesh,
                                       const NodalVectors<Number> &X_old,
                                       const NodalVectors<Number> &X_new)
  {
    if constexpr (std::is_same_v<Number, double>)
      if (X_old == remesh.X_before && X_new == remesh.mesh.X)
        return remesh.transfer;
    return MovingTransfer(old_mesh, remesh.X_before, remesh.mesh, remesh.transfer).at(X_old, X_new);
  }

  template TransferOperator    moved_transfer(const TetMesh &,
                                              const RemeshRecord &,
                                              const NodalVectors<double> &,
                                              const NodalVectors<double> &);
  template BasicTransfer<Dual> moved_transfer(const TetMesh &,
                                              const RemeshRecord &,
                                              const NodalVectors<Dual> &,
                                              const NodalVectors<Dual> &);

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodalVectors<Number> &, NodalVectors<Number> &to) const
  {
    to = X_new;
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodeField<Number> &q, NodeField<Number> &to) const
  {
    to = q;
    if (!q.empty())
      to = J.apply_bounded(q);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodeSkins<Number> &skins, NodeSkins<Number> &to) const
  {
    to.dies.resize(skins.dies.size());
    for_each_side(
      [&](const auto &before, auto &after) {
        for (unsigned int j = 0; j < n_skin_modes; ++j)
        {
          NodeField<Number> mode;
          (*this)(mode_of(before, j), mode);
          set_mode(j, mode, after);
        }
      },
      skins,
      to);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodeVectorField<3, Number> &v,
                                          NodeVectorField<3, Number>       &to) const
  {
    to = v;
    if (!v.empty())
      to = J.template apply<Vector3<Number>>(v);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const CellField<Number> &q, CellField<Number> &to) const
  {
    to = q;
    if (!q.empty())
      to = transfer_cells<Number>({old_mesh, X_old, J, new_mesh, X_new}, q);
  }

  template struct MemberTransfer<double>;
  template struct MemberTransfer<Dual>;

  template <typename Number>
  void MemberMotion<Number>::operator()(NodeSkins<Number> &skins) const
  {
    for_each_side(
      [&](auto &side) {
        for (unsigned int j = 0; j < n_skin_modes; ++j)
        {
          NodeField<Number> mode = mode_of(side, j);
          (*this)(mode);
          set_mode(j, mode, side);
        }
      },
      skins);
  }

  template struct MemberMotion<double>;
  template struct MemberMotion<Dual>;

  void ReverseMemberMotion::operator()(const NodeSkins<double> &skins,
                                       const NodeSkins<double> &skins_bar) const
  {
    if (skins_bar.dies.size() == skins.dies.size())
      for_each_side(
        [&](const auto &side, const auto &bar) {
          for (unsigned int j = 0; j < n_skin_modes; ++j)
            (*this)(mode_of(side, j), mode_of(bar, j));
        },
        skins,
        skins_bar);
  }

  ReverseMemberTransfer::ReverseMemberTransfer(const TetMesh              &old_mesh,
                                               const RemeshRecord         &remesh,
                                               const NodalVectors<double> &X,
                                               MovingTransfer             &moving,
                                               NodalVectors<double>       &X_old_bar)
      : old_mesh_(old_mesh)
      , remesh_(remesh)
      , X_(X)
      , moving_(moving)
      , X_old_bar_(X_old_bar)
      , X_new_bar_(remesh.mesh.n_nodes())
      , weight_bar_(remesh.transfer.weight.size(), 0.)
  {
  }

  void ReverseMemberTransfer::operator()(const NodalVectors<double> &positions,
                                         const NodalVectors<double> &q_bar,
                                         NodalVectors<double>       &to)
  {
    to.resize(positions.size());
    X_new_bar_ = q_bar;
  }

  void ReverseMemberTransfer::operator()(const NodeField<double> &q,
                                         const NodeField<double> &q_bar,
                                         NodeField<double>       &to)
  {
    to = q_bar;
    if (q_bar.empty())
      return;
    std::vector<double> free_bar = q_bar;
    to                           = remesh_.transfer.reverse_apply_bounded(q, free_bar);
    remesh_.transfer.add_weight_bar<double>(q, free_bar, weight_bar_);
  }

  void ReverseMemberTransfer::operator()(const NodeSkins<double> &skins,
                                         const NodeSkins<double> &skins_bar,
                                         NodeSkins<double>       &to)
  {
    to.dies.resize(skins_bar.dies.size());
    for_each_side(
      [&](const auto &after_bar, const auto &before, auto &before_bar) {
        for (unsigned int j = 0; j < n_skin_modes; ++j)
        {
          NodeField<double> mode;
          (*this)(mode_of(before, j), mode_of(after_bar, j), mode);
          set_mode(j, mode, before_bar);
        }
      },
      skins_bar,
      skins,
      to);
  }

  void ReverseMemberTransfer::operator()(const NodeVectorField<3, double> &v,
                                         const NodeVectorField<3, double> &v_bar,
                                         NodeVectorField<3, double>       &to)
  {
    to = remesh_.transfer.apply_transpose<Vec3>(v_bar);
    if (!v.empty())
      remesh_.transfer.add_weight_bar<Vec3>(v, v_bar, weight_bar_);
  }

  void ReverseMemberTransfer::operator()(const CellField<double> &q,
                                         const CellField<double> &q_bar,
                                         CellField<double>       &to)
  {
    to.assign(q_bar.empty() ? 0 : old_mesh_.n_cells(), 0.);
    if (!is_zero(q_bar))
      reverse_transfer_cells({old_mesh_, X_, remesh_.transfer, remesh_.mesh, remesh_.mesh.X},
                             q,
                             q_bar,
                             to,
                             X_old_bar_,
                             weight_bar_,
                             X_new_bar_);
  }

  void ReverseMemberTransfer::reverse_positions(const std::vector<Die>              &dies,
                                                const std::vector<DieState<double>> &states,
                                                std::vector<DieState<double>>       &dies_bar)
  {
    moving_.reverse(weight_bar_, X_old_bar_, X_new_bar_);
    remesh_.positions.reverse_positions(
      {old_mesh_, remesh_.mesh, dies, states}, X_, X_new_bar_, X_old_bar_, dies_bar);
  }

  WorkpieceState<3, double> reverse_change_mesh(const TetMesh                       &old_mesh,
                                                const RemeshRecord                  &remesh,
                                                const WorkpieceState<3, double>     &before,
                                                const std::vector<Die>              &dies,
                                                const std::vector<DieState<double>> &states,
                                                const WorkpieceState<3, double>     &costate,
                                                MovingTransfer                      &moving,
                                                std::vector<DieState<double>>       &dies_bar,
                                                const FollowingMesh                 *following)
  {
    AssertDimension(before.X.size(), old_mesh.n_nodes());
    AssertDimension(costate.X.size(), remesh.mesh.n_nodes());
    WorkpieceState<3, double> there, of_transfer = costate; // before heat is kept
    NodalVectors<double>      X_bar(before.X.size());
    NodeField<double>         T_bar(before.temperature.size(), 0.);
    if (!is_zero(costate.temperature))
    {
      const auto              X = moved_positions(old_mesh, remesh, before.X, dies, states);
      const NodeField<double> T{remesh.transfer.apply_bounded(before.temperature)};
      of_transfer.temperature = reverse_keep_heat({old_mesh, before.X, before.temperature},
                                                  {remesh.mesh, X, T},
                                                  costate.temperature,
                                                  X_bar,
                                                  T_bar,
                                                  of_transfer.X);
    }
    if (following != nullptr)
    {
      WorkpieceState<3, double> moved;
      NodalVectors<double>      w_bar(remesh.mesh.n_nodes());
      internal::for_each_member(
        MemberTransfer<double>{old_mesh, remesh.mesh, before.X, remesh.mesh.X, remesh.transfer},
        before,
        moved);
      internal::for_each_member(ReverseMemberMotion{*following, w_bar}, moved, of_transfer);
      of_transfer.X = following->reverse_positions(std::move(of_transfer.X), w_bar);
    }
    ReverseMemberTransfer reverse(old_mesh, remesh, before.X, moving, there.X);
    internal::for_each_member(
      [&](const auto &q, const auto &q_bar, auto &to) { reverse(q, q_bar, to); }, before, of_transfer, there);
    reverse.reverse_positions(dies, states, dies_bar);
    for (std::size_t k = 0; k < X_bar.size(); ++k)
      there.X[k] += X_bar[k];
    for (std::size_t k = 0; k < std::min(T_bar.size(), there.temperature.size()); ++k)
      there.temperature[k] += T_bar[k];
    return there;
  }
} // namespace retroforge
