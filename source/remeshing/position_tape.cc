// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/position_tape.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace retroforge
{
  namespace
  {
    using Triple = std::array<unsigned int, 3>;

    DieFeature feature_of(const PlacedBy &push_out)
    {
      return {push_out.arguments[2], static_cast<unsigned char>(push_out.arguments[3])};
    }

    /// The faces around a volume, by the numbers of their vectors.
    std::vector<Triple> faces_of(const PositionTape &tape, const PlacedBy &distance, const TetMesh &new_mesh)
    {
      std::vector<Triple> faces;
      for (unsigned int i = 0; i < distance.n_arguments; i += 3)
        faces.push_back({{distance.arguments[i], distance.arguments[i + 1], distance.arguments[i + 2]}});
      if (faces.empty())
        for (const BoundaryFace &face : new_mesh.faces)
          faces.push_back(
            {{tape.results[face.nodes[0]], tape.results[face.nodes[1]], tape.results[face.nodes[2]]}});
      return faces;
    }

    std::vector<Triple> faces_of(const TetMesh &mesh)
    {
      std::vector<Triple> faces;
      for (const BoundaryFace &face : mesh.faces)
        faces.push_back(face.nodes);
      return faces;
    }

    /// 1/6 sum x_a·(x_b x x_c), from a point near by, so that rounding is that of the workpiece's size.
    template <typename Number>
    Number volume_inside(const std::vector<Triple> &faces, const NodalVectors<Number> &x)
    {
      Number six_volumes(0.);
      if (faces.empty())
        return six_volumes;
      Vector3<Number> origin;
      for (unsigned int i = 0; i < 3; ++i)
        origin[i] = Number(value_of(x[faces[0][0]][i]));
      for (const Triple &face : faces)
      {
        const Vector3<Number> a = x[face[0]] - origin, b = x[face[1]] - origin, c = x[face[2]] - origin;
        six_volumes += a * cross(b, c);
      }
      return six_volumes / 6.;
    }

    /// Adds weight times the gradient of the volume.
    void add_gradient(const std::vector<Triple>  &faces,
                      const NodalVectors<double> &x,
                      const double                weight,
                      NodalVectors<double>       &bar)
    {
      for (const Triple &face : faces)
      {
        const Vec3 area = cross(Vec3(x[face[1]] - x[face[0]]), Vec3(x[face[2]] - x[face[0]])) * (weight / 6.);
        for (const unsigned int k : face)
          bar[k] += area;
      }
    }

    /// The vectors that an operation is of.
    template <typename Number>
    std::vector<Vector3<Number>> vectors_of(const PlacedBy &by, const NodalVectors<Number> &x)
    {
      std::vector<Vector3<Number>> of;
      for (unsigned int i = 0; i < by.n_vectors(); ++i)
        of.push_back(x[by.arguments[i]]);
      return of;
    }

    /// The shifts that an operation `distance` serves: those after it.
    class Shifts
    {
    public:
      Shifts(const PositionTape &tape, const std::size_t distance)
          : tape_(tape), distance_(tape.n_inputs + distance), first_(distance + 1), end_(first_)
      {
        while (end_ < tape.n_operations() && tape.operation(end_).rule == PlacingRule::shift &&
               tape.operation(end_).arguments[1] == distance_)
          ++end_;
      }

      /// Sets the shifted vectors.
      template <typename Number>
      void apply(const Number &d, NodalVectors<Number> &x) const
      {
        x[distance_]    = Vector3<Number>();
        x[distance_][0] = d;
        for (std::size_t i = first_; i < end_; ++i)
          x[tape_.n_inputs + i] = placed(tape_.operation(i), vectors_of(tape_.operation(i), x), tape_.planes);
      }

      /// dV/dd.
      double slope(const std::vector<Triple> &faces, const NodalVectors<double> &x) const
      {
        NodalVectors<double> g(x.size());
        add_gradient(faces, x, 1., g);
        double sum = 0.;
        for (std::size_t i = first_; i < end_; ++i)
        {
          sum += g[tape_.n_inputs + i] * x[tape_.operation(i).arguments[2]];
        }
        return sum;
      }

    private:
      const PositionTape &tape_;
      std::size_t         distance_, first_, end_;
    };

    /// Finds d by Newton's method, and moves what it moves.
    double find_distance(const std::vector<Triple> &faces,
                         const Shifts              &shifts,
                         const double               wanted,
                         NodalVectors<double>      &x)
    {
      constexpr unsigned int most = 10;
      double                 d    = 0.;
      shifts.apply(d, x);
      const double slope   = shifts.slope(faces, x);
      double       missing = wanted - volume_inside(faces, x);
      for (unsigned int i = 0; i < most && missing != 0.; ++i)
      {
        const double next = d + missing / slope;
        shifts.apply(next, x);
        const double rest = wanted - volume_inside(faces, x);
        if (!(std::abs(rest) < std::abs(missing)))
          break; // rounding
        d       = next;
        missing = rest;
      }
      shifts.apply(d, x);
      return d;
    }

    /// The derivative is that of one step more.
    void find_distance(const std::vector<Triple> &faces,
                       const Shifts              &shifts,
                       const Dual                &wanted,
                       NodalVectors<Dual>        &x)
    {
      NodalVectors<double> values;
      convert(x, values);
      Dual d = find_distance(faces, shifts, value_of(wanted), values);
      shifts.apply(d, x);
      d.fastAccessDx(0) = Dual(wanted - volume_inside(faces, x)).dx(0) / shifts.slope(faces, values);
      shifts.apply(d, x);
    }

    /// Adds the pull-back of placed(), found vector by vector.
    void reverse_placed(const PlacedBy             &by,
                        const NodalVectors<double> &x,
                        const std::vector<Plane>   &planes,
                        const Vec3                 &placed_bar,
                        NodalVectors<double>       &bar)
    {
      std::vector<Vector3<Gradient3>> of;
      convert(vectors_of(by, x), of);
      for (std::size_t i = 0; i < of.size(); ++i)
      {
        if (by.rule == PlacingRule::sum)
        {
          bar[by.arguments[i]] += by.numbers[i] * placed_bar;
          continue;
        }
        for (unsigned int c = 0; c < 3; ++c)
          of[i][c] = Gradient3(3, c, of[i][c].val());
        const Vector3<Gradient3> result = placed(by, of, planes);
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int r = 0; r < 3; ++r)
            bar[by.arguments[i]][c] += result[r].dx(c) * placed_bar[r];
        for (unsigned int c = 0; c < 3; ++c)
          of[i][c] = Gradient3(of[i][c].val());
      }
    }
  } // namespace

  PlacedBy PositionTape::operation(const std::size_t i) const
  {
    AssertIndexRange(i, n_operations());
    return {static_cast<PlacingRule>(rules[i]),
            arguments.data() + argument_begin[i],
            argument_begin[i + 1] - argument_begin[i],
            numbers.data() + number_begin[i],
            number_begin[i + 1] - number_begin[i]};
  }

  template <typename Number>
  NodalVectors<Number> PositionTape::all_vectors(const Scene<Number>        &scene,
                                                 const NodalVectors<Number> &X) const
  {
    AssertDimension(X.size(), n_inputs);
    AssertDimension(scene.dies.size(), scene.states.size());
    NodalVectors<Number> x = X;
    x.resize(n_inputs + n_operations());
    for (std::size_t i = 0; i < n_operations(); ++i)
    {
      const PlacedBy   by    = operation(i);
      Vector3<Number> &to    = x[n_inputs + i];
      const auto       first = by.n_arguments > 0 ? x[by.arguments[0]] : Vector3<Number>();
      switch (by.rule)
      {
        case PlacingRule::push_out: {
          const unsigned int d          = by.arguments[1];
          const auto         projection = scene.dies[d].project(first, scene.states[d], feature_of(by));
          to                            = first + projection.n * projection.delta;
          break;
        }
        case PlacingRule::distance:
          find_distance(faces_of(*this, by, scene.new_mesh),
                        Shifts(*this, i),
                        Number(volume_inside(faces_of(scene.old_mesh), x) - by.numbers[0]),
                        x);
          break;
        case PlacingRule::shift: // by its distance
          break;
        default:
          to = placed(by, vectors_of(by, x), planes);
      }
    }
    return x;
  }

  template <typename Number>
  NodalVectors<Number> PositionTape::positions(const Scene<Number>        &scene,
                                               const NodalVectors<Number> &X) const
  {
    const NodalVectors<Number> x = all_vectors(scene, X);
    NodalVectors<Number>       positions;
    positions.reserve(results.size());
    for (const unsigned int k : results)
      positions.push_back(x[k]);
    return positions;
  }

  template NodalVectors<double> PositionTape::positions(const Scene<double> &,
                                                        const NodalVectors<double> &) const;
  template NodalVectors<Dual> PositionTape::positions(const Scene<Dual> &, const NodalVectors<Dual> &) const;

  void PositionTape::reverse_positions(const Scene<double>           &scene,
                                       const NodalVectors<double>    &X,
                                       const NodalVectors<double>    &positions_bar,
                                       NodalVectors<double>          &X_bar,
                                       std::vector<DieState<double>> &dies_bar) const
  {
    AssertDimension(positions_bar.size(), results.size());
    const NodalVectors<double> x = all_vectors(scene, X);
    NodalVectors<double>       bar(x.size());
    for (std::size_t k = 0; k < results.size(); ++k)
      bar[results[k]] += positions_bar[k];
    for (std::size_t i = n_operations(); i-- > 0;)
    {
      const PlacedBy by     = operation(i);
      const Vec3     to_bar = bar[n_inputs + i];
      if (to_bar == Vec3())
        continue;
      switch (by.rule)
      {
        case PlacingRule::push_out: {
          const unsigned int d = by.arguments[1], k = by.arguments[0];
          const Die         &die     = scene.dies[d];
          const Vec3        &at      = scene.states[d].displacement;
          const auto         feature = feature_of(by);
          const auto         p       = die.project(x[k], at, feature);
          bar[k] += to_bar;
          die.reverse_project(x[k],
                              at,
                              feature,
                              p.n * to_bar,
                              p.delta * to_bar,
                              bar[k],
                              dies_bar[d].displacement,
                              dies_bar[d].vertices.empty() ? nullptr : &dies_bar[d].vertices);
          break;
        }
        case PlacingRule::distance: {
          const auto           faces = faces_of(*this, by, scene.new_mesh);
          const double         d_bar = to_bar[0] / Shifts(*this, i).slope(faces, x);
          NodalVectors<double> inside(x.size());
          add_gradient(faces, x, -d_bar, inside);
          // By a shifted x + d u it is that by x and d times that by u.
          for (std::size_t k = 0; k < inside.size(); ++k)
            if (k < n_inputs + i)
              bar[k] += inside[k];
            else if (inside[k] != Vec3())
            {
              const PlacedBy shift = operation(k - n_inputs);
              bar[shift.arguments[0]] += inside[k];
              bar[shift.arguments[2]] += x[n_inputs + i][0] * inside[k];
            }
          add_gradient(faces_of(scene.old_mesh), x, d_bar, bar);
          break;
        }
        default:
          reverse_placed(by, x, planes, to_bar, bar);
      }
    }
    for (std::size_t k = 0; k < n_inputs; ++k)
      X_bar[k] += bar[k];
  }

  PositionTape PositionTape::pruned() const
  {
    std::vector<unsigned char> used(n_inputs + n_operations(), false);
    for (const unsigned int k : results)
      used[k] = true;
    // Again where a volume needs shifted vectors, which come after it.
    for (bool more = true; more;)
    {
      more = false;
      for (std::size_t i = n_operations(); i-- > 0;)
        if (const PlacedBy by = operation(i); used[n_inputs + i])
          for (unsigned int a = 0; a < by.n_vectors(); ++a)
          {
            more                  = more || (by.arguments[a] > n_inputs + i && !used[by.arguments[a]]);
            used[by.arguments[a]] = true;
          }
    }
    std::vector<unsigned int> number(n_inputs + n_operations());
    unsigned int              n_used = n_inputs;
    std::iota(number.begin(), number.begin() + n_inputs, 0);
    for (std::size_t i = 0; i < n_operations(); ++i)
      if (used[n_inputs + i])
        number[n_inputs + i] = n_used++;
    PositionTape short_tape;
    short_tape.n_inputs = n_inputs;
    short_tape.planes   = planes;
    for (std::size_t i = 0; i < n_operations(); ++i)
      if (used[n_inputs + i])
      {
        const PlacedBy by = operation(i);
        short_tape.rules.push_back(rules[i]);
        for (unsigned int a = 0; a < by.n_arguments; ++a)
          short_tape.arguments.push_back(a < by.n_vectors() ? number[by.arguments[a]] : by.arguments[a]);
        short_tape.numbers.insert(short_tape.numbers.end(), by.numbers, by.numbers + by.n_numbers);
        short_tape.argument_begin.push_back(short_tape.arguments.size());
        short_tape.number_begin.push_back(short_tape.numbers.size());
      }
    for (const unsigned int k : results)
      short_tape.results.push_back(number[k]);
    return short_tape;
  }

  std::string PositionTape::defect(const unsigned int               n_old,
                                   const unsigned int               n_new,
                                   const std::vector<unsigned int> &die_facets) const
  {
    const auto is_list = [this](const std::vector<unsigned int> &begin, const std::size_t n_entries) {
      return begin.size() == n_operations() + 1 && begin.front() == 0 && begin.back() == n_entries &&
             std::is_sorted(begin.begin(), begin.end());
    };
    if (n_inputs != n_old || results.size() != n_new)
      return "it is of other meshes";
    if (!is_list(argument_begin, arguments.size()) || !is_list(number_begin, numbers.size()))
      return "its operations do not fit its lists";
    for (std::size_t i = 0; i < n_operations(); ++i)
    {
      const PlacedBy by = operation(i);
      if (rules[i] >= static_cast<unsigned char>(PlacingRule::n_rules) || !by.is_sound())
        return "operation " + std::to_string(i) + " is none";
      for (unsigned int a = 0; a < by.n_vectors(); ++a)
      {
        // A volume is that after the shifts.
        const bool is_shifted = by.rule == PlacingRule::distance;
        if (by.arguments[a] >= n_inputs + (is_shifted ? n_operations() : i))
          return "operation " + std::to_string(i) + " is of what comes after it";
      }
      if (by.rule == PlacingRule::snap)
        for (unsigned int a = 1; a < by.n_arguments; ++a)
          if (by.arguments[a] >= planes.size())
            return "operation " + std::to_string(i) + " is on a plane that is not there";
      if (by.rule == PlacingRule::push_out &&
          (by.arguments[1] >= die_facets.size() || by.arguments[2] >= die_facets[by.arguments[1]] ||
           by.arguments[3] >= DieFeature::n_kinds))
        return "operation " + std::to_string(i) + " is on a die's feature that is not there";
    }
    for (const unsigned int k : results)
      if (k >= n_inputs + n_operations())
        return "a new node is nowhere";
    return {};
  }

  std::size_t PositionTape::memory_consumption() const
  {
    return sizeof(*this) + rules.capacity() + sizeof(double) * numbers.capacity() +
           sizeof(unsigned int) * (argument_begin.capacity() + number_begin.capacity() +
                                   arguments.capacity() + results.capacity());
  }
} // namespace retroforge
