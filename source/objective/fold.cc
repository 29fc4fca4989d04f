// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/objective_settings.h>

#include <sstream>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Number strain_rate(const EquilibriumView<Number> &view, const CellIndex c)
    {
      const Scene &scene = view.stage.scene;
      return dispatch_element(scene.discretization, [&](const auto pair) -> Number {
        return cell_strain_rate(cell_geometry(pair.positions(scene.discretization, view.stage.X, c)),
                                pair.on_cell(scene.discretization, view.W, c));
      });
    }

    void reverse_strain_rate(const EquilibriumView<double> &view,
                             const CellIndex                c,
                             const double                   weight,
                             EquilibriumBar                &bar)
    {
      const Scene &scene = view.stage.scene;
      dispatch_element(scene.discretization, [&](const auto pair) {
        auto w_bar = pair.no_values();
        auto X_bar = pair.no_positions();
        reverse_cell_strain_rate(cell_geometry(pair.positions(scene.discretization, view.stage.X, c)),
                                 pair.on_cell(scene.discretization, view.W, c),
                                 weight,
                                 w_bar,
                                 X_bar);
        pair.add(scene.discretization, w_bar, c, bar.W);
        add_to_positions(scene.discretization, X_bar, c, bar.X);
      });
    }

    /// A face that counts.
    struct FreeFace
    {
      BoundaryFace face;
      CellIndex    cell;
      /// For each die in reach of all three nodes: their pairs.
      std::vector<std::array<unsigned int, 3>> touched;
    };

    template <typename Number>
    Number touching(const ContactSet<Number> &contact, const std::array<unsigned int, 3> &pairs)
    {
      return contact.ramps[pairs[0]] * contact.ramps[pairs[1]] * contact.ramps[pairs[2]];
    }

    template <typename Number>
    Number free_part(const ContactSet<Number> &contact, const FreeFace &free)
    {
      Number part(1.);
      for (const auto &pairs : free.touched)
        part *= Number(1. - touching(contact, pairs));
      return part;
    }

    void reverse_free_part(const ContactSet<double> &contact,
                           const FreeFace           &free,
                           const double              part_bar,
                           std::vector<double>      &ramp_bar)
    {
      for (const auto &pairs : free.touched)
      {
        double others = 1.;
        for (const auto &other : free.touched)
          if (&other != &pairs)
            others *= 1. - touching(contact, other);
        for (unsigned int c = 0; c < 3; ++c)
          ramp_bar[pairs[c]] -=
            part_bar * others * contact.ramps[pairs[(c + 1) % 3]] * contact.ramps[pairs[(c + 2) % 3]];
      }
    }

    /// (die, pair) of each node, by die.
    template <typename Number>
    std::vector<std::vector<std::pair<unsigned int, unsigned int>>>
    pairs_of_nodes(const Equilibrium<Number> &stage)
    {
      std::vector<std::vector<std::pair<unsigned int, unsigned int>>> pairs(stage.scene.mesh.n_nodes());
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
        if (const ContactPair &pair = stage.contact.pairs[p]; pair.point.is_node())
          pairs[pair.point.nodes[0]].emplace_back(pair.die, p);
      return pairs;
    }

    template <typename Number>
    Vector3<Number> centre_of(const BoundaryFace &face, const NodalVectors<Number> &X)
    {
      return (X[face.nodes[0]] + X[face.nodes[1]] + X[face.nodes[2]]) / Number(3.);
    }

    template <typename Number>
    Number weight_of(const std::optional<SmoothRegion> &region,
                     const BoundaryFace                &face,
                     const NodalVectors<Number>        &X)
    {
      return region ? (*region)(centre_of(face, X)) : Number(1.);
    }

    void reverse_weight(const std::optional<SmoothRegion> &region,
                        const BoundaryFace                &face,
                        const NodalVectors<double>        &X,
                        const double                       weight_bar,
                        NodalVectors<double>              &X_bar)
    {
      if (region)
        for (const NodeIndex k : face.nodes)
          X_bar[k] += weight_bar / 3. * region->gradient(centre_of(face, X));
    }

    /// The faces of this rank's cells, in the order of the mesh.
    template <typename Number>
    std::vector<FreeFace> free_faces(const EquilibriumView<Number>     &view,
                                     const std::optional<SmoothRegion> &region)
    {
      const Scene          &scene = view.stage.scene;
      const auto            pairs = pairs_of_nodes(view.stage);
      std::vector<FreeFace> faces;
      for (const BoundaryFace &face : scene.mesh.faces)
      {
        if (!scene.mesh.is_surface(face) || value_of(weight_of(region, face, view.stage.X)) == 0.)
          continue;
        FreeFace free{face, cell_at(scene.topology, face), {}};
        if (!scene.discretization.cells().owns(free.cell))
          continue;
        for (const auto &[die, first] : pairs[face.nodes[0]])
          for (const auto &[die_1, second] : pairs[face.nodes[1]])
            for (const auto &[die_2, third] : pairs[face.nodes[2]])
              if (die == die_1 && die == die_2)
                free.touched.push_back({{first, second, third}});
        faces.push_back(std::move(free));
      }
      return faces;
    }
  } // namespace

  FoldIntegrals::FoldIntegrals(const double exponent, const std::optional<SmoothRegion> &region)
      : exponent_(exponent), region_(region)
  {
    if (!(exponent >= 1.))
      throw Error("Fold",
                  "the exponent is " + as_text(exponent),
                  "it must be at least 1, or material at rest has infinite derivatives",
                  "use 4 for the plain indicator, 2 to 4 for the dimensionless one");
    if (region)
      region->check("Fold");
  }

  template <typename Number>
  std::vector<Number> FoldIntegrals::operator()(const EquilibriumView<Number> &view) const
  {
    const Equilibrium<Number> &stage          = view.stage;
    const Discretization<3>   &discretization = stage.scene.discretization;
    std::vector<Number>        sums(3, Number(0.));
    for (const FreeFace &free : free_faces(view, region_))
    {
      const Number area = free_part(stage.contact, free) * weight_of(region_, free.face, stage.X) *
                          triangle_area(free.face.nodes, stage.X);
      sums[0] += area * power(strain_rate(view, free.cell), Number(exponent_));
      sums[1] += area;
    }
    for (const CellIndex c : discretization.cells().owned())
      sums[2] += strain_rate(view, c) / double(stage.scene.mesh.n_cells());
    return sums;
  }

  void FoldIntegrals::reverse(const EquilibriumView<double> &view,
                              const std::vector<double>     &weights,
                              EquilibriumBar                &bar) const
  {
    const Equilibrium<double> &stage          = view.stage;
    const Discretization<3>   &discretization = stage.scene.discretization;
    for (const FreeFace &free : free_faces(view, region_))
    {
      const double part = free_part(stage.contact, free), e = strain_rate(view, free.cell);
      const double inside  = weight_of(region_, free.face, stage.X);
      const double area    = triangle_area(free.face.nodes, stage.X);
      const double density = weights[0] * std::pow(e, exponent_) + weights[1];
      const double slope   = weights[0] * exponent_ * std::pow(e, exponent_ - 1.);
      reverse_triangle_area(free.face.nodes, stage.X, part * inside * density, bar.X);
      reverse_free_part(stage.contact, free, inside * area * density, bar.contact.ramp);
      reverse_weight(region_, free.face, stage.X, part * area * density, bar.X);
      if (const double e_bar = part * inside * area * slope; e_bar != 0.)
        reverse_strain_rate(view, free.cell, e_bar, bar);
    }
    if (weights[2] != 0.)
      for (const CellIndex c : discretization.cells().owned())
        reverse_strain_rate(view, c, weights[2] / stage.scene.mesh.n_cells(), bar);
  }

  std::string FoldObjective::unit() const
  {
    std::ostringstream unit;
    unit << "mm^2";
    if (exponent_ != 1.)
      unit << " s^" << 1. - exponent_;
    return unit.str();
  }

  template std::vector<double> FoldIntegrals::operator()(const EquilibriumView<double> &) const;
  template std::vector<Dual> FoldIntegrals::operator()(const EquilibriumView<Dual> &) const;

  namespace
  {
    template <typename Fold>
    struct FoldType : ObjectiveType
    {
      double         exponent = 4.;
      RegionSettings region;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter(
          "exponent", exponent, "alpha of the fold indicators. Units: none.", dealii::Patterns::Double(0.));
        region.add_parameters(prm);
      }

      void make(const std::string &where, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.scaling =
          std::is_same_v<Fold, FoldObjective> ? SymmetryScaling::part : SymmetryScaling::none;
        objective.path = std::make_unique<Fold>(exponent, region.make(where));
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker fold_type()
  {
    return {"fold", Choice<ObjectiveType>::make<FoldType<FoldObjective>>};
  }

  Choice<ObjectiveType>::Maker dimensionless_fold_type()
  {
    return {"dimensionless fold", Choice<ObjectiveType>::make<FoldType<DimensionlessFold>>};
  }
} // namespace retroforge
