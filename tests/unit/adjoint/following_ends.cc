// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Whole runs whose increments end where the state does (steps/moved_ends.h) and whose new meshes follow the shape
// (steps/following_mesh.h): a sector of a cylinder under a bell, whose mesh is made anew by its quality, at constant speed,
// by a crank with metal that hardens and conducts heat, and in two operations. Proved of the energy, the wear of a die, the
// largest effort, mean efforts over windows of stroke and of time that begin within an increment, and the radius at the end:
// - the backward sweep agrees with the direct method to 1e-10 and with replayed differences to 1e-6, by the offset of
//   the bell and the nodes, at constant speed by the radius, K and m and the vertices of the bell, too; the remainder is
//   of second order;
// - nothing moves in a replay of the nominal run, which is that of increments that are held to rounding; elsewhere ends
//   move, each increment begins where the one before ends, and the end of an operation stays;
// - by the offset, slopes of increments that are held are others by more than 1e-3;
// - each term is needed, on two ranks, too: the direct method, made here of the parts that the library makes it of, agrees with the
//   sweep, and without any one of them it does not, in the objectives that are told.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/radius.h>
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/steps/moved_ends.h>

#include "../material/hot_metals.h"
#include "../random_numbers.h"
#include "../steps/crank_press.h"
#include "curved_scenes.h"
#include "ways.h"

using namespace retroforge;

namespace
{
  constexpr unsigned int bell = 1;

  /// @param strokes  of the operations, each with a bell that stands where the one before stopped
  Parameters scene(const std::vector<double> &strokes)
  {
    Parameters p                                         = bell_scene();
    p.billet.element_size                                = 9.;
    p.dies[bell].shape.choose<BellDie>().rotations.angle = 2.3;
    p.press.stroke                                       = strokes[0];
    p.press.increments                                   = std::lround(strokes[0]);
    p.newton.tolerance                                   = 1e-13;
    p.remeshing.when                                     = RemesherParameters::When::quality;
    p.remeshing.local.trigger_angle                      = 28.;
    p.remeshing.local.goal_angle                         = 30.;
    for (std::size_t o = 1; o < strokes.size(); ++o)
    {
      p.dies.push_back(p.dies[bell]);
      p.dies.back().name = "bell " + std::to_string(o + 1);
      p.dies.back().point[2] -= strokes[o - 1];
    }
    return p;
  }

  /// @param one_die  whether the bell moves in all of the run, whose force can be told then
  Objectives objectives(const bool one_die)
  {
    Objectives all;
    const auto add_path = [&](const std::string &name, std::unique_ptr<PathObjective> path) {
      all.push_back({name, 1., SymmetryScaling::none, invalid_index, std::move(path), nullptr});
    };
    const Effort     effort(bell);
    const PathWindow late{PathWindow::Over::stroke, 2.6, 1e9}, later{PathWindow::Over::time, 0.033, 1e9};
    add_path("energy", std::make_unique<EnergyObjective>());
    add_path("wear", std::make_unique<DieWear>(0, Wear::total, late));
    if (one_die)
    {
      add_path("largest effort", std::make_unique<MaximumEffort>(effort, PathWindow(), SmoothMaximum(), 0.3));
      add_path("mean effort", std::make_unique<MeanEffort>(effort, late));
      add_path("mean effort by time", std::make_unique<MeanEffort>(effort, later));
    }
    all.push_back({"radius",
                   1.,
                   SymmetryScaling::none,
                   invalid_index,
                   nullptr,
                   std::make_unique<RadiusObjective>(
                     RadiusStatistic::mean, std::vector<std::string>{"side"}, Vec3(), Vec3({0., 0., 1.}))});
    return all;
  }

  /// The part of a vector that keeps a node of the billet in its planes: those of symmetry, and top and bottom.
  Vec3 free_part(const TetMesh &mesh, const double height, const NodeIndex node, Vec3 x)
  {
    const Vec3 &at = mesh.X[node];
    if (at[2] < 1e-6 || at[2] > height - 1e-6)
      x[2] = 0.;
    if (std::hypot(at[0], at[1]) < 1e-6)
      return Vec3({0., 0., x[2]});
    for (const Patch &patch : mesh.patches)
      if (patch.symmetry && std::abs((at - patch.symmetry->point) * patch.symmetry->normal) < 1e-6)
        x -= (x * patch.symmetry->normal) * patch.symmetry->normal;
    return x;
  }

