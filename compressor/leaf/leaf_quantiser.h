// The quantiser of one leaf: equidistant levels of 1, 2, 4, 8 or 16 bits per voxel, placed so that the squared error of
// the decoded values is least.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "compressor/leaf/leaf_repeats.h"

namespace weir {

/// A code decodes to fl(fl(code * quantum) + minimum); codes are 0 to top.
struct Quantiser {
  float minimum = 0;
  float quantum = 0;      ///< >= 0; 0 means one level
  std::uint32_t top = 0;  ///< highest code that values may take, at most 2^bits - 1
};

/// What a fit needs to know of the values.
struct ValueRange {
  float min = 0;
  float max = 0;
  float mean = 0;        ///< rounded
  double deviation = 0;  ///< sum of (value - mean), which is not 0 because `mean` is rounded
};

/// Fits a quantiser of `bits` (1, 2, 4, 8 or 16) to `values`: 1 to 512 finite values with range.min != range.max.
/// Starts with levels over the whole range and, at 1 and 2 bits, also with levels over a part of it around the mean.
/// Refits each start by least squares (Lloyd's iteration with equidistant levels, as in k-means). More starts and more
/// rounds gain less than 0.2 dB on the volumes of the tests. Every value decodes to a level inside the range. If the
/// least value is zero, zeros decode to zero. The levels span at most float's largest number, so that code * quantum is
/// a float; values of a wider range may lie beyond the outer levels. If the range is so small that the quantum has no
/// reciprocal, there is one level: the mean, or zero if the least value is zero. If few levels are taken, the levels of
/// fewer bits are tried too, so that more bits never do worse: values near a lattice may lie on the levels of a few
/// bits, but beside the levels of many bits. The result is the same on every machine: fixed lanes, no fused operations.
/// `repeats`, for 512 values only, says what need not be computed again.
Quantiser fit_quantiser(std::span<const float> values, const ValueRange& range, unsigned bits,
                        const LeafRepeats& repeats = {});

/// Estimates the squared error of fit_quantiser at 1, 2 and 4 bits with a third of the work, to within 15 % on average.
/// The errors are relative to `squares`, the squared error about the mean (above 0). The error is 1 for each number of
/// bits that is not below `below_bits`.
std::array<double, 3> estimated_errors(std::span<const float> values, const ValueRange& range, unsigned below_bits,
                                       double squares, const LeafRepeats& repeats = {});

/// Returns levels over the whole range, none beyond it. The largest error is half a quantum plus the decoder's
/// rounding. If float cannot hold the levels, returns one level as fit_quantiser does: the mean or zero.
Quantiser range_quantiser(const ValueRange& range, unsigned bits);

/// Sets the code of each value to the nearest level up to quantiser.top. `codes` must be as long as `values`.
void quantise(std::span<const float> values, const Quantiser& quantiser, std::span<std::uint16_t> codes);

}  // namespace weir
