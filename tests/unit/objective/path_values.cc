// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Objectives along a path on a flow known by hand: a cube of edge a = 50 between flat dies without friction,
// Newtonian, K = 1.693, upset by 10 in 8 increments at v = 100 with V = v/h (x/2, y/2, -z), so that e = v/h
// everywhere. With Euler's steps the height falls by v dt and the side q grows by the factor 1 + v dt/(2h).
// By hand, increment by increment:
//   power 3 K e^2 h q^2,   effort power / v_die,   fold e^alpha 4 h q,   dimensionless fold 1,
//   shear sqrt(3) K e,   wear of the upper die rho c e/2 (moment of the area that the top's nodes push on),
// and, the upper die's velocity v_die being c = 2 above that of the top of the cube, the contact pressure rho
// c everywhere. Where middles of edges push, too, with the stiffness s over the nodes', a node k has half the
// force of each of its edges e on its area: p_k = rho c (1 + s/2 sum_e A_e / A_k), A the areas of the faces
// at e and k. Where velocities are quadratic, it is rho c (1/4 + 3/8 sum_e A_e / A_k): rho c but at the rim,
// where edges of the side are at k. Effort is averaged from 4.1 to 8.6 of the stroke, within increments. Its
// smooth maxima keep their bounds without fits (fitted_maximum.h), and with them are as near; their distance from
// the true maximum is printed in percent.
// Then: nothing is NaN where material rests, and what makes no sense is refused.

#include <deal.II/base/mpi.h>

#include <retroforge/billet/billet.h>
#include <retroforge/core/error.h>
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/largest_wear.h>
#include <retroforge/objective/stress_maxima.h>

#include "objective_test_tools.h"

using namespace retroforge;

constexpr double edge = 50., v = 100., K = 1.693, rho = 3., faster = 2., stroke = 10.;
constexpr int    n_increments = 8;

TetMesh make_cube()
{
  BilletParameters parameters;
  parameters.base_centre  = Vec3();
  parameters.size         = Vec3({edge, edge, edge});
  parameters.element_size = 20.;
  return make_billet(parameters, MPI_COMM_WORLD);
}

/// The run above, with the flow given.
class Upsetting
{
public:
  explicit Upsetting(const ElementPair pair = ElementPair::mini, const bool counts_closing = false)
      : counts_closing_(counts_closing)
      , scene_(
          make_cube(),
          {pair},
          {Die("lower", Vec3(), Vec3({0., 0., 1.})), Die("upper", Vec3({0., 0., edge}), Vec3({0., 0., -1.}))},
          MPI_COMM_WORLD)
  {
  }

  PathRows<double> rows(const PathObjective &objective, const double speed = v) const
  {
    NodalVectors<double> X = scene_.mesh.X;
    PathRows<double>     rows;
    for (int i = 0; i < n_increments; ++i)
    {
      const double         step = stroke / n_increments, dt = step / v, h = edge - i * step;
      NodalVectors<double> V(X.size());
      for (NodeIndex k = 0; k < X.size(); ++k)
        V[k] = speed / h * Vec3({X[k][0] / 2., X[k][1] / 2., -X[k][2]});
      Field<double> W(scene_.discretization);
      W.V.take(V);
      W.P.take(std::vector<double>(X.size(), pressure(i)));
      const Vec3            lower({0., 0., 0.}), upper({0., 0., -v - faster});
      const Physics<double> physics{MaterialLaw<double>{K, 1., 0.},
                                    {rho, 0.},
                                    {{lower, Vec3(), 0., {}}, {upper, Vec3({0., 0., -i * step}), 0., {}}}};
      const FrictionRamp    ramp{0.1, false};
      const auto            pairs   = find_contact_pairs(scene_.view(physics.dies, X), ramp, 1., true);
      const auto            contact = make_contact_set<double>(
        scene_.view(physics.dies, X), pairs, {ramp, 5. * dt, {}, 1., counts_closing_});
      const Equilibrium<double> stage(scene_, physics, contact, X);
      const ActiveSet           active = stage.decide_active(W);
      rows.push_back(
        recorded_row<double>(objective.integrals({stage, W, active}).complete(), dt, i * dt, i * step, step));
      for (NodeIndex k = 0; k < X.size(); ++k)
        X[k] += dt * V[k];
    }
    return rows;
  }

  /// That of all nodes in increment i [MPa].
  static double pressure(const int i) { return 10. + 3. * i; }

  /// On the upper die.
  DieSites sites() const { return {scene_.dies[1], scene_.mesh, Vec3({0., 0., -1.}), 30.}; }

  double value(const PathObjective &objective) const { return objective.value(rows(objective)); }

