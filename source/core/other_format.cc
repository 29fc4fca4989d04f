// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/input_file.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <iterator>
#include <sstream>

namespace retroforge
{
  namespace
  {
    /// What has to be done with a file is the same for many formats.
    enum class FormatGroup
    {
      cad,           ///< exact geometry that Gmsh reads
      closed_cad,    ///< geometry that only its own program reads
      script,        ///< of Gmsh
      stl,           ///< triangles
      msh,           ///< of Gmsh, of this program's kind
      old_msh,       ///< of Gmsh before 2.0
      triangles,     ///< other files of surfaces, which meshio reads
      scene,         ///< surfaces with colours and lights, which mesh tools read
      gmsh_reads,    ///< volume meshes
      meshio_reads,  ///< volume meshes
      nobody_reads,  ///< volume meshes
      archive,       ///< packed
      lfs,           ///< pointer of Git LFS
      annex,         ///< pointer of git-annex
      page,          ///< of the web
      document,      ///< picture or text
      parameter_file ///< of this program
    };

    struct OtherFormat
    {
      std::string name;
      FormatGroup group;
    };

    /// The beginning of a file, lines of text in lower case.
    class FileHead
    {
    public:
      explicit FileHead(const std::string &bytes)
          : raw_(bytes.substr(0, longest)), text_(as_plain_lines(raw_))
      {
        std::transform(text_.begin(), text_.end(), text_.begin(), [](const unsigned char c) {
          return static_cast<char>(std::tolower(c));
        });
        text_.erase(0, std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
      }

      bool begins(const std::string &with) const { return text_.compare(0, with.size(), with) == 0; }
      bool begins_raw(const std::string &with) const { return raw_.compare(0, with.size(), with) == 0; }
      bool holds(const std::string &part) const { return text_.find(part) != std::string::npos; }

      /// The first words of each line that is neither empty nor begins with `comment`.
      std::vector<std::vector<std::string>> lines(const std::string &comment) const
      {
        std::vector<std::vector<std::string>> lines;
        std::istringstream                    in(text_);
        for (std::string line; std::getline(in, line) && lines.size() < 20;)
        {
          std::istringstream       words(line);
          std::vector<std::string> found;
          for (std::string word; found.size() < 8 && words >> word;)
            found.push_back(word);
          if (!found.empty() && (comment.empty() || found[0].compare(0, comment.size(), comment) != 0))
            lines.push_back(found);
        }
        return lines;
      }

      /// Column 73 of each card of an IGES file tells its section, which is followed by a count.
      bool is_iges() const
      {
        const auto is_count = [](const char c) { return c == ' ' || c == '0' || c == '1'; };
        return raw_.size() > 79 && raw_.find_first_of("\r\n") >= 80 && raw_[72] == 'S' &&
               std::all_of(raw_.begin() + 73, raw_.begin() + 80, is_count);
      }

    private:
      static constexpr std::size_t longest = 20000;

      std::string raw_, text_;
    };

    bool is_numeral(const std::string &word)
    {
      std::istringstream in(word);
      double             x;
      return static_cast<bool>(in >> x) && in.eof();
    }

    /// The first line that is no comment says what a vertex, a group or a material is.
    bool is_obj(const FileHead &head)
    {
      const auto lines = head.lines("#");
      if (lines.empty())
        return false;
      const std::string &word = lines[0][0];
      if (word == "mtllib" || word == "usemtl")
        return true;
      return std::any_of(lines.begin(), lines.end(), [](const auto &line) {
        return line.size() >= 4 && line[0] == "v" && is_numeral(line[1]) && is_numeral(line[2]) &&
               is_numeral(line[3]);
      });
    }

    bool is_abaqus(const FileHead &head)
    {
      const auto lines = head.lines("**");
      if (lines.empty())
        return false;
      const std::string word = lines[0][0].substr(0, lines[0][0].find(','));
      return word == "*heading" || word == "*node" || word == "*part" || word == "*preprint";
    }

