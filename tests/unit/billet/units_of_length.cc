// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Billets in millimetres, metres, micrometres and what else there is. Proved: bodies that differ by a power
// of ten have the same mesh, cell by cell and patch by patch, with nodes that differ by this power to
// rounding.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

#include <algorithm>
#include <sstream>

using namespace retroforge;

using Entries = std::vector<std::pair<std::string, std::string>>;

/// Numbers of the text times 10^exponent, as a user writes them.
std::string scaled(const std::string &text, const int exponent)
{
  std::istringstream in(text);
  std::string        result;
  for (std::string word; std::getline(in, word, ' ');)
  {
    const bool        is_number = word.find_first_of("0123456789") != std::string::npos;
    const std::string end =
      is_number && (word.back() == ',' || word.back() == ';') ? word.substr(word.size() - 1) : "";
    result +=
      (result.empty() ? "" : " ") +
      (is_number ? word.substr(0, word.size() - end.size()) + "e" + std::to_string(exponent) + end : word);
  }
  return result;
}

TetMesh scaled_billet(const Entries &lengths, const Entries &others, const int exponent)
{
  Entries entries = others;
  for (const auto &[name, value] : lengths)
    entries.emplace_back(name, scaled(value, exponent));
  return billet(entries);
}

bool same_cells(const TetMesh &a, const TetMesh &b)
{
  bool same = a.cells == b.cells && a.faces.size() == b.faces.size() && a.patches.size() == b.patches.size();
  for (std::size_t f = 0; same && f < a.faces.size(); ++f)
    same = a.faces[f].nodes == b.faces[f].nodes && a.faces[f].patch == b.faces[f].patch;
  for (std::size_t p = 0; same && p < a.patches.size(); ++p)
    same = a.patches[p].name == b.patches[p].name &&
           a.patches[p].symmetry.has_value() == b.patches[p].symmetry.has_value();
  return same;
}

void check(const std::string &title, const Entries &lengths, const Entries &others)
{
  const TetMesh mesh     = scaled_billet(lengths, others, 0);
  const auto [low, high] = std::minmax_element(
    mesh.X.begin(), mesh.X.end(), [](const Vec3 &a, const Vec3 &b) { return a.norm() < b.norm(); });
  const double size = high->norm();
  bool         same = low != high, close = true;
  for (const int exponent : {-6, -3, -1, 1, 3, 4})
  {
    const TetMesh other = scaled_billet(lengths, others, exponent);
    same                = same && same_cells(mesh, other);
    double difference   = 0;
    for (NodeIndex k = 0; k < std::min(mesh.n_nodes(), other.n_nodes()); ++k)
      difference = std::max(difference, (other.X[k] * std::pow(10., -exponent) - mesh.X[k]).norm() / size);
    close = close && difference < 1e-14;
  }
  std::cout << title << ": more than 100 cells " << yes(mesh.n_cells() > 100) << ", same " << yes(same)
            << ", nodes to rounding " << yes(close) << '\n';
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check("box", {{"size", "30, 20, 47.3"}, {"element size", "8"}}, {{"shape", "box"}});
  check("quarter of a box away from the origin",
        {{"size", "50, 50, 50"}, {"element size", "12"}, {"base centre", "100, -7.1, 3.3"}},
        {{"shape", "box"}, {"symmetry planes", "-1, 0, 0; 0, -1, 0"}});
  check("sixth of a cylinder",
        {{"radius", "20"}, {"height", "40"}, {"element size", "6.1"}},
        {{"shape", "cylinder"}, {"sector angle", "60"}});
  check("quarter of a cylinder, half its height",
        {{"radius", "20"}, {"height", "40"}, {"element size", "7"}},
        {{"shape", "cylinder"},
         {"symmetry planes", "-1, 0, 0; 0, -1, 0; 0, 0, 1"},
         {"symmetry point", "centre"}});
  check("profile",
        {{"control points", "20, 0; 26, 15; 26, 30; 20, 45"}, {"element size", "7"}},
        {{"shape", "profile"}, {"sector angle", "90"}});
}