  /// At the start of the run, with the middles of all edges of the top among the points.
  double pressure_with_edges(const ContactPressure &objective) const
  {
    const NodalVectors<double> &X = scene_.mesh.X;
    const Physics<double>       physics{MaterialLaw<double>{K, 1., 0.},
                                  {rho, 0.},
                                  {{Vec3(), Vec3(), 0., {}}, {Vec3({0., 0., -faster}), Vec3(), 0., {}}}};
    const FrictionRamp          ramp{0.1, false};
    std::vector<ContactPair>    pairs = find_contact_pairs(scene_.view(physics.dies, X), ramp, 1., true);
    for (const auto &[a, b] : scene_.topology.surface_edges)
      if (is_linear() && is_on_top(a) && is_on_top(b))
        pairs.push_back({ContactPoint::middle(a, b), 1, true, DieFeature()});
    const auto contact =
      make_contact_set<double>(scene_.view(physics.dies, X), pairs, {ramp, 0.1, 0., edge_stiffness});
    const Equilibrium<double> stage(scene_, physics, contact, X);
    const Field<double>       W(scene_.discretization); // at rest
    const PathRows<double>    rows = {recorded_row<double>(
      objective.integrals({stage, W, stage.decide_active(W)}).complete(), 0.1, 0., 0., 0.1)};
    return objective.value(rows);
  }

  /// The same by hand.
  double pressure_with_edges_by_hand(const double exponent) const
  {
    std::vector<double> of_node(scene_.mesh.n_nodes(), 0.), of_edges(scene_.mesh.n_nodes(), 0.);
    for (const BoundaryFace &face : scene_.mesh.faces)
    {
      const auto  &n    = face.nodes;
      const double area = 0.5 * cross(x(n[1]) - x(n[0]), x(n[2]) - x(n[0])).norm();
      for (unsigned int c = 0; c < 3; ++c)
      {
        of_node[n[c]] += area;
        for (const unsigned int other : {(c + 1) % 3, (c + 2) % 3})
          of_edges[n[c]] += is_on_top(n[c]) && is_on_top(n[other]) ? area : 0.;
      }
    }
    double sum = 0., areas = 0.;
    for (NodeIndex k = 0; k < scene_.mesh.n_nodes(); ++k)
      if (is_on_top(k))
      {
        const double of_own = is_linear() ? 1. : 0.25, of_edge = is_linear() ? edge_stiffness : 0.75;
        const double p = rho * faster * (of_own + 0.5 * of_edge * of_edges[k] / of_node[k]);
        sum += of_node[k] * std::pow(p, exponent);
        areas += of_node[k];
      }
    return std::pow(sum / areas, 1. / exponent);
  }

  /// Sum of what the nodes of the top push on, a third of all surface faces at each, of a cube of side q and
  /// height h [mm^2].
  double pushed_area(const double q, const double h) const
  {
    return sum_of_top(q, h, [](const Vec3 &) { return 1.; });
  }

  /// The same of the area times the distance from the axis [mm^3].
  double pushed_moment(const double q, const double h) const
  {
    return sum_of_top(q, h, [](const Vec3 &x) { return std::hypot(x[0], x[1]); });
  }

private:
  template <typename F>
  double sum_of_top(const double q, const double h, const F &f) const
  {
    const auto at = [&](const NodeIndex k) {
      return Vec3({x(k)[0] * q / edge, x(k)[1] * q / edge, x(k)[2] * h / edge});
    };
    double sum = 0.;
    for (const BoundaryFace &face : scene_.mesh.faces)
      for (const NodeIndex k : face.nodes)
        if (is_on_top(k))
          sum += 0.5 / 3. * f(at(k)) *
                 cross(at(face.nodes[1]) - at(face.nodes[0]), at(face.nodes[2]) - at(face.nodes[0])).norm();
    return sum;
  }

  const Vec3 &x(const NodeIndex k) const { return scene_.mesh.X[k]; }
  bool        is_linear() const { return scene_.discretization.pair() == ElementPair::mini; }
  bool        is_on_top(const NodeIndex k) const { return x(k)[2] > edge - 1e-9; }

  static constexpr double edge_stiffness = 0.3;

  const bool counts_closing_;
  Scene      scene_;
};

/// What a hand computes of increment i.
struct ByHand
{
  double h = edge, q = edge, e, effort, side, dt = stroke / n_increments / v;

  ByHand() { update(); }

  void advance()
  {
    q *= 1. + v * dt / (2. * h);
    h -= v * dt;
    update();
  }

  void update()
  {
    e      = v / h;
    effort = 3. * K * e * e * h * q * q / (v + faster);
    side   = 4. * h * q;
  }
};

