// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/input_file.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/geometry/surface_repair.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

namespace retroforge
{
  namespace
  {
    constexpr std::size_t header_bytes = 80, facet_bytes = 50;
    constexpr double      merge_distance = 1e-6; ///< of the diagonal
    /// Distances within which vertices at the rim count as one: as a rule, and at most, over the diagonal.
    constexpr double seam = 1e-5, widest_seam = 1e-4;
    /// Within these bounds no product of lengths overflows, and corners are told apart.
    constexpr double largest_coordinate = 1e30, smallest_size = 1e-30, farthest_off = 1e6;

    struct StlFacet
    {
      Vec3                normal;
      std::array<Vec3, 3> corners;
    };

    /// Bytes in the order of the file format, little endian, on any machine.
    std::uint32_t unpack(const char *bytes)
    {
      std::uint32_t value = 0;
      for (unsigned int i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
      return value;
    }

    double unpack_float(const char *bytes)
    {
      const std::uint32_t bits = unpack(bytes);
      float               value;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }

    void pack(std::uint32_t value, std::string &bytes)
    {
      for (unsigned int i = 0; i < 4; ++i, value >>= 8)
        bytes.push_back(static_cast<char>(value & 0xff));
    }

    void pack_float(const double value, std::string &bytes)
    {
      const float   single = static_cast<float>(value);
      std::uint32_t bits;
      std::memcpy(&bits, &single, sizeof bits);
      pack(bits, bytes);
    }

    /// "nan", "-nan(ind)", "inf" and "1.#IND", as programs write what is no number.
    bool is_no_number(const std::string &word)
    {
      return word.find("nan") != std::string::npos || word.find("inf") != std::string::npos ||
             word.find('#') != std::string::npos;
    }

    /// Words of an ASCII file with the lines they stand on.
    class Words
    {
    public:
      Words(const std::string &file_name, const std::string &text) : file_name_(file_name), text_(text) {}

      /// The next word in lower case, empty at the end.
      std::string next()
      {
        skip_space();
        std::string word;
        for (; position_ < text_.size() && !is_space(text_[position_]); ++position_)
          word.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(text_[position_]))));
        return word;
      }

      void skip_line()
      {
        while (position_ < text_.size() && text_[position_] != '\n')
          ++position_;
      }

      /// Reads a keyword as word() does, but "endsolid" for "end solid".
      std::string keyword()
      {
        const std::string word = next();
        return word == "end" ? word + next() : word;
      }

      void expect(const char *wanted)
      {
        const std::string word = keyword();
        if (word != wanted)
          fail(word, "'" + std::string(wanted) + "' must follow here");
      }

      double number() { return as_number(next()); }

      double as_number(const std::string &word) const
      {
        char        *end = nullptr;
        const double x   = std::strtod(word.c_str(), &end);
        if (word.empty() || *end != '\0' || !std::isfinite(x))
          fail(word, "a finite number must follow here");
        return x;
      }

      /// Three of them.
      Vec3 vector()
      {
        Vec3 x;
        for (unsigned int i = 0; i < 3; ++i)
          x[i] = number();
        return x;
      }

      /// Reads a normal, or what programs write that found none.
      Vec3 normal()
      {
        Vec3 x;
        for (unsigned int i = 0; i < 3; ++i)
        {
          const std::string word = next();
          x[i]                   = is_no_number(word) ? std::nan("") : as_number(word);
        }
        return x;
      }

      [[noreturn]] void fail(const std::string &word, const std::string &rule) const
      {
        throw Error(file_name_ + ", line " + std::to_string(line_),
                    word.empty() ? "the file ends" : "found '" + word.substr(0, 40) + "'",
                    rule,
                    word.empty() ? "the file is cut short: copy or export it anew" : "export the file anew");
      }

    private:
      static bool is_space(const char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

      void skip_space()
      {
        for (; position_ < text_.size() && is_space(text_[position_]); ++position_)
          line_ += text_[position_] == '\n';
      }

      const std::string &file_name_, &text_;
      std::size_t        position_ = 0;
      unsigned int       line_     = 1;
    };

    /// Several solids one after the other are read as one surface.
    std::vector<StlFacet> parse_ascii(const std::string &file_name, const std::string &text)
    {
      std::vector<StlFacet> facets;
      Words                 words(file_name, text);
      std::string           word = words.keyword();
      while (word == "solid")
      {
        words.skip_line(); // the solid's name
        for (word = words.keyword(); word == "facet"; word = words.keyword())
        {
          StlFacet facet;
          words.expect("normal");
          facet.normal = words.normal();
          words.expect("outer");
          words.expect("loop");
          for (Vec3 &corner : facet.corners)
          {
            words.expect("vertex");
            corner = words.vector();
          }
          words.expect("endloop");
          words.expect("endfacet");
          facets.push_back(facet);
        }
        if (word != "endsolid")
          words.fail(word, "'facet' or 'endsolid' must follow here");
        words.skip_line();
        word = words.keyword();
      }
      if (!word.empty())
        words.fail(word, "'solid' must follow here");
      return facets;
    }

