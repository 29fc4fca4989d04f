// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// STL files as other programs leave them. Proved: forms of the text and of normals do not change the surface,
// bit for bit (to the digits of the file in binary); what is mended leaves the surface where it was, with a
// remark; and what could be another surface is refused.

#include <retroforge/core/error.h>
#include <retroforge/geometry/stl_file.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>
#include <tuple>

#include "file_bytes.h"
#include "geometry_test_tools.h"

using namespace retroforge;

std::string replaced(std::string text, const std::string &from, const std::string &to)
{
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string in_utf_16(const std::string &text)
{
  std::string bytes = "\xff\xfe";
  for (const char c : text)
    bytes += {c, '\0'};
  return bytes;
}

/// Same facets on the same corners, within a distance.
bool same(const TriangleSurface &a, const TriangleSurface &b, const double within)
{
  bool same = a.n_facets() == b.n_facets() && a.vertices().size() == b.vertices().size();
  for (unsigned int f = 0; same && f < a.n_facets(); ++f)
    for (unsigned int c = 0; c < 3; ++c)
      same = same && (a.vertices()[a.triangles()[f][c]] - b.vertices()[b.triangles()[f][c]]).norm() <= within;
  return same;
}

void show_remarks(const TriangleSurface &surface)
{
  for (const std::string &remark : surface.remarks)
    std::cout << "    " << remark << '\n';
}

void check_forms()
{
  const TriangleSurface surface = bumpy_sphere(2);
  write_stl("whole.stl", surface, StlFormat::ascii);
  const std::string  text = bytes_of("whole.stl");
  std::string        bad_normals;
  std::istringstream lines(text);
  unsigned int       n = 0;
  for (std::string line; std::getline(lines, line);)
    bad_normals += (line.find("normal") == std::string::npos ? line
                    : n++ % 3 == 0                           ? "facet normal nan nan nan"
                    : n % 3 == 1                             ? "facet normal -nan(ind) 0 1.#QNAN"
                                                             : "facet normal inf 0 0") +
                   "\n";
  write_stl("whole_binary.stl", surface, StlFormat::binary);
  std::string bad_binary = bytes_of("whole_binary.stl");
  for (unsigned int f = 0; f < surface.n_facets(); ++f)
    bad_binary.replace(84 + 50 * f, 4, std::string("\x00\x00\xc0\x7f", 4));
  std::cout << "forms of one surface\n";
  for (const auto &[name, bytes, within] : std::vector<std::tuple<std::string, std::string, double>>{
         {"byte order mark", "\xef\xbb\xbf" + text, 0.},
         {"UTF-16", in_utf_16(text), 0.},
         {"line ends \\r", replaced(text, "\n", "\r"), 0.},
         {"line ends \\r\\n", replaced(text, "\n", "\r\n"), 0.},
         {"end solid, end facet",
          replaced(replaced(text, "endsolid", "end solid"), "endfacet", "end facet"),
          0.},
         {"exponents of three digits", replaced(replaced(text, "e-0", "e-00"), "e-1", "e-01"), 0.},
         {"normals that are no numbers", bad_normals, 0.},
         {"the same, binary", bad_binary, 2e-7}})
  {
    write_bytes("form.stl", bytes);
    const TriangleSurface read = read_stl("form.stl");
    std::cout << "  " << name << ": " << yes(same(read, surface, within)) << '\n';
    show_remarks(read);
  }
}

/// Writes facets by their corners, with normals if `normals` has any.
std::string solid(const std::vector<std::array<Vec3, 3>> &facets, const NodalVectors<double> &normals = {})
{
  std::ostringstream out;
  out.precision(17);
  out << "solid\n";
  for (unsigned int f = 0; f < facets.size(); ++f)
  {
    out << "facet normal " << (normals.empty() ? Vec3() : normals[f]) << "\nouter loop\n";
    for (const Vec3 &x : facets[f])
      out << "vertex " << x << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid\n";
  return out.str();
}

std::vector<std::array<Vec3, 3>> facets_of(const TriangleSurface &surface)
{
  std::vector<std::array<Vec3, 3>> facets;
  for (const Triangle &t : surface.triangles())
    facets.push_back({{surface.vertices()[t[0]], surface.vertices()[t[1]], surface.vertices()[t[2]]}});
  return facets;
}

NodalVectors<double> normals_of(const std::vector<std::array<Vec3, 3>> &facets)
{
  NodalVectors<double> normals;
  for (const auto &x : facets)
    normals.push_back(facet_vector(x[0], x[1], x[2]) / facet_vector(x[0], x[1], x[2]).norm());
  return normals;
}

void show(const std::string &title, const std::string &bytes)
{
  write_bytes("mended.stl", bytes);
  std::cout << "  " << title << ": ";
  try
  {
    const TriangleSurface read = read_stl("mended.stl");
    std::cout << read.n_facets() << " facets, " << read.vertices().size() << " vertices, "
              << (read.is_closed() ? "closed, volume " + as_text(enclosed_volume(read)) : "open") << '\n';
    show_remarks(read);
  }
  catch (const Error &error)
  {
    std::cout << error.what() << '\n';
  }
}

/// All damage is done to the sphere; its volume must stay.
void check_mending()
{
  const auto         whole = facets_of(sphere(2));
  const unsigned int n     = whole.size();
  std::cout << "mended\n";
  show("the sphere", solid(whole));

  auto facets = whole;
  facets.push_back({{whole[0][0], whole[0][0], whole[0][1]}});
  show("two equal corners", solid(facets));

  facets.push_back({{whole[5][1], whole[5][2], whole[5][0]}});
  show("a facet twice", solid(facets));

  facets       = whole;
  const Vec3 a = whole[0][0], b = whole[0][1], middle = 0.5 * (a + b);
  const auto beyond = std::find_if(facets.begin() + 1, facets.end(), [&](const auto &facet) {
    return std::count(facet.begin(), facet.end(), a) > 0 && std::count(facet.begin(), facet.end(), b) > 0;
  });
  auto       half   = *beyond;
  std::replace(beyond->begin(), beyond->end(), a, middle);
  std::replace(half.begin(), half.end(), b, middle);
  facets.push_back(half);
  facets.push_back({{b, a, middle}});
  show("a needle between a facet and the halves of its neighbour", solid(facets));

  facets = whole;
  for (unsigned int f = 0; f < n; f += 2)
    for (Vec3 &x : facets[f])
      x *= 1. + 5e-6;
  show("seams open by rounding", solid(facets));

  facets = whole;
  for (unsigned int f = 0; f < n; f += 10)
    std::swap(facets[f][1], facets[f][2]);
  show("every tenth facet turned", solid(facets));
  show("the same with normals", solid(facets, normals_of(whole)));

  auto normals = normals_of(whole);
  for (unsigned int f = 0; f < n; f += 10)
    normals[f] *= -1.;
  show("every tenth normal against its corners", solid(whole, normals));

  facets = whole;
  for (auto &facet : facets)
    for (Vec3 &x : facet)
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = static_cast<float>(x[i] + 3e3);
  show("far away in single precision", solid(facets));
}

void check_refusals()
{
  const auto whole = facets_of(sphere(2));
  std::cout << "refused\n";
  auto facets = whole;
  for (unsigned int f = 0; f < whole.size(); f += 2)
    std::swap(facets[f][1], facets[f][2]);
  show("half of the facets turned", solid(facets));
  auto normals = normals_of(whole);
  for (Vec3 &normal : normals)
    normal *= -1.;
  show("all normals against their corners", solid(whole, normals));
  facets = whole;
  for (unsigned int f = 0; f < whole.size(); ++f)
    for (Vec3 &x : facets[f])
      x *= 1. + 1e-2 * (f % 7);
  show("a soup", solid(facets));
  show("a pointer", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 684\n");
}

int main()
{
  check_forms();
  check_mending();
  check_refusals();
}
