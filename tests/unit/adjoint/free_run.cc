// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The gradient of the free run. A sector of a cylinder under a bell, remeshed every second increment, forged again at
// parameters that are moved by little, everything decided anew: increments, contact, meshes. Nodes are a little off
// their places, so that no two edges are equally long. Proved for the mini element, without and with hardening, whose strain
// goes from mesh to mesh, and for P2-P1 with it, by the offset of the die, the consistency K, the radius, random positions of all nodes, and random vertices of the bell: central
// differences agree with the adjoint to 1e-4 in two steps each, and the direct method to 1e-8. The bell is turned by
// 2.3 degrees, so that no node of a plane of symmetry stands over an edge of its facets; its vertices move by more than
// what the metal sinks into it, which remeshing puts back onto it. With positions that are interpolated, what remeshing does to
// them held fixed, the adjoint by positions is off by more than 1e-3. These are slopes between two jumps: remeshings repeat
// their operations. A sweep that has one increment at a time, as from the disk, has the same derivatives, also where new
// meshes follow the shape.

#include <deal.II/base/mpi.h>

#include "../random_numbers.h"
#include "recorded_run.h"
#include <retroforge/adjoint/sweep.h>

#include <array>
#include <cstdio>
#include <limits>

using namespace retroforge;

namespace
{
  Parameters scene(const Parameters &with)
  {
    Parameters p             = with;
    p.billet.shape           = BilletParameters::Shape::cylinder;
    p.billet.radius          = 20.;
    p.billet.height          = 24.;
    p.billet.symmetry_planes = {Vec3({0., -1., 0.}), Vec3({-std::sqrt(0.75), 0.5, 0.})};
    p.billet.element_size    = 9.;
    p.dies                   = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing         = Vec3({0., 0., 1.});
    p.dies[1].facing         = Vec3({0., 0., -1.});
    p.dies[1].point          = Vec3({0., 0., 18.9});
    p.dies[1].velocity       = Vec3({0., 0., -100.});
    p.dies[0].friction       = 0.4;
    p.dies[1].friction       = 0.3;
    auto &bell               = p.dies[1].shape.choose<BellDie>();
    bell.chord_error         = 0.3;
    bell.feature_angle       = 40.;
    bell.largest_sagitta     = 1.;
    bell.rotations.angle     = 2.3;
    bell.shape               = {{}, 30., 50., {6., 60., 2., 14.}};
    p.press.stroke           = 2.;
    p.press.increments       = 4;
    p.newton.tolerance       = 1e-13;
    p.adjoint.tolerance      = 1e-13;
    p.linear_solver.method   = LinearSolverParameters::Method::direct;
    p.remeshing.when         = RemesherParameters::When::increments;
    p.remeshing.every        = 2;
    p.resolve_defaults({p.billet.height, p.billet.height});
    return p;
  }

  /// A direction of all that is varied.
  struct Direction
  {
    const char          *name;
    NodalVectors<double> X;
    double               offset = 0., K = 0.;
    NodalVectors<double> vertices = {};
  };

  using Records = std::vector<IncrementRecord>;

  struct Forged
  {
    std::unique_ptr<ForwardRun> run;
    double                      energy;
    Records                     records;
  };

  /// The record of an increment with positions that are interpolated, and moved by what was left.
  IncrementRecord interpolated(IncrementRecord record)
  {
    if (!record.remesh)
      return record;
    auto                    remesh = std::make_shared<RemeshRecord>(*record.remesh);
    const TransferOperator &J      = remesh->transfer;
    PositionTape            tape;
    tape.n_inputs = J.n_old;
    for (NodeIndex k = 0; k < J.n_new(); ++k)
    {
      tape.rules.push_back(static_cast<unsigned char>(PlacingRule::sum));
      tape.arguments.insert(
        tape.arguments.end(), &J.node[J.begin[k]], &J.node[J.begin[k]] + J.begin[k + 1] - J.begin[k]);
      tape.numbers.insert(
        tape.numbers.end(), &J.weight[J.begin[k]], &J.weight[J.begin[k]] + J.begin[k + 1] - J.begin[k]);
      tape.numbers.insert(tape.numbers.end(), J.offset[k].begin_raw(), J.offset[k].end_raw());
      tape.argument_begin.push_back(tape.arguments.size());
      tape.number_begin.push_back(tape.numbers.size());
      tape.results.push_back(tape.n_inputs + k);
    }
    remesh->positions = std::move(tape);
    record.remesh     = remesh;
    return record;
  }