    bool is_nastran(const FileHead &head)
    {
      const auto lines = head.lines("$");
      return std::any_of(lines.begin(), lines.end(), [](const auto &line) {
        return (line[0] == "begin" && line.size() > 1 && line[1] == "bulk") ||
               line[0].compare(0, 5, "grid,") == 0 || (line[0] == "grid" && line.size() > 4);
      });
    }

    /// A data set begins with a line of -1, and one of its number.
    bool is_universal(const FileHead &head)
    {
      const auto lines = head.lines("");
      return lines.size() > 1 && lines[0].size() == 1 && lines[0][0] == "-1" && lines[1].size() == 1 &&
             lines[1][0].size() >= 2 && lines[1][0].size() <= 5 && is_numeral(lines[1][0]);
    }

    bool is_parameter_file(const FileHead &head)
    {
      const auto lines = head.lines("#");
      return !lines.empty() && lines[0].size() > 1 &&
             (lines[0][0] == "subsection" || (lines[0][0] == "set" && head.holds("=")) ||
              (lines[0][0] == "include" && lines[0][1].find(".prm") != std::string::npos));
    }

    bool is_script(const FileHead &head)
    {
      return head.holds("setfactory(") || head.holds("surface loop(") || head.holds("line loop(") ||
             head.holds("curve loop(");
    }

    struct Signature
    {
      std::function<bool(const FileHead &)> fits;
      OtherFormat                           format;
    };

    std::function<bool(const FileHead &)> begins_with(const std::string &with)
    {
      return [with](const FileHead &head) { return head.begins(with); };
    }

    std::function<bool(const FileHead &)> has_magic(const std::string &with)
    {
      return [with](const FileHead &head) { return head.begins_raw(with); };
    }

    std::function<bool(const FileHead &)> is_xml(const std::string &element)
    {
      return [element](const FileHead &head) { return head.begins("<") && head.holds("<" + element); };
    }

