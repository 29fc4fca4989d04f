// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>

#include <memory>

namespace retroforge
{
  /// The meshes of the billet that an optimisation forges on, one after the other: each is deformed to the
  /// designs that are tried, until its cells get too bad for it, or turn inside out wherever the search
  /// steps.
  class DesignMeshManager
  {
  public:
    /// @param first  the case that the optimisation begins with, which must live as long
    /// @param least_quality  of the cells, 0: any
    DesignMeshManager(const Case &first, double least_quality);

    const Case        &now() const { return now_ ? *now_ : first_; }
    const std::string &made_at() const { return made_at_; } ///< Design/meshed at; empty on the first mesh
    /// Number of the mesh among those used so far, the first one 0.
    unsigned int number() const { return number_; }

    /// Returns the quality of the worst cell where cells are at a design: see tet_quality().
    double quality(const std::vector<double> &mu) const { return now().design.mesh_quality(mu); }
    /// Returns the volume of the billet at a design [mm^3].
    double volume_at(const std::vector<double> &mu) const;

    /// Takes notice of a design that was tried.
    void tell(const std::vector<double> &mu, bool accepted, bool failed);

    /// Returns whether the mesh is to be renewed at a design, with a candidate that is better there.
    /// Collective.
    bool due(const std::vector<double> &mu);
    /// Why the last question was answered with no, where a new mesh was asked for.
    const std::string &complaint() const { return complaint_; }

    /// Another mesh for a design, before it is used.
    struct Candidate
    {
      std::unique_ptr<const Case> made;
      std::string                 made_at;
    };
    const Candidate &candidate() const { return candidate_; }
    void             use_candidate();
    /// Nothing is changed, nor asked for again at this design.
    void refuse_candidate(const std::vector<double> &mu);

  private:
    std::string meshed_at(const std::vector<double> &mu) const;
    void        make_candidate(const std::vector<double> &mu);

    const Case                 &first_;
    const double                least_quality_;
    std::unique_ptr<const Case> now_; ///< null: the first
    std::string                 made_at_;
    unsigned int                number_ = 0;
    Candidate                   candidate_;
    std::vector<double>         settled_at_; ///< design at which a new mesh does not help
    unsigned int n_inverted_ = 0;            ///< designs tried since the last accepted one whose cells were
    std::string  complaint_;
  };

  /// A case with some of its parameters set to other values, meshed anew at other designs. @throws Error
  std::unique_ptr<const Case> make_case(CommandLine command, const std::string &meshed_at, MPI_Comm comm);
} // namespace retroforge
