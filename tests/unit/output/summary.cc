// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: the summary has the keys of doc/summary_schema.md in their order, null for what is unknown or
// not finite, and no empty lists; numbers read back to the same bits.
// In summary.output the bracket after a key stands on a line of its own: the test driver normalises JSON so.
#include <retroforge/output/safe_file.h>
#include <retroforge/output/summary.h>

#include <nlohmann/json.hpp>

#include <iostream>

using namespace retroforge;

Summary filled()
{
  Summary s;
  s.command           = "check";
  s.version           = "0.1.0";
  s.commit            = "";
  s.blas              = "reference";
  s.ranks             = 2;
  s.n_nodes           = 1331;
  s.n_cells           = 6000;
  s.objectives        = {{"energy", 1.5, "mJ", {{"deformation", 1.25}, {"friction", 0.25}}, {}, 6.},
                         {"maximum effort", 8., "N", {}, {{"true maximum", 9.}}}};
  s.whole             = {4., Summary::unknown};
  s.parameters        = {{"material/K", 1., "MPa s^m", {{"energy", 1.5}, {"volume", Summary::unknown}}, 2.}};
  s.increments        = 20;
  s.cuts              = 0;
  s.remeshings        = 3;
  s.newton_iterations = 71;
  s.krylov_iterations = 900;
  s.linear_solves_forward = 71;
  s.linear_solves_adjoint = 40;
  s.volume_initial        = 8.;
  s.volume_final          = 7.5;
  s.volume_of_shape       = 8.25;
  s.heat                  = {true, true, 12.5, 1.75, 3., 0.75, 1100.25, {{8., 3.}, {2., 0.}}};
  s.warnings              = {"the stroke pressed no node against die side"};
  s.wall_seconds          = {{"assembly", 0.5}, {"total", 2.}};
  s.record_bytes          = 5000000000;
  s.spanned               = {80, 5, 0.07, 3., {{1., 2., 3.}}, "lower"};
  s.restarts              = {{13, 9.25, {{"Press/increments", {"20", "40"}}}}};
  s.check                 = {{"energy", "material/K", 1.5, 1.5, {}, {2., 1. / 0.}, "passed"}};
  s.check_remaining       = 3;
  s.check[0].steps        = {{1e-3, 1.5, 1.5, 1.5, Summary::unknown}};
  return s;
}

int main()
{
  std::cout << "-- filled\n" << filled().to_json() << "-- empty\n" << Summary().to_json();

  Summary s             = filled();
  s.volume_final        = 0.1 + 0.2;
  s.objectives[0].value = 1. / 3.;
  s.objectives[0].name  = "\xff\"";
  s.write("summary.json");
  const auto json = nlohmann::json::parse(read_file("summary.json"));
  std::cout << "-- read back: same bits " << (json["volume_final"] == 0.1 + 0.2)
            << (json["objectives"][0]["value"] == 1. / 3.) << '\n';
}