  class Bench
  {
  public:
    Bench(const Parameters &with, const bool show)
        : p_(scene(with))
        , mesh_(make_billet(p_.billet, MPI_COMM_WORLD))
        , dies_({p_.dies[0].die(), p_.dies[1].die()})
        , process_(p_.process({p_.billet.height, p_.billet.height}))
        , show_(show)
    {
      for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
      {
        const double further = 1. + 0.013 * std::sin(0.1 * mesh_.X[k][0] + 0.07 * mesh_.X[k][1]);
        const Vec3   off     = 0.02 * p_.billet.element_size * free(k, numbers_.vector());
        mesh_.X[k]           = Vec3({further * mesh_.X[k][0], further * mesh_.X[k][1], mesh_.X[k][2]}) + off;
      }
      nominal_              = forged(Direction{"", NodalVectors<double>(mesh_.n_nodes())}, 0.);
      const ForwardRun &run = *nominal_.run;
      bar_                  = run.sweep(each(run.objectives())).gradients[0];
      Records frozen;
      for (const IncrementRecord &record : nominal_.records)
        frozen.push_back(interpolated(record));
      const RecordedForging recorded{
        run.model(),
        std::shared_ptr<MeshEpoch>(&run.first_epoch(), [](MeshEpoch *) {}),
        run.process(),
        [&](const unsigned int i) -> const IncrementRecord & { return frozen[i]; },
        run.state().increments,
        run.objectives(),
        run.trace().recorded(),
        timings_of_runs()};
      frozen_bar_ = adjoint_sweep(recorded, run.state(), each(run.objectives())).gradients[0];
      // As from the disk, where an increment that is read takes the place of the one before: that is of no use any more.
      std::array<IncrementRecord, 2> places;
      unsigned int                   last       = 0;
      RecordedForging                one_by_one = recorded;
      one_by_one.meshes_follow                  = run.follows_trend();
      one_by_one.record                         = [&](const unsigned int i) -> const IncrementRecord                         &{
        places[last].stroke = std::numeric_limits<double>::quiet_NaN();
        last                = 1 - last;
        places[last]        = nominal_.records[i];
        return places[last];
      };
      const AdjointResult again = adjoint_sweep(one_by_one, run.state(), each(run.objectives())).gradients[0];
      is_same_one_by_one_       = again.X_0 == bar_.X_0 &&
                            again.process.dies[1].velocity == bar_.process.dies[1].velocity &&
                            again.process.dies[1].displacement == bar_.process.dies[1].displacement;
    }

    void describe() const
    {
      std::size_t written = 0;
      for (const IncrementRecord &record : nominal_.records)
        written += record.remesh ? record.remesh->positions.n_operations() : 0;
      std::printf("  remeshed: %zu times, positions found by operations: %s\n",
                  nominal_.run->state().remeshed.size(),
                  written > 50 ? "yes" : "FEW");
      std::printf("  increments read one by one: the same derivatives: %s\n",
                  is_same_one_by_one_ ? "yes" : "NO");
    }

    /// @param vertex_steps  of the mini element smaller ones: middles of edges touch with small jumps. At 3e-7 energies
    /// round: by the kernels of the BLAS, differences are 1.5e-6 to 1.7e-4 beside the slope
    void check_all(const std::array<double, 2> &vertex_steps)
    {
      Direction direction{"offset", NodalVectors<double>(mesh_.n_nodes())};
      direction.offset = 1.;
      check(direction, {{1e-3, 1e-4}});
      direction   = {"K", NodalVectors<double>(mesh_.n_nodes())};
      direction.K = process_.material.law.K;
      check(direction, {{1e-3, 1e-4}});
      direction = {"radius", NodalVectors<double>(mesh_.n_nodes())};
      for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
        direction.X[k] = Vec3({mesh_.X[k][0], mesh_.X[k][1], 0.}) / p_.billet.radius;
      check(direction, {{1e-4, 1e-5}});
      direction.name = "positions";
      for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
        direction.X[k] = free(k, numbers_.vector());
      check(direction, {{1e-5, 1e-6}});
      direction = {"vertices", NodalVectors<double>(mesh_.n_nodes())};
      for (std::size_t k = 0; k < dies_[1].surface()->vertices().size(); ++k)
        direction.vertices.push_back(numbers_.vector());
      check(direction, vertex_steps);
    }

  private:
    /// The part of a vector that keeps a node in its planes: those of symmetry, and top and bottom.
    Vec3 free(const NodeIndex node, Vec3 x) const
    {
      const double z = mesh_.X[node][2];
      if (z < 1e-6 || z > p_.billet.height - 1e-6)
        x[2] = 0.;
      if (std::hypot(mesh_.X[node][0], mesh_.X[node][1]) < 1e-6)
        return Vec3({0., 0., x[2]});
      for (const Patch &patch : mesh_.patches)
        if (patch.symmetry &&
            std::abs((mesh_.X[node] - patch.symmetry->point) * patch.symmetry->normal) < 1e-6)
          x -= (x * patch.symmetry->normal) * patch.symmetry->normal;
      return x;
    }

