// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/smoothing.h>

#include <map>
#include <set>

namespace retroforge
{
  namespace
  {
    using Slot = TapeWriter::Slot;

    /// Writes what is done from position to position.
    class PlacementWriter
    {
    public:
      PlacementWriter(const Placement &placement, const RemeshingContext &context, TapeWriter &tape)
          : placement_(placement), context_(context), tape_(tape)
      {
      }

      Slot position() const
      {
        const Slot start = middle();
        switch (placement_.how)
        {
          case Placement::How::put:
            return put(start);
          case Placement::How::towards:
            return snapped(
              tape_.add(PlacingRule::sum, {start, put(start)}, {1. - placement_.part, placement_.part}));
          default:
            return searched(placement_.between[0] == placement_.between[1] ? start : put(start));
        }
      }

    private:
      Slot middle() const
      {
        const Slot a = tape_.node(placement_.between[0]), b = tape_.node(placement_.between[1]);
        return a == b ? a : tape_.add(PlacingRule::sum, {a, b}, {0.5, 0.5});
      }

      Slot put(const Slot x) const
      {
        if (placement_.kind == NodeKind::surface)
          return context_.old_surface.write_on_region(placement_.feature, x, tape_);
        if (placement_.kind == NodeKind::ridge)
          return context_.old_surface.write_on_curve(placement_.feature, x, tape_);
        return x;
      }

      Slot snapped(const Slot x) const
      {
        const OldSurface &surface = context_.old_surface;
        if (placement_.kind == NodeKind::surface)
          return OldSurface::write_on_planes(x, surface.planes_of_region(placement_.feature), tape_);
        if (placement_.kind == NodeKind::ridge)
          return OldSurface::write_on_planes(x, surface.planes_of_curve(placement_.feature), tape_);
        return x;
      }

      Slot size(const Slot start) const
      {
        std::map<Slot, double> count;
        for (const auto &face : placement_.cavity)
          for (const NodeIndex node : face)
            ++count[tape_.node(node)];
        std::vector<unsigned int> arguments = {start};
        std::vector<double>       numbers;
        for (const auto &[corner, n] : count)
        {
          arguments.push_back(corner);
          numbers.push_back(n);
        }
        return tape_.add(PlacingRule::size, arguments, numbers);
      }

      /// Of the cavity, edges with a face on one side only.
      Slot rim() const
      {
        using Edge = std::array<NodeIndex, 2>;
        std::set<Edge> edges;
        for (const auto &face : placement_.cavity)
          for (unsigned int i = 0; i < 3; ++i)
            if (const NodeIndex a = face[i], b = face[(i + 1) % 3]; edges.erase(Edge{{b, a}}) == 0)
              edges.insert(Edge{{a, b}});
        std::vector<unsigned int> arguments;
        for (const Edge &edge : edges)
          for (const NodeIndex node : edge)
            arguments.push_back(tape_.node(node));
        return tape_.add(PlacingRule::rim, arguments);
      }

      Slot searched(const Slot start) const
      {
        if (placement_.steps.empty())
          return start;
        const Slot size = this->size(start);
        switch (placement_.kind)
        {
          case NodeKind::interior:
            return searched_inside(start, size);
          case NodeKind::surface:
            return searched_on_surface(start, size);
          default:
            return searched_on_ridge(start, size);
        }
      }

      Slot searched_inside(const Slot start, const Slot size) const
      {
        const std::vector<Vec3> directions = space_directions();
        Vec3                    w;
        for (const SearchStep &step : placement_.steps)
          w += step.part * directions[step.direction];
        return tape_.add(PlacingRule::step_inside, {start, size}, {w[0], w[1], w[2]});
      }

      Slot searched_on_surface(const Slot start, const Slot size) const
      {
        const Slot rim = this->rim();
        Slot       x   = start;
        for (const SearchStep &step : placement_.steps)
        {
          const auto d = plane_direction(step.direction);
          x            = put(tape_.add(PlacingRule::step_on_surface,
                            {x, size, rim, placement_.axis},
                            {step.part * d[0], step.part * d[1]}));
        }
        return x;
      }

      Slot searched_on_ridge(const Slot start, const Slot size) const
      {
        std::vector<double> push(3, 0.);
        push[placement_.axis] = ridge_push;
        const Slot pushed     = put(tape_.add(PlacingRule::step_inside, {start, size}, push));
        Slot       x          = start;
        for (const SearchStep &step : placement_.steps)
          x = put(tape_.add(PlacingRule::step_on_ridge,
                            {x, size, start, pushed},
                            {step.direction == 0 ? step.part : -step.part}));
        return x;
      }

      const Placement        &placement_;
      const RemeshingContext &context_;
      TapeWriter             &tape_;
    };
  } // namespace

  TapeWriter::Slot write(const Placement &placement, const RemeshingContext &context, TapeWriter &tape)
  {
    return PlacementWriter(placement, context, tape).position();
  }
} // namespace retroforge
