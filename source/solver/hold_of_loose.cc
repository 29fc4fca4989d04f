// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <retroforge/element/mini_element.templates.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/solver/rigid_modes.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    /// A motion is loose where what resists it is felt at less than this part of its root mean square speed.
    constexpr double loose = 0.3;
    /// How much more than contacts planes of symmetry count: they do not give way, however little of a motion they
    /// see, as that of a bar about the end at which it is cut.
    constexpr double rigid = 1e4;
    /// Cosine of the least angle between the mean normals of dies that press from both sides.
    constexpr double opposed = -0.5;
    /// What a hold gives way to the force of the press, over the press speed: what it takes of the power is this
    /// at most, and as a rule much less.
    constexpr double yield = 1e-3;

    /// Six motions that are orthonormal in the nodes' mean.
    std::array<RigidMotion, 6> orthonormal_motions(const NodalVectors<double> &X)
    {
      Vec3 centre;
      for (const Vec3 &x : X)
        centre += x / static_cast<double>(X.size());
      dealii::SymmetricTensor<2, 3> inertia;
      for (const Vec3 &x : X)
      {
        const Vec3 arm = x - centre;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = i; j < 3; ++j)
            inertia[i][j] += ((i == j ? arm.norm_square() : 0.) - arm[i] * arm[j]) / X.size();
      }
      std::array<RigidMotion, 6> motions;
      const auto                 axes = dealii::eigenvectors(inertia);
      for (unsigned int i = 0; i < 3; ++i)
      {
        motions[i].slide[i]  = 1.;
        motions[i + 3].turn  = axes[i].second / std::sqrt(axes[i].first);
        motions[i + 3].slide = -cross(motions[i + 3].turn, centre);
      }
      return motions;
    }

    /// What a point's speed in a direction is in six motions.
    using Speeds = std::array<double, 6>;

    /// The mean square of what resists six motions, of one that is held all over about 1.
    class Holding
    {
    public:
      explicit Holding(const NodalVectors<double> &X) : basis_(orthonormal_motions(X)), gram_(6) {}

      Speeds speeds(const Vec3 &x, const Vec3 &direction) const
      {
        Speeds of;
        for (unsigned int i = 0; i < 6; ++i)
          of[i] = basis_[i].at(x) * direction;
        return of;
      }

      /// Adds what resists both ways at a point: friction, or a plane of symmetry.
      void add_two_sided(const Speeds &of, const double weight) { add(of, weight); }

      /// Adds what resists both ways of points that a die presses from one side: where it presses may shift
      /// among them. Of one point, or of those on a line, it is nothing.
      void add_one_sided(const std::vector<Speeds> &points)
      {
        const Speeds middle = mean(points);
        for (Speeds of : points)
        {
          for (unsigned int i = 0; i < 6; ++i)
            of[i] -= middle[i];
          add(of, 1. / points.size());
        }
      }

      /// Adds what dies that press from both sides resist together.
      void add_between(const std::vector<Speeds> &points, const std::vector<Speeds> &others)
      {
        Speeds       a = mean(points);
        const Speeds b = mean(others);
        for (unsigned int i = 0; i < 6; ++i)
          a[i] = 0.5 * (a[i] - b[i]);
        add(a, 1.);
      }

      std::vector<RigidMotion> loose_motions()
      {
        dealii::Vector<double>     eigenvalues;
        dealii::FullMatrix<double> eigenvectors;
        gram_.compute_eigenvalues_symmetric(-1., loose * loose, 0., eigenvalues, eigenvectors);
        std::vector<RigidMotion> motions(eigenvalues.size());
        for (unsigned int m = 0; m < motions.size(); ++m)
          for (unsigned int i = 0; i < 6; ++i)
          {
            motions[m].slide += eigenvectors(i, m) * basis_[i].slide;
            motions[m].turn += eigenvectors(i, m) * basis_[i].turn;
          }
        return motions;
      }

    private:
      static Speeds mean(const std::vector<Speeds> &points)
      {
        Speeds sum = {};
        for (const Speeds &of : points)
          for (unsigned int i = 0; i < 6; ++i)
            sum[i] += of[i] / points.size();
        return sum;
      }

      void add(const Speeds &of, const double weight)
      {
        for (unsigned int i = 0; i < 6; ++i)
          for (unsigned int j = 0; j < 6; ++j)
            gram_(i, j) += weight * of[i] * of[j];
      }

      std::array<RigidMotion, 6>       basis_;
      dealii::LAPACKFullMatrix<double> gram_;
    };

    /// Whether points that touch dies are in the way of a motion, and others in that of its opposite: what
    /// moves then is pressed, however their dies stand to each other.
    bool is_blocked_both_ways(const RigidMotion          &motion,
                              const ContactSet<double>   &contact,
                              const NodalVectors<double> &X)
    {
      double most = 0., least = 0.;
      for (unsigned int p = 0; p < contact.pairs.size(); ++p)
        if (const ContactPair &pair = contact.pairs[p]; pair.touching)
        {
          const double speed = motion.at(pair.point.position(X)) * contact.projections[p].n;
          most               = std::max(most, speed);
          least              = std::min(least, speed);
        }
      return std::min(most, -least) > loose;
    }

    std::vector<RigidMotion>
    loose_motions(const Scene &scene, const ContactSet<double> &contact, const NodalVectors<double> &X)
    {
      const ContactAreas<double> areas      = contact_areas(scene.mesh, scene.topology, contact, X);
      const double               n_touching = std::count_if(
        contact.pairs.begin(), contact.pairs.end(), [](const ContactPair &pair) { return pair.touching; });
      Holding                          holding(X);
      std::vector<std::vector<Speeds>> pressed(scene.dies.size());
      std::vector<Speeds>              fixed;
      std::vector<Vec3>                normals(scene.dies.size());
      for (NodeIndex k = 0; k < X.size(); ++k)
        for (const Vec3 &direction : scene.topology.fixed_directions[k])
          fixed.push_back(holding.speeds(X[k], direction));
      for (unsigned int p = 0; p < contact.pairs.size(); ++p)
        if (const ContactPair &pair = contact.pairs[p]; pair.touching)
        {
          const Vec3 x = pair.point.position(X), &n = contact.projections[p].n;
          pressed[pair.die].push_back(holding.speeds(x, n));
          normals[pair.die] += n;
          for (const Vec3 &across : directions_across(n))
            holding.add_two_sided(holding.speeds(x, across), areas.Sf[p] / (areas.S[p] * n_touching));
        }
      for (const Speeds &of : fixed)
        holding.add_two_sided(of, rigid / fixed.size());
      for (unsigned int d = 0; d < pressed.size(); ++d)
      {
        holding.add_one_sided(pressed[d]);
        for (unsigned int e = 0; e < d; ++e)
          if (normals[d] * normals[e] < opposed * normals[d].norm() * normals[e].norm())
            holding.add_between(pressed[d], pressed[e]);
      }
      std::vector<RigidMotion> motions = holding.loose_motions();
      motions.erase(
        std::remove_if(motions.begin(),
                       motions.end(),
                       [&](const RigidMotion &motion) { return is_blocked_both_ways(motion, contact, X); }),
        motions.end());
      return motions;
    }

    /// Whether the workpiece is between dies, or between a die and a plane of symmetry across its way.
    bool is_between(const Scene &scene, const Physics<double> &physics, const ContactSet<double> &contact)
    {
      std::vector<bool> touches(scene.dies.size(), false);
      Vec3              way;
      for (const ContactPair &pair : contact.pairs)
        if (pair.touching && pair.point.is_node())
          touches[pair.die] = true;
      for (const auto &die : physics.dies)
        if (die.velocity.norm() > way.norm())
          way = die.velocity;
      const auto planes = symmetry_planes(scene.mesh);
      const auto n      = std::count(touches.begin(), touches.end(), true);
      return n > 1 || (n == 1 && std::any_of(planes.begin(), planes.end(), [&](const Plane &plane) {
                         return std::abs(plane.normal * way) > 0.5 * way.norm();
                       }));
    }

    /// A force typical of the press over its speed [N s/mm].
    double typical_drag(const Scene &scene, const Physics<double> &physics, const NodalVectors<double> &X)
    {
      double speed = 1e-300;
      for (const auto &die : physics.dies)
        speed = std::max(speed, die.velocity.norm());
      const double              length    = std::cbrt(volume(scene.mesh.cells, X));
      const double              rate      = speed / length;
      const MaterialLaw<double> newtonian = physics.material.initial_law().newtonian(rate);
      return newtonian(1.5 * rate * rate) * rate * length * length / speed;
    }
  } // namespace

  RigidHold hold_of_loose(const Scene               &scene,
                          const Physics<double>     &physics,
                          const ContactView<double> &view,
                          std::vector<ContactPair>   pairs,
                          const double               near)
  {
    const NodalVectors<double> &X = view.X;
    // What will touch within the increment does not hold at its start, and walls do as other faces.
    ContactSet<double> contact = make_contact_set<double>(view, pairs, {FrictionRamp{near}, 1.});
    for (unsigned int p = 0; p < pairs.size(); ++p)
      contact.pairs[p].touching = contact.projections[p].delta <= near;
    RigidHold hold;
    if (!is_between(scene, physics, contact))
      return hold;
    hold.motions = loose_motions(scene, contact, X);
    if (!hold.empty())
      hold.drag = typical_drag(scene, physics, X) / yield;
    return hold;
  }
} // namespace retroforge
