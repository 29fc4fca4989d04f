// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/timer.h>
#include <retroforge/record/increment_record.h>
#include <retroforge/remeshing/error_sizes.h>
#include <retroforge/remeshing/gap_sizes.h>
#include <retroforge/remeshing/local_remesher.h>
#include <retroforge/remeshing/size_field.h>
#include <retroforge/remeshing/uncross.h>

#include <optional>

#include <mpi.h>

namespace retroforge
{
  struct RemesherParameters
  {
    enum class When
    {
      never,
      quality,   ///< when cells are bad or the surface no longer fits a die
      increments ///< as with quality, and after every so many increments
    };
    enum class Method
    {
      local,  ///< only where the mesh is bad, and from the surface where cells are inverted
      rebuild ///< from the surface each time
    };
    enum class Sizes
    {
      uniform,
      dies, ///< shorter edges near curved dies
      error ///< as with dies, elsewhere by the indicated error
    };

    When                when           = When::quality;
    Method              method         = Method::local;
    unsigned int        every          = 5;
    double              element_size   = 0.;
    Sizes               sizes          = Sizes::dies;
    double              chord_error    = 0.;
    double              smallest_size  = 0.2;
    double              largest_size   = 4.;
    double              growth         = 0.3;
    double              gap_elements   = 0.; ///< over the thickness of a narrow gap; 0: gaps do not count
    double              fit            = 0.1;
    double              largest_repair = 5e-4; ///< of the workpiece's volume, over the run
    bool                first_mesh     = false;
    RemeshingParameters local;

    void add_parameters(dealii::ParameterHandler &prm);
    void check() const;
    bool enabled() const { return when != When::never; }
  };

  /// Decides when the mesh is to be remade, and remakes it: locally, or where that cannot be (inverted
  /// cells), from its surface, followed by a local pass.
  class Remesher
  {
  public:
    /// States of all dies.
    using DieStates = std::vector<DieState<double>>;

    /// @param element_size  wanted length of the edges away from curved dies [mm]
    /// @param patches  of the workpiece: its symmetry planes count
    Remesher(const RemesherParameters &parameters,
             double                    element_size,
             const std::vector<Die>   &dies,
             const std::vector<Patch> &patches,
             MPI_Comm                  comm);

    double largest_repair() const { return parameters_.largest_repair; }

    bool enabled() const { return parameters_.enabled(); }

    /// @param frozen      cells that the last remeshing could not make better, see frozen_cells()
    /// @param increments  since the last remeshing
    /// @param first       true before the first increment: then the mesh may be too coarse for its dies
    bool due(const TetMesh              &mesh,
             const NodalVectors<double> &X,
             const DieStates            &states,
             const std::vector<bool>    &frozen,
             unsigned int                increments,
             bool                        first) const;

    /// Returns whether sizes follow indicated errors.
    bool follows_errors() const { return parameters_.sizes == RemesherParameters::Sizes::error; }

    /// Returns the bounds of sizes that follow errors.
    SizeBounds error_size_bounds() const;

    /// Returns whether a mesh is to be remade because its errors ask for other sizes.
    /// @param increments  since the last remeshing
    /// @param first       true after the first increment: the first mesh was made without errors
    static bool worthwhile(const OptimalSizes &sizes, unsigned int increments, bool first);

    /// Returns the cells of a new mesh that remeshing cannot make better.
    std::vector<bool> frozen(const TetMesh &mesh) const;

    /// Collective: made on rank 0, the same everywhere. Numbered with renumber().
    /// @param repairable  volume of slivers at the surface that may be removed [mm^3], see without_slivers()
    /// @param errors      sizes that follow indicated errors, where these are known
    /// @param timings     the scope "transfer" gets the time to find J
    /// @throws Error  when no method gives a sound mesh
    std::shared_ptr<const RemeshRecord> remesh(const TetMesh                     &mesh,
                                               const NodalVectors<double>        &X,
                                               const DieStates                   &states,
                                               const std::optional<OptimalSizes> &errors,
                                               double                             repairable,
                                               Timings                           &timings) const;

    /// Returns whether a surface that crosses itself can be repaired, because the crossing parts are thinner
    /// than an element.
    bool repairs(const TetMesh &mesh, const NodalVectors<double> &X, const DieStates &states) const
    {
      return uncross(mesh, X, size_field(mesh, X, states)).has_value();
    }

    /// Returns the wanted length of edges: near a curved die by its curvature, elsewhere, and where it is
    /// shorter, by errors. Refers to this object.
    /// @param errors  null: the element size
    SizeField size_field(const DieStates &states, std::shared_ptr<const ErrorSizes> errors = {}) const;

    /// Returns that, or what narrow gaps between dies ask for where this is shorter. For the inside of a mesh
    /// and close to it.
    SizeField size_field(const TetMesh                    &mesh,
                         const NodalVectors<double>       &X,
                         const DieStates                  &states,
                         std::shared_ptr<const ErrorSizes> errors = {}) const;

    /// Returns whether a surface edge at a curved die, or in a narrow gap, is much longer than wanted there.
    bool too_coarse(const TetMesh &mesh, const NodalVectors<double> &X, const DieStates &states) const;

    /// Returns the largest depth inside a die of the middles of surface edges whose ends touch it [mm].
    double misfit(const TetMesh &mesh, const NodalVectors<double> &X, const DieStates &states) const;

  private:
    double smallest_size() const { return parameters_.smallest_size * element_size_; }
    double largest_size() const;
    bool   has_narrow_gap(const TetMesh &mesh, const NodalVectors<double> &X, const DieStates &states) const;
    RemeshedMesh make(const TetMesh              &mesh,
                      const NodalVectors<double> &X,
                      const SizeField            &size,
                      const DieStates            &states,
                      double                      repairable,
                      double                     &removed_volume,
                      TapeWriter                 &tape) const;
    PushOut      push_out(const DieStates &states) const;
    TouchesDie   touches(const DieStates &states) const;

    RemesherParameters                     parameters_;
    double                                 element_size_;
    const std::vector<Die>                &dies_;
    MPI_Comm                               comm_;
    std::vector<std::optional<GradedSize>> near_die_; ///< of each curved die, in its first position
    GapSizes                               gaps_;
  };
} // namespace retroforge
