// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// STL files. Proved: what is written is read back, ASCII to the last bit and binary to single precision, a
// binary file that begins with "solid" included; corners equal to 1e-6 become one vertex; the volume of a
// finely triangulated unit sphere is 4 pi/3 to second order; and each way a file can be bad has its message.

#include <retroforge/core/error.h>
#include <retroforge/geometry/stl_file.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>

#include "file_bytes.h"
#include "geometry_test_tools.h"

using namespace retroforge;

std::string facet(const std::string &corners, const std::string &normal = "0 0 0")
{
  std::string        words = "facet normal " + normal + "\nouter loop\n";
  std::istringstream in(corners);
  for (std::string corner; std::getline(in, corner, ',');)
    words += "vertex " + corner + "\n";
  return words + "endloop\nendfacet\n";
}

std::string solid(const std::string &facets)
{
  return "solid two words\n" + facets + "endsolid two words\n";
}

void show_error(const std::string &title, const std::string &bytes)
{
  write_bytes("bad.stl", bytes);
  std::cout << title << ":\n  ";
  try
  {
    read_stl("bad.stl");
    std::cout << "no error\n";
  }
  catch (const Error &error)
  {
    std::cout << error.what() << "\n";
  }
}

double largest_difference(const TriangleSurface &a, const TriangleSurface &b)
{
  double largest = a.n_facets() == b.n_facets() && a.vertices().size() == b.vertices().size() ? 0. : 1e300;
  for (unsigned int f = 0; f < std::min(a.n_facets(), b.n_facets()); ++f)
    for (unsigned int c = 0; c < 3; ++c)
      largest =
        std::max(largest, (a.vertices()[a.triangles()[f][c]] - b.vertices()[b.triangles()[f][c]]).norm());
  return largest;
}

void check_round_trips()
{
  const TriangleSurface surface = bumpy_sphere(3);
  write_stl("ascii.stl", surface, StlFormat::ascii);
  write_stl("binary.stl", surface, StlFormat::binary);
  std::string disguised = bytes_of("binary.stl");
  disguised.replace(0, 6, "solid ");
  write_bytes("disguised.stl", disguised);
  write_bytes("trailing.stl", disguised + "\n");
  std::string windows = bytes_of("ascii.stl"), capital = windows;
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
    windows.replace(at, 1, "\r\n");
  std::transform(
    capital.begin(), capital.end(), capital.begin(), [](const unsigned char c) { return std::toupper(c); });
  write_bytes("windows.stl", windows);
  write_bytes("capital.stl", capital);
  std::cout << "round trips of " << surface.n_facets() << " facets\n";
  for (const char *name : {"ascii", "windows", "capital"})
    std::cout << "  " << name
              << " exact: " << yes(largest_difference(read_stl(std::string(name) + ".stl"), surface) == 0.)
              << "\n";
  for (const char *name : {"binary", "disguised", "trailing"})
  {
    const TriangleSurface read = read_stl(std::string(name) + ".stl");
    std::cout << "  " << name << " to single precision: " << yes(largest_difference(read, surface) < 2e-7)
              << ", closed: " << yes(read.is_closed()) << ", vertices " << read.vertices().size() << "\n";
  }
}

void check_merging()
{
  // Two facets of a square; the shared corners differ by 1e-7 of the diagonal.
  write_bytes("near.stl",
              solid(facet("0 0 0,1 0 0,1 1 0", "0 0 1") + facet("1e-7 0 0,1 1.0000001 0,0 1 0", "0 0 1")));
  const TriangleSurface surface = read_stl("near.stl");
  std::cout << "merging: " << surface.vertices().size() << " vertices, neighbours "
            << surface.neighbour(0, 2).facet << " and " << surface.neighbour(1, 0).facet
            << ", open: " << yes(!surface.is_closed()) << "\n";
  // Several solids in one file are one surface.
  write_bytes("two.stl", solid(facet("0 0 0,1 0 0,1 1 0")) + solid(facet("0 0 0,1 1 0,0 1 0")));
  std::cout << "two solids: " << read_stl("two.stl").vertices().size() << " vertices\n";
}

