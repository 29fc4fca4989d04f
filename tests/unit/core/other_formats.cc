// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Files of other formats than the wanted one. Proved: each known format is told by its first bytes, whatever
// the name of the file, with its name and the way to convert it, as a die and as a billet; and STL and Gmsh
// files, noise and nothing at all are left to their readers. Text with a byte order mark, in UTF-16 or with
// carriage returns for line ends becomes plain lines, and plain lines stay.

#include <retroforge/core/error.h>
#include <retroforge/core/input_file.h>

#include <iostream>
#include <utility>
#include <vector>

using namespace retroforge;

std::string refusal(const std::string &bytes, const Wanted wanted)
{
  try
  {
    refuse_other_format("part", bytes, wanted);
  }
  catch (const Error &error)
  {
    return error.what();
  }
  return "not known";
}

/// The head of a card file with the letter of its section in column 73.
std::string iges()
{
  return std::string(72, ' ') + "S      1\n" + "1H,,1H;,4Hpart" + std::string(58, ' ') + "G      1\n";
}

std::string binary_stl()
{
  return std::string(80, 'x') + std::string("\1\0\0\0", 4) + std::string(50, '\0');
}

void show_formats()
{
  const std::vector<std::pair<std::string, std::string>> files = {
    {"STEP", "ISO-10303-21;\nHEADER;\n"},
    {"STEP with a byte order mark", "\xef\xbb\xbfISO-10303-21;\nHEADER;\n"},
    {"IGES", iges()},
    {"BREP", "\nCASCADE Topology V1, (c) Matra-Datavision\n"},
    {"Parasolid", "**ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz***\n"},
    {"OLE", std::string("\xd0\xcf\x11\xe0\xa1\xb1", 6)},
    {"DXF", "  0\nSECTION\n  2\nHEADER\n"},
    {"OBJ", "# made by hand\nmtllib part.mtl\nv 0 0 0\n"},
    {"OBJ without materials", "o cube\nv 0.0 0.0 1.0\nv 1.0 0 0\nf 1 2 3\n"},
    {"PLY", "ply\nformat ascii 1.0\n"},
    {"OFF", "OFF\n8 6 12\n"},
    {"glTF", std::string("glTF\2\0\0\0", 8)},
    {"AMF", "<?xml version=\"1.0\"?>\n<amf unit=\"millimeter\">\n"},
    {"zip", std::string("PK\3\4\24\0", 6)},
    {"gzip", "\x1f\x8b\x08"},
    {"Git LFS", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"},
    {"git-annex", "/annex/objects/SHA256E-s12345--4d7a.stl\n"},
    {"web page", "\n<!DOCTYPE html>\n<html lang=\"en\">\n"},
    {"PDF", "%PDF-1.7\n"},
    {"PNG", "\x89PNG\r\n"},
    {"VTK", "# vtk DataFile Version 3.0\n"},
    {"VTU", "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">\n"},
    {"XDMF", "<?xml version=\"1.0\"?><Xdmf Version=\"3.0\">\n"},
    {"HDF5", "\x89HDF\r\n"},
    {"Abaqus", "** made by hand\n*HEADING\n*NODE\n1, 0, 0, 0\n"},
    {"LS-DYNA", "*KEYWORD\n*NODE\n"},
    {"Fluent", "(0 \"GAMBIT to Fluent File\")\n(2 3)\n"},
    {"Nastran", "$ made by hand\nSOL 101\nCEND\nBEGIN BULK\nGRID           1\n"},
    {"UNV", "    -1\n  2411\n         1         1         1        11\n"},
    {"Medit", " MeshVersionFormatted 1\n"},
    {"Netgen", "mesh3d\ndimension\n3\n"},
    {"SU2", "NDIME= 3\n"},
    {"Gmsh 1", "$NOD\n4\n"},
    {"Gmsh script", "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n"},
    {"parameter file", "# a case\nsubsection Billet\nend\n"},
    {"Gmsh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"},
    {"STL", "solid part\nfacet normal 0 0 1\n"},
    {"STL, binary", binary_stl()},
    {"empty", ""},
    {"noise", "What is it?"}};
  for (const auto &[name, bytes] : files)
    std::cout << name << "\n  " << refusal(bytes, Wanted::surface) << "\n  "
              << refusal(bytes, Wanted::volume_mesh) << '\n';
}

void show_lines()
{
  const auto show = [](const std::string &name, const std::string &bytes) {
    std::string lines = as_plain_lines(bytes);
    for (std::size_t at = 0; (at = lines.find_first_of("\r\n", at)) != std::string::npos; at += 2)
      lines.replace(at, 1, lines[at] == '\r' ? "\\r" : "\\n");
    std::cout << "  " << name << ": " << lines << '\n';
  };
  std::cout << "lines\n";
  show("plain", "one\ntwo\n");
  show("of Windows", "one\r\ntwo\r\n");
  show("of an old Macintosh", "one\rtwo\r");
  show("byte order mark", "\xef\xbb\xbfone\ntwo\n");
  show("UTF-16, low byte first",
       std::string("\xff\xfe"
                   "o\0n\0\xac\x20\n\0",
                   10));
  show("UTF-16, high byte first",
       std::string("\xfe\xff"
                   "\0o\0n\x20\xac\0\n",
                   10));
  show("UTF-16, odd",
       std::string("\xff\xfe"
                   "o\0n",
                   5));
}

int main()
{
  show_formats();
  show_lines();
}
