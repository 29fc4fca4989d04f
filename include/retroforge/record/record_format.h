// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/hdf5_tools.h>
#include <retroforge/record/increment_record.h>

#include <cstdint>
#include <string>

/// @file
/// What is in a record, object by object. Little endian; arrays in C order; n_* are counts.
///
///     /header                 attributes: format, n_patches
///       program commit parameters               text
///       die_facets            [n_dies]          uint32        facets of each die; 1 for a plane
///       die_fingerprints      [n_dies]          uint64        of the surface of each die
///       X X_0                 [n_nodes][3]      double [mm]   mesh when made, and at the start of the run
///       cells                 [n_cells][4]      uint32
///       faces                 [n_faces][4]      uint32        three nodes, patch
///       patch_0 ...           name; of a symmetry plane also the attributes point, normal  [3] double
///     /increment_000000 ...   attributes: run, n_nodes, n_velocity_nodes, operation, stroke, step, cuts,
///                             deformation_energy, friction_energy, closing_energy, closing_work, newton, krylov,
///                             linear_solves, sharp (the ramp is), counts_closing (energies do),
///                             contact [7] double: approach, layer, step, width of the ramp, edge_stiffness, part of
///                             the ramp's width at walls, recovery,
///                             n_held_motions and, where there are some,
///                             hold [7 + 6 n_held_motions] double: drag, force and moment that it bears, slide and
///                             turn of each motion
///       scheme                                  text          name of the time scheme
///       parameters                              text          only where other settings hold from here on
///       forces                [n_dies][3]             double [N]
///       V                     [n_solves][n_velocity_nodes][3]  double [mm/s]
///       vertices              [n_solves][n_nodes][3]  double [mm/s]  motion of the nodes, where it is not V
///       P                     [n_solves][n_nodes]     double [MPa]
///       pairs                 [n_pairs][4]            uint32  node, second node of an edge or 2^32 - 1,
///                                                             velocity node or 2^32 - 1, die
///       touching              [n_pairs]               uint8
///       facet                 [n_pairs]               uint32  of the die
///       kind                  [n_pairs]               uint8   0 face, 1-3 edge, 4-6 corner of the facet, 7
///                                                             its plane
///       active                [n_solves][n_pairs]     uint8
///       remesh                only of an increment that begins on a new mesh: that mesh as in the header
///         X_before            [n_old][3]              double [mm]   positions on the mesh before
///         attribute: repaired, volume of metal thinner than an element taken away [mm^3]
///         begin               [n_nodes + 1]           uint32        rows of J,
///         node weight         [n_entries]             uint32, double
///         positions           how X follow from X_before and the dies (position_tape.h), attribute: inputs
///           rules             [n_operations]          uint8
///           argument_begin number_begin  [n_operations + 1]  uint32
///           arguments numbers [n]                     uint32, double
///           results           [n_nodes]               uint32
///           planes            [n_planes][6]           double        point, normal
/// A finished file has at its root the attribute n_increments.
namespace retroforge
{
  /// What holds for a whole run.
  struct RecordHeader
  {
    std::string                program;    ///< version
    std::string                commit;     ///< of the program
    std::string                parameters; ///< the complete input
    std::vector<unsigned int>  die_facets; ///< number of facets of each die; 1 for a plane
    TetMesh                    mesh;
    NodalVectors<double>       X_0;              ///< positions at the start of the run [mm]
    std::vector<std::uint64_t> die_fingerprints; ///< of the surface of each die
  };

  /// What of an increment can be read without its arrays.
  struct IncrementHead
  {
    unsigned int               operation = 0;
    double                     stroke = 0., step = 0.; ///< [mm]
    std::optional<std::string> parameters;
  };

  /// What the increments of a run have in common.
  struct RecordShape
  {
    std::vector<unsigned int> die_facets; ///< as in the header
    std::uint64_t             run = 0; ///< fingerprint of the header: increments of different runs do not mix

    RecordShape() = default;
    explicit RecordShape(const RecordHeader &header);
  };

  std::string increment_name(unsigned int i); ///< increment_000000

  /// Into and out of an open file.  @throws hdf5::Failure; reading also Error, which names `file_name`
  void         write_header(hid_t file, const RecordHeader &header);
  RecordHeader read_header(hid_t file, const std::string &file_name);

  void            write_increment(hid_t file, unsigned int i, const IncrementRecord &, const RecordShape &);
  IncrementRecord read_increment(hid_t file, unsigned int i, const RecordShape &);
  IncrementHead   read_increment_head(hid_t file, unsigned int i, const RecordShape &);
} // namespace retroforge