void check_values(const Upsetting &run)
{
  double              energy = 0., closing = 0., mean = 0., largest = 0., wear = 0., areas = 0., squares = 0.;
  constexpr double    gamma     = 12.;
  double              pressures = 0., shears = 0., volumes = 0., late_pressures = 0., late_volumes = 0.;
  std::vector<double> fold(4, 0.);
  ByHand              hand;
  for (int i = 0; i < n_increments; ++i, hand.advance())
  {
    const double begin = i * stroke / n_increments, end = (i + 1) * stroke / n_increments;
    energy += hand.dt * (v + faster) * hand.effort;
    closing += hand.dt * rho * faster * faster * run.pushed_area(hand.q, hand.h); // all of it where m = 1
    mean += hand.effort * std::max(0., std::min(8.6, end) - std::max(4.1, begin)) / 4.5;
    largest           = std::max(largest, hand.effort);
    const double area = run.pushed_area(hand.q, hand.h), volume = hand.dt * hand.h * hand.q * hand.q;
    wear += hand.dt * rho * faster * hand.e / 2. * run.pushed_moment(hand.q, hand.h);
    areas += hand.dt * area;
    squares += hand.dt * area * area;
    volumes += volume;
    pressures += volume * std::pow(Upsetting::pressure(i), gamma);
    shears += volume * std::pow(std::sqrt(3.) * K * hand.e, gamma);
    const double late = volume * std::max(0., end - std::max(8.2, begin)) / (end - begin);
    late_volumes += late;
    late_pressures += late * std::pow(Upsetting::pressure(i), gamma);
    for (int alpha = 1; alpha <= 4; ++alpha)
      fold[alpha - 1] += hand.dt * std::pow(hand.e, alpha) * hand.side;
  }
  using Over = PathWindow::Over;
  Errors errors;
  errors.compare("energy", run.value(EnergyObjective()), energy);
  errors.compare("energy with the work on gaps that close",
                 Upsetting(ElementPair::mini, true).value(EnergyObjective()),
                 energy + closing);
  const Effort by_power(1);
  errors.compare("mean effort over stroke", run.value(MeanEffort(by_power, {Over::stroke, 4.1, 8.6})), mean);
  errors.compare("mean effort over time", run.value(MeanEffort(by_power, {Over::time, 0.041, 0.086})), mean);
  for (int alpha = 1; alpha <= 4; ++alpha)
    errors.compare("fold", run.value(FoldObjective(alpha)), fold[alpha - 1]);
  for (const double alpha : {1., 2.5, 4., 10.})
    errors.compare("dimensionless fold", run.value(DimensionlessFold(alpha)), 1.);
  for (const double exponent : {1., 30.})
    errors.compare("contact pressure", run.value(ContactPressure(1, exponent, 1.)), rho * faster);
  const Upsetting quadratic(ElementPair::taylor_hood);
  for (const double exponent : {1., 30.})
  {
    errors.compare("contact pressure with edges",
                   run.pressure_with_edges(ContactPressure(1, exponent, 1.)),
                   run.pressure_with_edges_by_hand(exponent));
    errors.compare("contact pressure, quadratic velocities",
                   quadratic.pressure_with_edges(ContactPressure(1, exponent, 1.)),
                   quadratic.pressure_with_edges_by_hand(exponent));
  }
  const StressMaximum pressure(InnerStress::pressure, gamma, 5.), shear(InnerStress::shear, gamma, 5.);
  errors.compare("hydrostatic pressure", run.value(pressure), std::pow(pressures / volumes, 1. / gamma));
  errors.compare("true maximum of it",
                 pressure.details(run.rows(pressure)).at("true maximum"),
                 Upsetting::pressure(n_increments - 1));
  errors.compare("shear", run.value(shear), std::pow(shears / volumes, 1. / gamma));
  const SmoothRegion around{{Vec3({-200., -200., -200.}), Vec3({200., 200., 200.})}, 1.};
  errors.compare("pressure late, in a box around all",
                 run.value(StressMaximum(InnerStress::pressure, gamma, 5., {Over::stroke, 8.2, 99.}, around)),
                 std::pow(late_pressures / late_volumes, 1. / gamma));
  errors.compare("wear, total", run.value(DieWear(1, Wear::total)), wear);
  errors.compare("wear, mean", run.value(DieWear(1, Wear::mean)), wear * areas / squares);
  errors.compare("wear of a die without pressure", run.value(DieWear(0, Wear::mean)), 0.);
  errors.compare("die without pressure", run.value(ContactPressure(0, 8., 1.)), 0.);
  const MaximumEffort maximum(by_power, {}, {});
  errors.compare("true maximum of the effort", maximum.true_maximum(run.rows(maximum)), largest);
  std::cout << "by hand" << std::endl;
  errors.print(1e-12);
}

