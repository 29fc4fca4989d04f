// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/material/material.h>

#include <algorithm>
#include <deque>

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

    struct NamedType
    {
      std::string                         name;
      std::unique_ptr<const MaterialType> type;
    };

    /// The sorts there are, by the names that parameter files have for them.
    std::deque<NamedType> &material_types()
    {
      static std::deque<NamedType> types = [] {
        std::deque<NamedType> made;
        made.push_back({"Norton-Hoff", std::make_unique<NortonHoffMetal>()});
        return made;
      }();
      return types;
    }

    std::vector<std::string> names_of_types()
    {
      std::vector<std::string> names;
      for (const NamedType &known : material_types())
        names.push_back(known.name);
      return names;
    }

    constexpr unsigned int norton_hoff = 0;
  } // namespace

  const MaterialType &material_type(const unsigned int i)
  {
    AssertIndexRange(i, material_types().size());
    return *material_types()[i].type;
  }

  unsigned int find_material_type(const std::string &name, const std::string &where)
  {
    const std::vector<std::string> names = names_of_types();
    const auto                     found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
    {
      const std::string near = nearest_name(name, names, tolerated_edits(name));
      throw Error(where,
                  "'" + name + "' is no law of the metal",
                  "there are: " + join(names),
                  near.empty() ? "name one of these" : "did you mean '" + near + "'?");
    }
    return found - names.begin();
  }

  void add_material_type(const std::string &name, std::unique_ptr<const MaterialType> type)
  {
    Assert(type != nullptr, dealii::ExcMessage("no sort of metal"));
    for (const std::string &known : names_of_types())
      AssertThrow(known != name, dealii::ExcMessage("there is a law of the metal of this name"));
    material_types().push_back({name, std::move(type)});
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
  MaterialLaw<Number> Material<Number>::at(const PointState<Number> &state) const
  {
    return type == norton_hoff ? law : material_type(type).law_at(*this, state);
  }

  template struct Material<double>;
  template struct Material<Dual>;

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
    auto       metal    = converted<Dual>(material);
    auto       point    = converted<Dual>(state);
    const auto pull_one = [&](Dual &x, double &x_bar) {
      x.fastAccessDx(0)           = 1.;
      const MaterialLaw<Dual> law = metal.at(point);
      x.fastAccessDx(0)           = 0.;
      for_each_number([&](const Dual &y, const double &y_bar) { x_bar += y_bar * y.dx(0); }, law, law_bar);
    };
    for_each_number(pull_one, metal, bar);
    for_each_number(pull_one, point, state_bar);
  }
} // namespace retroforge
