// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: the command line is understood, and every mistake is answered with what is known and the nearest of
// it.
#include <retroforge/core/command_line.h>
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>

#include <iostream>
#include <vector>

using namespace retroforge;

void show(const std::vector<const char *> &words)
{
  std::cout << "$";
  for (const char *word : words)
    std::cout << ' ' << word;
  std::cout << "\n  ";
  try
  {
    const CommandLine line = CommandLine::parse(words.size(), words.data());
    std::cout << "command '" << (line.command ? word_of(*line.command) : "") << "' case '" << line.case_file
              << "' output '" << line.output_directory << "' resume " << line.resume << " overwrite "
              << line.overwrite << " print " << line.print_parameters << " version " << line.version
              << " help " << line.help << '\n';
    for (const auto &[path, value] : line.settings())
      std::cout << "  [" << path << "] <- [" << value << "]\n";
  }
  catch (const Error &error)
  {
    std::cout << error.what() << '\n';
  }
}

int main()
{
  show({"retroforge", "simulate", "prm/tutorial/upsetting.prm"});
  show({"retroforge", "gradient", "a.prm", "--set", "Dies/upper die/offset=1 = 2", "--set=Time/steps=3"});
  show({"retroforge", "--resume", "check", "--output", "some dir", "a.prm"});
  show({"retroforge", "check", "a.prm", "--output=x"});
  show({"retroforge", "check", "a.prm", "--overwrite"});
  show({"retroforge",
        "gradient",
        "a.prm",
        "--at",
        "die upper/offset=-1e-2",
        "--at=billet/radius=20",
        "--at",
        "billet/radius=21"});
  show({"retroforge", "scene", "prm/tutorial/upsetting.prm", "--at", "billet/radius=21"});
  show({"retroforge", "--print-parameters"});
  show({"retroforge", "simulate", "a.prm", "--print-parameters"});
  show({"retroforge", "--version"});
  show({"retroforge", "-h"});

  show({"retroforge"});
  show({"retroforge", "simulate"});
  show({"retroforge", "simulaet", "a.prm"});
  show({"retroforge", "forge", "a.prm"});
  show({"retroforge", "a.prm"});
  show({"retroforge", "simulate", "a.prm", "b.prm"});
  show({"retroforge", "simulate", "a.prm", "--ouput", "x"});
  show({"retroforge", "simulate", "a.prm", "-q"});
  show({"retroforge", "simulate", "a.prm", "--output"});
  show({"retroforge", "simulate", "a.prm", "--output", "--resume"});
  show({"retroforge", "simulate", "a.prm", "--set", "Time/steps"});
  show({"retroforge", "simulate", "a.prm", "--set", "=3"});
  show({"retroforge", "simulate", "a.prm", "--resume=yes"});
  show({"retroforge", "simulate", "a.prm", "--resume", "--overwrite"});
  show({"retroforge", "scene", "a.prm", "--resume"});
  show({"retroforge", "simulate", "a.prm", "--at", "billet/radius"});
  show({"retroforge", "simulate", "a.prm", "--at", "billet/radius=20mm"});
  show({"retroforge", "simulate", "a.prm", "--at", "=20"});

  // one swap, one case change (free), one letter added and one replaced
  std::cout << "edits: " << edit_distance("check", "chekc") << edit_distance("Check", "check")
            << edit_distance("gradients", "gradiant") << edit_distance("", "abc") << '\n';
  for (const std::string &command : known_commands())
    std::cout << command
              << " is explained: " << (help_text().find("\n  " + command + " ") != std::string::npos) << '\n';
}
