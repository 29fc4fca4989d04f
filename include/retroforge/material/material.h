// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/damage_law.h>
#include <retroforge/material/flow_table.h>
#include <retroforge/material/material_law.h>

#include <memory>

/// @file
/// The metal, whose law may differ from point to point: kernels take the MaterialLaw of their cell, and only
/// Material knows what it follows from. Sorts of metal, MaterialType, are chosen by name.
namespace retroforge
{
  /// The state of the metal at a point, as a stage of an increment finds it.
  template <typename Number>
  struct PointState
  {
    Number strain      = Number(0.); ///< accumulated equivalent strain q, dimensionless
    Number temperature = Number(0.); ///< T [C]

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[strain, temperature] = self;
      return std::tie(strain, temperature);
    }
  };

  /// The numbers of a metal, which are design parameters, and its sort.
  template <typename Number>
  struct Material
  {
    MaterialLaw<Number> law;      ///< K, m and e0, of which the sort makes the law at a point
    std::vector<Number> numbers;  ///< further numbers of its type, by MaterialType::info
    PointState<Number>  initial;  ///< the metal's before the stroke
    unsigned int        type = 0; ///< sort of metal, as material_type() counts them; 0: Norton-Hoff
    std::shared_ptr<const FlowTable> table  = {}; ///< of a sort that has one
    unsigned int                     damage = 0;  ///< a Damage

    Material() = default;
    Material(const MaterialLaw<Number> &law) : law(law) {}

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[law, numbers, initial, type, table, damage] = self;
      return std::tie(law, numbers, initial, type, table, damage);
    }

    /// Returns how users know its numbers, those of the law and those beyond, in their order.
    std::vector<NumberInfo> info() const;

    /// Tells whether the law at a point depends on the state there.
    bool depends_on_state() const;

    /// Tells whether the workpiece has a damage in each cell.
    bool is_damaged() const { return damage != static_cast<unsigned int>(Damage::none); }

    /// Tells whether the stress depends on the number with a name of info().
    bool depends_on(const std::string &name) const;

    /// Returns the law at a point.
    MaterialLaw<Number> at(const PointState<Number> &state) const;

    /// Returns the law of the metal before the stroke: by it forces and rates are estimated.
    MaterialLaw<Number> initial_law() const { return at(initial); }
  };

  /// Adds the derivatives of a scalar in the numbers of the metal and the state of a point, where `law_bar`
  /// are those in the numbers of the law there: the chain through Material::at().
  void reverse_at(const Material<double>    &material,
                  const PointState<double>  &state,
                  const MaterialLaw<double> &law_bar,
                  Material<double>          &bar,
                  PointState<double>        &state_bar);

  /// Adds the derivatives of a scalar in the numbers of the metal, its initial state included: the chain
  /// through Material::initial_law().
  inline void reverse_initial_law(const Material<double>    &material,
                                  const MaterialLaw<double> &law_bar,
                                  Material<double>          &bar)
  {
    reverse_at(material, material.initial, law_bar, bar, bar.initial);
  }

  /// A sort of metal: how the law at a point follows from K, m and e0, further numbers, and the state. Where
  /// m is 1 in one state it is so in all, since Newton's method asks the initial one. Sorts derive from
  /// MaterialTypeOf.
  class MaterialType
  {
  public:
    virtual ~MaterialType() = default;

    /// Returns how users know the numbers beyond those of the law.
    virtual std::vector<NumberInfo> info() const { return {}; }

    /// Tells whether laws depend on the state: where they do not, no derivatives in it are carried.
    virtual bool depends_on_state() const { return true; }

    /// Tells whether they depend on the temperature, with the numbers that a metal has.
    virtual bool depends_on_temperature(const Material<double> &) const { return false; }

    /// Tells whether Material::table is read.
    virtual bool reads_table() const { return false; }

    /// Tells whether K and m are numbers of the metal: else they follow from other numbers alone.
    virtual bool reads_consistency() const { return true; }

    virtual MaterialLaw<double> law_at(const Material<double>   &material,
                                       const PointState<double> &state) const                             = 0;
    virtual MaterialLaw<Dual> law_at(const Material<Dual> &material, const PointState<Dual> &state) const = 0;

    /// Adds the derivatives of the law at a point, as reverse_at() says: column by column, from dual numbers. Sorts whose
    /// own is short have it in closed form, which is what the time of a sweep asks for.
    virtual void reverse_law_at(const Material<double>    &material,
                                const PointState<double>  &state,
                                const MaterialLaw<double> &law_bar,
                                Material<double>          &bar,
                                PointState<double>        &state_bar) const;
  };

  /// A MaterialType made from class Type, which has for any Number
  ///   MaterialLaw<Number> compute_law(const Material<Number> &, const PointState<Number> &) const;
  /// smooth in all of them.
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
