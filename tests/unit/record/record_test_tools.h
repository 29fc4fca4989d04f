// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>
#include <retroforge/record/record_file.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <sstream>

namespace retroforge
{
  inline std::string yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  /// Outer faces of the cells, turned outwards, on two patches: the plane x = 0, of symmetry, and the rest.
  inline void add_boundary(TetMesh &mesh)
  {
    constexpr unsigned int opposite[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    std::map<std::array<NodeIndex, 3>, std::vector<std::array<NodeIndex, 3>>> found;
    for (const auto &cell : mesh.cells)
      for (const auto &corners : opposite)
      {
        const std::array<NodeIndex, 3> face{{cell[corners[0]], cell[corners[1]], cell[corners[2]]}};
        auto                           key = face;
        std::sort(key.begin(), key.end());
        found[key].push_back(face);
      }
    mesh.patches = {{"x = 0", Plane{Vec3(), Vec3({-1., 0., 0.})}}, {"free, and \"die\"", {}}};
    for (const auto &[key, faces] : found)
      if (faces.size() == 1)
      {
        const bool is_free = mesh.X[key[0]][0] + mesh.X[key[1]][0] + mesh.X[key[2]][0] > 0.;
        mesh.faces.push_back({faces[0], is_free ? 1u : 0u});
      }
  }

  /// Unit cubes, a x b x c nodes, each split in six tetrahedra along its diagonal.
  inline TetMesh brick(const unsigned int a, const unsigned int b, const unsigned int c)
  {
    TetMesh mesh;
    for (unsigned int k = 0; k < c; ++k)
      for (unsigned int j = 0; j < b; ++j)
        for (unsigned int i = 0; i < a; ++i)
          mesh.X.push_back(Vec3({1. * i, 1. * j, 1. * k}));
    const NodeIndex        stride[3]   = {1, a, a * b};
    constexpr unsigned int paths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (unsigned int k = 0; k + 1 < c; ++k)
      for (unsigned int j = 0; j + 1 < b; ++j)
        for (unsigned int i = 0; i + 1 < a; ++i)
          for (unsigned int p = 0; p < 6; ++p)
          {
            const NodeIndex n0 = i + a * (j + b * k), n1 = n0 + stride[paths[p][0]],
                            n2 = n1 + stride[paths[p][1]], n3 = n2 + stride[paths[p][2]];
            mesh.cells.push_back(p < 3 ? std::array<NodeIndex, 4>{{n0, n1, n2, n3}}
                                       : std::array<NodeIndex, 4>{{n0, n2, n1, n3}});
          }
    add_boundary(mesh);
    return mesh;
  }

  inline RecordHeader sample_header(const TetMesh     &mesh,
                                    const std::string &parameters = "set K = 1\n# 5°, µ\n")
  {
    std::mt19937_64 random(7);
    RecordHeader    header{"0.1.0", "abc1234", parameters, {1, 96}, mesh, mesh.X, {random(), random()}};
    for (Vec3 &x : header.X_0)
      x *= 1.1;
    return header;
  }

  /// Increment i of a run, arbitrary but always the same: random numbers, every bit of them in use.
  inline IncrementRecord
  sample_increment(const RecordHeader &header, const unsigned int i, const unsigned int n_solves = 2)
  {
    std::mt19937_64 random(i + 1);
    const auto      number = [&]() { return std::ldexp(static_cast<double>(random()) - 9e18, -60); };
    IncrementRecord increment;
    increment.operation          = i / 3;
    increment.stroke             = 0.1 * i;
    increment.step               = 0.1;
    increment.cuts               = i % 3;
    increment.deformation_energy = number();
    increment.friction_energy    = number();
    increment.closing_energy     = number();
    increment.closing_work       = number();
    increment.newton             = i + 1;
    increment.krylov             = 10 * i;
    increment.linear_solves      = i + 2;
    if (i % 4 == 1)
      increment.parameters = "set K = 1\nset n = " + std::to_string(i) + "\n";
    increment.scheme  = i % 2 == 0 ? "midpoint" : "euler";
    increment.contact = {number(), number(), number(), {number(), i % 2 == 0}, number(), i % 3 != 1};
    const auto vector = [&]() { return Vec3({number(), number(), number()}); };
    for (unsigned int j = 0; j < i % 3; ++j)
      increment.hold.motions.push_back({vector(), vector()});
    if (!increment.hold.empty())
    {
      increment.hold.drag = number();
      increment.hold_load = {vector(), vector()};
    }
    for (unsigned int d = 0; d < header.die_facets.size(); ++d)
      increment.forces.push_back(Vec3({number(), number(), number()}));
    for (NodeIndex k = 0; k < header.mesh.n_nodes(); k += 3)
    {
      const ContactPoint point    = k % 2 == 0 ? ContactPoint::node(k) : ContactPoint::middle(k - 1, k);
      const unsigned int die      = random() % header.die_facets.size();
      const bool         touching = random() % 2 == 0;
      const unsigned int facet    = random() % header.die_facets[die];
      increment.pairs.push_back(
        {point, die, touching, {facet, static_cast<unsigned char>(random() % DieFeature::n_kinds)}});
    }
    for (unsigned int s = 0; s < n_solves; ++s)
    {
      SolveRecord solve;
      for (NodeIndex k = 0; k < header.mesh.n_nodes(); ++k)
      {
        solve.V.push_back(Vec3({number(), number(), number()}));
        solve.P.push_back(number());
      }
      for (std::size_t p = 0; p < increment.pairs.size(); ++p)
        solve.active.push_back(random() % 2);
      increment.solves.push_back(solve);
    }
    return increment;
  }

  /// The same on a new mesh, each node of which stands between two of the old one.
  inline IncrementRecord sample_remeshed(const RecordHeader &header, const unsigned int i)
  {
    RecordHeader other = header;
    other.mesh         = brick(2, 4, 3);
    for (Vec3 &x : other.mesh.X)
      x *= 1.05;
    auto remesh      = std::make_shared<RemeshRecord>();
    remesh->X_before = header.X_0;
    remesh->mesh     = other.mesh;
    auto &J          = remesh->transfer;
    J.n_old          = header.X_0.size();
    for (NodeIndex k = 0; k < other.mesh.n_nodes(); ++k)
    {
      J.node.insert(J.node.end(), {k, k + 1});
      J.weight.insert(J.weight.end(), {0.3, 0.7});
      J.begin.push_back(J.node.size());
    }
    J.set_offset(remesh->X_before, remesh->mesh.X);
    PositionTape &tape = remesh->positions;
    const auto    add  = [&](const PlacingRule                rule,
                         const std::vector<unsigned int> &arguments,
                         const std::vector<double>       &numbers) {
      tape.rules.push_back(static_cast<unsigned char>(rule));
      tape.arguments.insert(tape.arguments.end(), arguments.begin(), arguments.end());
      tape.numbers.insert(tape.numbers.end(), numbers.begin(), numbers.end());
      tape.argument_begin.push_back(tape.arguments.size());
      tape.number_begin.push_back(tape.numbers.size());
    };
    tape.n_inputs = header.X_0.size();
    tape.planes   = {{Vec3({0.1, 0.2, 0.3}), Vec3({0., 0., 1.})}};
    for (NodeIndex k = 0; k < other.mesh.n_nodes(); ++k)
    {
      add(PlacingRule::sum, {k, k + 1}, {0.3, 0.7, -1. / (k + 3.), 0.1 * k, 0.7});
      tape.results.push_back(tape.n_inputs + k);
    }
    add(PlacingRule::snap, {tape.n_inputs, 0}, {});
    add(PlacingRule::push_out, {tape.n_inputs, 0, 0, 0}, {});
    IncrementRecord increment = sample_increment(other, i);
    increment.remesh          = remesh;
    return increment;
  }

  template <typename T>
  bool same_bits(const std::vector<T> &a, const std::vector<T> &b)
  {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
  }

  inline bool same_bits(const double a, const double b)
  {
    return std::memcmp(&a, &b, sizeof(double)) == 0;
  }

  bool same(const TetMesh &a, const TetMesh &b);

  inline bool same(const PositionTape &a, const PositionTape &b)
  {
    bool equal = a.n_inputs == b.n_inputs && same_bits(a.rules, b.rules) &&
                 same_bits(a.argument_begin, b.argument_begin) && same_bits(a.number_begin, b.number_begin) &&
                 same_bits(a.arguments, b.arguments) && same_bits(a.numbers, b.numbers) &&
                 same_bits(a.results, b.results) && a.planes.size() == b.planes.size();
    for (std::size_t p = 0; equal && p < a.planes.size(); ++p)
      equal = a.planes[p].point == b.planes[p].point && a.planes[p].normal == b.planes[p].normal;
    return equal;
  }

  inline bool same(const RemeshRecord &a, const RemeshRecord &b)
  {
    return same_bits(a.X_before, b.X_before) && same(a.mesh, b.mesh) &&
           a.transfer.n_old == b.transfer.n_old && same_bits(a.transfer.begin, b.transfer.begin) &&
           same_bits(a.transfer.node, b.transfer.node) && same_bits(a.transfer.weight, b.transfer.weight) &&
           same_bits(a.transfer.offset, b.transfer.offset) && same(a.positions, b.positions);
  }

  inline bool same(const ContactNumerics &a, const ContactNumerics &b)
  {
    return same_bits(a.approach, b.approach) && same_bits(a.layer, b.layer) && same_bits(a.step, b.step) &&
           same_bits(a.ramp.width, b.ramp.width) && a.ramp.sharp == b.ramp.sharp &&
           same_bits(a.edge_stiffness, b.edge_stiffness) && same_bits(a.recovery, b.recovery) &&
           a.counts_closing == b.counts_closing;
  }

  inline bool same(const RigidHold &a, const RigidHold &b)
  {
    bool equal = same_bits(a.drag, b.drag) && a.motions.size() == b.motions.size();
    for (std::size_t j = 0; equal && j < a.motions.size(); ++j)
      equal = a.motions[j].slide == b.motions[j].slide && a.motions[j].turn == b.motions[j].turn;
    return equal;
  }

  inline bool same(const IncrementRecord &a, const IncrementRecord &b)
  {
    bool equal = a.operation == b.operation && same_bits(a.stroke, b.stroke) && same_bits(a.step, b.step) &&
                 a.cuts == b.cuts && same_bits(a.deformation_energy, b.deformation_energy) &&
                 same_bits(a.friction_energy, b.friction_energy) &&
                 same_bits(a.closing_energy, b.closing_energy) && same_bits(a.closing_work, b.closing_work) &&
                 a.newton == b.newton && a.krylov == b.krylov && a.linear_solves == b.linear_solves &&
                 same_bits(a.forces, b.forces) && a.parameters == b.parameters && a.scheme == b.scheme &&
                 same(a.contact, b.contact) && same(a.hold, b.hold) &&
                 a.hold_load.force == b.hold_load.force && a.hold_load.moment == b.hold_load.moment &&
                 !a.remesh == !b.remesh && (!a.remesh || same(*a.remesh, *b.remesh)) &&
                 a.pairs.size() == b.pairs.size() && a.solves.size() == b.solves.size();
    for (std::size_t p = 0; equal && p < a.pairs.size(); ++p)
      equal = a.pairs[p].point == b.pairs[p].point && a.pairs[p].die == b.pairs[p].die &&
              a.pairs[p].touching == b.pairs[p].touching && a.pairs[p].feature == b.pairs[p].feature;
    for (std::size_t s = 0; equal && s < a.solves.size(); ++s)
      equal = same_bits(a.solves[s].V, b.solves[s].V) && same_bits(a.solves[s].P, b.solves[s].P) &&
              same_bits(a.solves[s].active, b.solves[s].active);
    return equal;
  }

  inline bool same(const TetMesh &a, const TetMesh &b)
  {
    bool equal = same_bits(a.X, b.X) && same_bits(a.cells, b.cells) && same_bits(a.faces, b.faces) &&
                 a.patches.size() == b.patches.size();
    for (std::size_t p = 0; equal && p < a.patches.size(); ++p)
    {
      const Patch &q = a.patches[p], &r = b.patches[p];
      equal =
        q.name == r.name && q.symmetry.has_value() == r.symmetry.has_value() &&
        (!q.symmetry || (q.symmetry->point == r.symmetry->point && q.symmetry->normal == r.symmetry->normal));
    }
    return equal;
  }

  inline bool same(const RecordHeader &a, const RecordHeader &b)
  {
    return a.program == b.program && a.commit == b.commit && a.parameters == b.parameters &&
           a.die_facets == b.die_facets && a.die_fingerprints == b.die_fingerprints &&
           same_bits(a.X_0, b.X_0) && same(a.mesh, b.mesh);
  }

  inline std::string bytes_of(const std::string &file)
  {
    std::ifstream      in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }

  inline void write_bytes(const std::string &file, const std::string &bytes)
  {
    std::ofstream(file, std::ios::binary) << bytes;
  }

  /// A fresh, empty folder below the test's own.
  inline std::string fresh_folder(const std::string &name)
  {
    std::filesystem::remove_all(name);
    std::filesystem::create_directories(name);
    return name;
  }

  template <typename Action>
  void show_error(const std::string &title, const Action &action)
  {
    std::cout << title << ":\n  ";
    try
    {
      action();
      std::cout << "no error\n";
    }
    catch (const Error &error)
    {
      std::cout << error.what() << '\n';
    }
  }
} // namespace retroforge
