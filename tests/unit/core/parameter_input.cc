// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: values of a parameter file reach the variables they are bound to, however its lines end and its
// keywords are written, overrides come after it, and each mistake is reported once, with its line, the rule
// and the nearest known name.
#include <retroforge/core/error.h>
#include <retroforge/core/parameter_input.h>

#include <fstream>
#include <iostream>

using namespace retroforge;
using Overrides = std::vector<std::pair<std::string, std::string>>;

struct Parameters
{
  double                   coefficient = 0.1;
  bool                     smooth      = true;
  std::string              law         = "norton";
  dealii::Tensor<1, 3>     velocity;
  unsigned int             steps = 20;
  dealii::ParameterHandler prm;

  Parameters()
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Contact");
    prm.enter_subsection("Friction");
    prm.add_parameter("coefficient", coefficient, "Norton coefficient alpha. Units: none.", Double(0.));
    prm.declare_alias("coefficient", "alpha", true);
    prm.add_parameter("law", law, "Friction law. Units: none.", Selection("norton|tresca|none"));
    prm.add_parameter("smooth ramp", smooth, "Weight of faces that approach. Units: none.");
    prm.leave_subsection();
    prm.leave_subsection();
    prm.enter_subsection("Upper die");
    prm.add_parameter("velocity", velocity, "Velocity. Units: mm/s.");
    prm.leave_subsection();
    prm.add_parameter("steps", steps, "Number of increments. Units: none.", Integer(1, 100000));
  }
};

void show(const std::string &text, const Overrides &overrides = {})
{
  std::ofstream("case.prm") << text;
  Parameters p;
  try
  {
    read_parameters(p.prm, "case.prm", overrides);
    std::cout << "coefficient " << p.coefficient << ", law " << p.law << ", smooth " << p.smooth
              << ", velocity " << p.velocity << ", steps " << p.steps << '\n';
  }
  catch (const Error &error)
  {
    std::cout << error.what() << '\n';
  }
}

std::string friction(const std::string &line)
{
  return "subsection Contact\n  subsection Friction\n    " + line + "\n  end\nend\n";
}

void accepted()
{
  show("");
  show(friction("set coefficient = 0.3 # rough\n    set   smooth\tramp = false\r") + "SET steps = 7\n");
  show("subsection Upper die\nset velocity = 0, \\\n  0, -2\nend");
  show(friction("set alpha = 0.2")); // an old name
  show(friction("set coefficient = 0.3"),
       {{"Contact/Friction/coefficient", "0.4"}, {"Contact/Friction/coefficient", "0.5"}, {"steps", "3"}});
  show("\xef\xbb\xbfSubsection Upper die\r\nSet velocity = 0, \\\r\n  0, -3\r\nEnd\r\n"); // as on Windows
  show("subsection Upper die\rset velocity = 0, 0, -4\rend\r");
  std::ofstream("included.prm") << friction("set law = tresca");
  show("include included.prm\n" + friction("set smooth ramp = false"));
}

void lines()
{
  std::ofstream("included.prm") << friction("set law = tresca");
  std::ofstream("case.prm") << "Include included.prm\n" + friction("set coefficient=0.3") +
                                 "set names = a, \\\n b";
  for (const auto &[path, value] : parameter_values(read_parameter_lines("case.prm", {{"names", "c, d"}})))
    std::cout << path << " = " << value << '\n';
  for (const ParameterLine &line : parameter_lines_of("subsection A\n  set b = 1 # one\nend\n", "text"))
    std::cout << line.where << ": " << line.path << (line.value ? " = " + *line.value : "") << '\n';
}

void unknown_names()
{
  show(friction("set coeficient = 0.3"));
  show(friction("set Coefficient = 0.3"));
  show(friction("set quality = 0.3"));
  show("\n\nset coefficient = 0.3"); // right name, wrong place
  show("set step = 3");
  show("subsection Contact\n subsection Fricton\n end\nend");
  show("subsection Friction\nend");
  show("subsection Mesh\nend");
  show("subsection Upper die\n set velocity/x = 3\nend");
  show("", {{"Contact/Friktion/coefficient", "1"}});
}

void wrong_values()
{
  show(friction("set coefficient = -0.3"));
  show(friction("set coefficient = 0,3"));
  show(friction("set coefficient = nan"));
  show(friction("set coefficient ="));
  show(friction("set law = coulomb"));
  show(friction("set smooth ramp = maybe"));
  show("subsection Upper die\n set velocity = 1, 2\nend");
  show("set steps = 1.5");
  show("set steps = 0");
  show("set steps = 99999999999");
  show("", {{"Contact/Friction/coefficient", "-0.3"}});
}

void wrong_structure()
{
  show("subsection Contact\n subsection Friction\n end\n");
  show("subsection Contact\nend\nend\n");
  show("subsection Contact\nend of contact\n");
  show("subsection\nend\n");
  show("set steps 3");
  show("set = 3");
  show("steps = 3");
  show("set steps = 3\nset steps = 4");
  show(friction("set alpha = 3\nset coefficient = 4")); // two names of one parameter
  show("include nowhere.prm");
  show("include case.prm");
  std::string deep;
  for (unsigned int i = 0; i < 21; ++i)
    deep += "subsection Contact\n";
  show(deep);
  std::string endless = "subsection Upper die\nset velocity = \\\n";
  for (unsigned int i = 0; i < 40000; ++i)
    endless += "0, 0, \\\n";
  show(endless);
  show("set steps = " + std::string(200000, '3'));
  show("", {{"steps", std::string(200000, '3')}});
}

void unreadable_files()
{
  for (const std::string file : {"nowhere.prm", "."})
    try
    {
      Parameters p;
      read_parameters(p.prm, file);
    }
    catch (const Error &error)
    {
      std::cout << error.what() << '\n';
    }
}

void required_parameter()
{
  dealii::ParameterHandler prm;
  prm.enter_subsection("Billet shape");
  prm.declare_entry("mesh file", "", dealii::Patterns::FileName(), "Gmsh file. Units: mm.", true);
  prm.leave_subsection();
  std::ofstream("case.prm") << "";
  read_parameters(prm, "case.prm", {{"Billet shape/mesh file", "cube.msh"}});
  dealii::ParameterHandler unset;
  unset.enter_subsection("Billet shape");
  unset.declare_entry("mesh file", "", dealii::Patterns::FileName(), "Gmsh file. Units: mm.", true);
  unset.leave_subsection();
  try
  {
    read_parameters(unset, "case.prm");
  }
  catch (const Error &error)
  {
    std::cout << error.what() << '\n';
  }
}

int main()
{
  accepted();
  std::cout << "-- lines, of whatever names\n";
  lines();
  std::cout << "-- unknown names\n";
  unknown_names();
  std::cout << "-- wrong values\n";
  wrong_values();
  std::cout << "-- wrong structure\n";
  wrong_structure();
  std::cout << "-- files\n";
  unreadable_files();
  required_parameter();
}
