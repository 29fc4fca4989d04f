// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/record/recording.h>

#include <memory>

namespace retroforge
{
  std::function<const IncrementRecord &(unsigned int)> Recording::access() const
  {
    if (!increments_.empty())
      return [this](const unsigned int i) -> const IncrementRecord & { return increments_[i]; };
    struct Reader
    {
      RecordReader    file;
      IncrementRecord increment;
    };
    const auto reader = std::make_shared<Reader>(Reader{RecordReader(directory_), {}});
    return [reader](const unsigned int i) -> const IncrementRecord & {
      reader->increment = reader->file.read(i);
      return reader->increment;
    };
  }

  std::optional<std::uint64_t> Recording::bytes() const
  {
    if (!writer_)
      return {};
    return writer_->bytes();
  }
} // namespace retroforge