  ForgingProblem
  problem_of(Parameters p, const AdjointParameters::Remeshings remeshings, const std::vector<double> &strokes)
  {
    p.adjoint.remeshings = remeshings;
    p.resolve_defaults({p.billet.height, p.billet.height});
    TetMesh       mesh = make_billet(p.billet, MPI_COMM_WORLD);
    RandomNumbers numbers;
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      mesh.X[k] += 0.02 * p.billet.element_size * free_part(mesh, p.billet.height, k, numbers.vector());
    std::vector<Die> dies;
    for (const DieParameters &die : p.dies)
      dies.push_back(die.die());
    Process<double> process = p.process({p.billet.height, p.billet.height});
    if (strokes.size() > 1)
    {
      const Operation<double> first = process.operations.front();
      process.operations.clear();
      for (unsigned int o = 0; o < strokes.size(); ++o)
      {
        Operation<double> &operation = process.operations.emplace_back(first);
        operation.dies               = {0, bell + o};
        operation.leading_die        = bell + o;
        operation.stroke             = strokes[o];
      }
    }
    return {p, std::move(mesh), std::move(dies), std::move(process), objectives(strokes.size() == 1)};
  }

  /// By the offset of the bell and random positions of the nodes first.
  std::vector<Way> ways_of(const RecordedRun &run)
  {
    const TetMesh             &mesh   = run.scene.mesh;
    const double               height = run.parameters.billet.height;
    const NodalVectors<double> still(mesh.n_nodes());
    NodalVectors<double>       wider = still, nodes = still;
    RandomNumbers              numbers;
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    {
      wider[k] = Vec3({mesh.X[k][0], mesh.X[k][1], 0.}) / run.parameters.billet.radius;
      nodes[k] = free_part(mesh, height, k, numbers.vector());
    }
    return {Way{{"offset", still, 0., 1., {}}},
            Way{{"nodes", nodes, 0., 0., {}}},
            Way{{"radius", wider, 0., 0., {}}},
            Way{{"K and m", still, 0., 0., {}},
                [](Process<double> &dot) {
                  dot.material.law.K = 1.;
                  dot.material.law.m = 0.1;
                }},
            Way{random_vertices(run)}};
  }

  /// What can be left out of the direct method.
  enum class Term
  {
    none,
    state,   ///< what positions are ahead by
    made,    ///< those at which the mesh was made
    carry,   ///< the start, in the end
    start,   ///< where dies begin
    end,     ///< where they end
    mesh,    ///< where dies are at which nodes are put when the mesh is made anew
    shape,   ///< that new meshes follow the shape
    strokes, ///< of rows
    times    ///< of rows
  };

  std::vector<FollowingRule> rules_of(const RecordedRun &run)
  {
    std::vector<StrokeStep> increments;
    for (const IncrementRecord &record : run.records)
      increments.push_back(place(record));
    return following_rules(increments, run.state().remeshed);
  }

