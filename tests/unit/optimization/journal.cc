// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A journal gives back what was written, bit for bit, with failures and gradients; a line that the program's
// end cut short does not count, and is overwritten; a design on another mesh is another forging; what is no
// journal is refused.

#include <retroforge/core/error.h>
#include <retroforge/optimization/journal.h>
#include <retroforge/output/safe_file.h>

#include <cstdio>
#include <iostream>

using namespace retroforge;

namespace
{
  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  void refuse(const std::string &what, const std::string &text)
  {
    write_file("wrong.jsonl", text);
    try
    {
      Journal::read("wrong.jsonl");
      std::cout << what << ": NOT REFUSED\n";
    }
    catch (const Error &error)
    {
      const std::string message = error.what();
      std::cout << what << ": refused, "
                << (message.find("line") != std::string::npos ? "with its line" : "as a whole") << "\n";
    }
    std::remove("wrong.jsonl");
  }

  /// Designs are told apart by the operation, too.
  void operations()
  {
    Journal journal({"1.0 abc", "", {{"small", "subsection B\nend\n"}}});
    journal.write_to("operations.jsonl");
    journal.add({{1.}, {2.}, "", 1, 0.5, {}});
    journal.add({{1.}, {3.}, "", 1, 0.5, {}, "small"});
    journal.add_gradients(journal.place_of({1.}, "small"), {{7.}});
    const Journal     again = Journal::read("operations.jsonl");
    const Evaluation *main = again.find({1.}), *small = again.find({1.}, "small");
    std::cout << "operations: "
              << answer(again.header().operations == journal.header().operations && main != nullptr &&
                        main->values[0] == 2. && main->gradients.empty() && small != nullptr &&
                        small->values[0] == 3. && small->gradients[0][0] == 7. &&
                        again.find({1.}, "other") == nullptr)
              << "\n";
    std::remove("operations.jsonl");
  }

  /// The increments that others repeat are those of the first design in the operation on the mesh.
  void steps()
  {
    Journal journal({"1.0 abc", ""});
    journal.write_to("steps.jsonl");
    journal.add({{1.}, {2.}, "", 2, 0.5, {}, "small", {1. / 3., 0.7}});
    const bool none = journal.find_steps("") == nullptr;
    journal.add({{1.}, {3.}, "", 3, 0.5, {}, "", {0.1, 0.2, 0.7}});
    journal.add({{2.}, {3.}, "", 3, 0.5, {}});
    journal.use_mesh("a: 1");
    const bool none_on_mesh = journal.find_steps("") == nullptr;
    journal.add({{2.}, {3.}, "", 1, 0.5, {}, "", {0.7}});
    Journal          again = Journal::read("steps.jsonl");
    const Evaluation first = *again.find_steps(""), small = *again.find_steps("small");
    again.use_mesh("a: 1");
    std::cout << "steps: "
              << answer(none && none_on_mesh && first.mu[0] == 1. && first.steps.size() == 3 &&
                        small.steps == std::vector<double>({1. / 3., 0.7}) &&
                        again.find_steps("")->mu[0] == 2. && again.find_steps("small")->steps == small.steps)
              << "\n";
    std::remove("steps.jsonl");
  }
} // namespace

int main()
{
  const double third = 1. / 3.;
  Journal      journal({"1.0 abc", "subsection A\nend\n"});
  journal.write_to("journal.jsonl");
  journal.add({{third, -0.}, {1e-300, third * 7.}, "", 12, 0.5, {}});
  journal.add({{2., 3.}, {}, "Increment 3: is \"too\" \\ long", 3, 0.1, {}});
  journal.add_gradients(0, {{third, 1.}, {-third, 5e-324}});

  const Journal again = Journal::read("journal.jsonl");
  std::cout << "header: "
            << answer(again.header().program == "1.0 abc" &&
                      again.header().parameters == "subsection A\nend\n")
            << "\n";
  const Evaluation *first = again.find({third, 0.}), *second = again.find({2., 3.});
  std::cout << "values: "
            << answer(first != nullptr && first->values == std::vector<double>({1e-300, third * 7.}) &&
                      first->increments == 12)
            << "\ngradients: " << answer(first != nullptr && first->gradients == journal[0].gradients)
            << "\nfailure: "
            << answer(second != nullptr && second->failed() &&
                      second->failure == "Increment 3: is \"too\" \\ long")
            << "\nother designs: " << answer(again.find({third}) == nullptr) << "\n";

  std::cout << "no word of operations where there is one: "
            << answer(read_file("journal.jsonl").find("operation") == std::string::npos) << "\n";
  operations();
  steps();

  const std::string whole = read_file("journal.jsonl");
  write_file("journal.jsonl", whole.substr(0, whole.size() - 10));
  Journal cut = Journal::read("journal.jsonl");
  std::cout << "cut short: " << answer(cut.size() == 2 && cut[0].gradients.empty()) << "\n";
  cut.write_to("journal.jsonl");
  cut.add_gradients(0, journal[0].gradients);
  std::cout << "and completed: "
            << answer(Journal::read("journal.jsonl")[0].gradients == journal[0].gradients) << "\n";

  // The same design on another mesh is another forging; a mesh asked for again is the one there is.
  const std::vector<double> design  = {third, 0.};
  const unsigned int        number  = cut.use_mesh("a: 1");
  const bool                unknown = cut.find(design) == nullptr;
  cut.add_gradients(cut.add({design, {7.}, "", 1, 0., {}}), {{8.}});
  Journal            meshes       = Journal::read("journal.jsonl");
  const bool         on_the_first = meshes.find(design)->values.size() == 2;
  const unsigned int other = meshes.use_mesh("b: 2"), same = meshes.use_mesh("a: 1");
  std::cout << "meshes: "
            << answer(number == 1 && unknown && on_the_first && other == 2 && same == 1 &&
                      meshes.find(design)->values == std::vector<double>({7.}) &&
                      meshes.find(design)->gradients[0][0] == 8.)
            << ", the first again: "
            << answer(meshes.use_mesh("") == 0 && meshes.find(design)->values.size() == 2) << "\n";
  meshes.write_to("journal.jsonl");
  std::cout << "written anew: "
            << answer(Journal::read("journal.jsonl").use_mesh("b: 2") == 2 &&
                      Journal::read("journal.jsonl").size() == 3)
            << "\n";
  std::remove("journal.jsonl");

  refuse("empty", "");
  refuse("other text", "subsection A\n");
  refuse("a number that is none", R"({"retroforge":"1","parameters":""}
{"mu":["0x1p+0"],"increments":1,"seconds":1,"values":["nan"]}
)");
  refuse("a mesh that is not there", R"({"retroforge":"1","parameters":""}
{"mu":["0x1p+0"],"increments":1,"seconds":1,"values":["0x1p+0"],"mesh":1}
)");
  refuse("gradients of what is not there", R"({"retroforge":"1","parameters":""}
{"of":0,"gradients":[]}
)");
}
