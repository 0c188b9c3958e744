#pragma once

/// Compiles a function twice, for plain x86-64 and for AVX2 with FMA; the loader picks what the
/// machine can do. For the few loops over all pixels of an image or a patch. Results agree to
/// rounding. Not under a sanitizer: the loader picks before its runtime has started.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define STEREOMOTION_MULTIVERSION __attribute__((target_clones("arch=x86-64-v3", "default")))
/// Inlines a helper into each of the versions, so that it is compiled for that machine too.
#define STEREOMOTION_INLINE inline __attribute__((always_inline))
#else
#define STEREOMOTION_INLINE inline
#define STEREOMOTION_MULTIVERSION
#endif
