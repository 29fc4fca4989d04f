// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/choice.h>
#include <retroforge/geometry/die.h>
#include <retroforge/geometry/die_free_form_parameters.h>
#include <retroforge/geometry/die_shapes.h>
#include <retroforge/geometry/rotations.h>

#include <deal.II/base/tensor.h>

#include <optional>

namespace retroforge
{
  /// Name and position of a die.
  struct DiePlace
  {
    std::string name;
    std::string section; ///< for messages
    Vec3        point;
    Vec3        facing; ///< unit vector
  };

  /// A kind of die by its shape: the settings it reads, and the die made of them.
  class DieKind
  {
  public:
    virtual ~DieKind() = default;

    virtual void add_parameters(dealii::ParameterHandler &) {}

    /// @param chosen  name of the kind the die is of, this one or another     @throws Error
    virtual void check([[maybe_unused]] const std::string &section,
                       [[maybe_unused]] const std::string &chosen) const
    {
    }

    /// @throws Error  for a file or measures that make no surface
    virtual Die make(const DiePlace &place) const = 0;

    /// Returns the depth of contact, where the user sets it [mm].
    virtual std::optional<double> depth_of_contact() const { return {}; }

    /// Returns the free form of dies whose vertices can move, else null.
    virtual const DieFreeFormParameters *free_form() const { return nullptr; }

    /// The measures that a design can vary.
    virtual std::map<std::string, Measure> measures() const { return {}; }

    /// Vertices where the die stands at the start, some of its measures changed; always as many as it has.
    /// @throws Error  for measures that do not fit each other
    virtual NodalVectors<double> vertices(const DiePlace                      &place,
                                          const std::map<std::string, double> &changed) const;
    virtual NodalVectors<Dual>   vertices(const DiePlace                    &place,
                                          const std::map<std::string, Dual> &changed) const;
  };

  /// The table of kinds: to add one, add a line to it.
  const Choice<DieKind>::Makers &die_kinds();

  /// A die of facets.
  class SurfaceDie : public DieKind
  {
  public:
    enum class Surface
    {
      smooth, ///< facets stand for a smooth surface, interpolated between their corners
      facets  ///< the surface is its facets
    };

    double depth = 0.; ///< 0: a tenth of the surface's diagonal [mm]

    Surface surface_law     = Surface::smooth;
    double  feature_angle   = 25.;  ///< [degrees]
    double  largest_sagitta = 3e-3; ///< part of the surface's diagonal

    Rotations rotations; ///< for a die by measures only the angle, about its own axis

    DieFreeFormParameters free_form_parameters;

    void                  add_parameters(dealii::ParameterHandler &prm) override;
    void                  check(const std::string &section, const std::string &chosen) const override;
    Die                   make(const DiePlace &place) const override;
    std::optional<double> depth_of_contact() const override
    {
      return depth > 0. ? std::optional(depth) : std::nullopt;
    }

    const DieFreeFormParameters *free_form() const override { return &free_form_parameters; }

  protected:
    void add_angle(dealii::ParameterHandler &prm);

    /// Returns the surface at the die's place.
    virtual TriangleSurface surface(const DiePlace &place) const = 0;
  };

  /// The surface of an STL file as drawn, scaled, turned by its rotations and moved by the place's point;
  /// `facing` only says along which way `die NAME/offset` moves it.
  class StlDie : public SurfaceDie
  {
  public:
    std::string file;
    double      scale = 1.;

    void add_parameters(dealii::ParameterHandler &prm) override;
    void check(const std::string &section, const std::string &chosen) const override;

  protected:
    TriangleSurface surface(const DiePlace &place) const override;
  };

  /// A die made from measures, which has its origin at the place's point and its z axis along `facing`,
  /// turned about it by an angle: x' = point + R x, R the rotation that takes z to `facing` the short way
  /// (for facing = -z: half a turn about the x axis) after the turn about z.
  template <template <typename> class Shape>
  class CavityDie : public SurfaceDie
  {
  public:
    double        chord_error = 0.05; ///< [mm]
    Shape<double> shape;

    void                           add_parameters(dealii::ParameterHandler &prm) override;
    std::map<std::string, Measure> measures() const override;
    NodalVectors<double>           vertices(const DiePlace                      &place,
                                            const std::map<std::string, double> &changed) const override;
    NodalVectors<Dual>             vertices(const DiePlace                    &place,
                                            const std::map<std::string, Dual> &changed) const override;

  protected:
    TriangleSurface surface(const DiePlace &place) const override;

  private:
    template <typename Number>
    ShapeMesh<Number>
    mesh(const DiePlace &place, const std::map<std::string, Number> &changed, Segments &segments) const;
    template <typename Number>
    NodalVectors<Number> changed_vertices(const DiePlace                      &place,
                                          const std::map<std::string, Number> &changed) const;
  };

  using TripodDie = CavityDie<TripodShape>;
  using BellDie   = CavityDie<BellShape>;
  using GearDie   = CavityDie<GearShape>;
  using PunchDie  = CavityDie<PunchShape>;
} // namespace retroforge