void check_volume()
{
  std::cout << "volume of a sphere, relative error times 4^refinements\n ";
  for (unsigned int n = 2; n < 6; ++n)
  {
    write_stl("sphere.stl", sphere(n), StlFormat::ascii);
    const double volume = enclosed_volume(read_stl("sphere.stl"));
    std::printf(" %.3f", std::pow(4., n) * (1. - volume / (4. / 3. * M_PI)));
  }
  std::cout << "\n";
}

void check_bad_files()
{
  const std::string good = facet("0 0 0,1 0 0,1 1 0"), next = facet("0 0 0,1 1 0,0 1 0");
  write_stl("cube.stl", cube(), StlFormat::binary);
  const std::string binary = bytes_of("cube.stl");
  std::string       nan    = binary;
  nan.replace(84 + 12, 4, std::string("\x00\x00\xc0\x7f", 4));

  show_error("good", solid(good + next));
  std::cout << "missing:\n  ";
  try
  {
    read_stl("none.stl");
  }
  catch (const Error &error)
  {
    std::cout << error.what() << "\n";
  }
  show_error("empty file", "");
  show_error("empty solid", solid(""));
  show_error("ASCII cut in a number", solid(good).substr(0, 70));
  show_error("ASCII without its end", "solid\n" + good);
  show_error("no number", solid(facet("0 0 0,1 0 0,1 x 0")));
  show_error("not finite", solid(facet("0 0 0,1 0 0,1 nan 0")));
  show_error("overflow", solid(facet("0 0 0,1 0 0,1 1e999 0")));
  show_error("four corners", solid(facet("0 0 0,1 0 0,1 1 0,0 1 0")));
  show_error("another format", "ply\nformat ascii 1.0\n");
  show_error("binary cut", binary.substr(0, binary.size() - 1));
  show_error("binary, one facet more than announced", binary + binary.substr(84, 50));
  show_error("binary without facets", binary.substr(0, 80) + std::string(4, '\0'));
  show_error("binary, not finite", nan);
  show_error("opposite orientation", solid(good + facet("0 0 0,0 1 0,1 1 0")));
  show_error("three facets at an edge", solid(good + next + facet("0 0 0,1 1 0,0 0 1")));
  show_error("folded", solid(good + facet("0 0 0,1 1 0,0.9 0 1e-4")));
  show_error("normal against the order", solid(good + facet("0 0 0,1 1 0,0 1 0", "0 0 -1")));
  show_error("normal across", solid(good + facet("0 0 0,1 1 0,0 1 0", "1 0 0")));
  show_error("crack", solid(good + facet("0.00005 0 0,1 1.00005 0,0 1 0")));
  show_error("vertex on another edge",
             solid(good + facet("0 0 0,0.5 0.5 0,0 1 0") + facet("0.5 0.5 0,1 1 0,0 1 0")));
}

/// What is mended in files, a surface itself refuses.
void check_bad_surfaces()
{
  const NodalVectors<double> X = {Vec3({0, 0, 0}), Vec3({1, 0, 0}), Vec3({1, 1, 0}), Vec3({0.5, 0.5, 0})};
  for (const auto &[title, second] : std::vector<std::pair<std::string, Triangle>>{
         {"two equal corners", {{0, 2, 2}}}, {"corners on a line", {{0, 3, 2}}}, {"duplicate", {{2, 0, 1}}}})
  {
    std::cout << title << ":\n  ";
    try
    {
      const TriangleSurface surface("surface", X, {{{0, 1, 2}}, second});
      std::cout << "no error\n";
    }
    catch (const Error &error)
    {
      std::cout << error.what() << "\n";
    }
  }
}

int main()
{
  check_round_trips();
  check_merging();
  check_volume();
  check_bad_files();
  check_bad_surfaces();
}
