// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: damaged parameter files, and damaged --set options, are refused with an Error, or give finite
// parameters from which process and steps follow, and an input that reads back to itself.
#include "mutate.h"

#include <retroforge/case/parameters.h>

#include <filesystem>

using namespace retroforge;

const std::string file = "damaged.prm";

const std::string whole = R"(# Upsetting of a cylinder.
include common.prm
subsection Billet
  set shape        = cylinder
  set radius       = 25   # mm
  set height       = 50
  set element size = 6
  set symmetry planes = -1, 0, 0; 0, -1, 0
  set symmetry point  = 0, 0, 25
end

subsection Dies
  set names = lower, upper
end
subsection Die lower
  set facing   = 0, 0, 1
  set friction = 0.3
end
subsection Die upper
  set point    = 0, 0, \
                 50
  set facing   = 0, 0, -1
  set velocity = 0, 0, -1
  set friction = 0.3
  subsection Bell
    set depth = 3
  end
end
subsection Press
  set stroke     = 10
  set increments = 0
end
subsection Contact
  set law   = smooth
  set layer = 0.5
end
subsection Design
  set parameters = material/K, die upper/friction
end
)";

const std::string common = "subsection Material\n  set consistency = 1000\nend\n";

std::pair<std::string, std::string> some_override(fuzz::Random &random)
{
  const std::vector<std::pair<std::string, std::string>> overrides = {{"Press/stroke", "5"},
                                                                      {"Dies/names", "lower, upper"},
                                                                      {"Billet/size", "1, 2, 3"},
                                                                      {"Contact/layer", "0"},
                                                                      {"Press/increments", "40"}};
  auto                                                   override  = random.one_of(overrides);
  (random.below(4) == 0 ? override.first : override.second) =
    random.below(2) == 0 ? random.one_of(fuzz::nasty_words) : fuzz::mutate(override.second, random);
  return override;
}

void require_sane(Parameters &parameters)
{
  parameters.resolve_defaults({50., 50., 50.});
  const Process<double> process = parameters.process({50., 50., 50.});
  const StepModel       model   = parameters.step_model();
  using fuzz::require;
  require(parameters.press.increments > 0, "there are no increments");
  require(process.operations.front().leading_die < process.dies.size(), "the leading die does not exist");
  require(std::isfinite(process.speed()) && process.speed() > 0., "the leading die does not move");
  require(std::isfinite(process.contact.rho) && process.contact.rho > 0., "the penalty is not positive");
  require(std::isfinite(model.reach) && model.reach > 0., "the reach of contact is not positive");
  require(std::isfinite(parameters.press.stroke / parameters.press.increments), "the step is not finite");
}

int main()
{
  fuzz::write_bytes("common.prm", common);
  std::string echo;
  fuzz::write_bytes(file, whole);
  Parameters::read(file, {}, echo);
  const std::string all  = echo;
  const auto        read = [](const std::vector<std::pair<std::string, std::string>> &overrides) {
    std::string echo, second;
    Parameters  parameters = Parameters::read(file, overrides, echo);
    require_sane(parameters);
    fuzz::write_bytes("echo.prm", echo);
    Parameters::read("echo.prm", {}, second);
    fuzz::require(echo == second, "the echo reads back to something else");
  };
  fuzz::run("parameter file", "", [&](fuzz::Random &random) {
    fuzz::write_bytes("common.prm", random.below(5) == 0 ? fuzz::mutate(common, random) : common);
    fuzz::write_bytes(file, fuzz::mutate(random.below(3) == 0 ? all : whole, random));
    read({});
  });
  fuzz::run("--set", "", [&](fuzz::Random &random) {
    fuzz::write_bytes("common.prm", common);
    fuzz::write_bytes(file, whole);
    read({some_override(random)});
  });
}