    /// The first that fits counts.
    const std::vector<Signature> &signatures()
    {
      using G                                 = FormatGroup;
      static const std::vector<Signature> all = {
        {begins_with("version https://git-lfs"), {"a pointer of Git LFS", G::lfs}},
        {[](const FileHead &head) { return head.begins("/annex/") || head.holds(".git/annex/objects"); },
         {"a pointer of git-annex", G::annex}},
        {begins_with("iso-10303-21"), {"a STEP file", G::cad}},
        {[](const FileHead &head) { return head.is_iges(); }, {"an IGES file", G::cad}},
        {begins_with("dbrep_drawableshape"), {"a BREP file of Open CASCADE", G::cad}},
        {begins_with("cascade topology"), {"a BREP file of Open CASCADE", G::cad}},
        {begins_with("**abcdefghij"), {"a Parasolid file", G::closed_cad}},
        {has_magic("V5_CFV2"), {"a CATIA file", G::closed_cad}},
        {has_magic("\xd0\xcf\x11\xe0"), {"a file of SolidWorks or an office program", G::closed_cad}},
        {has_magic("AC10"), {"an AutoCAD drawing", G::closed_cad}},
        {has_magic("BLENDER"), {"a Blender file", G::closed_cad}},
        {[](const FileHead &head) {
           const auto lines = head.lines("999");
           return lines.size() > 1 && lines[0][0] == "0" && lines[1][0] == "section";
         },
         {"a DXF file", G::closed_cad}},
        {has_magic("PK\x03\x04"), {"a zip archive, as 3MF and FreeCAD files are, too", G::archive}},
        {has_magic("\x1f\x8b"), {"packed with gzip", G::archive}},
        {has_magic("BZh"), {"packed with bzip2", G::archive}},
        {has_magic("\xfd"
                   "7zXZ"),
         {"packed with xz", G::archive}},
        {has_magic("\x28\xb5\x2f\xfd"), {"packed with zstd", G::archive}},
        {has_magic("7z\xbc\xaf"), {"a 7z archive", G::archive}},
        {has_magic("Rar!"), {"a rar archive", G::archive}},
        {has_magic("\x89PNG"), {"a picture", G::document}},
        {has_magic("\xff\xd8\xff"), {"a picture", G::document}},
        {has_magic("%PDF"), {"a PDF document", G::document}},
        {has_magic("glTF"), {"a glTF file", G::scene}},
        {has_magic("\x89HDF"), {"an HDF5 file, as MED, CGNS and XDMF data are", G::meshio_reads}},
        {has_magic("CDF"), {"a netCDF file, as Exodus meshes are", G::meshio_reads}},
        {is_xml("vtkfile"), {"a VTK file", G::meshio_reads}},
        {is_xml("xdmf"), {"an XDMF file", G::meshio_reads}},
        {is_xml("amf"), {"an AMF file", G::scene}},
        {is_xml("x3d"), {"an X3D file", G::scene}},
        {is_xml("collada"), {"a COLLADA file", G::scene}},
        {is_xml("html"), {"a web page", G::page}},
        {is_xml("!doctype html"), {"a web page", G::page}},
        {begins_with("ply\n"), {"a PLY file", G::triangles}},
        {begins_with("ply\r"), {"a PLY file", G::triangles}},
        {begins_with("off\n"), {"an OFF file", G::triangles}},
        {begins_with("off\r"), {"an OFF file", G::triangles}},
        {begins_with("off "), {"an OFF file", G::triangles}},
        {begins_with("coff"), {"an OFF file", G::triangles}},
        {begins_with("#vrml"), {"a VRML file", G::scene}},
        {begins_with("# vtk datafile"), {"a VTK file", G::gmsh_reads}},
        {begins_with("meshversionformatted"), {"a Medit mesh", G::gmsh_reads}},
        {begins_with("mesh3d"), {"a Netgen mesh", G::meshio_reads}},
        {begins_with("ndime"), {"an SU2 mesh", G::meshio_reads}},
        {begins_with("*keyword"), {"an LS-DYNA file", G::nobody_reads}},
        {is_abaqus, {"an Abaqus file", G::meshio_reads}},
        {is_nastran, {"a Nastran file", G::gmsh_reads}},
        {is_universal, {"a universal file (UNV)", G::gmsh_reads}},
        {[](const FileHead &head) {
           const auto lines = head.lines("");
           return !lines.empty() && lines[0][0].size() > 1 && lines[0][0][0] == '(' &&
                  std::isdigit(static_cast<unsigned char>(lines[0][0][1])) != 0;
         },
         {"a Fluent mesh", G::meshio_reads}},
        {begins_with("$nod"), {"a Gmsh mesh of version 1", G::old_msh}},
        {[](const FileHead &head) { return head.begins("$") && head.holds("$meshformat\n"); },
         {"a Gmsh mesh", G::msh}},
        {[](const FileHead &head) { return head.begins("$") && head.holds("$meshformat\r"); },
         {"a Gmsh mesh", G::msh}},
        {[](const FileHead &head) { return head.begins("solid") && head.holds("facet"); },
         {"an STL file", G::stl}},
        {is_parameter_file, {"a parameter file", G::parameter_file}},
        {is_obj, {"an OBJ file", G::triangles}},
        {is_script, {"a script of Gmsh", G::script}}};
      return all;
    }

    /// Of a file that is made of another one, in the folder where the command is given.
    std::string name_with(const std::string &file_name, const std::string &ending)
    {
      const std::string base = file_name.substr(file_name.find_last_of('/') + 1);
      const auto        dot  = base.find_last_of('.');
      const std::string name = (dot == std::string::npos || dot == 0 ? base : base.substr(0, dot)) + ending;
      return name == base ? "new" + ending : name;
    }

    std::string as_billet_of_surface(const std::string &stl)
    {
      return "`echo 'Merge \"" + stl + "\"; Surface Loop(1) = {1}; Volume(1) = {1};' > " +
             name_with(stl, ".geo") + " && gmsh " + name_with(stl, ".geo") + " -3 -o " +
             name_with(stl, ".msh") + "'";
    }

