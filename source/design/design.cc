// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/design/design.h>
#include <retroforge/time/closing_speed.h>

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
                 const FirstMesh                  &first,
                 const double                      stroke)
      : dies_(dies)
      , process_(nominal_process)
      , contact_(contact)
      , stroke_(stroke)
      , billet_map_(billet, first)
      , nominal_X_(billet_map_.nominal_positions())
      , width_(billet.shape == "file" ? extent_in_x(nominal_X_) : billet.whole_width())
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

  std::vector<std::string> Design::expanded(const std::vector<std::string> &names) const
  {
    const std::vector<DesignParameter> all        = offered();
    const auto                         is_mode_of = [](const std::string &name, const std::string &form) {
      const std::string end = "/free form";
      return form.size() > end.size() && form.substr(form.size() - end.size()) == end &&
             name.rfind(form + " ", 0) == 0;
    };
    std::vector<std::string> single;
    for (const std::string &name : names)
    {
      const std::size_t n = single.size();
      for (const DesignParameter &parameter : all)
        if (is_mode_of(parameter.name, name))
          single.push_back(parameter.name);
      // One that is given a value stands for itself in all of them.
      if (single.size() == n && std::none_of(names.begin(), names.end(), [&](const std::string &form) {
            return is_mode_of(name, form);
          }))
        single.push_back(name);
    }
    return single;
  }

  std::map<std::string, std::string> idle_parameters(const std::vector<DieParameters> &dies,
                                                     const MaterialLaw<double>        &law)
  {
    std::map<std::string, std::string> idle;
    bool                               friction = false;
    for (const DieParameters &die : dies)
    {
      friction |= die.friction > 0.;
      if (die.friction == 0.)
        idle["die " + die.name + "/friction"] = "the friction of die " + die.name + " is 0";
      if (die.velocity.norm() == 0.)
        idle["die " + die.name + "/speed"] = "the velocity of die " + die.name + " is 0";
    }
    if (!friction)
      idle["dies/friction"] = "the friction of all dies is 0";
    for (const NumberInfo &number : ContactLaw<double>::info())
      if (!ContactLaw<double>::depends_on(number.name, friction))
        idle["contact/" + number.name] = "the friction of all dies is 0";
    for (const NumberInfo &number : MaterialLaw<double>::info())
      if (!law.depends_on(number.name))
        idle["material/" + number.name] = "the strain rate sensitivity is 1";
    return idle;
  }

  bool DesignParameter::overlaps(const DesignParameter &other) const
  {
    const bool same_die = die == other.die || die == invalid_index || other.die == invalid_index;
    return kind == other.kind && same_die && number == other.number && measure == other.measure;
  }

  namespace
  {
    /// The numbers of a law, called GROUP/NAME, those that `offers` names.
    template <typename Law, typename Offers>
    void add_numbers_of(Law                           law,
                        const std::string            &group,
                        const Kind                    kind,
                        const Offers                 &offers,
                        std::vector<DesignParameter> &all)
    {
      const std::vector<NumberInfo> info = law.info();
      for (unsigned int i = 0; i < info.size(); ++i)
        if (offers(info[i].name))
        {
          const double value = number_of(law, i);
          all.push_back({group + "/" + info[i].name,
                         info[i].unit,
                         kind,
                         value,
                         value,
                         invalid_index,
                         i,
                         {},
                         info[i].may_vanish,
                         info[i].largest});
        }
    }

    void add_numbers_of(const DieParameters          &die,
                        const DieFreeForm            &form,
                        const NumberInfo             &friction,
                        const unsigned int            d,
                        const double                  width,
                        std::vector<DesignParameter> &all)
    {
      const std::string prefix = "die " + die.name + "/";
      const double      speed  = die.velocity.norm();
      if (die.friction > 0.)
        all.push_back({prefix + "friction",
                       friction.unit,
                       Kind::friction,
                       die.friction,
                       die.friction,
                       d,
                       0,
                       {},
                       friction.may_vanish,
                       friction.largest});
      if (speed > 0.)
        all.push_back({prefix + "speed", "mm/s", Kind::speed, speed, speed, d});
      all.push_back({prefix + "offset", "mm", Kind::offset, 0., width, d});
      for (const auto &[key, measure] : die.shape->measures())
        all.push_back({prefix + key, measure.unit, Kind::die_shape, measure.value, measure.value, d, 0, key});
      for (unsigned int i = 0; i < form.n_modes(); ++i)
        all.push_back(
          {prefix + "free form " + std::to_string(i + 1), "mm", Kind::die_free_form, 0., width, d, i});
    }
  } // namespace

  NumberInfo Design::friction_of(const unsigned int d) const
  {
    return interface_law(process_.dies[d].interface_law).coefficient();
  }

  std::vector<DesignParameter> Design::offered() const
  {
    const auto with_friction =
      std::find_if(dies_.begin(), dies_.end(), [](const DieParameters &die) { return die.friction > 0.; });
    const bool                   friction = with_friction != dies_.end();
    std::vector<DesignParameter> all;
    add_numbers_of(
      process_.material,
      "material",
      Kind::material,
      [&](const std::string &name) { return process_.material.law.depends_on(name); },
      all);
    add_numbers_of(
      process_.contact,
      "contact",
      Kind::contact,
      [&](const std::string &name) { return process_.contact.depends_on(name, friction); },
      all);
    for (unsigned int j = 0; j < billet_map_.parameters().size(); ++j)
    {
      const ShapeParameter &shape = billet_map_.parameters()[j];
      all.push_back(
        {"billet/" + shape.name, shape.unit, Kind::billet, shape.nominal, shape.scale, invalid_index, j});
    }
    for (unsigned int d = 0; d < dies_.size(); ++d)
      add_numbers_of(dies_[d], die_forms_[d], friction_of(d), d, width_, all);
    if (friction)
      all.push_back({"dies/friction",
                     friction_of(with_friction - dies_.begin()).unit,
                     Kind::friction,
                     with_friction->friction,
                     with_friction->friction,
                     invalid_index,
                     0,
                     {},
                     true});
    return all;
  }

  void Design::check_offered(const std::string &name, const std::string &where) const
  {
    std::vector<std::string> known;
    for (const DesignParameter &parameter : offered())
      known.push_back(parameter.name);
    if (std::find(known.begin(), known.end(), name) != known.end())
      return;
    const auto idle = idle_parameters(dies_, process_.material.law);
    if (const auto found = idle.find(name); found != idle.end())
      throw Error(where,
                  "'" + name + "' changes nothing, as " + found->second,
                  "a derivative is taken by what acts",
                  "leave it out, or give that number another value: a friction of 1e-6 is next to none");
    const std::string near = nearest_name(name, known, 6);
    throw Error(where,
                "'" + name + "' is not a parameter of this scene",
                "it offers " + join(known),
                near.empty() ? "name some of these" : "did you mean '" + near + "'?");
  }

  void Design::check_common_friction() const
  {
    const DieParameters *first = nullptr;
    for (const auto &die : dies_)
      if (die.friction > 0.)
      {
        if (first && (first->friction != die.friction || first->friction_law != die.friction_law))
          throw Error("Design/parameters",
                      std::string("'dies/friction' stands for all dies with friction, but their ") +
                        (first->friction_law != die.friction_law ? "laws" : "coefficients") + " differ",
                      "one number must describe them all",
                      "name each die, as in 'die " + die.name + "/friction'");
        first = &die;
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
    auto process = converted<Number>(process_);
    for (unsigned int j = 0; j < parameters_.size(); ++j)
    {
      const DesignParameter &parameter = parameters_[j];
      switch (parameter.kind)
      {
        case Kind::material:
          number_of(process.material, parameter.number) = mu[j];
          break;
        case Kind::friction:
          for (unsigned int d = 0; d < dies_.size(); ++d)
            if (d == parameter.die || (parameter.die == invalid_index && dies_[d].friction > 0.))
              process.dies[d].friction = mu[j];
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
    process.contact = contact_.law(process.material.law, closing_speed(process.dies));
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
        if (d == process_.leading_die)
          process.stretch -= shift / (stroke_ * (dies_[d].velocity * facing) / dies_[d].velocity.norm());
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
