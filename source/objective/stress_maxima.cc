// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/stress_maxima.h>
#include <retroforge/solver/metal_stress.h>

#include <deal.II/base/mpi.h>

#include <limits>

namespace retroforge
{
  namespace
  {
    /// A stress and the place where it counts, with a share of the cell's volume.
    template <typename Number>
    struct Sample
    {
      Number          x; ///< [MPa]
      Vector3<Number> place;
    };

    template <typename Number>
    Number shear_stress(const CellStress<Number> &stress)
    {
      return Number(von_mises(stress.s) / std::sqrt(3.));
    }

    /// Returns what a cell is sampled by, all with the same share of its volume.
    template <typename Number>
    std::vector<Sample<Number>>
    samples(const EquilibriumView<Number> &view, const InnerStress stress, const CellIndex c)
    {
      const Discretization<3>    &discretization = view.stage.scene.discretization;
      const Four<Vector3<Number>> X              = positions_of_cell(discretization, view.stage.X, c);
      std::vector<Sample<Number>> all;
      if (stress == InnerStress::shear)
        all.push_back({shear_stress(cell_stress(view, c)), (X[0] + X[1] + X[2] + X[3]) * Number(0.25)});
      else
        for (unsigned int a = 0; a < 4; ++a)
          all.push_back({view.W.P.at_place(discretization.pressure_places(c)[a]), X[a]});
      return all;
    }

    /// Adds the derivatives that samples() takes back.
    void reverse_samples(const EquilibriumView<double>     &view,
                         const InnerStress                  stress,
                         const CellIndex                    c,
                         const std::vector<Sample<double>> &samples_bar,
                         EquilibriumBar                    &bar)
    {
      const Discretization<3> &discretization = view.stage.scene.discretization;
      const NodeIndex         *nodes          = discretization.geometry_nodes(c);
      if (stress == InnerStress::shear)
      {
        const auto shear = [](const auto &at) { return shear_stress(at); };
        if (const double weight = samples_bar[0].x; weight != 0.)
          reverse_cell_stress(view, c, derivatives(weight, shear, cell_stress(view, c)), bar);
        for (unsigned int a = 0; a < 4; ++a)
          bar.X[nodes[a]] += 0.25 * samples_bar[0].place;
      }
      else
        for (unsigned int a = 0; a < 4; ++a)
        {
          bar.W.P.at_place(discretization.pressure_places(c)[a]) += samples_bar[a].x;
          bar.X[nodes[a]] += samples_bar[a].place;
        }
    }
  } // namespace

  StressMaximum::StressMaximum(const InnerStress                  stress,
                               const double                       exponent,
                               const double                       reference,
                               const PathWindow                  &window,
                               const std::optional<SmoothRegion> &region)
      : PathMaximumOf("Largest stress", exponent, reference, window), stress_(stress), region_(region)
  {
    if (region)
      region->check("Largest stress");
  }

  std::string StressMaximum::name() const
  {
    return stress_ == InnerStress::pressure ? "largest hydrostatic pressure" : "largest shear";
  }

  std::map<std::string, double> StressMaximum::details(const PathRows<double> &rows) const
  {
    double largest = 0.;
    for (const PathRow<double> &row : rows)
      if (window().overlap(row) > 0.)
        largest = std::max(largest, row.integrals[2]);
    return {{"true maximum", largest}};
  }

  template <typename Number>
  std::vector<Number> StressMaximum::compute_integrals(const EquilibriumView<Number> &view) const
  {
    const Discretization<3> &discretization = view.stage.scene.discretization;
    std::vector<Number>      sums(3, Number(0.));
    double                   largest = 0.;
    for (const CellIndex c : discretization.cells().owned())
    {
      const auto   of_cell = samples(view, stress_, c);
      const Number share = geometry_of_cell(discretization, view.stage.X, c).volume / double(of_cell.size());
      for (const Sample<Number> &sample : of_cell)
      {
        const Number volume = share * weight_in(region_, sample.place);
        if (value_of(volume) == 0.)
          continue;
        sums[1] += volume;
        if (value_of(sample.x) <= 0.)
          continue;
        sums[0] += volume * raised(sample.x);
        largest = std::max(largest, double(value_of(sample.x)));
      }
    }
    // A maximum is no sum: one rank has it.
    largest = dealii::Utilities::MPI::max(largest, discretization.comm());
    if (dealii::Utilities::MPI::this_mpi_process(discretization.comm()) == 0)
      sums[2] = Number(largest);
    return sums;
  }

  void StressMaximum::reverse_integrals(const EquilibriumView<double> &view,
                                        const std::vector<double>     &weights,
                                        EquilibriumBar                &bar) const
  {
    const Discretization<3> &discretization = view.stage.scene.discretization;
    if (weights[0] == 0. && weights[1] == 0.)
      return;
    for (const CellIndex c : discretization.cells().owned())
    {
      const auto                  of_cell  = samples(view, stress_, c);
      const CellGeometry<double>  geometry = geometry_of_cell(discretization, view.stage.X, c);
      const double                part     = 1. / double(of_cell.size());
      std::vector<Sample<double>> samples_bar;
      double                      volume_bar = 0.;
      for (const auto &[x, place] : of_cell)
      {
        const double inside  = weight_in(region_, place);
        const double density = weights[0] * raised(x) + weights[1];
        volume_bar += part * inside * density;
        const double volume = part * geometry.volume;
        samples_bar.push_back({volume * inside * weights[0] * slope(x),
                               region_ ? Vec3(volume * density * region_->gradient(place)) : Vec3()});
      }
      reverse_samples(view, stress_, c, samples_bar, bar);
      Four<Vec3> X_bar = {};
      reverse_cell_geometry(geometry, volume_bar, Four<Vec3>(), X_bar);
      add_to_positions(discretization, X_bar, c, bar.X);
    }
  }

  template std::vector<double> StressMaximum::compute_integrals(const EquilibriumView<double> &) const;
  template std::vector<Dual>   StressMaximum::compute_integrals(const EquilibriumView<Dual> &) const;

  namespace
  {
    template <InnerStress stress>
    struct StressMaximumType : ObjectiveType
    {
      double         sharpness = 20.;
      WindowSettings window;
      RegionSettings region;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        add_sharpness(prm, sharpness);
        window.add_parameters(prm);
        region.add_parameters(prm);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.path = std::make_unique<StressMaximum>(
          stress, sharpness, context.consistency, window.make(where, context), region.make(where));
        if (stress == InnerStress::pressure)
          objective.least = -std::numeric_limits<double>::infinity();
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker largest_hydrostatic_pressure_type()
  {
    return {"largest hydrostatic pressure",
            Choice<ObjectiveType>::make<StressMaximumType<InnerStress::pressure>>};
  }

  Choice<ObjectiveType>::Maker largest_shear_type()
  {
    return {"largest shear", Choice<ObjectiveType>::make<StressMaximumType<InnerStress::shear>>};
  }
} // namespace retroforge
