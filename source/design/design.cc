// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/design/design.h>
#include <retroforge/geometry/closing_speed.h>

namespace retroforge
{
  namespace
  {
    using Kind = DesignParameter::Kind;

    Dual with_direction(const double value, const double direction)
    {
      Dual x(value);
      x.fastAccessDx(0) = direction;
      return x;
    }

    /// A coefficient of friction as dies have it: 0 is next to none instead. No friction is left out of all equations, and
    /// of their derivatives; this is not felt in forces, and has its slope.
    template <typename Number>
    Number felt(const Number &friction)
    {
      constexpr double next_to_none = 1e-9;
      return value_of(friction) == 0. ? Number(friction + next_to_none) : friction;
    }

    std::vector<Dual> along(const std::vector<double> &mu, const unsigned int j)
    {
      std::vector<Dual> dual;
      for (unsigned int i = 0; i < mu.size(); ++i)
        dual.push_back(with_direction(mu[i], i == j ? 1. : 0.));
      return dual;
    }

    /// The node that is farthest against the facing of a die that follows the billet; else invalid_index.
    NodeIndex followed_node(const DieParameters &die, const NodalVectors<double> &X)
    {
      if (!die.follows_billet)
        return invalid_index;
      const auto lower = [&](const Vec3 &a, const Vec3 &b) { return a * die.facing < b * die.facing; };
      return std::min_element(X.begin(), X.end(), lower) - X.begin();
    }

    std::vector<Plane> symmetry_planes(const TetMesh &mesh)
    {
      std::vector<Plane> planes;
      for (const Patch &patch : mesh.patches)
        if (patch.symmetry)
          planes.push_back(*patch.symmetry);
      return planes;
    }

    double extent_in_x(const NodalVectors<double> &X)
    {
      const auto [low, high] = bounding_box(X);
      return high[0] - low[0];
    }
  } // namespace

  Design::Design(const std::vector<std::string>   &names,
                 const BilletParameters           &billet,
                 const std::vector<DieParameters> &dies,
                 const Process<double>            &nominal_process,
                 const OpenContact                &contact,
                 const FirstMesh                  &first)
      : dies_(dies)
      , process_(nominal_process)
      , contact_(contact)
      , billet_map_(billet, first)
      , nominal_X_(billet_map_.nominal_positions())
      , width_(billet.is_from_file() ? extent_in_x(nominal_X_) : billet.whole_width())
  {
    for (const DieParameters &die : dies_)
    {
      followed_.push_back(followed_node(die, nominal_X_));
      die_forms_.emplace_back(die, symmetry_planes(first.mesh));
    }
    const std::vector<DesignParameter> all = offered();
    for (const std::string &name : expanded(names))
    {
      check_offered(name, "Design/parameters");
      const DesignParameter &parameter = *std::find_if(
        all.begin(), all.end(), [&](const DesignParameter &other) { return other.name == name; });
      if (parameter.kind == Kind::friction && parameter.die == invalid_index)
        check_common_friction();
      for (const DesignParameter &other : parameters_)
        if (parameter.overlaps(other))
          throw Error("Design/parameters",
                      "'" + name + "' and '" + other.name + "' set the same number",
                      "parameters must be independent",
                      "leave one of them out");
      parameters_.push_back(parameter);
    }
  }

  std::vector<double> Design::nominal() const
  {
    std::vector<double> mu;
    for (const auto &parameter : parameters_)
      mu.push_back(parameter.nominal);
    return mu;
  }

  namespace
  {
    void check_value(const DesignParameter &parameter, const double value)
    {
      const bool in_range = parameter.is_free() || ((value > 0. || (parameter.may_vanish && value == 0.)) &&
                                                    value <= parameter.largest);
      if (!std::isfinite(value) || !in_range)
        throw Error("Design/at",
                    "gives " + parameter.name + " the value " + as_text(value),
                    std::isfinite(parameter.largest)
                      ? "it lies above 0 and up to " + as_text(parameter.largest)
                    : parameter.may_vanish ? "it is not negative"
                                           : "it is positive",
                    "stay closer to the nominal value, " + as_text(parameter.nominal));
    }
  } // namespace

