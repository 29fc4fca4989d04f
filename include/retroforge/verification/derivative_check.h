// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/run/simulation.h>
#include <retroforge/verification/check.h>

namespace retroforge
{
  /// The command check: a case forged and differentiated as by `gradient`, whose derivatives are then
  /// compared with the direct method and with differences of replayed and of free runs.
  class DerivativeCheck : public Simulation
  {
  public:
    using Simulation::Simulation;

  private:
    bool verify() override;
    /// Keeps what of a check is done, however it ends.
    void keep(const std::vector<CheckRow> &rows, unsigned int remaining);
    /// Rows of a check of the same run that was stopped.
    std::vector<CheckRow> kept() const;
  };
} // namespace retroforge
