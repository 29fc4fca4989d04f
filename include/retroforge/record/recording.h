// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/record_file.h>

#include <functional>
#include <optional>

namespace retroforge
{
  /// The increments of a run as they are recorded: in memory, on the disk, or both.
  class Recording
  {
  public:
    /// @param directory  of the run's results
    /// @param memory     most bytes that increments may take in memory, where all are kept or none
    Recording(std::string directory, const std::size_t memory)
        : directory_(std::move(directory)), memory_left_(memory), keeps_(memory > 0)
    {
    }

    /// From here on increments are written, too; on the rank that writes.
    void write_to(RecordWriter writer) { writer_.emplace(std::move(writer)); }

    /// An increment that was solved: onto the disk.  @throws Error  if it cannot be written
    void write(const IncrementRecord &increment)
    {
      if (writer_)
        writer_->write(increment);
    }

    /// An increment that was solved, or restored from the disk: into memory.
    void keep(const IncrementRecord &increment);

    /// All increments are written.
    void finish()
    {
      if (writer_)
        writer_->finish();
    }

    /// The increments, from memory or, one at a time, from the disk. Refers to this object.
    std::function<const IncrementRecord &(unsigned int)> access() const;

    /// Size on the disk, of what this run wrote, or of the finished record that it was restored from.
    std::optional<std::uint64_t> bytes() const;

  private:
    std::string                  directory_;
    std::size_t                  memory_left_; ///< [bytes]
    bool                         keeps_;       ///< none was too much
    std::vector<IncrementRecord> increments_;
    std::optional<RecordWriter>  writer_;
  };
} // namespace retroforge
