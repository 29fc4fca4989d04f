// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/remeshing/volume_correction.h>
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/transfer/cell_transfer.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Number volume_of(const TetMesh &mesh, const NodalVectors<Number> &X)
    {
      Number six_volumes(0.);
      for (const auto &cell : mesh.cells)
      {
        const Vector3<Number> a = X[cell[1]] - X[cell[0]], b = X[cell[2]] - X[cell[0]],
                              c = X[cell[3]] - X[cell[0]];
        six_volumes += dealii::cross_product_3d(a, b) * c;
      }
      return six_volumes / 6.;
    }
  } // namespace

  template <typename Number>
  NodalVectors<Number>
  positions_after(const TetMesh &old_mesh, const RemeshRecord &remesh, const NodalVectors<Number> &X)
  {
    NodalVectors<Number>        positions = remesh.transfer.positions(X);
    const NodalVectors<double> &u         = remesh.spread;
    if (u.empty())
      return positions;
    AssertDimension(u.size(), positions.size());
    // What is below is rounding, and the nominal positions keep their bits.
    constexpr double   negligible = 1e-13;
    constexpr unsigned most       = 8;
    const double       then       = volume_of(remesh.mesh, remesh.mesh.X),
                 slope            = dot(volume_gradient(remesh.mesh.faces, remesh.mesh.X), u);
    const Number wanted           = volume_of(old_mesh, X) + (then - volume_of(old_mesh, remesh.X_before));
    for (unsigned int i = 0; i < most; ++i)
    {
      const Number missing = wanted - volume_of(remesh.mesh, positions);
      if (std::is_same<Number, double>::value && std::abs(value_of(missing)) <= negligible * then)
        break;
      const Number d = missing / slope;
      for (std::size_t k = 0; k < positions.size(); ++k)
        positions[k] += u[k] * d;
    }
    return positions;
  }

  template NodalVectors<double>
  positions_after(const TetMesh &, const RemeshRecord &, const NodalVectors<double> &);
  template NodalVectors<Dual>
  positions_after(const TetMesh &, const RemeshRecord &, const NodalVectors<Dual> &);

  NodalVectors<double> reverse_positions_after(const TetMesh              &old_mesh,
                                               const RemeshRecord         &remesh,
                                               const NodalVectors<double> &X,
                                               const NodalVectors<double> &positions_bar)
  {
    const NodalVectors<double> &u = remesh.spread;
    if (u.empty())
      return remesh.transfer.apply_transpose(positions_bar);
    const NodalVectors<double> g_new = volume_gradient(remesh.mesh.faces, remesh.mesh.X),
                               g_old = volume_gradient(old_mesh.faces, X);
    const double         d_bar       = dot(u, positions_bar) / dot(g_new, u);
    NodalVectors<double> bar         = positions_bar;
    for (std::size_t k = 0; k < bar.size(); ++k)
      bar[k] -= d_bar * g_new[k];
    NodalVectors<double> X_bar = remesh.transfer.apply_transpose(bar);
    for (std::size_t k = 0; k < X_bar.size(); ++k)
      X_bar[k] += d_bar * g_old[k];
    return X_bar;
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodalVectors<Number> &positions,
                                          NodalVectors<Number>       &to) const
  {
    to = positions_after(old_mesh, remesh, positions);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodeField<Number> &q, NodeField<Number> &to) const
  {
    to = remesh.transfer.apply<Number>(q);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const CellField<Number> &q, CellField<Number> &to) const
  {
    to = transfer_cells<Number>(old_mesh, X, remesh.transfer, remesh.mesh, q);
  }

  template struct MemberTransfer<double>;
  template struct MemberTransfer<Dual>;

  void ReverseMemberTransfer::operator()(const NodalVectors<double> &positions,
                                         const NodalVectors<double> &q_bar,
                                         NodalVectors<double>       &to) const
  {
    to = reverse_positions_after(old_mesh, remesh, positions, q_bar);
  }

  void ReverseMemberTransfer::operator()(const NodeField<double> &,
                                         const NodeField<double> &q_bar,
                                         NodeField<double>       &to) const
  {
    to = remesh.transfer.apply_transpose<double>(q_bar);
  }

  void ReverseMemberTransfer::operator()(const CellField<double> &q,
                                         const CellField<double> &q_bar,
                                         CellField<double>       &to) const
  {
    to.assign(old_mesh.n_cells(), 0.);
    if (!is_zero(q_bar))
      reverse_transfer_cells(old_mesh, X, remesh.transfer, remesh.mesh, q, q_bar, to, X_bar);
  }
} // namespace retroforge
