// Run-time choice of the instruction set for a few hot functions. Results are the same with every instruction set: sums
// use a fixed number of lanes and no operations are fused.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define WEIR_SIMD __attribute__((target_clones("avx512f", "avx2", "default")))
#define WEIR_SIMD_PATHS  // for functions that are written once for each width
#else
// Sanitizers start too late for the resolvers of the clones, and clang 14 clones no functions in namespaces.
#define WEIR_SIMD
#endif

#include <cstdint>

namespace weir {

// Vectors that the compiler keeps in registers of whatever width the clone has; arrays of lanes would end up as
// scalars. + - * / and comparisons work elementwise.
using Floats16 = float __attribute__((vector_size(64)));
using Floats8 = float __attribute__((vector_size(32)));
using Ints16 = std::int32_t __attribute__((vector_size(64)));
using Ints8 = std::int32_t __attribute__((vector_size(32)));
using Words8 = std::uint32_t __attribute__((vector_size(32)));

/// Loads a vector from consecutive values of any type, or stores it. Not by a copy of bytes: GCC 12 copies them in
/// pieces of 16, and a read of the whole vector then waits for the pieces.
template <typename Lanes, typename T>
[[gnu::always_inline]] inline void load_lanes(const T* at, Lanes& v) {
  using Stored [[gnu::aligned(alignof(T)), gnu::may_alias]] = Lanes;
  v = *reinterpret_cast<const Stored*>(at);
}
template <typename Lanes, typename T>
[[gnu::always_inline]] inline void store_lanes(const Lanes& v, T* at) {
  using Stored [[gnu::aligned(alignof(T)), gnu::may_alias]] = Lanes;
  *reinterpret_cast<Stored*>(at) = v;
}

}  // namespace weir
