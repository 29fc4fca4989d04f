// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/msh_elements.h>
#include <retroforge/billet/msh_file.h>
#include <retroforge/billet/msh_scanner.h>
#include <retroforge/core/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

namespace retroforge
{
  namespace
  {
    using Tags = MshFile::Tags;

    class Reader
    {
    public:
      explicit Reader(const std::string &file_name) : file_name_(file_name), in_(file_name) {}

      MshFile read()
      {
        for (std::string name = in_.next_section(); !name.empty(); name = in_.next_section())
          read_section(name);
        if (version_ == 0.)
          in_.fail("there is no section $MeshFormat", "a Gmsh file begins with it");
        check_elements();
        gather_tetrahedra();
        gather_surfaces();
        check_nodes();
        return file_;
      }

    private:
      using ByEntity = std::map<int, Tags>;

      const std::string                        file_name_;
      MshScanner                               in_;
      MshFile                                  file_;
      double                                   version_ = 0.;
      ByEntity                                 tetrahedra_, triangles_;
      std::map<int, std::vector<int>>          physical_;         ///< physical surfaces of each surface
      std::map<int, std::vector<int>>          physical_volumes_; ///< and physical volumes of each volume
      std::map<int, std::string>               names_;            ///< of physical surfaces
      std::set<int>                            volumes_;          ///< physical volumes of the tetrahedra
      std::size_t                              n_curved_ = 0;     ///< tetrahedra of higher order
      std::map<MshElement::Shape, std::size_t> other_volume_elements_;

      void read_section(const std::string &name)
      {
        if (name != "MeshFormat" && version_ == 0.)
          in_.fail("found '$" + legible(name) + "'", "a Gmsh file begins with $MeshFormat");
        const bool old = version_ < 3.;
        if (name == "MeshFormat")
          read_format();
        else if (name == "PhysicalNames")
          read_names();
        else if (name == "Entities" && !old)
          read_entities(false);
        else if (name == "Nodes")
          old ? read_nodes_2() : read_nodes_4();
        else if (name == "Elements")
          old ? read_elements_2() : read_elements_4();
        else if (name == "PartitionedEntities" && version_ >= 4.1)
          read_partitioned_entities();
        else if (name == "PartitionedEntities" || name == "ParametricNodes")
          in_.fail("there is a section $" + name,
                   "the mesh must be in one piece, saved without parametric coordinates");
        else
        {
          in_.skip_section(name);
          return;
        }
        in_.end_section(name);
      }

      void read_format()
      {
        const double version = in_.real_in_text();
        const int    binary = in_.integer_in_text(), data_size = in_.integer_in_text();
        in_.rest_of_line();
        if (version_ != 0. || !((version >= 2. && version < 3.) || (version >= 4. && version < 4.2)))
          in_.fail("the version is " + as_text(version), "versions 2, 4.0 and 4.1 are read, one in a file");
        if (binary < 0 || binary > 1 || data_size != 8)
          in_.fail("file type is " + std::to_string(binary) + ", data size " + std::to_string(data_size),
                   "the type is 0 (ASCII) or 1 (binary), the data size 8");
        if (binary == 1 && version >= 4. && version < 4.1)
          in_.fail("the file is binary and of version 4.0", "of this version only ASCII files are read");
        version_ = version;
        if (binary == 1)
        {
          in_.set_binary();
          if (in_.integer() != 1)
            in_.fail("numbers have another order of bytes",
                     "binary files are read on the kind of machine that wrote them");
        }
      }

      void read_names()
      {
        const std::size_t n = in_.count_in_text(3);
        for (std::size_t i = 0; i < n; ++i)
        {
          const int         dimension = in_.integer_in_text(), tag = in_.integer_in_text();
          const std::string line  = in_.rest_of_line();
          const std::size_t first = line.find('"'), last = line.rfind('"');
          if (first == last)
            in_.fail("found '" + legible(line.substr(0, 40)) + "'",
                     "a name in quotation marks must stand here");
          if (dimension == 2)
            names_[tag] = legible(line.substr(first + 1, last - first - 1));
        }
      }

      void read_entities(const bool are_parts)
      {
        std::size_t n[4];
        for (std::size_t &number : n)
          number = in_.count(0);
        for (int dimension = 0; dimension < 4; ++dimension)
        {
          in_.check_room(n[dimension], 5);
          for (std::size_t i = 0; i < n[dimension]; ++i)
            read_entity(dimension, are_parts);
        }
      }

      /// Parts for parallel programs, each an entity by itself with the physical groups of its parent.
      void read_partitioned_entities()
      {
        in_.count(0);                        // partitions
        in_.skip_integers(2 * in_.count(2)); // ghost entities
        read_entities(true);
      }

