// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/record/recording.h>

#include <algorithm>
#include <list>
#include <memory>

namespace retroforge
{
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
    if (!writer_)
      return {};
    return writer_->bytes();
  }
} // namespace retroforge
