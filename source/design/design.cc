// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/design/design.h>

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

    double extent_in_x(const TetMesh &mesh)
    {
      const auto [low, high] = bounding_box(mesh.X);
      return high[0] - low[0];
    }
  } // namespace

  Design::Design(const std::vector<std::string>   &names,
                 const BilletParameters           &billet,
                 const std::vector<DieParameters> &dies,
                 const Process<double>            &nominal_process,
                 const TetMesh                    &nominal_billet,
                 const double                      stroke)
      : dies_(dies)
      , process_(nominal_process)
      , nominal_X_(nominal_billet.X)
      , stroke_(stroke)
      , billet_map_(billet, nominal_billet)
      , width_(billet.shape == "file" ? extent_in_x(nominal_billet) : billet.whole_width())
  {
    for (const DieParameters &die : dies_)
      followed_.push_back(followed_node(die, nominal_X_));
    for (const std::string &name : names)
    {
      const DesignParameter parameter = make(name);
      for (const DesignParameter &other : parameters_)
        if (other.kind == parameter.kind &&
            (other.die == parameter.die || other.die == invalid_index || parameter.die == invalid_index) &&
            other.measure == parameter.measure)
          throw Error("Design/parameters",
                      "'" + name + "' and '" + other.name + "' set the same number",
                      "parameters must be independent",
                      "leave one of them out");
      parameters_.push_back(parameter);
    }
  }

  std::vector<std::string> Design::available() const
  {
    std::vector<std::string> names = {"material/K", "material/m", "contact/rho"};
    if (process_.law.m != 1.)
      names.push_back("material/e0");
    for (const ShapeParameter &shape : billet_map_.parameters())
      names.push_back("billet/" + shape.name);
    bool friction = false;
    for (const auto &die : dies_)
    {
      friction |= die.friction > 0.;
      if (die.friction > 0.)
        names.push_back("die " + die.name + "/friction");
      if (die.velocity.norm() > 0.)
        names.push_back("die " + die.name + "/speed");
      names.push_back("die " + die.name + "/offset");
      for (const std::string &measure : die.measures())
        names.push_back("die " + die.name + "/" + measure);
    }
    if (friction)
      names.insert(names.end(), {"dies/friction", "contact/v0"});
    return names;
  }

  void Design::check_offered(const std::string &name, const std::string &where) const
  {
    const auto known = available();
    if (std::find(known.begin(), known.end(), name) != known.end())
      return;
    const std::string near = nearest_name(name, known, 6);
    throw Error(where,
                "'" + name + "' is not a parameter of this scene",
                "it offers " + join(known),
                near.empty() ? "name some of these" : "did you mean '" + near + "'?");
  }

  DesignParameter Design::make(const std::string &name) const
  {
    check_offered(name, "Design/parameters");
    if (name == "material/K")
      return {name, "MPa s^m", Kind::consistency, invalid_index, process_.law.K, process_.law.K};
    if (name == "material/m")
      return {name, "", Kind::sensitivity, invalid_index, process_.law.m, process_.law.m};
    if (name == "material/e0")
      return {name, "1/s", Kind::strain_rate, invalid_index, process_.law.e0, process_.law.e0};
    if (name == "contact/rho")
      return {name, "MPa s/mm", Kind::penalty, invalid_index, process_.contact.rho, process_.contact.rho};
    if (name == "contact/v0")
      return {name, "mm/s", Kind::slip, invalid_index, process_.contact.v0, process_.contact.v0};
    const auto &shapes = billet_map_.parameters();
    for (unsigned int j = 0; j < shapes.size(); ++j)
      if (name == "billet/" + shapes[j].name)
        return {name, shapes[j].unit, Kind::billet, j, shapes[j].nominal, shapes[j].scale};
    if (name == "dies/friction")
    {
      double alpha = 0.;
      for (const auto &die : dies_)
        if (die.friction > 0.)
        {
          if (alpha > 0. && alpha != die.friction)
            throw Error("Design/parameters",
                        "'dies/friction' stands for all dies with friction, but their coefficients differ",
                        "one number must describe them all",
                        "name each die, as in 'die " + die.name + "/friction'");
          alpha = die.friction;
        }
      return {name, "mm^(-m)", Kind::friction, invalid_index, alpha, alpha};
    }
    for (unsigned int d = 0; d < dies_.size(); ++d)
    {
      const double friction = dies_[d].friction, speed = dies_[d].velocity.norm();
      if (name == "die " + dies_[d].name + "/friction")
        return {name, "mm^(-m)", Kind::friction, d, friction, friction};
      if (name == "die " + dies_[d].name + "/speed")
        return {name, "mm/s", Kind::speed, d, speed, speed};
      if (name == "die " + dies_[d].name + "/offset")
        return {name, "mm", Kind::offset, d, 0., width_};
      for (const std::string &measure : dies_[d].measures())
        if (name == "die " + dies_[d].name + "/" + measure)
        {
          const double value = dies_[d].measure(measure);
          return {
            name, measure == "draft angle" ? "degrees" : "mm", Kind::die_shape, d, value, value, measure};
        }
    }
    throw Error("Design/parameters", name, "unknown", "see the list of parameters");
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
    /// Shapes are checked where they are made.
    void check_value(const DesignParameter &parameter, const double value)
    {
      const bool may_vanish = parameter.kind == Kind::friction || parameter.kind == Kind::strain_rate ||
                              parameter.kind == Kind::slip;
      const bool is_free  = parameter.kind == Kind::offset || parameter.kind == Kind::billet;
      const bool is_sound = std::isfinite(value) && (is_free || value > 0. || (may_vanish && value == 0.)) &&
                            (parameter.kind != Kind::sensitivity || value <= 1.);
      if (!is_sound)
        throw Error("Design/at",
                    "gives " + parameter.name + " the value " + as_text(value),
                    parameter.kind == Kind::sensitivity ? "it lies above 0 and up to 1"
                    : may_vanish                        ? "it is not negative"
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

  template <typename Number>
  std::vector<Number> Design::shape_of(const std::vector<Number> &mu) const
  {
    std::vector<Number> shape;
    for (const ShapeParameter &parameter : billet_map_.parameters())
      shape.push_back(Number(parameter.nominal));
    for (unsigned int j = 0; j < parameters_.size(); ++j)
      if (parameters_[j].kind == Kind::billet)
        shape[parameters_[j].die] = mu[j];
    return shape;
  }

  template <typename Number>
  NodalVectors<Number> Design::positions(const std::vector<Number> &mu) const
  {
    return billet_map_.positions(shape_of(mu));
  }

  template <typename Number>
  Process<Number> Design::process(const std::vector<Number> &mu) const
  {
    Process<Number> process{{process_.law.K, process_.law.m, process_.law.e0},
                            {process_.contact.rho, process_.contact.v0},
                            {},
                            process_.leading_die};
    for (const auto &die : process_.dies)
    {
      DieState<Number> state;
      for (unsigned int i = 0; i < 3; ++i)
      {
        state.velocity[i]     = Number(die.velocity[i]);
        state.displacement[i] = Number(die.displacement[i]);
      }
      state.friction = Number(die.friction);
      process.dies.push_back(state);
    }
    std::vector<std::map<std::string, Number>> measures(dies_.size());
    for (unsigned int j = 0; j < parameters_.size(); ++j)
    {
      const DesignParameter &parameter = parameters_[j];
      switch (parameter.kind)
      {
        case Kind::consistency:
          process.law.K = mu[j];
          break;
        case Kind::sensitivity:
          process.law.m = mu[j];
          break;
        case Kind::strain_rate:
          process.law.e0 = mu[j];
          break;
        case Kind::penalty:
          process.contact.rho = mu[j];
          break;
        case Kind::slip:
          process.contact.v0 = mu[j];
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
        case Kind::die_shape:
          measures[parameter.die][parameter.measure] = mu[j];
          break;
        case Kind::billet:
          break;
      }
    }
    for (unsigned int d = 0; d < dies_.size(); ++d)
      if (!measures[d].empty())
        process.dies[d].vertices =
          std::make_shared<const NodalVectors<Number>>(dies_[d].vertices(measures[d]));
    follow_billet(mu, process);
    return process;
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
                                        const ProcessBar           &bar) const
  {
    const std::vector<double> billet = billet_map_.pull_back(shape_of(mu), X_0_bar);
    std::vector<double>       gradient;
    for (unsigned int j = 0; j < parameters_.size(); ++j)
    {
      const auto p   = process(along(mu, j));
      double     sum = bar.stretch * p.stretch.dx(0) + bar.K * p.law.K.dx(0) + bar.m * p.law.m.dx(0) +
                   bar.e0 * p.law.e0.dx(0) + bar.rho * p.contact.rho.dx(0) + bar.v0 * p.contact.v0.dx(0);
      for (unsigned int d = 0; d < p.dies.size(); ++d)
      {
        sum += bar.dies[d].friction * p.dies[d].friction.dx(0);
        if (p.dies[d].vertices && d < bar.die_vertices.size())
          for (std::size_t k = 0; k < bar.die_vertices[d].size(); ++k)
            for (unsigned int i = 0; i < 3; ++i)
              sum += bar.die_vertices[d][k][i] * (*p.dies[d].vertices)[k][i].dx(0);
        for (unsigned int i = 0; i < 3; ++i)
          sum += bar.dies[d].velocity[i] * p.dies[d].velocity[i].dx(0) +
                 bar.dies[d].displacement[i] * p.dies[d].displacement[i].dx(0);
      }
      if (parameters_[j].kind == Kind::billet)
        sum += billet[parameters_[j].die];
      gradient.push_back(sum);
    }
    return gradient;
  }
} // namespace retroforge
