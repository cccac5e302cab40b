#pragma once

// One copy of each loop for processors with 256-bit vectors, chosen when the program is loaded, and one for
// all others. Address sanitizer cannot run the choosing code, and only glibc's loader does. (A name of one
// processor, such as arch=haswell, would choose the copy on that processor alone.) Not by Clang: its version
// 22 leaves out inline functions that only the copies of a function with internal linkage call, and the
// module cannot be loaded.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
#if defined(__GNUC__) && __GNUC__ >= 12
#define SKINGLOW_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
#endif
#ifndef SKINGLOW_VECTOR_CLONES
#define SKINGLOW_VECTOR_CLONES
#endif

// The arrays of a block do not overlap: no need to make each loop twice and to try at run time.
#if defined(__clang__)
#define SKINGLOW_VECTOR_LOOP _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define SKINGLOW_VECTOR_LOOP _Pragma("GCC ivdep")
#else
#define SKINGLOW_VECTOR_LOOP
#endif
