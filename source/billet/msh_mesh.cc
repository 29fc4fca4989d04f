// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/msh_file.h>
#include <retroforge/billet/msh_mesh.h>
#include <retroforge/billet/patch_shapes.h>
#include <retroforge/billet/tagged_mesh.h>
#include <retroforge/core/error.h>
#include <retroforge/mesh/cell_faces.h>

#include <algorithm>
#include <map>

namespace retroforge
{
  namespace
  {
    FileNodes nodes_of(const MshFile &file, const TagToNode &number)
    {
      FileNodes all{file.tags, {}, file.X};
      for (const std::size_t tag : file.tags)
      {
        const auto node = number.find(tag);
        all.nodes.push_back(node == number.end() ? invalid_index : node->second);
      }
      return all;
    }

    struct PhysicalSurface
    {
      std::string name;
      std::string id;
      Tags        nodes; // three for each triangle
    };

    std::vector<PhysicalSurface> physical_surfaces(const MshFile &file)
    {
      std::vector<PhysicalSurface> surfaces;
      for (const auto &[number, surface] : file.surfaces)
      {
        const std::string id = std::to_string(number);
        surfaces.push_back({surface.name.empty() ? id : surface.name, id, surface.triangles});
      }
      return surfaces;
    }

    // Patch of each triangle of the physical surfaces.
    std::map<FaceKey, unsigned int> patches_of_triangles(const std::vector<PhysicalSurface> &surfaces,
                                                         const TagToNode                    &number,
                                                         const std::string                  &where)
    {
      std::map<FaceKey, unsigned int> patch_of;
      for (unsigned int s = 0; s < surfaces.size(); ++s)
        for (std::size_t i = 0; i + 2 < surfaces[s].nodes.size(); i += 3)
        {
          std::array<NodeIndex, 3> nodes;
          for (unsigned int j = 0; j < 3; ++j)
          {
            const auto node = number.find(surfaces[s].nodes[i + j]);
            if (node == number.end())
              throw Error(where,
                          "a triangle of the physical surface `" + surfaces[s].name + "' uses node " +
                            std::to_string(surfaces[s].nodes[i + j]) + ", which is in no tetrahedron",
                          "surfaces must bound the volume mesh",
                          "save the mesh again, with its volume");
            nodes[j] = node->second;
          }
          const auto [entry, is_new] = patch_of.emplace(face_key(nodes), s);
          if (!is_new && entry->second != s)
            throw Error(where,
                        "a triangle is on the physical surfaces `" + surfaces[entry->second].name +
                          "' and `" + surfaces[s].name + "'",
                        "each boundary face belongs to one patch",
                        "let the physical surfaces not overlap");
        }
      return patch_of;
    }

    // Whether each patch is a symmetry plane, from the list of names or numbers. The patch of the rest
    // has no number and is none.
    std::vector<bool> find_symmetry(const std::vector<PhysicalSurface> &surfaces,
                                    const std::vector<std::string>     &names,
                                    const std::string                  &where)
    {
      std::vector<bool> is_symmetry(surfaces.size(), false);
      std::string       known;
      for (const auto &surface : surfaces)
        if (!surface.id.empty())
          known += (known.empty() ? "" : ", ") + surface.name;
      for (const auto &name : names)
      {
        const auto surface = std::find_if(surfaces.begin(), surfaces.end(), [&](const PhysicalSurface &s) {
          return !s.id.empty() && (s.name == name || s.id == name);
        });
        if (surface == surfaces.end())
          throw Error("Billet/symmetry patches",
                      "there is no physical surface `" + name + "' in " + where,
                      "symmetry patches are names or numbers of physical surfaces",
                      known.empty() ? "the file has none: define them in Gmsh"
                                    : "choose from those in the file: " + known);
        is_symmetry[surface - surfaces.begin()] = true;
      }
      return is_symmetry;
    }

    // Outer faces of the cells on the patches of the file, the others on a last patch of their own.
    std::vector<PhysicalSurface>
    add_faces(TetMesh &mesh, const MshFile &file, const TagToNode &number, const std::string &where)
    {
      auto         surfaces = physical_surfaces(file);
      const auto   patch_of = patches_of_triangles(surfaces, number, where);
      unsigned int rest     = surfaces.size();
      bool         has_rest = false;
      for (const auto &face : boundary_cell_faces(mesh.cells))
      {
        const auto entry = patch_of.find(face.key);
        mesh.faces.push_back({face.nodes, entry == patch_of.end() ? rest : entry->second});
        has_rest = has_rest || entry == patch_of.end();
      }
      if (has_rest)
        surfaces.push_back({"surface", "", {}});
      for (const auto &surface : surfaces)
        mesh.patches.push_back({surface.name, {}});
      return surfaces;
    }
  } // namespace

  TetMesh read_msh(const std::string &file_name, const std::vector<std::string> &symmetry_patches)
  {
    const MshFile file = read_msh_file(file_name);
    TagToNode     number;
    TetMesh       mesh = cells_and_nodes(file.tetrahedra, file.tags, file.X, number);
    mesh.remarks.insert(mesh.remarks.begin(), file.remarks.begin(), file.remarks.end());
    if (mesh.cells.empty())
      return mesh;
    mesh.of_file           = nodes_of(file, number);
    const auto surfaces    = add_faces(mesh, file, number, file_name);
    const auto is_symmetry = find_symmetry(surfaces, symmetry_patches, file_name);
    fit_symmetry_planes(mesh, is_symmetry, file_name);
    return mesh;
  }
} // namespace retroforge
