// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a .vtu holds the mesh with shared nodes and all fields. The arrays are decoded here from VTK's
// layout (base64 header, base64 zlib blocks); the second mesh has more than one block of 262144 bytes per
// array.
#include <retroforge/output/safe_file.h>
#include <retroforge/output/vtu_writer.h>

#include <deal.II/base/utilities.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <zlib.h>

#include <cstring>
#include <iostream>
#include <sstream>

using namespace retroforge;
using Tree = boost::property_tree::ptree;

template <typename T>
std::vector<T> as_array(const std::vector<unsigned char> &bytes)
{
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

/// The bytes of an array; its header of 3 + n_blocks numbers takes a whole number of base64 groups of 4
/// letters.
std::vector<unsigned char> decode(std::string text)
{
  text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
  const auto letters  = [](const std::size_t n_bytes) { return (n_bytes + 2) / 3 * 4; };
  const auto n_blocks = as_array<std::uint32_t>(dealii::Utilities::decode_base64(text.substr(0, 8)))[0];
  const auto header =
    as_array<std::uint32_t>(dealii::Utilities::decode_base64(text.substr(0, letters(4 * (3 + n_blocks)))));
  const auto data = dealii::Utilities::decode_base64(text.substr(letters(4 * (3 + n_blocks))));

  std::vector<unsigned char> bytes, block(header[1]);
  std::size_t                begin = 0;
  for (unsigned int b = 0; b < n_blocks; begin += header[3 + b++])
  {
    uLongf size = block.size();
    if (uncompress(block.data(), &size, data.data() + begin, header[3 + b]) != Z_OK)
      std::cout << "block " << b << " is damaged\n";
    if (b + 1 == n_blocks && size != (header[2] == 0 ? header[1] : header[2]))
      std::cout << "the last block has a wrong size\n";
    bytes.insert(bytes.end(), block.begin(), block.begin() + size);
  }
  return bytes;
}

const Tree &find_array(const Tree &tree, const std::string &name)
{
  for (const auto &[tag, array] : tree)
    if (tag == "DataArray" && array.get<std::string>("<xmlattr>.Name") == name)
      return array;
  throw std::runtime_error("no array " + name);
}

template <typename T>
std::vector<T> array(const Tree &tree, const std::string &name)
{
  return as_array<T>(decode(find_array(tree, name).data()));
}

Tree read_grid(const std::string &file)
{
  std::istringstream in(read_file(file));
  Tree               tree;
  boost::property_tree::read_xml(in, tree);
  return tree.get_child("VTKFile.UnstructuredGrid");
}

Tree read(const std::string &file)
{
  return read_grid(file).get_child("Piece");
}

template <typename T>
void print(const std::string &name, const std::vector<T> &values)
{
  std::cout << name << ':';
  for (const T x : values)
    std::cout << ' ' << +x;
  std::cout << '\n';
}

void two_cells()
{
  TetMesh mesh;
  mesh.X = {
    Vec3({0., 0., 0.}), Vec3({1., 0., 0.}), Vec3({0., 1., 0.}), Vec3({0., 0., 1.}), Vec3({1., 1., 1.})};
  mesh.cells             = {{{0, 1, 2, 3}}, {{1, 4, 2, 3}}};
  NodalVectors<double> X = mesh.X, V(5);
  X[4][2]                = 1.25;
  V[3]                   = Vec3({0.5, 0., -2.});
  mesh.patches           = {{"x", Plane{Vec3({0., 0., 0.}), Vec3({-1., 0., 0.})}}};
  mesh.faces             = {{{{0, 3, 2}}, 0}};
  write_vtu("two.vtu",
            mesh,
            X,
            {{"p < \"q\" & r", {1, 2, 3, 4, 5}}},
            {{"velocity", V}},
            {{"quality", {0.5, 0.75}}},
            {{"stress", {{{1, 2, 3, 4, 5, 6}}, {{0, 0, 0, 0, 0, 7}}}}});

  const Tree grid  = read_grid("two.vtu");
  const Tree piece = grid.get_child("Piece");
  std::cout << "points " << piece.get<int>("<xmlattr>.NumberOfPoints") << ", cells "
            << piece.get<int>("<xmlattr>.NumberOfCells") << '\n';
  print("points", array<double>(piece.get_child("Points"), "Points"));
  print("connectivity", array<std::int32_t>(piece.get_child("Cells"), "connectivity"));
  print("offsets", array<std::int32_t>(piece.get_child("Cells"), "offsets"));
  print("types", array<std::uint8_t>(piece.get_child("Cells"), "types"));
  print("scalar", array<float>(piece.get_child("PointData"), "p < \"q\" & r"));
  print("velocity", array<float>(piece.get_child("PointData"), "velocity"));
  print("quality", array<float>(piece.get_child("CellData"), "quality"));
  print("stress xx, yy, zz, xy, yz, xz", array<float>(piece.get_child("CellData"), "stress"));
  print("symmetry planes", array<double>(grid.get_child("FieldData"), "symmetry_planes"));
}

void many_cells()
{
  TetMesh             mesh;
  std::vector<double> p;
  for (unsigned int i = 0; i < 40000; ++i)
  {
    mesh.X.push_back(Vec3({std::sin(1. * i), std::sin(2. * i), std::sin(3. * i)}));
    mesh.cells.push_back({{i, (i + 1) % 40000, (i + 7) % 40000, (i * 11) % 40000}});
    p.push_back(std::cos(1. * i));
  }
  write_vtu("many.vtu", mesh, mesh.X, {{"p", p}}, {}, {});
  const Tree piece        = read("many.vtu");
  const auto X            = array<double>(piece.get_child("Points"), "Points");
  const auto connectivity = array<std::int32_t>(piece.get_child("Cells"), "connectivity");
  const auto p_read       = array<float>(piece.get_child("PointData"), "p");
  bool       same = X.size() == 3 * 40000 && connectivity.size() == 4 * 40000 && p_read.size() == p.size();
  for (unsigned int i = 0; same && i < 40000; ++i)
  {
    same = p_read[i] == static_cast<float>(p[i]);
    for (unsigned int d = 0; d < 3; ++d)
      same = same && X[3 * i + d] == mesh.X[i][d];
    for (unsigned int c = 0; c < 4; ++c)
      same = same && connectivity[4 * i + c] == static_cast<int>(mesh.cells[i][c]);
  }
  std::cout << "many blocks read back to the same bits: " << same << '\n';
}

int main()
{
  two_cells();
  many_cells();
}
