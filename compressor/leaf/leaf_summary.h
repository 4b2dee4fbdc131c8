// The survey's kernel: computes the statistics of one leaf while its values are in the CPU cache.
#pragma once

#include <cstdint>
#include <span>

#include "compressor/leaf/leaf_quantiser.h"
#include "compressor/leaf/leaf_repeats.h"
#include "compressor/leaf/leaf_row.h"

namespace weir {

/// The digest of the last uniform leaf, because empty space repeats the same leaf many times. One object per thread.
struct UniformDigest {
  std::uint32_t bits = 0;
  std::size_t count = 0;  ///< number of values; 0 before the first uniform leaf
  Digest digest;
};

/// Returns the statistics and the digest of a leaf. `values` are its 1 to 512 in-domain values, x fastest. `sample_at`
/// is the position of the sampled value. Makes two passes with double sums in 16 lanes (Chan, Golub, LeVeque 1983).
/// Non-finite values only count in the digest.
LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at, UniformDigest& last);
inline LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at) {
  UniformDigest none;
  return summarize_leaf(values, sample_at, none);
}

/// The same for 512 values that repeat each other. Each value of `distinct` stands for the same number of values.
LeafRow summarize_leaf(std::span<const float> values, std::size_t sample_at, UniformDigest& last,
                       std::span<const float> distinct, const LeafRepeats& repeats);

/// Returns the extrema and the rounded mean of 1 to 512 finite values. If they repeat each other, there must be 512.
ValueRange leaf_range(std::span<const float> values, const LeafRepeats& repeats = {});

/// Fills `quantised`, `exact_bits` and `at_ends` of a row that summarize_leaf made. `values` are the leaf's row.finite
/// finite in-domain values. `all` says that the leaf has no other in-domain values.
void summarize_widths(std::span<const float> values, bool all, LeafRow& row);
/// The same for 512 finite values that repeat each other, as in summarize_leaf.
void summarize_widths(std::span<const float> values, std::span<const float> distinct, const LeafRepeats& repeats,
                      LeafRow& row);

}  // namespace weir