      void read_entity(const int dimension, const bool is_part)
      {
        const int tag = in_.integer();
        if (is_part)
        {
          in_.skip_integers(2); // the parent
          in_.skip_integers(in_.count(1));
        }
        in_.skip_reals(dimension == 0 && version_ >= 4.1 ? 3 : 6); // position or box
        for (std::size_t n = in_.count(1); n > 0; --n)
        {
          const int physical = in_.integer();
          if (dimension == 2)
            physical_[tag].push_back(physical);
          else if (dimension == 3)
            physical_volumes_[tag].push_back(physical);
        }
        if (dimension > 0)
          in_.skip_integers(in_.count(1)); // boundary
      }

      void add_node(const std::size_t tag, const Vec3 &x)
      {
        if (!(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])))
          in_.fail("node " + std::to_string(tag) + " has a coordinate that is not finite",
                   "coordinates must be finite numbers");
        file_.tags.push_back(tag);
        file_.X.push_back(x);
      }

      Vec3 position()
      {
        Vec3 x;
        for (unsigned int i = 0; i < 3; ++i)
          x[i] = in_.real();
        return x;
      }

      std::size_t node_2()
      {
        const int tag = in_.integer();
        if (tag < 1)
          in_.fail("found node " + std::to_string(tag), "nodes are numbered from 1");
        return tag;
      }

      void read_nodes_2()
      {
        const std::size_t n = in_.count_in_text(4);
        for (std::size_t i = 0; i < n; ++i)
        {
          const std::size_t tag = node_2();
          add_node(tag, position());
        }
      }

