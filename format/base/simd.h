// Run-time choice of instruction set for a few hot functions. Results are the
// same on every one: sums use a fixed number of lanes and nothing is fused.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define WEIR_SIMD __attribute__((target_clones("avx512f", "avx2", "default")))
#define WEIR_SIMD_PATHS  // for functions that are written once for each width
#else
// Sanitizers start too late for the resolvers, and clang 14 clones no functions in namespaces.
#define WEIR_SIMD
#endif

#include <cstdint>

namespace weir {

// Lanes that the compiler keeps in registers of whatever width the clone has; arrays of lanes end up as
// scalars. Elementwise + - * / and comparisons mean what they mean for the elements.
using Floats16 = float __attribute__((vector_size(64)));
using Floats8 = float __attribute__((vector_size(32)));
using Ints16 = std::int32_t __attribute__((vector_size(64)));
using Ints8 = std::int32_t __attribute__((vector_size(32)));
using Words8 = std::uint32_t __attribute__((vector_size(32)));

/// A vector from values that lie one after the other, of whatever type, and back. Copies of bytes GCC 12 makes in
/// pieces of 16, and waits for them where the whole is read next.
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
