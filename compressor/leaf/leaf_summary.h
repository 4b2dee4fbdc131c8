// The survey's kernel: statistics of one leaf's values in cache.
#pragma once

#include <cstdint>
#include <span>

#include "compressor/leaf/leaf_quantiser.h"
#include "compressor/leaf/leaf_repeats.h"
#include "compressor/leaf/leaf_row.h"

namespace weir {

/// Digest of the last uniform leaf: empty space repeats one leaf over and over. One per thread.
struct UniformDigest {
  std::uint32_t bits = 0;
  std::size_t count = 0;  ///< values; 0: nothing yet
  Digest digest;
};

/// Statistics and digest of the in-domain values of a leaf, x fastest, 1 to 512 of them; `sample_at` is
/// the position of the sampled value. Two passes, double sums in 16 lanes (Chan, Golub, LeVeque 1983).
/// Non-finite values take part in the digest only.
LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at, UniformDigest& last);
inline LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at) {
  UniformDigest none;
  return summarize_leaf(values, sample_at, none);
}

/// The same of 512 values that repeat each other: each of `distinct` is so many of them.
LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at, UniformDigest& last,
                       std::span<const float> distinct, const LeafRepeats& repeats);

/// Extrema and rounded mean of 1 to 512 finite values, 512 where they repeat each other.
ValueRange leaf_range(std::span<const float> values, const LeafRepeats& repeats = {});

/// Fills `quantised`, `exact_bits` and `at_ends` of a row that summarize_leaf made: `values` are the leaf's finite
/// in-domain values, row.finite of them, `all` that there are no others.
void summarize_widths(std::span<const float> values, bool all, LeafRow& row);
/// The same of 512 finite values that repeat each other, as for summarize_leaf.
void summarize_widths(std::span<const float> values, std::span<const float> distinct, const LeafRepeats& repeats,
                      LeafRow& row);

}  // namespace weir
