// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

/// @file
/// Kernels of vectors in registers: one source, compiled for several processors, of which the program takes
/// the one it runs on. What such a kernel calls must vanish into it, which alone is compiled so.
#define RETROFORGE_INLINE inline __attribute__((always_inline))
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define RETROFORGE_ALSO_FOR(processor) __attribute__((target_clones(processor, "default")))
#else
#define RETROFORGE_ALSO_FOR(processor)
#endif
