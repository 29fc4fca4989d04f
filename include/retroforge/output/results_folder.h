// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <vector>

namespace retroforge
{
  /// Returns the files that a run, a scan or the report left in a folder, by names relative to it, sorted.
  /// Files that none of them writes are not listed.
  std::vector<std::string> results_in(const std::string &directory);

  /// Makes the folder of a new run, without results of an earlier one: they are removed where the user said
  /// --overwrite.
  /// @param parameters  of the new run, as understood
  /// @throws Error  where there are some and the user did not, where the new run reads one of them, or where
  /// the folder cannot be made
  void make_results_folder(const std::string &directory, bool overwrite, const std::string &parameters);

  /// Removes what a run that goes on writes anew: all but its record, and what of a check is done.
  /// @param keep_check  whether the run goes on with that, too
  /// @throws Error
  void remove_all_but_record(const std::string &directory, bool keep_check);
} // namespace retroforge
