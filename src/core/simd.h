#pragma once

/// \file
/// Kernels marked TUFT_CLONES are compiled for several instruction sets and the best
/// one is chosen when the program starts. Rounding is the same in all of them: no
/// contraction (see the top CMakeLists.txt), no sums in an order of the compiler's.
#if defined(TUFT_CLONES)  // set from outside: one instruction set, for comparing
#elif defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define TUFT_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define TUFT_CLONES
#endif
