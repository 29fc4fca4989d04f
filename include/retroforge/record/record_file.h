// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/increment_record.h>
#include <retroforge/record/record_format.h>

#include <cstdint>
#include <optional>
#include <string>

/// @file
/// The record of a run on disk: all that a replay and the backward pass need.
///
///     DIR/record/header.h5                 while the run goes on, and when it was stopped
///     DIR/record/increment_000000.h5 ...   one file per finished increment
///     DIR/record.h5                        of a finished run: header and increments in one file
///
/// Why not one file from the start: HDF5 changes its metadata in place and in an order of its own, so a
/// process killed while it appends can lose all that was there before. HDF5's single-writer mode is made for
/// readers of growing arrays: it forbids new groups and arrays, leaves a file that must be repaired after a
/// kill, and promises nothing about a machine that stops. Files that are written aside, brought to disk and
/// renamed cannot tear: each increment exists whole or not at all, and a failure (a full disk) costs only the
/// increment at hand. HDF5 itself takes 2.1 kB of an increment's file, 1.1 kB once merged.
///
/// Numbers are kept to the bit and not deflated: with shuffled bytes that saved 14 % of a smooth velocity
/// field, at 60 MB/s.
///
/// State is replicated, so one rank writes and every rank may read. Nothing here communicates.
namespace retroforge
{
  class RecordWriter
  {
  public:
    /// Starts the record of a new run, in place of any that is in `directory`, which is made if need be.
    /// @throws Error
    RecordWriter(const std::string &directory, const RecordHeader &header);

    /// Goes on with the record of a run that was stopped, after its last whole increment.
    /// @throws Error  if there is none, or the run is finished
    static RecordWriter resume(const std::string &directory);

    /// Makes a finished record one of a run that was stopped after its last increment, so that the run can
    /// go on: finish() backwards. Interrupted at any moment it leaves the one record or the other.
    /// @throws Error
    static void reopen(const std::string &directory);

    /// Appends an increment. On return it is on disk; on Error all earlier ones still are, and the call may
    /// be repeated.
    void write(const IncrementRecord &increment);

    /// Merges all into DIR/record.h5, the last thing a writer does. Needs the size of the record once
    /// more on disk, and in memory; on Error the increments stay as they were.
    void finish();

    /// Removes the increments beside a finished record: they stay where finish() was killed.
    static void tidy(const std::string &directory);

    unsigned int n_increments() const { return n_increments_; }

    /// Size of the record on disk.
    std::uint64_t bytes() const;

    /// The same of a finished record, whose writer is gone; none where there is no such.
    static std::optional<std::uint64_t> finished_bytes(const std::string &directory);

  private:
    RecordWriter(const std::string &directory, const RecordShape &shape, unsigned int n_increments);

    std::string  directory_;
    RecordShape  shape_;
    unsigned int n_increments_;
  };

  /// The complete input of a run, and the increment, counted from 0, stroke [mm] and operation from which it
  /// holds.
  struct RecordedInput
  {
    unsigned int first  = 0;
    double       stroke = 0.;
    std::string  parameters;
    unsigned int operation = 0;
  };

  /// Reads the record of a run, finished or not, as it is at construction. Do not keep a reader of an
  /// unfinished record over RecordWriter::finish().
  class RecordReader
  {
  public:
    /// @param path  folder of a run, or the file of a finished one
    /// @throws Error  if there is no record, it is damaged, or of another format
    explicit RecordReader(const std::string &path);

    const RecordHeader &header() const { return header_; }
    unsigned int        n_increments() const { return n_increments_; }
    bool                finished() const { return !file_.empty(); }

    /// Of the start of the run, and of each restart with other settings.  @throws Error
    std::vector<RecordedInput> inputs() const;

    /// Where the record ends: the operation, and the path of its leading die by then [mm].  @throws Error
    std::pair<unsigned int, double> end() const;

    /// Its mesh is not looked at, which takes as long as the rest: a run reads back what it has written.
    /// @throws Error  if the increment is damaged or of another run
    IncrementRecord read(unsigned int i) const;

    /// Reads all increments, and checks their meshes (check_mesh).  @throws Error  as read, or if one does
    /// not begin on the mesh that was there
    void check_increments() const;

  private:
    IncrementHead head(unsigned int i) const;

    std::string  directory_; ///< of an unfinished run
    std::string  file_;      ///< of a finished run
    RecordHeader header_;
    RecordShape  shape_;
    unsigned int n_increments_ = 0;
  };
} // namespace retroforge
