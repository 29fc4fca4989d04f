// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: BLAS libraries are told apart by where distributions put them, and this process' one is found.
#include <retroforge/output/blas.h>

#include <iostream>

using namespace retroforge;

// the BLAS is linked only into programs that call it
extern "C" double ddot_(const int *n, const double *x, const int *x_step, const double *y, const int *y_step);

int main()
{
  const int    n = 2, step = 1;
  const double x[2] = {3., 4.};
  std::cout << "x.x = " << ddot_(&n, x, &step, x, &step) << '\n';
  for (const std::string file : {"/usr/lib/x86_64-linux-gnu/blas/libblas.so.3.11.0",
                                 "/usr/lib/x86_64-linux-gnu/openblas-serial/libblas.so.3",
                                 "/opt/lib/libopenblasp-r0.3.21.so",
                                 "/usr/lib/x86_64-linux-gnu/blis-openmp/libblas.so.4",
                                 "/usr/lib/x86_64-linux-gnu/atlas/libblas.so.3",
                                 "/opt/intel/lib/libmkl_rt.so.2",
                                 "/home/openblas/spack/lib/libblas.so.3",
                                 "/home/user/retroforge"})
    std::cout << blas_of_library(file) << '\n';
  std::cout << "in use is known: " << (blas_in_use() != "unknown") << '\n';
}