  /// The direct method as tangent_sweep has it, without a term.
  std::vector<Dual> tangent(const RecordedRun &run, const Way &way, const Term omitted)
  {
    const auto [process, X_0] = at<Dual>(run, way, 0.);
    std::shared_ptr<MeshEpoch>  epoch(&run.first_epoch(), [](MeshEpoch *) {});
    std::vector<PathRows<Dual>> rows(run.objectives().size());
    auto state = workpiece_before(process, NodalVectors<Dual>(X_0), epoch->scene.mesh.n_cells());
    NodalVectors<Dual> X_made = state.X;
    const auto         rules  = rules_of(run);
    MovedEnds<Dual>    ends;
    StrokeStep         end{0., 0.};
    for (std::size_t i = 0; i < run.records.size(); ++i)
    {
      const IncrementRecord &record = run.records[i];
      if (record.operation != end.operation)
        state.velocity.clear();
      if (record.remesh)
      {
        const Dual       moved = omitted == Term::mesh ? Dual(0.) : ends.end;
        const StrokeStep at{record.stroke, 0., record.operation};
        const auto       following = following_mesh(omitted != Term::shape, i, *record.remesh);
        state                      = change_mesh(epoch->scene.mesh,
                            *record.remesh,
                            state,
                            run.dies(),
                            with_moved_ends(process, at, {moved, moved}).over(at).dies,
                            following.get());
        epoch  = std::make_shared<MeshEpoch>(record.remesh->mesh, run.model(), timings_of_runs());
        X_made = state.X;
      }
      end  = place(record);
      ends = {ends.end, Dual(0.)};
      {
        NodalVectors<double> X, made;
        convert(state.X, X);
        convert(X_made, made);
        const FollowingEnd following(epoch->scene.mesh,
                                     made,
                                     X,
                                     epoch->increment.mechanics.mean_velocity(record),
                                     run.process(),
                                     end,
                                     rules[i]);
        NodalVectors<Dual> X_nominal, made_nominal;
        convert(X, X_nominal);
        convert(made, made_nominal);
        ends.end = following.moved(omitted == Term::carry ? Dual(0.) : ends.start,
                                   omitted == Term::made ? made_nominal : X_made,
                                   omitted == Term::state ? X_nominal : state.X);
      }
      const MovedEnds<Dual> of_dies{omitted == Term::start ? Dual(0.) : ends.start,
                                    omitted == Term::end ? Dual(0.) : ends.end};
      const PathRow<Dual> still = row_of<Dual>(record, process, {});
      for (auto &of_objective : rows)
      {
        of_objective.push_back(row_of<Dual>(record, process, ends));
        if (omitted == Term::strokes)
          of_objective.back().stroke = still.stroke, of_objective.back().step = still.step;
        if (omitted == Term::times)
          of_objective.back().time = still.time, of_objective.back().dt = still.dt;
      }
      epoch->increment.tangent(
        with_moved_ends(process, end, of_dies),
        record,
        [&](const EquilibriumView<Dual> &view, const Dual &) {
          for (std::size_t o = 0; o < rows.size(); ++o)
            if (run.objectives()[o].path)
              add_integrals(*run.objectives()[o].path, view, rows[o].back());
        },
        state);
    }
    const auto        physics = process.at_stroke(end.stroke + end.step, end.operation);
    std::vector<Dual> values;
    for (std::size_t o = 0; o < rows.size(); ++o)
      if (run.objectives()[o].path)
        values.push_back(run.objectives()[o].path->value(rows[o]));
      else
      {
        const FinalObjective &objective = *run.objectives()[o].at_end;
        const FinalDecisions &decisions = run.trace().recorded().decisions[o];
        const auto            view      = final_view(objective, epoch->scene, state, physics);
        values.push_back(objective.value(objective.integrals(view, decisions).complete(), decisions));
      }
    return values;
  }

  void check_terms(const RecordedRun &run, const std::vector<AdjointResult> &bars, const Way &way)
  {
    const auto errors = [&](const Term omitted) {
      const auto          tangents = tangent(run, way, omitted);
      std::vector<double> list;
      for (std::size_t o = 0; o < bars.size(); ++o)
        list.push_back(relative_error(tangents[o].dx(0), slope(run, bars[o], way)));
      return list;
    };
    const auto complete = errors(Term::none);
    std::cout << "  complete: within 1e-10: "
              << yes(*std::max_element(complete.begin(), complete.end()) < 1e-10) << "\n";
    for (const auto &[term, name] :
         std::vector<std::pair<Term, std::string>>{{Term::state, "what positions are ahead by"},
                                                   {Term::made, "where meshes were made"},
                                                   {Term::carry, "starts in ends"},
                                                   {Term::start, "where dies begin"},
                                                   {Term::end, "where dies end"},
                                                   {Term::mesh, "dies at new meshes"},
                                                   {Term::shape, "the shape that new meshes follow"},
                                                   {Term::strokes, "strokes of rows"},
                                                   {Term::times, "times of rows"}})
    {
      const auto without = errors(term);
      std::cout << "  without " << name << ", off by more than 1e-6:";
      bool none = true;
      for (std::size_t o = 0; o < without.size(); ++o)
        if (without[o] > 1e-6)
        {
          std::cout << (none ? " " : ", ") << run.objectives()[o].name;
          none = false;
        }
      std::cout << (none ? " NOTHING" : "") << "\n";
    }
  }

