// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/final_objective.h>

namespace retroforge
{
  namespace
  {
    std::size_t n_target_vertices(const FinalView<double> &view, const unsigned int target_die)
    {
      if (view.target)
        return view.target->size();
      const bool is_surface = target_die != invalid_index && view.scene.dies[target_die].surface();
      return is_surface ? view.scene.dies[target_die].surface()->vertices().size() : 0;
    }
  } // namespace

  FinalBar::FinalBar(const FinalView<double> &view, const unsigned int target_die)
      : X(view.scene.mesh.n_nodes())
      , q(view.scene.mesh.n_cells(), 0.)
      , T(view.T != nullptr ? view.scene.mesh.n_nodes() : 0, 0.)
      , damage(view.damage != nullptr ? view.scene.mesh.n_cells() : 0, 0.)
      , skin(view.skin != nullptr ? NodeSkins<double>::none(view.scene.mesh.n_nodes(), view.scene.dies.size())
                                  : NodeSkins<double>())
      , target(n_target_vertices(view, target_die))
      , dies(no_derivatives(view.scene.dies))
  {
  }
} // namespace retroforge
