// The quantiser of one leaf: equidistant levels of 1, 2, 4, 8 or 16 bits a voxel,
// placed so that the squared error of what a reader decodes is least.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "compressor/leaf/leaf_repeats.h"

namespace weir {

/// value = fl(fl(code * quantum) + minimum), code in 0 .. top.
struct Quantiser {
  float minimum = 0;
  float quantum = 0;      ///< >= 0; 0: one level
  std::uint32_t top = 0;  ///< highest code that values take, at most 2^bits - 1
};

/// What a fit needs to know of the values.
struct ValueRange {
  float min = 0;
  float max = 0;
  float mean = 0;        ///< rounded
  double deviation = 0;  ///< sum of (value - mean): what the rounding left
};

/// Fits `bits` (1, 2, 4, 8 or 16) to `values`, 1 to 512 finite ones of range.min != range.max: levels over
/// the whole range at first and, at 1 and 2 bits, over less of it around the mean as well, each refitted by
/// least squares (Lloyd's iteration with equidistant levels, as in k-means). More starts and more rounds
/// gain less than 0.2 dB on the volumes of the tests.
/// Every value decodes to a level inside the range, and where the least value is zero, zeros decode to zero.
/// Levels are at most float's largest number apart, so that code * quantum is one: values of a wider range may lie
/// beyond the outer levels. Where the range is so small that the quantum has no reciprocal there is one level, the
/// mean, or zero where the least value is zero. Where few levels are taken, those of fewer bits are tried as well, so
/// that more bits never do worse: values near a lattice may lie on the levels of a few bits, and beside those of many.
/// The same on every machine: fixed lanes, nothing fused. `repeats`, of 512 values, say what need not be computed
/// again.
Quantiser fit_quantiser(std::span<const float> values, const ValueRange& range, unsigned bits,
                        const LeafRepeats& repeats = {});

/// What the squared error of fit_quantiser will be at 1, 2 and 4 bits, from a third of the work: within 15 % on
/// average, relative to `squares`, the squared error about the mean (above 0). 1 for what is not below `below_bits`.
std::array<double, 3> estimated_errors(std::span<const float> values, const ValueRange& range, unsigned below_bits,
                                       double squares, const LeafRepeats& repeats = {});

/// Levels over the whole range, none beyond it: the largest error is half a quantum, and the roundings of the decoder.
/// One level, the mean or zero as there, where float cannot hold them.
Quantiser range_quantiser(const ValueRange& range, unsigned bits);

/// The code of each value, the nearest level up to the top. `codes` is as long as `values`.
void quantise(std::span<const float> values, const Quantiser& quantiser, std::span<std::uint16_t> codes);

}  // namespace weir