    Forged forged(const Direction &direction, const double h) const
    {
      TetMesh          mesh    = mesh_;
      std::vector<Die> dies    = dies_;
      Process<double>  process = process_;
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
        mesh.X[k] += h * direction.X[k];
      if (!direction.vertices.empty())
      {
        NodalVectors<double> vertices = dies[1].surface()->vertices();
        for (std::size_t k = 0; k < vertices.size(); ++k)
          vertices[k] += h * direction.vertices[k];
        dies[1] = dies[1].moved(std::move(vertices));
      }
      process.dies[1].displacement[2] += h * direction.offset;
      process.material.law.K += h * direction.K;
      Forged made{std::make_unique<ForwardRun>(ForgingProblem(p_, std::move(mesh), std::move(dies), process),
                                               ForwardRun::Keep::increments,
                                               timings_of_runs()),
                  0.,
                  {}};
      made.run->forge();
      made.energy       = made.run->values()[0];
      const auto access = made.run->recording().access();
      for (unsigned int i = 0; i < made.run->state().increments; ++i)
        made.records.push_back(access(i));
      return made;
    }

    static double slope(const AdjointResult &bar, const Direction &direction)
    {
      return dot(bar.X_0, direction.X) + bar.process.dies[1].displacement[2] * direction.offset +
             bar.process.material.law.K * direction.K +
             (direction.vertices.empty() ? 0. : dot(bar.process.dies[1].vertices, direction.vertices));
    }

    double tangent(const Direction &direction) const
    {
      const auto         along   = [](Dual &x, const double &d) { x.fastAccessDx(0) = d; };
      Process<Dual>      process = converted<Dual>(process_);
      NodalVectors<Dual> X;
      convert(mesh_.X, X);
      for_each_number(along, X, direction.X);
      along(process.dies[1].displacement[2], direction.offset);
      along(process.material.law.K, direction.K);
      if (!direction.vertices.empty())
      {
        convert(dies_[1].surface()->vertices(), process.dies[1].vertices);
        for_each_number(along, process.dies[1].vertices, direction.vertices);
      }
      return nominal_.run->tangent(process, X)[0].dx(0);
    }

    void check(const Direction &direction, const std::array<double, 2> &steps)
    {
      const double adjoint = slope(bar_, direction), frozen = slope(frozen_bar_, direction) / adjoint - 1.;
      double       worst = 0.;
      for (const double h : steps)
      {
        const double difference = (forged(direction, h).energy - forged(direction, -h).energy) / (2. * h);
        worst                   = std::max(worst, std::abs(difference / adjoint - 1.));
        if (show_)
          std::fprintf(stderr, "    step %.0e: %.1e\n", h, difference / adjoint - 1.);
      }
      const auto yes = [](const bool condition) { return condition ? "yes" : "NO"; };
      std::printf("  %s: free differences within 1e-4: %s, direct method within 1e-8: %s",
                  direction.name,
                  yes(worst < 1e-4),
                  yes(std::abs(tangent(direction) / adjoint - 1.) < 1e-8));
      // Of the others it depends on the mesh.
      if (direction.name == std::string("positions"))
        std::printf(", interpolated positions off by more than 1e-3: %s", yes(std::abs(frozen) > 1e-3));
      std::printf("\n");
      if (show_)
        std::fprintf(stderr, "  %s: %.1e, interpolated %.1e\n", direction.name, worst, frozen);
    }

    RandomNumbers          numbers_;
    const Parameters       p_;
    TetMesh                mesh_;
    const std::vector<Die> dies_;
    const Process<double>  process_;
    Forged                 nominal_;
    AdjointResult          bar_, frozen_bar_;
    bool                   is_same_one_by_one_ = false;
    const bool             show_;
  };
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Parameters                               p;
  p.adjoint.remeshings = AdjointParameters::Remeshings::hold;
  std::printf("mini element\n");
  Bench mini(p, argc > 1);
  mini.describe();
  mini.check_all({{3e-6, 1e-6}});
  Parameters follow         = p;
  follow.adjoint.remeshings = AdjointParameters::Remeshings::follow;
  std::printf("mini element, new meshes follow the shape\n");
  Bench(follow, argc > 1).describe();
  p.material.type        = "power";
  p.material.numbers     = {{"n", 0.4}, {"q0", 0.1}, {"beta", 0.}, {"m1", 0.}, {"T0", 900.}};
  p.material.temperature = "900";
  std::printf("mini element, hardening\n");
  Bench hardening(p, argc > 1);
  hardening.describe();
  hardening.check_all({{3e-6, 1e-6}});
  p.discretization.choice.pair = ElementPair::taylor_hood;
  std::printf("P2-P1, hardening\n");
  Bench quadratic(p, argc > 1);
  quadratic.describe();
  quadratic.check_all({{3e-5, 3e-6}});
}
