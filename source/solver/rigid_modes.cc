// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/solver/rigid_modes.h>

#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    /// Distance from a die beyond the nearest node's within which nodes touch it, over the size of the
    /// workpiece.
    constexpr double touching = 0.05;
    /// Eigenvalues below this, of one per resisting direction, are of free motions.
    constexpr double unresisted = 1e-8;

    /// x -> slide + turn x (x - centre)/size, of a body.
    struct RelativeMotion
    {
      Vec3 slide, turn;

      double operator*(const RelativeMotion &other) const { return slide * other.slide + turn * other.turn; }
      void   add(const double factor, const RelativeMotion &other)
      {
        slide += factor * other.slide;
        turn += factor * other.turn;
      }
    };

    /// The resistance to rigid motions of a body.
    class Resistance
    {
    public:
      explicit Resistance(const NodalVectors<double> &X) : X_(X), gram_(6)
      {
        for (const Vec3 &x : X)
          centre_ += x / static_cast<double>(X.size());
        for (const Vec3 &x : X)
          size_ = std::max(size_, (x - centre_).norm());
      }

      double      size() const { return size_; }
      const Vec3 &centre() const { return centre_; }

      void resist(const NodeIndex k, const Vec3 &direction)
      {
        const Vec3            moment = cross(Vec3((X_[k] - centre_) / size_), direction);
        std::array<double, 6> row;
        for (unsigned int i = 0; i < 3; ++i)
        {
          row[i]     = direction[i];
          row[i + 3] = moment[i];
        }
        // Gram matrix of the velocities that the resisting directions see: zero eigenvalues are free motions.
        for (unsigned int i = 0; i < 6; ++i)
          for (unsigned int j = 0; j < 6; ++j)
            gram_(i, j) += row[i] * row[j];
        n_resisting_ += 1.;
      }

      /// An orthonormal basis.
      std::vector<RelativeMotion> free_motions()
      {
        dealii::Vector<double>     eigenvalues;
        dealii::FullMatrix<double> eigenvectors;
        gram_.compute_eigenvalues_symmetric(
          -1., unresisted * std::max(1., n_resisting_), 0., eigenvalues, eigenvectors);
        std::vector<RelativeMotion> motions(eigenvalues.size());
        for (unsigned int m = 0; m < motions.size(); ++m)
          for (unsigned int i = 0; i < 3; ++i)
          {
            motions[m].slide[i] = eigenvectors(i, m);
            motions[m].turn[i]  = eigenvectors(i + 3, m);
          }
        return motions;
      }

    private:
      const NodalVectors<double>      &X_;
      Vec3                             centre_;
      double                           size_ = 0., n_resisting_ = 0.;
      dealii::LAPACKFullMatrix<double> gram_;
    };

    /// The part of a motion that is made of those of an orthonormal basis.
    RelativeMotion projected(const RelativeMotion &motion, const std::vector<RelativeMotion> &basis)
    {
      RelativeMotion sum;
      for (const RelativeMotion &of : basis)
        sum.add(motion * of, of);
      return sum;
    }

    /// Slides that are among the motions, along the axes where that is possible, each orthogonal to the
    /// others.
    std::vector<RelativeMotion> slides_among(const std::vector<RelativeMotion> &motions)
    {
      // Whatever turns is taken out: what is left of the motions spans their slides.
      std::vector<RelativeMotion> left = motions;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const auto pivot = std::max_element(left.begin(), left.end(), [&](const auto &a, const auto &b) {
          return std::abs(a.turn[i]) < std::abs(b.turn[i]);
        });
        if (pivot == left.end() || std::abs(pivot->turn[i]) < 1e-3)
          continue;
        const RelativeMotion turning = *pivot;
        left.erase(pivot);
        for (RelativeMotion &motion : left)
          motion.add(-motion.turn[i] / turning.turn[i], turning);
      }
      return left;
    }

    std::vector<RelativeMotion> orthonormal(const std::vector<RelativeMotion> &motions, const double least)
    {
      std::vector<RelativeMotion> basis;
      for (RelativeMotion motion : motions)
      {
        motion.add(-1., projected(motion, basis));
        if (const double length = std::sqrt(motion * motion); length > least)
        {
          RelativeMotion unit;
          unit.add(1. / length, motion);
          basis.push_back(unit);
        }
      }
      return basis;
    }

    std::string vector_text(Vec3 x, const double zero)
    {
      std::string text;
      for (unsigned int i = 0; i < 3; ++i)
        text += (i == 0 ? "" : ", ") + as_text(std::abs(x[i]) < zero ? 0. : x[i]);
      return "(" + text + ")";
    }

    /// An axis, whichever way it points.
    std::string axis_text(const Vec3 &direction)
    {
      for (unsigned int i = 0; i < 3; ++i)
        if (std::abs(direction[i]) > 1. - 1e-4)
          return std::string(1, "xyz"[i]);
      return vector_text(direction, 1e-3);
    }

    /// @param slides  that are free, too: across the axis they would make its place any
    std::string turn_text(const RelativeMotion              &motion,
                          const std::vector<RelativeMotion> &slides,
                          const Resistance                  &resistance)
    {
      const Vec3 turn = motion.turn;
      if (std::any_of(slides.begin(), slides.end(), [&](const RelativeMotion &slide) {
            return cross(turn, slide.slide).norm() > 0.1 * turn.norm();
          }))
        return "turn about " + axis_text(turn / turn.norm());
      // The axis is where the slide undoes the turning.
      const Vec3 place = resistance.centre() + resistance.size() / (turn * turn) * cross(turn, motion.slide);
      return "turn about " + axis_text(turn / turn.norm()) + " at " +
             vector_text(place, 1e-3 * resistance.size());
    }

    std::vector<std::string> in_words(const std::vector<RelativeMotion> &motions,
                                      const Resistance                  &resistance)
    {
      // Along and about the axes where that is possible.
      const std::vector<RelativeMotion> sliding = orthonormal(slides_among(motions), 1e-6);
      std::vector<RelativeMotion>       candidates, turning;
      for (unsigned int i = 0; i < 3; ++i)
      {
        RelativeMotion slide, turn;
        slide.slide[i] = turn.turn[i] = 1.;
        candidates.push_back(projected(slide, sliding));
        turning.push_back(projected(turn, motions));
      }
      candidates.insert(candidates.end(), sliding.begin(), sliding.end());
      const std::vector<RelativeMotion> slides = orthonormal(candidates, 0.05);
      turning.insert(turning.begin(), slides.begin(), slides.end());
      turning.insert(turning.end(), motions.begin(), motions.end());
      const std::vector<RelativeMotion> all = orthonormal(turning, 0.05);
      std::vector<std::string>          words;
      for (std::size_t m = 0; m < all.size(); ++m)
        words.push_back(m < slides.size() ? "slide along " + axis_text(all[m].slide)
                                          : turn_text(all[m], slides, resistance));
      return words;
    }
  } // namespace

  std::vector<std::string> free_rigid_motions(const Scene                &scene,
                                              const Physics<double>      &physics,
                                              const NodalVectors<double> &X,
                                              const std::optional<double> within)
  {
    Resistance resistance(X);
    for (NodeIndex k = 0; k < X.size(); ++k)
      for (const Vec3 &direction : scene.topology.fixed_directions[k])
        resistance.resist(k, direction);
    for (unsigned int d = 0; d < scene.dies.size(); ++d)
    {
      if (physics.dies[d].in_press == 0)
        continue;
      const Vec3 &displacement = physics.dies[d].displacement;
      double      reach        = within.value_or(0.);
      if (!within)
      {
        double nearest = std::numeric_limits<double>::max();
        for (NodeIndex k = 0; k < X.size(); ++k)
          if (scene.topology.is_on_surface(k))
            nearest = std::min(nearest, scene.dies[d].signed_distance(X[k], displacement));
        reach = nearest + touching * resistance.size();
      }
      for (NodeIndex k = 0; k < X.size(); ++k)
        if (scene.topology.is_on_surface(k))
        {
          const auto feature = scene.dies[d].closest(X[k], displacement, reach);
          if (!feature.found())
            continue;
          const auto projection = scene.dies[d].project(X[k], displacement, feature);
          if (projection.delta > reach)
            continue;
          resistance.resist(k, projection.n);
          if (physics.dies[d].rubs())
            for (unsigned int i = 0; i < 3; ++i)
            {
              Vec3 unit;
              unit[i] = 1.;
              resistance.resist(k, unit);
            }
        }
    }
    return in_words(resistance.free_motions(), resistance);
  }

  std::vector<std::string> held_motions(const RigidHold &hold, const NodalVectors<double> &X)
  {
    const Resistance            body(X);
    std::vector<RelativeMotion> motions;
    for (const RigidMotion &motion : hold.motions)
      motions.push_back({motion.at(body.centre()), body.size() * motion.turn});
    return in_words(orthonormal(motions, 1e-6), body);
  }
} // namespace retroforge
