// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/solver/contact_pullback.h>
#include <retroforge/solver/spent_power.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Number speed(const EquilibriumView<Number> &view, const unsigned int die)
    {
      using std::sqrt;
      const Vector3<Number> &v  = view.stage.physics.dies[die].velocity;
      const Number           v2 = v * v;
      if (value_of(v2) == 0.)
        throw Error("Effort",
                    "die " + view.stage.scene.dies[die].name + " stands still",
                    "effort is power over the speed of a die that moves",
                    "name the die that does");
      return sqrt(v2);
    }

    /// f·v_die, f the die's force on the workpiece [mJ/s].
    template <typename Number>
    Number power_of_die(const EquilibriumView<Number> &view, const unsigned int die)
    {
      const Equilibrium<Number> &stage = view.stage;
      Number                     power(0.);
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
        if (stage.contact.pairs[p].die == die &&
            stage.scene.discretization.owns(stage.contact.pairs[p].point.nodes[0]))
          power -= contact_force(stage.contact_node(p, view.W, view.active),
                                 stage.surface_law(p),
                                 stage.physics.contact) *
                   stage.physics.dies[die].velocity;
      return power;
    }

    void reverse_power_of_die(const EquilibriumView<double> &view,
                              const unsigned int             die,
                              const double                   weight,
                              EquilibriumBar                &bar)
    {
      const Equilibrium<double> &stage = view.stage;
      const Vec3                &v     = stage.physics.dies[die].velocity;
      ContactPullback            pullback(view, bar);
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
        if (stage.contact.pairs[p].die == die &&
            stage.scene.discretization.owns(stage.contact.pairs[p].point.nodes[0]))
        {
          const ContactNode<double> node = stage.contact_node(p, view.W, view.active);
          pullback.add(p,
                       reverse_contact_force(node, stage.surface_law(p), stage.physics.contact, -weight * v));
          bar.physics.dies[die].velocity -=
            weight * contact_force(node, stage.surface_law(p), stage.physics.contact);
        }
      pullback.finish();
    }

    template <typename Number>
    void check_length(const Number &length)
    {
      if (value_of(length) == 0.)
        throw Error("Effort",
                    "no increment lies in the window",
                    "the window must overlap the run",
                    "let it begin before the end of the stroke and end after its beginning");
    }
  } // namespace

  void PathWindow::check(const std::string &where) const
  {
    if (!(begin < end))
      throw Error(where,
                  "the window goes from " + as_text(begin) + " to " + as_text(end),
                  "it must end after it begins",
                  "swap the two, or leave out the end");
  }

  template <typename Number>
  Number PathWindow::overlap(const PathRow<Number> &row) const
  {
    const Number from = over == Over::time ? row.time : row.stroke;
    const Number to   = over == Over::time ? Number(row.time + row.dt) : Number(row.stroke + row.step);
    const Number low  = value_of(from) < begin ? Number(begin) : from;
    const Number high = value_of(to) > end ? Number(end) : to;
    return value_of(high) > value_of(low) ? Number(high - low) : Number(0.);
  }

  template <typename Number>
  Number PathWindow::time_inside(const PathRow<Number> &row) const
  {
    const Number length = overlap(row);
    return over == Over::time || value_of(row.step) == 0. ? length : Number(row.dt * length / row.step);
  }

  namespace
  {
    template <typename Number>
    bool is_in_press(const EquilibriumView<Number> &view, const unsigned int die)
    {
      return view.stage.physics.dies[die].in_press != 0;
    }

    /// The speed is no sum: one rank has it.
    template <typename Number>
    bool has_speed(const EquilibriumView<Number> &view)
    {
      return dealii::Utilities::MPI::this_mpi_process(view.stage.scene.discretization.comm()) == 0;
    }
  } // namespace

  template <typename Number>
  std::vector<Number> Effort::terms(const EquilibriumView<Number> &view) const
  {
    std::vector<Number> terms = power_terms(view);
    if (!is_in_press(view, die_))
    {
      terms.insert(terms.end(), 2, Number(0.));
      return terms;
    }
    const Number v = speed(view, die_);
    terms.push_back(has_speed(view) ? v : Number(0.));
    terms.push_back(by_ == By::force ? power_of_die(view, die_) : Number(0.));
    return terms;
  }

  template <typename Number>
  Number Effort::length(const PathRow<Number> &row, const PathWindow &window) const
  {
    return value_of(row.integrals[row.integrals.size() - 2]) > 0. ? window.overlap(row) : Number(0.);
  }

  void Effort::reverse_terms(const EquilibriumView<double> &view,
                             const std::vector<double>     &weights,
                             EquilibriumBar                &bar) const
  {
    const std::size_t n = n_power_terms(view.stage.scene.dies.size());
    AssertDimension(weights.size(), n + 2);
    if (!is_in_press(view, die_))
      return; // no window has this increment
    reverse_power_terms(view, weights, bar);
    if (has_speed(view))
      bar.physics.dies[die_].velocity +=
        weights[n] / speed(view, die_) * view.stage.physics.dies[die_].velocity;
    if (by_ == By::force)
      reverse_power_of_die(view, die_, weights[n + 1], bar);
  }

  template <typename Number>
  Number Effort::force(const std::vector<Number> &terms) const
  {
    const std::vector<Number> of_power(terms.begin(), terms.end() - 2);
    const Number             &speed = terms[terms.size() - 2], &of_die = terms.back();
    return (by_ == By::power ? spent_power(of_power).total() : Number(of_die * force_factor(of_power))) /
           speed;
  }

  MeanEffort::MeanEffort(const Effort &effort, const PathWindow &window) : effort_(effort), window_(window)
  {
    window.check("Mean effort");
  }

  void MeanEffort::reverse_integrals(const EquilibriumView<double> &view,
                                     const std::vector<double>     &weights,
                                     EquilibriumBar                &bar) const
  {
    effort_.reverse_terms(view, weights, bar);
  }

  template <typename Number>
  std::vector<Number> MeanEffort::compute_integrals(const EquilibriumView<Number> &view) const
  {
    return effort_.terms(view);
  }

  template <typename Number>
  std::vector<Number> MeanEffort::terms(const PathRow<Number> &row, double) const
  {
    const Number length = effort_.length(row, window_);
    if (value_of(length) == 0.)
      return {Number(0.), Number(0.)};
    return {Number(effort_.force(row.integrals) * length), length};
  }

  template <typename Number>
  Number MeanEffort::combine(const std::vector<Number> &sums, double) const
  {
    check_length(sums[1]);
    return sums[0] / sums[1];
  }

  MaximumEffort::MaximumEffort(const Effort        &effort,
                               const PathWindow    &window,
                               const SmoothMaximum &maximum,
                               const double         reach)
      : effort_(effort), window_(window), maximum_(maximum), reach_(reach)
  {
    window.check("Maximum effort");
    maximum.check("Maximum effort");
    if (!(reach >= 0. && reach <= 1.))
      throw Error("Maximum effort",
                  "forces are fitted over " + as_text(reach) + " of the path",
                  "it must be a part of it, from 0 to 1",
                  "use 0.08, or 0 for the force of each increment as it is");
  }

  double MaximumEffort::true_maximum(const PathRows<double> &rows) const
  {
    bool   found   = false;
    double largest = 0.;
    for (const PathRow<double> &row : rows)
      if (effort_.length(row, window_) > 0.)
      {
        const double force = effort_.force(row.integrals);
        largest            = found ? std::max(largest, force) : force;
        found              = true;
      }
    return largest;
  }

  template <typename Number>
  ForcePath<Number> MaximumEffort::path_of(const PathRows<Number> &rows) const
  {
    ForcePath<Number> path{{}, {}, {}, {}, 0.};
    double            whole = 0.;
    for (const PathRow<Number> &row : rows)
      whole += row.length;
    for (const PathRow<Number> &row : rows)
    {
      const double offset = 3. * whole * row.operation; // nothing is fitted across to another one
      const Number length = effort_.length(row, window_);
      if (value_of(length) == 0.)
        continue;
      path.force.push_back(effort_.force(row.integrals));
      path.length.push_back(length);
      path.place.push_back(offset + row.stroke + 0.5 * row.step);
      path.recorded.push_back(offset + row.place);
      path.reach += reach_ * row.length;
    }
    return path;
  }

  template <typename Number>
  Number MaximumEffort::evaluate(const PathRows<Number> &rows) const
  {
    const ForcePath<Number> path = path_of(rows);
    check_length(double(path.size()));
    return maximum_.value(path);
  }

  PathRows<double> MaximumEffort::reverse_value(const PathRows<double> &rows) const
  {
    const ForcePath<double> bar = maximum_.reverse(path_of(rows));
    PathRows<double>        rows_bar;
    std::size_t             i = 0; // of those in the window
    for (const PathRow<double> &row : rows)
    {
      const bool is_inside = effort_.length(row, window_) > 0.;
      rows_bar.push_back(derivatives_of(
        [&](const PathRow<Dual> &at) {
          return is_inside ? Dual(bar.force[i] * effort_.force(at.integrals) +
                                  bar.length[i] * effort_.length(at, window_) +
                                  bar.place[i] * (at.stroke + 0.5 * at.step))
                           : Dual(0.);
        },
        row));
      i += is_inside;
    }
    return rows_bar;
  }

  void MaximumEffort::reverse_integrals(const EquilibriumView<double> &view,
                                        const std::vector<double>     &weights,
                                        EquilibriumBar                &bar) const
  {
    effort_.reverse_terms(view, weights, bar);
  }

  template <typename Number>
  std::vector<Number> MaximumEffort::compute_integrals(const EquilibriumView<Number> &view) const
  {
    return effort_.terms(view);
  }