    std::string way_to_surface(const OtherFormat &format, const std::string &from)
    {
      const std::string stl = name_with(from, ".stl");
      switch (format.group)
      {
        case FormatGroup::cad:
        case FormatGroup::script:
          return "`gmsh " + from + " -2 -clmax 2 -o " + stl +
                 "' makes triangles of at most 2 mm of it; or export STL from the CAD program";
        case FormatGroup::msh:
          return "`gmsh " + from + " -0 -o " + stl + "' writes its surface elements";
        case FormatGroup::triangles:
          return "`meshio convert " + from + " " + stl + "', or a mesh tool, makes it STL";
        case FormatGroup::scene:
          return "open it in a mesh tool, MeshLab or Blender for instance, and export STL";
        default:
          return "export the die's surface as STL from the program that made the file";
      }
    }

    std::string way_to_volume(const OtherFormat &format, const std::string &from)
    {
      const std::string msh = name_with(from, ".msh");
      switch (format.group)
      {
        case FormatGroup::cad:
        case FormatGroup::script:
          return "`gmsh " + from + " -3 -clmax 3 -o " + msh +
                 "' makes tetrahedra with edges of at most 3 mm of it";
        case FormatGroup::stl:
          return "it is a surface; " + as_billet_of_surface(from) + " fills it";
        case FormatGroup::triangles:
          return "it is a surface; `meshio convert " + from + " " + name_with(from, ".stl") + "', then " +
                 as_billet_of_surface(name_with(from, ".stl")) + " fills it";
        case FormatGroup::scene:
          return "it is a surface; export it as STL from a mesh tool, MeshLab or Blender for instance, "
                 "then " +
                 as_billet_of_surface(name_with(from, ".stl")) + " fills it";
        case FormatGroup::gmsh_reads:
        case FormatGroup::old_msh:
          return "`gmsh " + from + " -0 -save_all -o " + msh + "' converts it";
        case FormatGroup::meshio_reads:
          return "`meshio convert " + from + " " + msh + " --output-format gmsh' converts it";
        case FormatGroup::nobody_reads:
          return "save it as a Nastran or Abaqus file from a preprocessor, then `gmsh part.bdf -0 -save_all "
                 "-o " +
                 msh + "' or `meshio convert part.inp " + msh + " --output-format gmsh'";
        default:
          return "export STEP from the program that made the file, then `gmsh part.step -3 -clmax 3 -o " +
                 msh + "'";
      }
    }

    std::string way(const OtherFormat &format, const std::string &from, const Wanted wanted)
    {
      switch (format.group)
      {
        case FormatGroup::archive:
          return "unpack it, and name a file that was in it";
        case FormatGroup::lfs:
          return "fetch the file itself, by `git lfs pull' in the clone it lies in";
        case FormatGroup::annex:
          return "fetch the file itself, by `git annex get' in the clone it lies in";
        case FormatGroup::page:
          return "download the file itself (on pages of repositories: `raw')";
        case FormatGroup::document:
          return "name the file of the part";
        case FormatGroup::parameter_file:
          return "name the file of the part; the case is the program's own argument";
        default:
          return wanted == Wanted::surface ? way_to_surface(format, from) : way_to_volume(format, from);
      }
    }
  } // namespace

  void refuse_other_format(const std::string &file_name, const std::string &bytes, const Wanted wanted)
  {
    const std::string rule   = wanted == Wanted::surface
                                 ? "a surface is read from an STL file"
                                 : "a billet is read from a Gmsh file (.msh) of version 2 or 4";
    const auto        refuse = [&](const OtherFormat &format) {
      throw Error(file_name, "is " + format.name, rule, way(format, file_name, wanted));
    };
    if (wanted == Wanted::volume_mesh && has_length_of_binary_stl(bytes))
      refuse({"an STL file", FormatGroup::stl});
    const FormatGroup own = wanted == Wanted::surface ? FormatGroup::stl : FormatGroup::msh;
    const FileHead    head(bytes);
    for (const Signature &signature : signatures())
      if (signature.format.group != own && signature.fits(head))
        refuse(signature.format);
  }
} // namespace retroforge
