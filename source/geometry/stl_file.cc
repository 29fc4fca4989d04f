// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/geometry/stl_file.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace retroforge
{
  namespace
  {
    constexpr std::size_t header_bytes = 80, facet_bytes = 50;
    constexpr double      merge_distance = 1e-6; ///< of the diagonal
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

      void expect(const char *wanted)
      {
        const std::string word = next();
        if (word != wanted)
          fail(word, "'" + std::string(wanted) + "' must follow here");
      }

      double number()
      {
        const std::string word = next();
        char             *end  = nullptr;
        const double      x    = std::strtod(word.c_str(), &end);
        if (word.empty() || *end != '\0' || !std::isfinite(x))
          fail(word, "a finite number must follow here");
        return x;
      }

      Vec3 vector()
      {
        Vec3 x;
        for (unsigned int i = 0; i < 3; ++i)
          x[i] = number();
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
      std::string           word = words.next();
      while (word == "solid")
      {
        words.skip_line(); // the solid's name
        for (word = words.next(); word == "facet"; word = words.next())
        {
          StlFacet facet;
          words.expect("normal");
          facet.normal = words.vector();
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
        word = words.next();
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
    bool is_ascii(const std::string &bytes)
    {
      if (bytes.size() >= header_bytes + 4 &&
          bytes.size() ==
            header_bytes + 4 + facet_bytes * static_cast<std::size_t>(unpack(bytes.data() + header_bytes)))
        return false;
      const std::size_t first = bytes.find_first_not_of(" \t\r\n");
      if (first == std::string::npos || bytes.size() < header_bytes + 4)
        return true;
      std::string word = bytes.substr(first, 5);
      std::transform(
        word.begin(), word.end(), word.begin(), [](const unsigned char c) { return std::tolower(c); });
      return word == "solid" && bytes.find('\0') == std::string::npos;
    }

    /// Gives equal corners one number, by a grid of cells as wide as the distance that counts as equal.
    class Merger
    {
    public:
      explicit Merger(const double distance) : distance_(distance) {}

      unsigned int operator()(const Vec3 &x)
      {
        const Key    home = key(x);
        unsigned int best = invalid_index;
        for (int i = 0; i < 27; ++i)
        {
          const auto found =
            cells_.find({{home[0] + i % 3 - 1, home[1] + i / 3 % 3 - 1, home[2] + i / 9 - 1}});
          if (found != cells_.end())
            for (const unsigned int v : found->second)
              if ((vertices[v] - x).norm() <= distance_)
                best = std::min(best, v);
        }
        if (best != invalid_index)
          return best;
        vertices.push_back(x);
        cells_[home].push_back(vertices.size() - 1);
        return vertices.size() - 1;
      }

      NodalVectors<double> vertices;

    private:
      using Key = std::array<long long, 3>;

      Key key(const Vec3 &x) const
      {
        Key k;
        for (unsigned int i = 0; i < 3; ++i)
          k[i] = std::llround(std::floor(x[i] / distance_));
        return k;
      }

      const double                             distance_;
      std::map<Key, std::vector<unsigned int>> cells_;
    };

    std::string read_bytes(const std::string &file_name)
    {
      std::ifstream      in(file_name, std::ios::binary);
      std::ostringstream bytes;
      std::error_code    ignored;
      const bool         is_folder = std::filesystem::is_directory(file_name, ignored);
      const bool         is_device = std::filesystem::is_character_file(file_name, ignored);
      if (!in || is_folder || is_device || (in.peek() != EOF && !(bytes << in.rdbuf())))
        throw Error(file_name,
                    is_folder   ? "is a folder"
                    : is_device ? "is a device"
                                : "cannot be read",
                    "the file of a die must exist",
                    "correct its name, which counts from the parameter file's folder, or from where the "
                    "program is started");
      return bytes.str();
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

    void check_normal(const std::string &file_name, const StlFacet &facet, const std::size_t f)
    {
      const Vec3 v = facet_vector(facet.corners[0], facet.corners[1], facet.corners[2]);
      // Near a right angle rounding decides, and a zero or NaN normal says nothing.
      if (facet.normal * v < -0.1 * facet.normal.norm() * v.norm())
        throw Error(file_name,
                    "the normal of facet " + std::to_string(f + 1) +
                      " points against the order of its corners",
                    "corners run counter-clockwise as seen from the normal's side",
                    "find out which is right, and export the file anew or with normals of 0 0 0");
    }
  } // namespace

  TriangleSurface read_stl(const std::string &file_name)
  {
    const std::string bytes = read_bytes(file_name);
    const auto facets = is_ascii(bytes) ? parse_ascii(file_name, bytes) : parse_binary(file_name, bytes);
    NodalVectors<double> corners;
    for (const StlFacet &facet : facets)
      corners.insert(corners.end(), facet.corners.begin(), facet.corners.end());
    Merger                merge(merge_distance * checked_size(file_name, corners));
    std::vector<Triangle> triangles;
    for (std::size_t f = 0; f < facets.size(); ++f)
    {
      check_normal(file_name, facets[f], f);
      const auto &c = facets[f].corners;
      triangles.push_back({{merge(c[0]), merge(c[1]), merge(c[2])}});
    }
    return TriangleSurface(file_name, merge.vertices, triangles);
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