    std::vector<StlFacet> parse_binary(const std::string &file_name, const std::string &bytes)
    {
      const std::size_t n = unpack(bytes.data() + header_bytes), n_whole = header_bytes + 4 + n * facet_bytes;
      // Some programs leave a few bytes behind the last facet.
      if (bytes.size() < n_whole || bytes.size() >= n_whole + facet_bytes)
        throw Error(file_name,
                    "has " + std::to_string(bytes.size()) + " bytes where the " + std::to_string(n) +
                      " facets that it announces take " + std::to_string(n_whole),
                    "a binary STL file has 84 bytes and 50 per facet",
                    "the file is damaged or no STL file: copy or export it anew");
      std::vector<StlFacet> facets(n);
      for (std::size_t f = 0; f < n; ++f)
      {
        const char *from = bytes.data() + header_bytes + 4 + f * facet_bytes;
        for (unsigned int i = 0; i < 3; ++i, from += 4)
          facets[f].normal[i] = unpack_float(from);
        for (Vec3 &corner : facets[f].corners)
          for (unsigned int i = 0; i < 3; ++i, from += 4)
            corner[i] = unpack_float(from);
        for (const Vec3 &corner : facets[f].corners)
          if (!std::isfinite(corner.norm()))
            throw Error(file_name,
                        "facet " + std::to_string(f + 1) + " has a corner that is no finite number",
                        "all corners must be given",
                        "export the file anew");
      }
      return facets;
    }