  std::vector<double> Design::at(const std::multimap<std::string, double> &values) const
  {
    std::vector<double> mu = nominal();
    for (unsigned int j = 0; j < parameters_.size(); ++j)
      if (const auto found = values.find(parameters_[j].name); found != values.end())
      {
        if (values.count(parameters_[j].name) > 1)
          throw Error("Design/at",
                      "'" + parameters_[j].name + "' stands twice",
                      "each parameter has one value",
                      "leave one of them out");
        check_value(parameters_[j], found->second);
        mu[j] = found->second;
      }
    return mu;
  }

  void Design::check_values(const std::vector<double> &mu) const
  {
    for (unsigned int j = 0; j < parameters_.size(); ++j)
      check_value(parameters_[j], mu[j]);
  }

  template <typename Number>
  std::vector<Number> Design::shape_of(const std::vector<Number> &mu) const
  {
    std::vector<Number> shape;
    for (const ShapeParameter &parameter : billet_map_.parameters())
      shape.push_back(Number(parameter.nominal));
    for (unsigned int j = 0; j < parameters_.size(); ++j)
      if (parameters_[j].kind == Kind::billet)
        shape[parameters_[j].number] = mu[j];
    return shape;
  }

  template <typename Number>
  NodalVectors<Number> Design::positions(const std::vector<Number> &mu) const
  {
    AssertDimension(mu.size(), parameters_.size());
    return billet_map_.positions(shape_of(mu));
  }

  double Design::mesh_quality(const std::vector<double> &mu) const
  {
    return billet_map_.mesh_quality(shape_of(mu));
  }

  std::optional<DesignParameter> Design::held() const
  {
    const ShapeParameter *held = billet_map_.held();
    if (held == nullptr)
      return {};
    return DesignParameter{"billet/" + held->name, held->unit, Kind::billet, held->nominal, held->scale};
  }

  double Design::held_value(const std::vector<double> &mu) const
  {
    return billet_map_.held_value(shape_of(mu));
  }

  std::vector<double> Design::held_gradient(const std::vector<double> &mu) const
  {
    AssertDimension(mu.size(), parameters_.size());
    std::vector<double> gradient;
    for (unsigned int j = 0; j < mu.size(); ++j)
      gradient.push_back(
        parameters_[j].kind == Kind::billet ? billet_map_.held_value(shape_of(along(mu, j))).dx(0) : 0.);
    return gradient;
  }

  std::vector<std::pair<std::string, double>> Design::billet_at(const std::vector<double> &mu) const
  {
    std::vector<std::pair<std::string, double>> values;
    const std::vector<double>                   all = billet_map_.all_values(shape_of(mu));
    for (std::size_t j = 0; j < all.size(); ++j)
      if (const ShapeParameter &parameter = billet_map_.shape_parameters()[j]; all[j] != parameter.nominal)
        values.emplace_back("billet/" + parameter.name, all[j]);
    return values;
  }

  template <typename Number>
  Process<Number> Design::process(const std::vector<Number> &mu) const
  {
    AssertDimension(mu.size(), parameters_.size());
    auto process = converted<Number>(process_);
    for (unsigned int j = 0; j < parameters_.size(); ++j)
    {
      const DesignParameter &parameter = parameters_[j];
      switch (parameter.kind)
      {
        case Kind::material:
          number_of(process.material, parameter.number) = mu[j];
          break;
        case Kind::heat:
          number_of(process.heat, parameter.number) = mu[j];
          break;
        case Kind::transfer:
          process.operations[parameter.number].waiting.transfer = mu[j];
          break;
        case Kind::dwell:
          process.operations[parameter.number].waiting.dwell = mu[j];
          break;
        case Kind::friction:
          for (unsigned int d = 0; d < dies_.size(); ++d)
            if (d == parameter.die || (parameter.die == invalid_index && dies_[d].friction > 0.))
              process.dies[d].friction = felt(mu[j]);
          break;
        case Kind::shear_limit:
          process.dies[parameter.die].shear_limit = mu[j];
          break;
        case Kind::die_temperature:
          process.dies[parameter.die].temperature = mu[j];
          break;
        case Kind::zone_friction:
          process.dies[parameter.die].zones[parameter.number].friction = felt(mu[j]);
          break;
        case Kind::zone_limit:
          process.dies[parameter.die].zones[parameter.number].shear_limit = mu[j];
          break;
        case Kind::speed:
          for (unsigned int i = 0; i < 3; ++i)
            process.dies[parameter.die].velocity[i] =
              dies_[parameter.die].velocity[i] / parameter.nominal * mu[j];
          break;
        case Kind::offset:
          for (unsigned int i = 0; i < 3; ++i)
            process.dies[parameter.die].displacement[i] += dies_[parameter.die].facing[i] * mu[j];
          break;
        case Kind::contact:
        case Kind::die_shape:
        case Kind::die_free_form:
        case Kind::billet:
          break;
      }
    }
    set_contact(mu, process);
    shape_dies(mu, process);
    follow_billet(mu, process);
    return process;
  }

