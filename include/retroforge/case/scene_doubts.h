// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/parameters.h>
#include <retroforge/contact/die_approach.h>

namespace retroforge
{
  /// Adds a sentence on each thing that a forging can begin with and that may not be meant: a billet that
  /// touches facets in front of which their smooth surface stands, chamfers taken for roundings, dies that
  /// end a little before a plane of symmetry, and parts of dies that would come into the metal between nodes.
  /// @param X           positions of the billet's nodes
  /// @param approaches  of the dies, see find_approaches()
  void add_doubts(const Parameters               &parameters,
                  const Scene                    &scene,
                  const Process<double>          &process,
                  const NodalVectors<double>     &X,
                  const std::vector<DieApproach> &approaches,
                  std::vector<std::string>       &warnings);
} // namespace retroforge