    /// Binary files may begin with "solid" too: the length that a binary file's count of facets announces
    /// decides, and otherwise whether there are characters that no text has.
    bool begins_as_text(const std::string &text)
    {
      std::string word = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()), 5);
      std::transform(
        word.begin(), word.end(), word.begin(), [](const unsigned char c) { return std::tolower(c); });
      return word == "solid" && text.find('\0') == std::string::npos;
    }

    std::vector<StlFacet> parse(const std::string &file_name)
    {
      const std::string bytes = read_input_file(file_name, "the file of a die");
      if (has_length_of_binary_stl(bytes))
        return parse_binary(file_name, bytes);
      const std::string text = as_plain_lines(bytes);
      if (begins_as_text(text))
        return parse_ascii(file_name, text);
      refuse_other_format(file_name, bytes, Wanted::surface);
      const bool is_short = bytes.size() < header_bytes + 4;
      return is_short ? parse_ascii(file_name, text) : parse_binary(file_name, bytes);
    }

    /// The diagonal of the corners' bounding box, with which distances can be computed; 1 if all corners are
    /// one point, whose facets are then found to have no area.
    double checked_size(const std::string &file_name, const NodalVectors<double> &corners)
    {
      if (corners.empty())
        return 1.;
      double farthest = 0.;
      for (const Vec3 &x : corners)
        for (unsigned int i = 0; i < 3; ++i)
          farthest = std::max(farthest, std::abs(x[i]));
      const auto   box  = bounding_box(corners);
      const double size = farthest < largest_coordinate ? (box.second - box.first).norm() : 0.;
      if (!(farthest < largest_coordinate) || (size > 0. && size < smallest_size) ||
          (size > 0. && farthest > farthest_off * size))
      {
        std::ostringstream what;
        what << "has a corner at a coordinate of " << farthest << " and an extent of "
             << (box.second - box.first).norm();
        throw Error(file_name,
                    what.str(),
                    "coordinates are below 1e30, and 1e-30 and 1e-6 of them is the least extent",
                    "export the part in millimetres, near the origin");
      }
      return size > 0. ? size : 1.;
    }

    /// @return what there is to say of those that are few
    std::vector<std::string> check_normals(const std::string &file_name, const Facets &facets)
    {
      const NormalsAgainst against = normals_against_corners(facets);
      if (against.are_few && against.n > 0)
        return {(against.n == 1 ? "one normal points" : std::to_string(against.n) + " normals point") +
                " against the order of the corners, which fits the other facets and counts"};
      if (against.n > 0)
        throw Error(file_name,
                    "the normal of facet " + std::to_string(against.first + 1) +
                      " points against the order of its corners" +
                      (against.n == 1 ? "" : ", and those of " + std::to_string(against.n - 1) + " more"),
                    "corners run counter-clockwise as seen from the normal's side",
                    "find out which is right, and export the file anew or with normals of 0 0 0");
      return {};
    }

    /// A normal that is no number says nothing: the order of the corners does.
    /// @return how many there were
    std::size_t forget_bad_normals(std::vector<StlFacet> &facets)
    {
      std::size_t n = 0;
      for (StlFacet &facet : facets)
        if (!std::isfinite(facet.normal.norm()))
        {
          facet.normal = Vec3();
          ++n;
        }
      return n;
    }

    /// Corners that were one are apart by what the file's digits leave: those of single precision [mm].
    double rounding_of_corners(const NodalVectors<double> &corners)
    {
      double farthest = 0.;
      for (const Vec3 &x : corners)
        for (unsigned int i = 0; i < 3; ++i)
          farthest = std::max(farthest, std::abs(x[i]));
      return farthest * std::numeric_limits<float>::epsilon();
    }

    /// A facet without a neighbour at any of its edges.
    unsigned int n_lonely_facets(const TriangleSurface &surface)
    {
      unsigned int n = 0;
      for (unsigned int f = 0; f < surface.n_facets(); ++f)
        n += surface.neighbour(f, 0).facet == invalid_index &&
             surface.neighbour(f, 1).facet == invalid_index && surface.neighbour(f, 2).facet == invalid_index;
      return n;
    }

    /// Facets that hang together nowhere have no inner side: what is deep and what is not, nobody knows.
    void check_is_surface(const std::string &file_name, const TriangleSurface &surface)
    {
      constexpr unsigned int few = 3;
      if (const unsigned int n = n_lonely_facets(surface); n > few && 2 * n > surface.n_facets())
        throw Error(file_name,
                    std::to_string(n) + " of its " + std::to_string(surface.n_facets()) +
                      " facets share no edge with another",
                    "facets that meet must share their vertices",
                    "merge the vertices with a mesh repair tool, or export one surface, with all digits");
    }
  } // namespace

  TriangleSurface read_stl(const std::string &file_name)
  {
    auto                 facets        = parse(file_name);
    const std::size_t    n_bad_normals = forget_bad_normals(facets);
    NodalVectors<double> corners, normals;
    for (const StlFacet &facet : facets)
    {
      corners.insert(corners.end(), facet.corners.begin(), facet.corners.end());
      normals.push_back(facet.normal);
    }
    const double size     = checked_size(file_name, corners);
    const double rounding = std::min(rounding_of_corners(corners), widest_seam * size);
    Facets       merged   = merge_corners(corners, normals, merge_distance * size);
    auto         remarks  = mend(merged, std::max(seam * size, rounding));
    for (const std::string &remark : check_normals(file_name, merged))
      remarks.push_back(remark);
    if (n_bad_normals > 0)
      remarks.push_back((n_bad_normals == 1 ? "one normal is no number"
                                            : std::to_string(n_bad_normals) + " normals are no numbers") +
                        ": the order of the corners counts");
    if (rounding > seam * size)
      remarks.push_back("it is so far from the origin that single precision rounds its corners to " +
                        as_text(rounding));
    TriangleSurface surface(file_name, merged.vertices, merged.triangles);
    check_is_surface(file_name, surface);
    surface.remarks = remarks;
    return surface;
  }

  TriangleSurface read_stl(const std::string &file_name, const std::string &setting)
  {
    try
    {
      return read_stl(file_name);
    }
    catch (const Error &error)
    {
      throw error.in_setting(setting);
    }
  }

  void write_stl(const std::string &file_name, const TriangleSurface &surface, const StlFormat format)
  {
    write_stl(file_name, surface.vertices(), surface.triangles(), format);
  }

  void write_stl(const std::string           &file_name,
                 const NodalVectors<double>  &vertices,
                 const std::vector<Triangle> &triangles,
                 const StlFormat              format)
  {
    std::string bytes;
    char        line[160];
    if (format == StlFormat::ascii)
      bytes = "solid\n";
    else
    {
      bytes.assign(header_bytes, ' ');
      pack(triangles.size(), bytes);
    }
    for (const Triangle &t : triangles)
    {
      const std::array<Vec3, 3> x{{vertices[t[0]], vertices[t[1]], vertices[t[2]]}};
      const Vec3                v = facet_vector(x[0], x[1], x[2]), normal = v / v.norm();
      if (format == StlFormat::ascii)
      {
        const auto add = [&](const char *words, const Vec3 &y) {
          std::snprintf(line, sizeof line, "%s %.17g %.17g %.17g\n", words, y[0], y[1], y[2]);
          bytes += line;
        };
        add("facet normal", normal);
        bytes += "outer loop\n";
        for (const Vec3 &corner : x)
          add("vertex", corner);
        bytes += "endloop\nendfacet\n";
        continue;
      }
      for (const Vec3 &y : {normal, x[0], x[1], x[2]})
        for (unsigned int i = 0; i < 3; ++i)
          pack_float(y[i], bytes);
      bytes.append(2, '\0');
    }
    if (format == StlFormat::ascii)
      bytes += "endsolid\n";
    std::ofstream out(file_name, std::ios::binary);
    if (!out.write(bytes.data(), bytes.size()) || !out.flush())
      throw Error(file_name,
                  "cannot be written",
                  "the folder must exist and have room",
                  "choose another folder, or make room");
  }
} // namespace retroforge
