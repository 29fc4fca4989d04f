// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/record/recording.h>

#include <algorithm>
#include <list>
#include <memory>

namespace retroforge
{
  namespace
  {
    template <typename T>
    std::size_t bytes_of(const std::vector<T> &values)
    {
      return values.size() * sizeof(T);
    }

    std::size_t bytes_of(const IncrementRecord &increment)
    {
      std::size_t bytes = sizeof(increment) + bytes_of(increment.pairs);
      if (increment.parameters)
        bytes += increment.parameters->size();
      for (const SolveRecord &solve : increment.solves)
        bytes += bytes_of(solve.V) + bytes_of(solve.P) + bytes_of(solve.active) +
                 (solve.vertices ? bytes_of(*solve.vertices) : 0);
      if (const auto &remesh = increment.remesh)
        bytes += bytes_of(remesh->X_before) + bytes_of(remesh->mesh.X) + bytes_of(remesh->mesh.cells) +
                 bytes_of(remesh->mesh.faces) + remesh->transfer.memory_consumption() +
                 remesh->positions.memory_consumption();
      return bytes;
    }
  } // namespace

  void Recording::keep(const IncrementRecord &increment)
  {
    if (!keeps_)
      return;
    const std::size_t bytes = bytes_of(increment);
    keeps_                  = bytes <= memory_left_;
    if (keeps_)
    {
      memory_left_ -= bytes;
      increments_.push_back(increment);
    }
    else
      increments_ = {};
  }

  std::function<const IncrementRecord &(unsigned int)> Recording::access() const
  {
    if (!increments_.empty())
      return [this](const unsigned int i) -> const IncrementRecord & { return increments_[i]; };
    // A sweep asks for each increment, and once more as the one before the next.
    constexpr std::size_t kept = 2;
    struct Reader
    {
      RecordReader                                        file;
      std::list<std::pair<unsigned int, IncrementRecord>> last;
    };
    const auto reader = std::make_shared<Reader>(Reader{RecordReader(directory_), {}});
    return [reader](const unsigned int i) -> const IncrementRecord & {
      auto      &last = reader->last;
      const auto found =
        std::find_if(last.begin(), last.end(), [i](const auto &of) { return of.first == i; });
      if (found != last.end())
        return found->second;
      last.emplace_front(i, reader->file.read(i));
      if (last.size() > kept)
        last.pop_back();
      return last.front().second;
    };
  }

  std::optional<std::uint64_t> Recording::bytes() const
  {
    if (writer_)
      return writer_->bytes();
    return RecordWriter::finished_bytes(directory_);
  }
} // namespace retroforge
