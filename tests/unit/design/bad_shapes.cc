// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Shapes that cannot be are refused with what was found, the rule and a remedy: measures of the section
// Billet, names of parameters, and values of mu.

#include <deal.II/base/mpi.h>

#include <retroforge/design/design.h>

#include "design_test_tools.h"

#include <iomanip>
#include <regex>
#include <sstream>

using namespace retroforge;

const Entries ring    = {{"shape", "ring"}, {"sector angle", "18"}, {"element size", "5"}};
const Entries profile = {{"shape", "profile"},
                         {"control points", "20, 0; 26, 15; 26, 30; 20, 45"},
                         {"sector angle", "30"},
                         {"element size", "6"}};

std::string title(const Entries &entries)
{
  std::string text;
  for (const auto &[name, value] : entries)
    text += (text.empty() ? "" : ", ") + name + " = " + value;
  return text;
}

Entries with(Entries entries, const Entries &more)
{
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}

void refuse_billet(const Entries &base, const Entries &more)
{
  print_error(title(more), [&]() { billet(with(base, more)); });
}

void refuse_map(const Entries &base, const Entries &more)
{
  print_error(title(more), [&]() { MappedBillet(with(base, more)); });
}

void refuse_change(const MappedBillet &billet, const unsigned int j, const double change)
{
  print_error(billet.map.parameters()[j].name + " changed by " + std::to_string(change),
              [&]() { billet.map.positions(billet.changed(j, change)); });
}

/// The same where what is refused follows from the volume of the mesh, which is another one with another
/// version of Gmsh: of this value two digits are shown.
void refuse_held_change(const MappedBillet &billet, const unsigned int j, const double change)
{
  const auto rounded = [](const std::string &text) {
    std::smatch found;
    if (!std::regex_search(text, found, std::regex("= (-?[0-9.]+)")))
      return text;
    std::ostringstream value;
    value << std::setprecision(2) << std::stod(found[1]);
    return found.prefix().str() + "= " + value.str() + found.suffix().str();
  };
  print_error(
    billet.map.parameters()[j].name + " changed by " + std::to_string(change),
    [&]() { billet.map.positions(billet.changed(j, change)); },
    rounded);
}

void refuse_name(const Entries &entries, const std::string &name)
{
  const BilletParameters parameters = billet_parameters(entries);
  const TetMesh          mesh       = make_billet(parameters, MPI_COMM_WORLD);
  print_error(title(entries) + ": " + name,
              [&]() { Design({name}, parameters, {}, {}, {}, first_mesh(parameters, mesh)); });
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::cout << "section Billet, ring\n";
  refuse_billet(ring, {{"mu4", "18"}});
  refuse_billet(ring, {{"mu2", "26"}});
  refuse_billet(ring, {{"mu3", "45"}});
  refuse_billet(ring, {{"bore radius", "0"}});
  refuse_billet(ring, {{"outer edge height", "31"}});
  std::cout << "section Billet, profile\n";
  refuse_billet({{"shape", "profile"}}, {});
  refuse_billet(profile, {{"control points", "20, 0; 20, 10; 20, 20"}});
  refuse_billet(profile, {{"control points", "20, 0; 60, 30; -10, 30; 20, 45"}});
  refuse_billet(profile, {{"control points", "20, 0; 80, 90; 80, -60; 20, 45"}});
  refuse_billet(profile, {{"control points", "20, 45; 26, 30; 26, 15; 20, 0"}});
  refuse_billet(profile, {{"control points", "20, 1; 26, 15; 26, 30; 20, 45"}});
  refuse_billet(profile, {{"inner radius", "21"}});
  std::cout << "names\n";
  refuse_map(ring, {{"volume held by", "mu5"}});
  refuse_map({{"element size", "20"}}, {{"volume held by", "radius"}});
  refuse_name(with(ring, {{"volume held by", "mu4"}}), "billet/mu4");
  refuse_name(ring, "billet/radius");
  std::cout << "values, ring\n";
  const MappedBillet free(ring);
  refuse_change(free, 0, -16.);
  refuse_change(free, 1, -7.);
  refuse_change(free, 1, 7.);
  refuse_change(free, 1, 6.4);
  refuse_change(free, 2, -28.);
  refuse_change(free, 3, -30.);
  std::cout << "values, ring, volume held by mu4\n";
  const MappedBillet held(with(ring, {{"volume held by", "mu4"}}));
  refuse_held_change(held, 0, 40.);
  refuse_held_change(held, 0, 1000.);
  refuse_held_change(held, 1, 6.8);
  std::cout << "values, box, volume held by height\n";
  const MappedBillet box({{"element size", "20"}, {"volume held by", "height"}});
  refuse_change(box, 0, -25.);
  std::cout << "values, profile\n";
  const MappedBillet spline(profile);
  refuse_change(spline, 0, -21.);
  refuse_change(spline, 3, 200.);
  refuse_change(spline, 7, -40.);
  const MappedBillet belly(with(profile, {{"volume held by", "control point 3 r"}}));
  refuse_held_change(belly, 2, 60.);
  std::cout << "values, cylinder\n";
  const MappedBillet cylinder({{"shape", "cylinder"}, {"element size", "20"}});
  refuse_change(cylinder, 0, -25.);
  refuse_change(cylinder, 1, -60.);
}
