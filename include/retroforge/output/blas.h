// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>

namespace retroforge
{
  /// The BLAS library this process calls: "OpenBLAS", "MKL", "BLIS", "ATLAS", "reference" (netlib's, several
  /// times slower in the direct solver), or "unknown". It is the file that dgemm_ resolves to, all symbolic
  /// links followed.
  std::string blas_in_use();

  /// Returns the name of the BLAS for the file name of a library.
  std::string blas_of_library(const std::string &file);
} // namespace retroforge
