#pragma once

/// \file
/// Targets of functions that are compiled once for each instruction set from the same source and
/// chosen by `Isa`. They read tables in vectors where the processor can.
#if defined(__x86_64__) || defined(__i386__)
#define TUFT_X86 1
#define TUFT_AVX2 "avx2,tune=haswell"
#ifdef __clang__
#define TUFT_AVX512 "avx512f,avx512vl,avx512bw,avx512dq"
#else
#define TUFT_AVX512 "avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512,tune=skylake-avx512"
#endif
#endif
