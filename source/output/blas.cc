// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/blas.h>

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <utility>

namespace retroforge
{
  std::string blas_of_library(const std::string &file)
  {
    // Debian keeps all of them as .../<name>/libblas.so.3, so the folder counts, and "blas" alone comes last
    static const std::array<std::pair<const char *, const char *>, 5> signs = {{{"openblas", "OpenBLAS"},
                                                                                {"mkl", "MKL"},
                                                                                {"blis", "BLIS"},
                                                                                {"atlas", "ATLAS"},
                                                                                {"blas", "reference"}}};

    std::string lower = file;
    std::transform(
      lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::filesystem::path path(lower);
    const std::string           name = (path.parent_path().filename() / path.filename()).string();
    for (const auto &[sign, library] : signs)
      if (name.find(sign) != std::string::npos)
        return library;
    return "unknown";
  }

  std::string blas_in_use()
  {
    Dl_info     info;
    const void *dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
    if (dgemm == nullptr || dladdr(dgemm, &info) == 0 || info.dli_fname == nullptr)
      return "unknown";
    std::error_code   error;
    const std::string file = std::filesystem::canonical(info.dli_fname, error).string();
    return blas_of_library(error ? info.dli_fname : file);
  }
} // namespace retroforge
