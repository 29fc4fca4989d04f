// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/tape_writer.h>

#include <algorithm>
#include <numeric>

namespace retroforge
{
  TapeWriter::TapeWriter(const NodalVectors<double> &X) : values_(X), now_(X.size())
  {
    tape_.n_inputs = X.size();
    std::iota(now_.begin(), now_.end(), 0);
    at_start_ = now_;
  }

  TapeWriter::Slot TapeWriter::add(const PlacingRule                rule,
                                   const std::vector<unsigned int> &arguments,
                                   const std::vector<double>       &numbers)
  {
    const PlacedBy    by = {rule,
                            arguments.data(),
                            static_cast<unsigned int>(arguments.size()),
                            numbers.data(),
                            static_cast<unsigned int>(numbers.size())};
    std::vector<Vec3> of;
    for (unsigned int a = 0; a < by.n_vectors(); ++a)
      of.push_back(values_[arguments[a]]);
    return add(rule, arguments, numbers, placed(by, of, tape_.planes));
  }

  TapeWriter::Slot TapeWriter::add(const PlacingRule                rule,
                                   const std::vector<unsigned int> &arguments,
                                   const std::vector<double>       &numbers,
                                   const Vec3                      &value)
  {
    tape_.rules.push_back(static_cast<unsigned char>(rule));
    tape_.arguments.insert(tape_.arguments.end(), arguments.begin(), arguments.end());
    tape_.numbers.insert(tape_.numbers.end(), numbers.begin(), numbers.end());
    tape_.argument_begin.push_back(tape_.arguments.size());
    tape_.number_begin.push_back(tape_.numbers.size());
    Assert(tape_.operation(tape_.n_operations() - 1).is_sound(),
           dealii::ExcMessage("an operation has the arguments and numbers of its rule"));
    values_.push_back(value);
    return values_.size() - 1;
  }

  void TapeWriter::place(const NodeIndex node, const Slot slot)
  {
    if (node == now_.size())
      now_.push_back(slot);
    else
      now_[node] = slot;
  }

  void TapeWriter::place(std::vector<Slot> nodes)
  {
    now_         = std::move(nodes);
    kept_volume_ = invalid_index;
  }

  void TapeWriter::begin_pass()
  {
    at_start_ = now_;
    made_.clear();
  }

  std::vector<TapeWriter::Slot> TapeWriter::nodes(const std::vector<NodeIndex> &numbers) const
  {
    std::vector<Slot> slots;
    for (const NodeIndex node : numbers)
      slots.push_back(now_[node]);
    return slots;
  }

  unsigned int TapeWriter::plane(const Plane &plane)
  {
    const auto same = [&](const Plane &other) {
      return other.point == plane.point && other.normal == plane.normal;
    };
    const auto found = std::find_if(tape_.planes.begin(), tape_.planes.end(), same);
    if (found != tape_.planes.end())
      return found - tape_.planes.begin();
    tape_.planes.push_back(plane);
    return tape_.planes.size() - 1;
  }

  std::vector<TapeWriter::Slot> TapeWriter::directions(const std::vector<BoundaryFace> &faces,
                                                       const VolumeCorrection          &correction)
  {
    const NodalVectors<double>            &u = correction.directions;
    std::vector<std::vector<unsigned int>> around(u.size());
    for (const BoundaryFace &face : faces)
      for (unsigned int i = 0; i < 3; ++i)
        if (const NodeIndex k = face.nodes[i]; u[k] != Vec3())
          around[k].insert(around[k].end(), {now_[face.nodes[(i + 1) % 3]], now_[face.nodes[(i + 2) % 3]]});
    std::vector<Slot> slots(u.size(), invalid_index);
    for (NodeIndex k = 0; k < u.size(); ++k)
    {
      if (u[k] == Vec3())
        continue;
      if (correction.distance == 0.) // then it counts only to second order that it turns
      {
        slots[k] = add(PlacingRule::constant, {}, {u[k][0], u[k][1], u[k][2]});
        continue;
      }
      const NodeConstraint     &constraint = correction.constraints[k];
      std::vector<unsigned int> arguments  = around[k];
      std::vector<double>       numbers;
      for (unsigned int i = 0; i < constraint.n; ++i)
        if (constraint.faces[i] == invalid_index)
          numbers.insert(numbers.end(), constraint.normals[i].begin_raw(), constraint.normals[i].end_raw());
        else
          for (const NodeIndex node : faces[constraint.faces[i]].nodes)
            arguments.push_back(now_[node]);
      arguments.push_back(around[k].size());
      slots[k] = add(PlacingRule::outward, arguments, numbers);
    }
    return slots;
  }

  void TapeWriter::keep_volume(const std::vector<BoundaryFace> &faces, const VolumeCorrection &correction)
  {
    AssertDimension(correction.directions.size(), now_.size());
    const std::vector<Slot> u       = directions(faces, correction);
    std::vector<Slot>       shifted = now_;
    Slot                    next    = values_.size() + 1;
    for (NodeIndex k = 0; k < u.size(); ++k)
      if (u[k] != invalid_index)
        shifted[k] = next++;
    std::vector<unsigned int> around;
    for (const BoundaryFace &face : faces)
      for (const NodeIndex k : face.nodes)
        around.push_back(shifted[k]);
    const Slot distance =
      add(PlacingRule::distance, around, {correction.rest}, Vec3({correction.distance, 0., 0.}));
    for (NodeIndex k = 0; k < u.size(); ++k)
      if (u[k] != invalid_index)
        add(PlacingRule::shift, {now_[k], distance, u[k]});
    now_         = shifted;
    kept_volume_ = distance;
  }

  PositionTape TapeWriter::tape(const std::vector<NodeIndex> &order) const
  {
    PositionTape made = tape_;
    made.results      = nodes(order);
    // Its faces are known.
    if (kept_volume_ != invalid_index)
    {
      const std::size_t i     = kept_volume_ - made.n_inputs;
      const auto        first = made.arguments.begin() + made.argument_begin[i];
      const auto        n     = made.argument_begin[i + 1] - made.argument_begin[i];
      made.arguments.erase(first, first + n);
      for (std::size_t j = i + 1; j < made.argument_begin.size(); ++j)
        made.argument_begin[j] -= n;
    }
    return made.pruned();
  }
} // namespace retroforge
