#pragma once

// Included before any header of Highway by each file that compiles vector code. What is left compiled once each is the baseline,
// SSSE3, AVX2 and AVX-512 on x86 and NEON on ARM; the best is chosen at run time. SSE4 and AVX3_DL would add compile
// time and size and nothing to arithmetic in doubles; SVE's and RVV's vectors cannot be members of a struct.
#define HWY_DISABLED_TARGETS \
    (HWY_SSE4 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
