// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material_law.h>

#include <memory>

/// @file
/// The metal, whose law may differ from point to point: kernels take the MaterialLaw of their cell, and only
/// Material knows what it follows from. Sorts of metal, MaterialType, are chosen by name.
namespace retroforge
{
  /// The state of the metal at a point, as an increment finds it.
  template <typename Number>
  struct PointState
  {
    Number strain = Number(0.); ///< accumulated equivalent strain q, dimensionless

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[strain] = self;
      return std::tie(strain);
    }
  };

  /// The numbers of a metal, which are design parameters, and its sort.
  template <typename Number>
  struct Material
  {
    MaterialLaw<Number> law;      ///< law of metal in its initial state: q = 0
    std::vector<Number> numbers;  ///< further numbers of its type, by MaterialType::info
    unsigned int        type = 0; ///< sort of metal, as material_type() counts them; 0: Norton-Hoff

    Material() = default;
    Material(const MaterialLaw<Number> &law) : law(law) {}

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[law, numbers, type] = self;
      return std::tie(law, numbers, type);
    }

    /// Returns how users know its numbers, those of the law and those beyond, in their order.
    std::vector<NumberInfo> info() const;

    /// Tells whether the law at a point depends on the state there.
    bool depends_on_state() const;

    /// Returns the law at a point.
    MaterialLaw<Number> at(const PointState<Number> &state) const;
  };

  /// Adds the derivatives of a scalar in the numbers of the metal and the state of a point, where `law_bar`
  /// are those in the numbers of the law there: the chain through Material::at().
  void reverse_at(const Material<double>    &material,
                  const PointState<double>  &state,
                  const MaterialLaw<double> &law_bar,
                  Material<double>          &bar,
                  PointState<double>        &state_bar);

  /// A sort of metal: how the law at a point follows from the law of metal in its initial state, further
  /// numbers, and the state. Where that law is linear in the strain rate it stays so, since friction and
  /// Newton's method ask the initial one. Sorts derive from MaterialTypeOf.
  class MaterialType
  {
  public:
    virtual ~MaterialType() = default;

    /// Returns how users know the numbers beyond those of the law.
    virtual std::vector<NumberInfo> info() const { return {}; }

    /// Tells whether laws depend on the state: where they do not, no derivatives in it are carried.
    virtual bool depends_on_state() const { return true; }

    virtual MaterialLaw<double> law_at(const Material<double>   &material,
                                       const PointState<double> &state) const                             = 0;
    virtual MaterialLaw<Dual> law_at(const Material<Dual> &material, const PointState<Dual> &state) const = 0;
  };

  /// A MaterialType made from class Type, which has for any Number
  ///   MaterialLaw<Number> compute_law(const Material<Number> &, const PointState<Number> &) const;
  /// smooth in all of them. Derivatives come from dual numbers.
  template <typename Type>
  class MaterialTypeOf : public MaterialType
  {
  public:
    MaterialLaw<double> law_at(const Material<double>   &material,
                               const PointState<double> &state) const override
    {
      return static_cast<const Type &>(*this).compute_law(material, state);
    }
    MaterialLaw<Dual> law_at(const Material<Dual> &material, const PointState<Dual> &state) const override
    {
      return static_cast<const Type &>(*this).compute_law(material, state);
    }
  };

  /// Returns sort i, as Material::type counts them; 0 is Norton-Hoff, whose law is the same everywhere.
  const MaterialType &material_type(unsigned int i);

  /// Returns the number of the sort that a parameter file calls `name`.
  /// @param where  the setting that names it
  /// @throws Error  where there is none of this name
  unsigned int find_material_type(const std::string &name, const std::string &where);

  /// Adds a sort of metal to those there are, by a new name, before anything names it.
  void add_material_type(const std::string &name, std::unique_ptr<const MaterialType> type);
} // namespace retroforge
