// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
//
// Settings that an earlier program wrote into its record and that are not known any more: left out where their section
// changes nothing of the forging, told where it does; a user's are told everywhere. What the record says beside them is read.

#include <retroforge/case/parameters.h>
#include <retroforge/core/command_line.h>
#include <retroforge/core/error.h>

#include <iostream>

using namespace retroforge;

namespace
{
  const std::string scene =
    "subsection Billet\n set shape = cylinder\n set radius = 10\n set height = 15\nend\n"
    "subsection Dies\n set names = lower, upper\nend\n"
    "subsection Die lower\n set facing = 0, 0, 1\nend\n"
    "subsection Die upper\n set point = 0, 0, 15\n set facing = 0, 0, -1\n set velocity = 0, 0, -1\nend\n"
    "subsection Material\n set consistency = 7\nend\n"
    "subsection Press\n set stroke = 3\nend\n";

  template <typename Read>
  void show(const std::string &what, const Read &read)
  {
    std::cout << what << ": ";
    try
    {
      const Parameters p = read();
      std::cout << "read, K = " << p.material.law.K << ", tolerance " << p.adjoint.tolerance << '\n';
    }
    catch (const Error &error)
    {
      const std::string text = error.what();
      std::cout << "refused, "
                << (text.find("unknown parameter") == std::string::npos ? text : "unknown parameter") << '\n';
    }
  }
} // namespace

int main()
{
  const std::string in_adjoint =
    scene + "subsection Adjoint\n set increments = follow\n set tolerance = 1e-7\nend\n";
  const std::string in_press   = scene + "subsection Press\n set once = 3\nend\n";
  const std::string in_contact = scene + "subsection Contact\n set once = 3\nend\n";
  const auto        of_user    = [](const std::string &text) {
    CommandLine command;
    command.case_file = "case.prm";
    command.case_text = text;
    std::string echo;
    return Parameters::read(command, echo);
  };
  show("record, in Adjoint", [&] { return Parameters::of_record(in_adjoint); });
  show("record, in Press", [&] { return Parameters::of_record(in_press); });
  show("record, in Contact", [&] { return Parameters::of_record(in_contact); });
  show("user, in Adjoint", [&] { return of_user(in_adjoint); });
}
