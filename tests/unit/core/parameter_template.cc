// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: the printed parameters name every entry with meaning, allowed values and default, in the order of
// their declaration, and read back as the same values.
#include <retroforge/core/parameter_input.h>
#include <retroforge/core/parameter_list.h>

#include <fstream>
#include <iostream>
#include <sstream>

using namespace retroforge;

struct Parameters
{
  double                        scale = 2.5;
  int                           seed  = -3;
  double                        ratio = 0.5;
  bool                          on    = true;
  std::string                   note, value = "wedge", file = "a.stl";
  std::vector<double>           list = {1, 2.5};
  std::map<std::string, double> map  = {{"left", 1.}, {"right", 2.}};
  dealii::ParameterHandler      prm;

  Parameters()
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Zeroth, declared first");
    prm.add_parameter(
      "scale",
      scale,
      "A description longer than one line of the template can hold, so that it must be broken "
      "into several of them: K·m, 5°. Units: none.",
      Double(0., 10.));
    prm.add_parameter("seed", seed, "An integer. Units: none.");
    prm.enter_subsection("Inner");
    prm.add_parameter("value", value, "Named like a key of deal.II's. Units: none.", Selection("wedge|cone"));
    prm.add_parameter("note", note, "May be empty. Units: none.");
    prm.leave_subsection();
    prm.enter_subsection("Also inner");
    prm.add_parameter("file", file, "A file. Units: none.", FileName());
    prm.add_parameter("list", list, "Numbers. Units: mm.");
    prm.declare_alias("list", "old list", true);
    prm.leave_subsection();
    prm.leave_subsection();
    prm.enter_subsection("Last");
    prm.add_parameter("on_off", on, "A switch. Units: none.");
    prm.add_parameter(
      "ratio", ratio, "At most one. Units: none.", Double(-std::numeric_limits<double>::max(), 1.));
    prm.add_parameter("map", map, "Named numbers. Units: none.");
    prm.leave_subsection();
  }
};

int main()
{
  Parameters p;
  print_parameters(p.prm, std::cout);

  std::ofstream("changed.prm")
    << "subsection Zeroth, declared first\n subsection Also inner\n  set list = 3, 4, 5\n"
       " end\nend\nsubsection Last\n set map = up: 7\nend";
  read_parameters(p.prm, "changed.prm", {{"Zeroth, declared first/scale", "1.25"}});
  std::ostringstream first, second;
  print_parameters(p.prm, first);
  std::ofstream("printed.prm") << first.str();

  Parameters q;
  read_parameters(q.prm, "printed.prm");
  print_parameters(q.prm, second);
  std::cout << "\nsame after a round trip: " << (first.str() == second.str()) << ", scale " << q.scale
            << ", list of " << q.list.size() << ", map up " << q.map.at("up") << '\n';
  for (const ParameterEntry &entry : declared_parameters(q.prm))
    std::cout << entry.path() << (entry.alias_of.empty() ? "" : " is an old name of " + entry.alias_of)
              << '\n';
}