  void check_nominal(const RecordedRun &run, const RecordedRun &held)
  {
    const auto replayed = run.replay(run.process(), run.X_0()),
               other    = held.replay(held.process(), held.X_0());
    double apart        = 0.;
    for (std::size_t k = 0; k < other.workpiece.X.size(); ++k)
      apart = std::max(apart, (replayed.workpiece.X[k] - other.workpiece.X[k]).norm());
    std::cout << "  nominal replays: energies within 1e-14: "
              << yes(relative_error(replayed.energy.total(), other.energy.total()) < 1e-14)
              << ", nodes within 1e-12 mm: " << yes(apart < 1e-12) << "\n";
  }

  /// Where increments of a replay elsewhere begin and end.
  void check_ends(const RecordedRun &run, const Way &way)
  {
    const auto [process, X] = at<double>(run, way, 1e-2);
    bool         meet = true, move = true, stay = true;
    double       before = 0.; // by how much the last one ended beside its record
    unsigned int i      = 0;
    run.replay(process, X, [&](const IncrementEvent &event) {
      const bool is_last =
        i + 1 == run.records.size() || run.records[i + 1].operation != event.record.operation;
      meet = meet && event.ends.start == before;
      if (is_last)
        stay = stay && event.ends.end == 0.;
      else
        move = move && event.ends.end != 0.;
      before = event.ends.end;
      ++i;
    });
    std::cout << "  others: ends move: " << yes(move) << ", increments meet: " << yes(meet)
              << ", ends of operations stay: " << yes(stay) << "\n";
  }

  /// Whether slopes of increments that are held are others.
  void check_held(const RecordedRun                &run,
                  const std::vector<AdjointResult> &bars,
                  const RecordedRun                &held,
                  const Way                        &way)
  {
    const auto held_bars = held.sweep(each(held.objectives())).gradients;
    std::cout << "  held, off by more than 1e-3 by the offset:";
    for (std::size_t o = 0; o < bars.size(); ++o)
      std::cout << (o > 0 ? ", " : " ") << run.objectives()[o].name << " "
                << yes(relative_error(slope(held, held_bars[o], way), slope(run, bars[o], way)) > 1e-3);
    std::cout << "\n";
  }

  /// @param n_ways  by which slopes are compared with differences
  void check(const std::string         &name,
             const Parameters          &p,
             const std::vector<double> &strokes,
             const unsigned int         n_ways)
  {
    using Remeshings = AdjointParameters::Remeshings;
    const RecordedRun run(problem_of(p, Remeshings::follow, strokes)),
      held(problem_of(p, Remeshings::hold, strokes));
    const auto &remeshed = run.state().remeshed;
    std::cout << name << "\n  made anew on the way, twice or more: "
              << yes(std::count_if(
                       remeshed.begin(), remeshed.end(), [](const unsigned int i) { return i > 0; }) > 1)
              << ", ends follow: " << yes(run.follows_trend())
              << ", others are held: " << yes(!held.follows_trend()) << "\n";
    const std::vector<Way> ways = ways_of(run);
    const auto             bars = run.sweep(each(run.objectives())).gradients;
    check_nominal(run, held);
    check_ends(run, ways[1]);
    check_held(run, bars, held, ways[0]);
    WorstErrors worst;
    for (unsigned int w = 0; w < n_ways; ++w)
    {
      const auto errors = slope_errors(run, ways[w], bars, 1e-3);
      for (std::size_t o = 0; o < errors.size(); ++o)
        worst.take(errors[o], run.objectives()[o].name + " by " + ways[w].direction.name);
    }
    if (n_ways > 0)
      worst.print("  ");
    check_terms(run, bars, ways[0]);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  const bool                is_alone = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
  const std::vector<double> one = {8.}, two = {4., 4.};
  check("constant speed", scene(one), one, is_alone ? 5 : 0);
  if (!is_alone)
    return 0;
  add_crank_press();
  Parameters crank           = conducting(scene(one));
  crank.press.motion_type    = "crank";
  crank.press.motion_numbers = {50., 30.};
  check("a crank, metal that hardens and conducts heat", crank, one, 2);
  check("two operations", scene(two), two, 2);
}