void check_maxima(const Upsetting &run)
{
  std::cout << "smooth maxima of the effort" << std::endl;
  for (const auto kind : {SmoothMaximum::Kind::p_norm, SmoothMaximum::Kind::log_sum_exp})
    for (const double sharpness : {10., 50., 200.})
    {
      const bool          p_norm = kind == SmoothMaximum::Kind::p_norm;
      const MaximumEffort any(Effort(1), {}, {});
      const double        largest = any.true_maximum(run.rows(any));
      const SmoothMaximum any_kind{kind, p_norm ? sharpness : sharpness / largest};
      const double        plain  = run.value(MaximumEffort(Effort(1), {}, any_kind, 0.));
      const double        fitted = run.value(MaximumEffort(Effort(1), {}, any_kind));
      const double        bound  = p_norm ? largest * std::pow(1. / n_increments, 1. / sharpness)
                                          : largest * (1. - std::log(n_increments) / sharpness);
      std::cout << "  " << (p_norm ? "p-norm" : "log-sum-exp") << ", sharpness " << sharpness << ": "
                << 100. * (plain / largest - 1.) << " % off, within its bounds: "
                << (plain <= largest * (1. + 1e-14) && plain >= bound ? "yes" : "NO")
                << "; fitted as near as 0.1 %: " << (std::abs(fitted / plain - 1.) < 1e-3 ? "yes" : "NO")
                << std::endl;
    }
}

/// Values and derivatives in the integrals of a run in which nothing moves.
void check_at_rest(const Upsetting &run)
{
  std::cout << "at rest, finite" << std::endl;
  const EnergyObjective                    energy;
  const MaximumEffort                      p_norm(Effort(1), {}, {});
  const FoldObjective                      fold(1.);
  const DimensionlessFold                  dimensionless(4.);
  const ContactPressure                    pressure(0, 8., 1.);
  const StressMaximum                      shear(InnerStress::shear, 8., 1.);
  const DieWear                            wear(1, Wear::mean);
  const LargestWear                        largest_wear(1, run.sites(), 20.);
  const std::vector<const PathObjective *> objectives = {
    &energy, &p_norm, &fold, &dimensionless, &pressure, &shear, &wear, &largest_wear};
  for (const PathObjective *objective : objectives)
  {
    const auto rows   = run.rows(*objective, 0.);
    bool       finite = objective->value(rows) == 0.;
    for (const auto &row : objective->reverse_value(rows))
      for (const double bar : row.integrals)
        finite = finite && std::isfinite(bar);
    std::cout << "  " << objective->name() << " [" << objective->unit() << "]: " << (finite ? "yes" : "NO")
              << std::endl;
  }
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  const Upsetting run;
  check_values(run);
  check_maxima(run);
  check_at_rest(run);
  std::cout << "refused" << std::endl;
  using Over = PathWindow::Over;
  refused([] { MeanEffort(Effort(1), {Over::time, 2., 1.}); });
  refused([&] { run.value(MeanEffort(Effort(1), {Over::stroke, 11., 12.})); });
  refused([&] { run.value(MeanEffort(Effort(0), {})); });
  refused([] { FoldObjective(0.5); });
  refused([] { FoldObjective(2., SmoothRegion{{Vec3(), Vec3({1., 1., 1.})}, 0.}); });
  refused([] { FoldObjective(2., SmoothRegion{{Vec3(), Vec3({1., -1., 1.})}, 1.}); });
  refused([] { ContactPressure(0, 0.5, 1.); });
  refused([] { ContactPressure(0, 8., 0.); });
  refused([] { StressMaximum(InnerStress::shear, 0.5, 1.); });
  refused([] { StressMaximum(InnerStress::pressure, 8., 0.); });
  refused([] { StressMaximum(InnerStress::pressure, 8., 1., {Over::time, 2., 1.}); });
  refused([] { DieWear(0, Wear::mean, {}, SmoothRegion{{Vec3(), Vec3({1., 1., 1.})}, 0.}); });
  refused([&] { LargestWear(1, run.sites(), 0.5); });
  refused([] { MaximumEffort(Effort(1), {}, {SmoothMaximum::Kind::p_norm, 0.}); });
  refused([] { MaximumEffort(Effort(1), {}, {SmoothMaximum::Kind::log_sum_exp, 0.}); });
  refused([] { MaximumEffort(Effort(1), {}, {}, 1.5); });
}