  template <typename Number>
  void Design::set_contact(const std::vector<Number> &mu, Process<Number> &process) const
  {
    process.contact = contact_.law(process.material.initial_law(), closing_speed(process.dies));
    for (unsigned int j = 0; j < parameters_.size(); ++j)
      if (parameters_[j].kind == Kind::contact)
        number_of(process.contact, parameters_[j].number) = mu[j];
  }

  template <typename Number>
  void Design::shape_dies(const std::vector<Number> &mu, Process<Number> &process) const
  {
    std::vector<std::map<std::string, Number>>  measures(dies_.size());
    std::vector<std::map<unsigned int, Number>> coefficients(dies_.size());
    for (unsigned int j = 0; j < parameters_.size(); ++j)
      if (parameters_[j].kind == Kind::die_shape)
        measures[parameters_[j].die][parameters_[j].measure] = mu[j];
      else if (parameters_[j].kind == Kind::die_free_form)
        coefficients[parameters_[j].die][parameters_[j].number] = mu[j];
    for (unsigned int d = 0; d < dies_.size(); ++d)
    {
      NodalVectors<Number> &vertices = process.dies[d].vertices;
      if (!measures[d].empty())
        vertices = dies_[d].shape->vertices(dies_[d].place(), measures[d]);
      else if (!coefficients[d].empty())
        convert(die_forms_[d].vertices(), vertices);
      if (!coefficients[d].empty())
        die_forms_[d].forward(coefficients[d], vertices);
    }
  }

  template <typename Number>
  void Design::follow_billet(const std::vector<Number> &mu, Process<Number> &process) const
  {
    if (std::all_of(followed_.begin(), followed_.end(), [](const NodeIndex k) { return k == invalid_index; }))
      return;
    const NodalVectors<Number> X = positions(mu);
    for (unsigned int d = 0; d < dies_.size(); ++d)
      if (const NodeIndex k = followed_[d]; k != invalid_index)
      {
        const Vec3 &facing = dies_[d].facing;
        Number      shift(0.);
        for (unsigned int i = 0; i < 3; ++i)
          shift += facing[i] * (X[k][i] - nominal_X_[k][i]);
        for (unsigned int i = 0; i < 3; ++i)
          process.dies[d].displacement[i] += facing[i] * shift;
        // Along its facing it goes stroke v·facing/|v|, and now -shift more.
        for (auto &operation : process.operations)
          if (d == operation.leading_die)
            operation.path_scale -=
              shift / (operation.stroke * (dies_[d].velocity * facing) / dies_[d].velocity.norm());
      }
  }

  template NodalVectors<double> Design::positions(const std::vector<double> &) const;
  template NodalVectors<Dual>   Design::positions(const std::vector<Dual> &) const;
  template Process<double>      Design::process(const std::vector<double> &) const;
  template Process<Dual>        Design::process(const std::vector<Dual> &) const;

  std::vector<double> Design::pull_back(const std::vector<double>  &mu,
                                        const NodalVectors<double> &X_0_bar,
                                        const Process<double>      &bar) const
  {
    AssertDimension(mu.size(), parameters_.size());
    AssertDimension(X_0_bar.size(), nominal_X_.size());
    AssertDimension(bar.dies.size(), dies_.size());
    const std::vector<double> billet = billet_map_.pull_back(shape_of(mu), X_0_bar);
    std::vector<double>       gradient;
    for (unsigned int j = 0; j < parameters_.size(); ++j)
    {
      const DesignParameter &parameter = parameters_[j];
      if (parameter.kind == Kind::die_free_form)
      {
        gradient.push_back(
          die_forms_[parameter.die].reverse(parameter.number, bar.dies[parameter.die].vertices));
        continue;
      }
      const auto process_dot = process(along(mu, j));
      double     sum         = 0.;
      for_each_number([&](const double &x_bar, const Dual &x) { sum += x_bar * x.dx(0); }, bar, process_dot);
      if (parameter.kind == Kind::billet)
        sum += billet[parameter.number];
      gradient.push_back(sum);
    }
    return gradient;
  }
} // namespace retroforge