#define RETROFORGE_INSTANTIATE(Number)                                                               \
  template Number              PathWindow::overlap(const PathRow<Number> &) const;                   \
  template Number              PathWindow::time_inside(const PathRow<Number> &) const;               \
  template std::vector<Number> Effort::terms(const EquilibriumView<Number> &) const;                 \
  template Number              Effort::force(const std::vector<Number> &) const;                     \
  template Number              Effort::length(const PathRow<Number> &, const PathWindow &) const;    \
  template std::vector<Number> MeanEffort::compute_integrals(const EquilibriumView<Number> &) const; \
  template std::vector<Number> MeanEffort::terms(const PathRow<Number> &, double) const;             \
  template Number              MeanEffort::combine(const std::vector<Number> &, double) const;       \
  template Number              MaximumEffort::evaluate(const PathRows<Number> &) const;              \
  template std::vector<Number> MaximumEffort::compute_integrals(const EquilibriumView<Number> &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  namespace
  {
    struct EffortType : ObjectiveType
    {
      DieSetting     die;
      Effort::By     by = Effort::By::power;
      WindowSettings window;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        die.add_parameters(prm);
        add_enum<Effort::By>(
          prm,
          "by",
          by,
          {{"power", Effort::By::power}, {"force", Effort::By::force}},
          "An effort is the power spent over the die's speed, or the force of the die along its "
          "velocity. Units: none.");
        window.add_parameters(prm);
      }

      void check_names(const std::string &where, const ObjectiveContext &context) const override
      {
        die.find(where, context);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.scaling = SymmetryScaling::force;
        objective.die     = die.find_moving(where, context);
        const Effort effort(objective.die, by);
        objective.path = make_path(where, effort, window.make(where, context));
      }

      virtual std::unique_ptr<PathObjective>
      make_path(const std::string &where, const Effort &effort, const PathWindow &path_window) const = 0;
    };

    struct MeanEffortType : EffortType
    {
      std::unique_ptr<PathObjective>
      make_path(const std::string &, const Effort &effort, const PathWindow &path_window) const override
      {
        return std::make_unique<MeanEffort>(effort, path_window);
      }
    };

    struct MaximumEffortType : EffortType
    {
      MaximumSettings maximum;
      double          reach = MaximumEffort::default_reach;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        EffortType::add_parameters(prm);
        maximum.add_parameters(prm);
        prm.add_parameter("fitted path",
                          reach,
                          "The largest force is taken of fits to the increments that lie within this part of "
                          "the path to either side; 0 for the force of each increment as it is. Units: none.",
                          dealii::Patterns::Double(0., 1.));
      }

      std::unique_ptr<PathObjective>
      make_path(const std::string &where, const Effort &effort, const PathWindow &path_window) const override
      {
        return std::make_unique<MaximumEffort>(effort, path_window, maximum.make(where), reach);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker mean_effort_type()
  {
    return {"mean effort", Choice<ObjectiveType>::make<MeanEffortType>};
  }

  Choice<ObjectiveType>::Maker maximum_effort_type()
  {
    return {"maximum effort", Choice<ObjectiveType>::make<MaximumEffortType>};
  }
} // namespace retroforge
