// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/registry.h>
#include <retroforge/material/flow_stress_laws.h>

namespace retroforge
{
  namespace
  {
    class NortonHoffMetal : public MaterialTypeOf<NortonHoffMetal>
    {
    public:
      bool depends_on_state() const override { return false; }

      template <typename Number>
      MaterialLaw<Number> compute_law(const Material<Number> &material, const PointState<Number> &) const
      {
        return material.law;
      }
    };

    Registry<MaterialType> known_types()
    {
      Registry<MaterialType> types("law of the metal", "Norton-Hoff", std::make_unique<NortonHoffMetal>());
      types.add("power", std::make_unique<PowerMetal>());
      types.add("Hansel-Spittel", std::make_unique<HanselSpittelMetal>());
      types.add("table", std::make_unique<TableMetal>());
      return types;
    }

    Registry<MaterialType> &material_types()
    {
      static Registry<MaterialType> types = known_types();
      return types;
    }

    constexpr unsigned int norton_hoff = 0;
  } // namespace

  const MaterialType &material_type(const unsigned int i)
  {
    return material_types()[i];
  }

  unsigned int find_material_type(const std::string &name, const std::string &where)
  {
    return material_types().find(name, where);
  }

  void add_material_type(const std::string &name, std::unique_ptr<const MaterialType> type)
  {
    material_types().add(name, std::move(type));
  }

  template <typename Number>
  std::vector<NumberInfo> Material<Number>::info() const
  {
    std::vector<NumberInfo> all = MaterialLaw<Number>::info();
    for (const NumberInfo &number : material_type(type).info())
      all.push_back(number);
    return all;
  }

  template <typename Number>
  bool Material<Number>::depends_on_state() const
  {
    return type != norton_hoff && material_type(type).depends_on_state();
  }

  template <typename Number>
  bool Material<Number>::depends_on(const std::string &name) const
  {
    const auto of_law = MaterialLaw<Number>::info();
    if (std::none_of(of_law.begin(), of_law.end(), [&](const NumberInfo &of) { return of.name == name; }))
      return true;
    return initial_law().depends_on(name) && (name == "e0" || material_type(type).reads_consistency());
  }

  template <typename Number>
  MaterialLaw<Number> Material<Number>::at(const PointState<Number> &state) const
  {
    return type == norton_hoff ? law : material_type(type).law_at(*this, state);
  }

  template struct Material<double>;
  template struct Material<Dual>;

  void MaterialType::reverse_law_at(const Material<double>    &material,
                                    const PointState<double>  &state,
                                    const MaterialLaw<double> &law_bar,
                                    Material<double>          &bar,
                                    PointState<double>        &state_bar) const
  {
    auto       metal    = converted<Dual>(material);
    auto       point    = converted<Dual>(state);
    const auto pull_one = [&](Dual &x, double &x_bar) {
      x.fastAccessDx(0)           = 1.;
      const MaterialLaw<Dual> law = law_at(metal, point);
      x.fastAccessDx(0)           = 0.;
      for_each_number([&](const Dual &y, const double &y_bar) { x_bar += y_bar * y.dx(0); }, law, law_bar);
    };
    for_each_number(pull_one, metal.law, bar.law);
    for_each_number(pull_one, metal.numbers, bar.numbers);
    for_each_number(pull_one, point, state_bar);
  }

  void reverse_at(const Material<double>    &material,
                  const PointState<double>  &state,
                  const MaterialLaw<double> &law_bar,
                  Material<double>          &bar,
                  PointState<double>        &state_bar)
  {
    if (material.type == norton_hoff)
    {
      add_numbers(law_bar, bar.law);
      return;
    }
    bar.numbers.resize(material.numbers.size(), 0.);
    material_type(material.type).reverse_law_at(material, state, law_bar, bar, state_bar);
  }
} // namespace retroforge
