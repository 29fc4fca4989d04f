// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/exceptions.h>

#include <retroforge/core/error.h>
#include <retroforge/core/fingerprint.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/record/contact_record.h>
#include <retroforge/record/record_format.h>
#include <retroforge/record/tape_record.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int format = 12;

    static_assert(sizeof(Vec3) == 3 * sizeof(double),
                  "nodal vectors are read and written as arrays of numbers");

    void write_vectors(const hid_t parent, const std::string &name, const NodalVectors<double> &X)
    {
      hdf5::write_array(parent, name, {X.size(), 3}, X.empty() ? nullptr : X[0].begin_raw());
    }

    NodalVectors<double> to_vectors(const double *values, const std::size_t n)
    {
      NodalVectors<double> X(n);
      if (n > 0)
        std::memcpy(X[0].begin_raw(), values, n * sizeof(Vec3));
      return X;
    }

    std::vector<double>
    read_numbers(const hid_t parent, const std::string &name, const std::vector<hsize_t> &shape)
    {
      std::vector<double> values = hdf5::read_array<double>(parent, name, shape);
      hdf5::check_finite(values.data(), values.size(), name);
      return values;
    }

    double read_number(const hid_t object, const std::string &name)
    {
      const double value = hdf5::read_attribute<double>(object, name);
      hdf5::check_finite(&value, 1, name);
      return value;
    }

    NodalVectors<double> read_vectors(const hid_t parent, const std::string &name, const hsize_t n)
    {
      const std::vector<double> values = read_numbers(parent, name, {n, 3});
      return to_vectors(values.data(), values.size() / 3);
    }

    std::string patch_name(const unsigned int p)
    {
      return "patch_" + std::to_string(p);
    }

    void write_patch(const hid_t parent, const std::string &name, const Patch &patch)
    {
      const hdf5::Handle group = hdf5::create_group(parent, name);
      hdf5::write_string(group, "name", patch.name);
      if (patch.symmetry)
      {
        hdf5::write_attribute(group, "point", patch.symmetry->point.begin_raw(), 3);
        hdf5::write_attribute(group, "normal", patch.symmetry->normal.begin_raw(), 3);
      }
    }

    Patch read_patch(const hid_t parent, const std::string &name)
    {
      const hdf5::Handle group = hdf5::open_group(parent, name);
      Patch              patch{hdf5::read_string(group, "name"), {}};
      if (hdf5::has_attribute(group, "point"))
      {
        Plane plane;
        hdf5::read_attribute(group, "point", plane.point.begin_raw(), 3);
        hdf5::read_attribute(group, "normal", plane.normal.begin_raw(), 3);
        hdf5::check_finite(plane.point.begin_raw(), 3, "point");
        if (!(std::abs(plane.normal.norm() - 1.) < 1e-6))
          throw hdf5::Failure("the normal of " + name + " has not length one");
        patch.symmetry = plane;
      }
      return patch;
    }

    void write_mesh(const hid_t parent, const TetMesh &mesh)
    {
      std::vector<unsigned int> cells, faces;
      for (const auto &cell : mesh.cells)
        cells.insert(cells.end(), cell.begin(), cell.end());
      for (const BoundaryFace &face : mesh.faces)
      {
        faces.insert(faces.end(), face.nodes.begin(), face.nodes.end());
        faces.push_back(face.patch);
      }
      write_vectors(parent, "X", mesh.X);
      hdf5::write_array(parent, "cells", {mesh.cells.size(), 4}, cells.data());
      hdf5::write_array(parent, "faces", {mesh.faces.size(), 4}, faces.data());
      for (unsigned int p = 0; p < mesh.patches.size(); ++p)
        write_patch(parent, patch_name(p), mesh.patches[p]);
      const unsigned int n_patches = mesh.patches.size();
      hdf5::write_attribute(parent, "n_patches", &n_patches);
    }

    TetMesh read_mesh(const hid_t parent)
    {
      using Indices = std::vector<unsigned int>;
      TetMesh mesh;
      mesh.X              = read_vectors(parent, "X", hdf5::any);
      const Indices cells = hdf5::read_array<unsigned int>(parent, "cells", {hdf5::any, 4});
      for (std::size_t i = 0; i < cells.size(); i += 4)
        mesh.cells.push_back({{cells[i], cells[i + 1], cells[i + 2], cells[i + 3]}});
      const Indices faces = hdf5::read_array<unsigned int>(parent, "faces", {hdf5::any, 4});
      for (std::size_t i = 0; i < faces.size(); i += 4)
        mesh.faces.push_back({{{faces[i], faces[i + 1], faces[i + 2]}}, faces[i + 3]});
      const auto n_patches = hdf5::read_attribute<unsigned int>(parent, "n_patches");
      for (unsigned int p = 0; p < n_patches; ++p)
        mesh.patches.push_back(read_patch(parent, patch_name(p)));
      return mesh;
    }

    /// Nodes of the mesh and of the velocity, of which there are more where it is quadratic.
    struct NodeCounts
    {
      unsigned int mesh = 0, velocity = 0;

      bool quadratic() const { return velocity > mesh; }
    };

    bool is_there(const ContactPoint &point, const NodeCounts &n)
    {
      if (!(point.nodes[0] < n.mesh))
        return false;
      if (point.is_node())
        return point.velocity_node == point.nodes[0];
      return point.nodes[0] < point.nodes[1] && point.nodes[1] < n.mesh &&
             (n.quadratic() ? point.velocity_node >= n.mesh && point.velocity_node < n.velocity
                            : !point.has_own_velocity());
    }

    bool is_there(const ContactPair &pair, const NodeCounts &n, const RecordShape &shape)
    {
      return is_there(pair.point, n) && pair.die < shape.die_facets.size() &&
             pair.feature.facet < shape.die_facets[pair.die] && pair.feature.kind < DieFeature::n_kinds;
    }

    /// A record with sizes that disagree is a mistake of the program, found before it reaches the disk.
    NodeCounts check_increment(const IncrementRecord &increment, const RecordShape &shape)
    {
      NodeCounts n;
      if (!increment.solves.empty())
        n = {static_cast<unsigned int>(increment.solves[0].P.size()),
             static_cast<unsigned int>(increment.solves[0].V.size())};
      AssertThrow(!increment.remesh || increment.remesh->mesh.n_nodes() == n.mesh,
                  dealii::ExcMessage("a new mesh has not as many nodes as the solution on it"));
      for (const ContactPair &pair : increment.pairs)
        AssertThrow(is_there(pair, n, shape),
                    dealii::ExcMessage("a contact pair refers to a node, die or feature that is not there"));
      for (const SolveRecord &solve : increment.solves)
      {
        AssertThrow(solve.V.size() == n.velocity, dealii::ExcDimensionMismatch(solve.V.size(), n.velocity));
        AssertThrow(solve.P.size() == n.mesh, dealii::ExcDimensionMismatch(solve.P.size(), n.mesh));
        AssertThrow(solve.motion().size() == n.mesh,
                    dealii::ExcDimensionMismatch(solve.motion().size(), n.mesh));
        AssertThrow(solve.active.size() == increment.pairs.size(),
                    dealii::ExcDimensionMismatch(solve.active.size(), increment.pairs.size()));
      }
      return n;
    }

    void write_remesh(const hid_t parent, const RemeshRecord &remesh)
    {
      const hdf5::Handle      group = hdf5::create_group(parent, "remesh");
      const TransferOperator &J     = remesh.transfer;
      write_mesh(group, remesh.mesh);
      write_vectors(group, "X_before", remesh.X_before);
      hdf5::write_array(group, "begin", {J.begin.size()}, J.begin.data());
      hdf5::write_array(group, "node", {J.node.size()}, J.node.data());
      hdf5::write_array(group, "weight", {J.weight.size()}, J.weight.data());
      write_tape(hdf5::create_group(group, "positions"), remesh.positions);
      hdf5::write_attribute(group, "repaired", &remesh.removed_volume);
    }

    std::shared_ptr<const RemeshRecord> read_remesh(const hid_t parent, const RecordShape &shape)
    {
      const hdf5::Handle group  = hdf5::open_group(parent, "remesh");
      auto               remesh = std::make_shared<RemeshRecord>();
      TransferOperator  &J      = remesh->transfer;
      remesh->mesh              = read_mesh(group);
      remesh->X_before          = read_vectors(group, "X_before", hdf5::any);
      remesh->removed_volume    = read_number(group, "repaired");
      J.n_old                   = remesh->X_before.size();
      J.begin                   = hdf5::read_array<unsigned int>(group, "begin", {remesh->mesh.X.size() + 1});
      J.node                    = hdf5::read_array<unsigned int>(group, "node", {hdf5::any});
      J.weight                  = read_numbers(group, "weight", {J.node.size()});
      remesh->positions         = read_tape(hdf5::open_group(group, "positions"));
      if (const std::string defect =
            remesh->positions.defect(J.n_old, remesh->mesh.n_nodes(), shape.die_facets);
          !defect.empty())
        throw hdf5::Failure("the tape of positions is damaged: " + defect);
      bool sound = J.begin.front() == 0 && J.begin.back() == J.node.size();
      for (std::size_t k = 0; k + 1 < J.begin.size(); ++k)
        sound = sound && J.begin[k] <= J.begin[k + 1];
      for (const NodeIndex k : J.node)
        sound = sound && k < J.n_old;
      if (!sound)
        throw hdf5::Failure("the rows of a transfer between meshes do not fit these meshes");
      J.set_offset(remesh->X_before, remesh->mesh.X);
      return remesh;
    }

    void write_solves(const hid_t                     group,
                      const std::vector<SolveRecord> &solves,
                      const NodeCounts               &n,
                      const hsize_t                   n_pairs)
    {
      std::vector<double>        V, P, vertices;
      std::vector<unsigned char> active;
      for (const SolveRecord &solve : solves)
      {
        if (n.velocity > 0)
          V.insert(V.end(), solve.V[0].begin_raw(), solve.V[0].begin_raw() + 3 * n.velocity);
        if (n.quadratic())
          vertices.insert(
            vertices.end(), (*solve.vertices)[0].begin_raw(), (*solve.vertices)[0].begin_raw() + 3 * n.mesh);
        P.insert(P.end(), solve.P.begin(), solve.P.end());
        active.insert(active.end(), solve.active.begin(), solve.active.end());
      }
      hdf5::write_array(group, "V", {solves.size(), n.velocity, 3}, V.data());
      if (n.quadratic())
        hdf5::write_array(group, "vertices", {solves.size(), n.mesh, 3}, vertices.data());
      hdf5::write_array(group, "P", {solves.size(), n.mesh}, P.data());
      hdf5::write_array(group, "active", {solves.size(), n_pairs}, active.data());
    }

    void write_pairs(const hid_t group, const std::vector<ContactPair> &pairs)
    {
      std::vector<unsigned int>  indices, facet;
      std::vector<unsigned char> touching, kind;
      for (const ContactPair &pair : pairs)
      {
        indices.insert(indices.end(),
                       {pair.point.nodes[0], pair.point.nodes[1], pair.point.velocity_node, pair.die});
        touching.push_back(pair.touching);
        facet.push_back(pair.feature.facet);
        kind.push_back(pair.feature.kind);
      }
      hdf5::write_array(group, "pairs", {pairs.size(), 4}, indices.data());
      hdf5::write_array(group, "touching", {pairs.size()}, touching.data());
      hdf5::write_array(group, "facet", {pairs.size()}, facet.data());
      hdf5::write_array(group, "kind", {pairs.size()}, kind.data());
    }

    std::vector<unsigned char>
    read_flags(const hid_t group, const std::string &name, const std::vector<hsize_t> &shape)
    {
      const std::vector<unsigned char> flags = hdf5::read_array<unsigned char>(group, name, shape);
      for (const unsigned char flag : flags)
        if (flag > 1)
          throw hdf5::Failure(name + " holds a flag of " + std::to_string(flag) + ", neither 0 nor 1");
      return flags;
    }

    std::vector<ContactPair>
    read_pairs(const hid_t group, const RecordShape &shape, const NodeCounts &n_nodes)
    {
      const auto               indices  = hdf5::read_array<unsigned int>(group, "pairs", {hdf5::any, 4});
      const auto               touching = read_flags(group, "touching", {indices.size() / 4});
      const hsize_t            n        = touching.size();
      const auto               facet    = hdf5::read_array<unsigned int>(group, "facet", {n});
      const auto               kind     = hdf5::read_array<unsigned char>(group, "kind", {n});
      std::vector<ContactPair> pairs;
      for (std::size_t i = 0; i < n; ++i)
      {
        pairs.push_back({{{{indices[4 * i], indices[4 * i + 1]}}, indices[4 * i + 2]},
                         indices[4 * i + 3],
                         touching[i] != 0,
                         {facet[i], kind[i]}});
        if (is_there(pairs[i], n_nodes, shape))
          continue;
        const bool feature     = is_there(pairs[i].point, n_nodes) && pairs[i].die < shape.die_facets.size();
        const std::string pair = "contact pair " + std::to_string(i) + " is of ";
        if (feature)
          throw hdf5::Failure(pair + "facet " + std::to_string(facet[i]) + ", kind " +
                              std::to_string(kind[i]) + " of a die of " +
                              std::to_string(shape.die_facets[pairs[i].die]) + " facets and " +
                              std::to_string(DieFeature::n_kinds) + " kinds, counted from 0");
        const auto &[first, second] = pairs[i].point.nodes;
        throw hdf5::Failure(
          pair +
          (pairs[i].point.is_node()
             ? "node " + std::to_string(first)
             : "the edge of nodes " + std::to_string(first) + " and " + std::to_string(second)) +
          (pairs[i].point.has_own_velocity()
             ? ", velocity node " + std::to_string(pairs[i].point.velocity_node)
             : "") +
          " and die " + std::to_string(pairs[i].die) + " where there are " + std::to_string(n_nodes.mesh) +
          " nodes, " + std::to_string(n_nodes.velocity) + " of the velocity, and " +
          std::to_string(shape.die_facets.size()) + " dies, counted from 0");
      }
      return pairs;
    }

    std::vector<SolveRecord> read_solves(const hid_t group, const NodeCounts &counts, const hsize_t n_pairs)
    {
      const hsize_t n_velocity = counts.velocity, n_nodes = counts.mesh;
      const auto    V        = read_numbers(group, "V", {hdf5::any, n_velocity, 3});
      const auto    n        = n_velocity == 0 ? 0 : V.size() / (3 * n_velocity);
      const auto    P        = read_numbers(group, "P", {n, n_nodes});
      const auto    vertices = counts.quadratic() ? read_numbers(group, "vertices", {n, n_nodes, 3}) : P;
      const auto    active   = read_flags(group, "active", {n, n_pairs});

      std::vector<SolveRecord> solves(n);
      for (std::size_t s = 0; s < n; ++s)
      {
        solves[s].V = to_vectors(V.data() + s * 3 * n_velocity, n_velocity);
        if (counts.quadratic())
          solves[s].vertices = to_vectors(vertices.data() + s * 3 * n_nodes, n_nodes);
        solves[s].P.assign(P.begin() + s * n_nodes, P.begin() + (s + 1) * n_nodes);
        solves[s].active.assign(active.begin() + s * n_pairs, active.begin() + (s + 1) * n_pairs);
      }
      return solves;
    }
  } // namespace

  RecordShape::RecordShape(const RecordHeader &header) : die_facets(header.die_facets)
  {
    const TetMesh &mesh = header.mesh;
    Fingerprint    fingerprint;
    fingerprint.add(header.parameters.data(), header.parameters.size());
    fingerprint.add(header.X_0.data(), header.X_0.size() * sizeof(Vec3));
    fingerprint.add(mesh.cells.data(), mesh.cells.size() * sizeof(mesh.cells[0]));
    run = fingerprint.value;
  }

  std::string increment_name(const unsigned int i)
  {
    char name[32];
    std::snprintf(name, sizeof(name), "increment_%06u", i);
    return name;
  }

  void write_header(const hid_t file, const RecordHeader &header)
  {
    AssertDimension(header.X_0.size(), header.mesh.n_nodes());
    AssertDimension(header.die_fingerprints.size(), header.die_facets.size());
    const hdf5::Handle group = hdf5::create_group(file, "header");
    hdf5::write_attribute(group, "format", &format);
    hdf5::write_array(group, "die_facets", {header.die_facets.size()}, header.die_facets.data());
    hdf5::write_array(
      group, "die_fingerprints", {header.die_fingerprints.size()}, header.die_fingerprints.data());
    hdf5::write_string(group, "program", header.program);
    hdf5::write_string(group, "commit", header.commit);
    hdf5::write_string(group, "parameters", header.parameters);
    write_mesh(group, header.mesh);
    write_vectors(group, "X_0", header.X_0);
  }

  RecordHeader read_header(const hid_t file, const std::string &file_name)
  {
    const hdf5::Handle group        = hdf5::open_group(file, "header");
    const auto         found_format = hdf5::read_attribute<unsigned int>(group, "format");
    RecordHeader       header;
    header.program = hdf5::read_string(group, "program");
    header.commit  = hdf5::read_string(group, "commit");
    if (found_format != format)
      throw Error(file_name,
                  "has format " + std::to_string(found_format),
                  "this program reads format " + std::to_string(format),
                  "use retroforge " + header.program + " (" + header.commit +
                    "), which wrote it, or run the simulation again with --overwrite");
    header.parameters = hdf5::read_string(group, "parameters");
    header.die_facets = hdf5::read_array<unsigned int>(group, "die_facets", {hdf5::any});
    header.die_fingerprints =
      hdf5::read_array<std::uint64_t>(group, "die_fingerprints", {header.die_facets.size()});
    if (std::count(header.die_facets.begin(), header.die_facets.end(), 0u) > 0)
      throw hdf5::Failure("die_facets holds a die without facets");
    header.mesh = read_mesh(group);
    header.X_0  = read_vectors(group, "X_0", header.mesh.n_nodes());
    check_mesh(header.mesh, file_name);
    return header;
  }

  void write_increment(const hid_t            file,
                       const unsigned int     i,
                       const IncrementRecord &increment,
                       const RecordShape     &shape)
  {
    const NodeCounts   n     = check_increment(increment, shape);
    const hdf5::Handle group = hdf5::create_group(file, increment_name(i));
    hdf5::write_attribute(group, "run", &shape.run);
    hdf5::write_attribute(group, "operation", &increment.operation);
    hdf5::write_attribute(group, "stroke", &increment.stroke);
    hdf5::write_attribute(group, "step", &increment.step);
    hdf5::write_attribute(group, "cuts", &increment.cuts);
    hdf5::write_attribute(group, "deformation_energy", &increment.deformation_energy);
    hdf5::write_attribute(group, "friction_energy", &increment.friction_energy);
    hdf5::write_attribute(group, "closing_energy", &increment.closing_energy);
    hdf5::write_attribute(group, "closing_work", &increment.closing_work);
    hdf5::write_attribute(group, "n_nodes", &n.mesh);
    hdf5::write_attribute(group, "n_velocity_nodes", &n.velocity);
    hdf5::write_attribute(group, "newton", &increment.newton);
    hdf5::write_attribute(group, "krylov", &increment.krylov);
    hdf5::write_attribute(group, "linear_solves", &increment.linear_solves);
    hdf5::write_string(group, "scheme", increment.scheme);
    write_contact(group, increment.contact);
    write_hold(group, increment.hold, increment.hold_load);
    if (increment.parameters)
      hdf5::write_string(group, "parameters", *increment.parameters);
    write_vectors(group, "forces", increment.forces);
    write_pairs(group, increment.pairs);
    write_solves(group, increment.solves, n, increment.pairs.size());
    if (increment.remesh)
      write_remesh(group, *increment.remesh);
  }

  namespace
  {
    hdf5::Handle open_increment(const hid_t file, const unsigned int i, const RecordShape &shape)
    {
      hdf5::Handle group = hdf5::open_group(file, increment_name(i));
      if (hdf5::read_attribute<std::uint64_t>(group, "run") != shape.run)
        throw hdf5::Failure(increment_name(i) + " belongs to another run");
      return group;
    }

    IncrementHead read_head(const hid_t group)
    {
      return {hdf5::read_attribute<unsigned int>(group, "operation"),
              read_number(group, "stroke"),
              read_number(group, "step"),
              hdf5::has_link(group, "parameters") ? hdf5::read_string(group, "parameters")
                                                  : std::optional<std::string>()};
    }
  } // namespace

  IncrementHead read_increment_head(const hid_t file, const unsigned int i, const RecordShape &shape)
  {
    return read_head(open_increment(file, i, shape));
  }

  IncrementRecord read_increment(const hid_t file, const unsigned int i, const RecordShape &shape)
  {
    const hdf5::Handle group = open_increment(file, i, shape);
    IncrementHead      head  = read_head(group);
    IncrementRecord    increment;
    increment.operation                           = head.operation;
    increment.stroke                              = head.stroke;
    increment.step                                = head.step;
    increment.parameters                          = std::move(head.parameters);
    increment.scheme                              = hdf5::read_string(group, "scheme");
    increment.contact                             = read_contact(group);
    std::tie(increment.hold, increment.hold_load) = read_hold(group);
    increment.cuts                                = hdf5::read_attribute<unsigned int>(group, "cuts");
    increment.deformation_energy                  = read_number(group, "deformation_energy");
    increment.friction_energy                     = read_number(group, "friction_energy");
    increment.closing_energy                      = read_number(group, "closing_energy");
    increment.closing_work                        = read_number(group, "closing_work");
    increment.newton                              = hdf5::read_attribute<unsigned int>(group, "newton");
    increment.krylov                              = hdf5::read_attribute<unsigned int>(group, "krylov");
    increment.linear_solves = hdf5::read_attribute<unsigned int>(group, "linear_solves");
    increment.forces        = read_vectors(group, "forces", shape.die_facets.size());
    const NodeCounts n{hdf5::read_attribute<unsigned int>(group, "n_nodes"),
                       hdf5::read_attribute<unsigned int>(group, "n_velocity_nodes")};
    if (n.velocity < n.mesh)
      throw hdf5::Failure("there are fewer nodes of the velocity than of the mesh");
    increment.pairs  = read_pairs(group, shape, n);
    increment.solves = read_solves(group, n, increment.pairs.size());
    if (hdf5::has_link(group, "remesh"))
      increment.remesh = read_remesh(group, shape);
    if (increment.remesh && increment.remesh->mesh.n_nodes() != n.mesh)
      throw hdf5::Failure("the new mesh has " + std::to_string(increment.remesh->mesh.n_nodes()) +
                          " nodes, the solution on it " + std::to_string(n.mesh));
    return increment;
  }
} // namespace retroforge
