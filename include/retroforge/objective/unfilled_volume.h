// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/facet_gaps.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/target_surface.h>

namespace retroforge
{
  /// Volume of a cavity that the workpiece does not reach [mm^3]:
  ///   Phi = |C| - |W| - sum_f s_f v_f,
  /// C the cavity, what lies in front of a die, or within a shape, in its region (cavity.h); W the workpiece
  /// there; v_f the volume between a facet of it and a die it lies on, s_f the part of the facet in the region
  /// (facet_gaps.h).
  ///
  /// Before a die |W| is the workpiece's volume in the region, and C has the smooth surface that the facets of
  /// the die stand for, by the gaps at the middles of their edges; v_f sees to it that metal in the die fills
  /// no other place. Within a shape, W is what of the workpiece lies in C, tetrahedron by tetrahedron: metal
  /// outside (flash) does not count. Only the sector counts that symmetry planes left of the workpiece.
  ///
  /// Exact for flat walls, to fourth order in the facets' size for others. Frozen: the region without its
  /// mouth's place, from where its shadows are seen, which facets lie at the die, and the features they see.
  class UnfilledVolume : public FinalObjectiveOf<UnfilledVolume>
  {
  public:
    /// Before a die.
    /// @param index   number of the die in the scene
    /// @param region  or what lies behind the die's mouth
    UnfilledVolume(Die die, unsigned int index, const std::optional<Box> &region = {});

    /// Within a shape that stands still, its normals outwards.
    /// @throws Error  for an open shape without a region
    explicit UnfilledVolume(const TargetSurface &shape);

    std::string  name() const override { return "unfilled volume"; }
    std::string  unit() const override { return "mm^3"; }
    unsigned int target_die() const override { return index_; }

    /// Tetrahedra of the workpiece within a shape, or cut by it.
    struct Cell
    {
      CellIndex                 cell;
      bool                      eye_in_front; ///< whether a point of it is within the shape
      std::vector<unsigned int> facets;       ///< of the shape that may cut it
    };

    struct Decisions
    {
      Region                    region;
      std::vector<unsigned int> facets; ///< of the surface, that may be in the region: this rank's
      std::vector<Cell>         cells;  ///< this rank's
      std::vector<FacetAtDie>   at_die; ///< this rank's
    };

    /// @throws Error  where there is no cavity
    Decisions compute_decisions(const FinalView<double> &view) const;

    /// Returns |C|, |W|, and the sum over facets.
    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view, const Decisions &decisions) const;

    template <typename Number>
    Number combine(const std::vector<Number> &integrals, const Decisions &) const
    {
      return integrals[0] - integrals[1] - integrals[2];
    }

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &decisions,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

    std::map<std::string, double> parts(const std::vector<double> &integrals) const override
    {
      return {
        {"cavity", integrals[0]}, {"metal in it", -integrals[1]}, {"between facets and die", -integrals[2]}};
    }

    std::map<std::string, double> details(const std::vector<double> &integrals,
                                          const FinalDecisions &) const override
    {
      const double unfilled = integrals[0] - integrals[1] - integrals[2];
      return {{"of the cavity [%]", integrals[0] > 0. ? 100. * unfilled / integrals[0] : 0.}};
    }

  private:
    template <typename Number>
    struct Surface;

    bool is_within() const { return index_ == invalid_index; }

    Decisions decide_cells(const FinalView<double> &view, const Die &die, Decisions decisions) const;

    void reverse_cavity(const FinalView<double>         &view,
                        const Region                    &region,
                        const std::vector<unsigned int> &facets,
                        double                           weight,
                        FinalBar                        &bar) const;
    void reverse_cells(const FinalView<double> &view,
                       const Decisions         &decisions,
                       double                   weight,
                       FinalBar                &bar) const;
    void reverse_facets(const FinalView<double> &view,
                        const Decisions         &decisions,
                        double                   weight,
                        FinalBar                &bar) const;

    Die                die_; ///< a shape turned inside out
    unsigned int       index_;
    std::optional<Box> region_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker unfilled_volume_type();
} // namespace retroforge