      void read_nodes_4()
      {
        const bool        by_list  = version_ >= 4.1;
        const std::size_t n_blocks = in_.count(3);
        in_.count(4);
        if (by_list)
          skip_range();
        for (std::size_t b = 0; b < n_blocks; ++b)
        {
          int dimension = in_.integer(), tag = in_.integer();
          if (!by_list)
            std::swap(dimension, tag);
          const int         parametric = in_.integer();
          const std::size_t n          = in_.count(4);
          if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1)
            in_.fail("found a block of nodes of dimension " + std::to_string(dimension) + ", parametric " +
                       std::to_string(parametric),
                     "the dimension is 0 to 3, parametric 0 or 1");
          read_node_block(n, by_list, parametric * dimension);
        }
      }

      void read_node_block(const std::size_t n, const bool by_list, const unsigned int n_parameters)
      {
        Tags tags;
        for (std::size_t i = 0; by_list && i < n; ++i)
          tags.push_back(in_.size());
        for (std::size_t i = 0; i < n; ++i)
        {
          const std::size_t tag = by_list ? tags[i] : node_2();
          add_node(tag, position());
          in_.skip_reals(n_parameters);
        }
      }

      /// Smallest and largest tag.
      void skip_range()
      {
        in_.size();
        in_.size();
      }

      unsigned int nodes_of(const int type) const
      {
        const unsigned int n = msh_element(type).n_nodes;
        if (n == 0)
          in_.fail("found an element of type " + std::to_string(type), "types are those of Gmsh's manual");
        return n;
      }

      void add_element(const int type, const int entity, const int surface, const Tags &nodes)
      {
        const MshElement element = msh_element(type);
        const auto       add     = [&](Tags &to, const unsigned int n_corners) {
          to.insert(to.end(), nodes.begin(), nodes.begin() + n_corners);
        };
        if (element.shape == MshElement::Shape::tetrahedron)
        {
          add(tetrahedra_[entity], 4);
          n_curved_ += !element.is_linear;
        }
        else if (element.shape == MshElement::Shape::triangle)
          add(triangles_[surface], 3);
        else if (element.shape != MshElement::Shape::other)
          ++other_volume_elements_[element.shape];
      }

      /// Its number, the physical group and the entity it belongs to, perhaps more, and the nodes.
      void read_element_2(const int type, const std::size_t n_tags)
      {
        int physical = 0, entity = 0;
        for (std::size_t i = 0; i < n_tags; ++i)
        {
          const int tag = in_.integer();
          if (i == 0)
            physical = tag;
          else if (i == 1)
            entity = tag;
        }
        Tags nodes(nodes_of(type));
        for (std::size_t &node : nodes)
          node = node_2();
        add_element(type, entity, physical, nodes);
        const MshElement::Shape shape = msh_element(type).shape;
        if (shape == MshElement::Shape::triangle && physical != 0)
          physical_[physical] = {physical};
        if (shape == MshElement::Shape::tetrahedron && physical != 0)
          volumes_.insert(physical);
      }

      void read_elements_2()
      {
        const std::size_t n = in_.count_in_text(3);
        for (std::size_t i = 0; i < n;)
        {
          int         type    = 0;
          std::size_t n_alike = 1;
          if (in_.is_binary())
          {
            type    = in_.integer();
            n_alike = number_2();
            if (n_alike == 0 || n_alike > n - i)
              in_.fail("found a block of " + std::to_string(n_alike) + " elements",
                       "blocks hold one element at least, and all together as many as announced");
          }
          std::size_t n_tags = in_.is_binary() ? number_2() : 0;
          for (std::size_t k = 0; k < n_alike; ++k, ++i)
          {
            in_.integer(); // the element's own number
            if (!in_.is_binary())
            {
              type   = in_.integer();
              n_tags = number_2();
            }
            read_element_2(type, n_tags);
          }
        }
      }

      std::size_t number_2()
      {
        const int number = in_.integer();
        if (number < 0)
          in_.fail("found " + std::to_string(number), "a number of entries must stand here");
        in_.check_room(number, 1);
        return number;
      }

      void read_elements_4()
      {
        const bool        sizes    = version_ >= 4.1;
        const std::size_t n_blocks = in_.count(3);
        in_.count(2);
        if (sizes)
          skip_range();
        for (std::size_t b = 0; b < n_blocks; ++b)
        {
          int dimension = in_.integer(), entity = in_.integer();
          if (!sizes)
            std::swap(dimension, entity);
          const int         type = in_.integer();
          const std::size_t n    = in_.count(1 + nodes_of(type));
          Tags              nodes(nodes_of(type));
          for (std::size_t i = 0; i < n; ++i)
          {
            sizes ? in_.size() : in_.integer(); // the element's own number
            for (std::size_t &node : nodes)
              node = sizes ? in_.size() : node_2();
            add_element(type, entity, entity, nodes);
          }
        }
      }

      void check_elements() const
      {
        for (const auto &[shape, n] : other_volume_elements_)
          throw Error(file_name_,
                      "there are " + std::to_string(n) + " " + name_of(shape) + " among its volume elements",
                      "all volume elements must be tetrahedra",
                      "mesh the part again without recombination, extruded layers and transfinite volumes");
      }

      void gather_tetrahedra()
      {
        std::set<std::array<std::size_t, 4>> known;
        std::size_t                          n_twice = 0;
        for (const auto &[entity, nodes] : tetrahedra_)
        {
          for (const int physical : physical_volumes_[entity])
            volumes_.insert(physical);
          for (std::size_t i = 0; i + 3 < nodes.size(); i += 4)
          {
            std::array<std::size_t, 4> key = {{nodes[i], nodes[i + 1], nodes[i + 2], nodes[i + 3]}};
            std::sort(key.begin(), key.end());
            if (known.insert(key).second)
              file_.tetrahedra.insert(file_.tetrahedra.end(), nodes.begin() + i, nodes.begin() + i + 4);
            else
              ++n_twice;
          }
        }
        remark(n_twice);
      }

      void remark(const std::size_t n_twice)
      {
        if (n_curved_ > 0)
          file_.remarks.push_back(std::to_string(n_curved_) +
                                  " tetrahedra are of higher order, and only their corners are read: curved "
                                  "edges are straight now");
        if (volumes_.size() > 1)
          file_.remarks.push_back("its " + std::to_string(volumes_.size()) +
                                  " physical volumes are taken together as one body of one material");
        if (n_twice > 0)
          file_.remarks.push_back("so many tetrahedra are there more than once, and taken once: " +
                                  std::to_string(n_twice));
      }

      /// The sign of a physical surface's number only tells its orientation.
      void gather_surfaces()
      {
        for (const auto &[surface, groups] : physical_)
          for (const int group : groups)
          {
            if (group == std::numeric_limits<int>::min())
              in_.fail("found the physical surface " + std::to_string(group), "numbers have 31 bits");
            MshFile::Surface &physical = file_.surfaces[std::abs(group)];
            const Tags       &nodes    = triangles_[surface];
            physical.triangles.insert(physical.triangles.end(), nodes.begin(), nodes.end());
          }
        for (auto &[number, surface] : file_.surfaces)
          if (const auto name = names_.find(number); name != names_.end())
            surface.name = name->second;
      }

      void check_nodes() const
      {
        Tags sorted = file_.tags;
        std::sort(sorted.begin(), sorted.end());
        if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
          throw_node(*twice, "is given more than once");
        for (const std::size_t tag : file_.tetrahedra)
          if (!std::binary_search(sorted.begin(), sorted.end(), tag))
            throw_node(tag, "belongs to a tetrahedron and is not given");
      }

      [[noreturn]] void throw_node(const std::size_t tag, const std::string &what) const
      {
        throw Error(file_name_,
                    "node " + std::to_string(tag) + " " + what,
                    "each node is given once",
                    "save the mesh again from Gmsh, all of it");
      }
    };
  } // namespace

  MshFile read_msh_file(const std::string &file_name)
  {
    return Reader(file_name).read();
  }
} // namespace retroforge
