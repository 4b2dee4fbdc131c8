#include "ingest/values/convert_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "format/base/load_scalar.h"
#include "format/base/simd.h"

namespace weir {
namespace {

static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

template <typename T, bool Swap>
T load(const std::byte* bytes, std::size_t i) {
  return load_scalar<T>(bytes + i * sizeof(T), Swap != kNativeIsBig);
}

/// Converts IEEE 754 binary16 to binary32. The result is exact; NaN payloads move to the upper bits.
float half_to_float(std::uint16_t half) {
  const auto sign = static_cast<std::uint32_t>(half & 0x8000U) << 16U;
  const std::uint32_t exponent = (half >> 10U) & 0x1FU;
  const std::uint32_t fraction = half & 0x3FFU;
  if (exponent == 0) {  // zero or denormal: fraction * 2^-24
    const float magnitude = static_cast<float>(fraction) * 0x1p-24F;
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(magnitude) | sign);
  }
  const std::uint32_t widened = exponent == 0x1FU ? 0xFFU : exponent + 112U;
  return std::bit_cast<float>(sign | (widened << 23U) | (fraction << 13U));
}

/// Converts bfloat16, which is the upper half of a binary32.
template <bool Swap>
ConversionLoss convert_bfloat16(const std::byte* bytes, std::span<float> values) {
  // Copies integers, for the same reason as copy_float32: loading a signalling NaN as a float could make it quiet.
  auto* out = reinterpret_cast<std::byte*>(values.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t word = std::uint32_t{load<std::uint16_t, Swap>(bytes, i)} << 16U;
    std::memcpy(out + i * sizeof word, &word, sizeof word);
  }
  return {};
}

template <bool Swap>
ConversionLoss convert_half(const std::byte* bytes, std::span<float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = half_to_float(load<std::uint16_t, Swap>(bytes, i));
  return {};
}

template <typename T, bool Swap>
ConversionLoss convert_exact(const std::byte* bytes, std::span<float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(load<T, Swap>(bytes, i));
  return {};
}

template <bool Swap>
ConversionLoss copy_float32(const std::byte* bytes, std::span<float> values) {
  // Copies integers, because loading a signalling NaN as a float could make it quiet.
  auto* out = reinterpret_cast<std::byte*>(values.data());
  if constexpr (Swap) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto word = load<std::uint32_t, true>(bytes, i);
      std::memcpy(out + i * sizeof word, &word, sizeof word);
    }
  } else {
    std::copy_n(bytes, values.size_bytes(), out);
  }
  return {};
}

/// Number of values converted at a time: the temporaries stay in the first-level cache.
constexpr std::size_t kChunk = 512;
/// Number of lanes for maxima and counts. Neither depends on the order, so the loops may be vectorised.
constexpr std::size_t kLanes = 16;

/// Rounds values and computes their errors. The difference between float32 and original is exact in double, because
/// it spans at most the 53 bits of a float64 or the 32 bits of an integer. It is NaN if both are the same infinity or
/// NaN, and infinite if a finite value overflowed.
template <typename T>
inline __attribute__((always_inline)) void round_values(const T* original, float* values, double* error) {
  for (std::size_t i = 0; i < kChunk; ++i) values[i] = static_cast<float>(original[i]);
  for (std::size_t i = 0; i < kChunk; ++i) {
    error[i] = std::fabs(static_cast<double>(values[i]) - static_cast<double>(original[i]));
  }
}
WEIR_SIMD void round_chunk(const double* original, float* values, double* error) {
  round_values<double>(original, values, error);
}
WEIR_SIMD void round_chunk(const std::int32_t* original, float* values, double* error) {
  round_values<std::int32_t>(original, values, error);
}
WEIR_SIMD void round_chunk(const std::uint32_t* original, float* values, double* error) {
  round_values<std::uint32_t>(original, values, error);
}

/// Rounds 64-bit integers. Their difference to a float32 needs 64 bits of significand, which long double has.
template <typename T>
void round_wide(const T* original, float* values, double* error) {
  static_assert(std::numeric_limits<long double>::digits >= 64);
  for (std::size_t i = 0; i < kChunk; ++i) {
    values[i] = static_cast<float>(original[i]);
    error[i] =
        static_cast<double>(std::fabs(static_cast<long double>(values[i]) - static_cast<long double>(original[i])));
  }
}
void round_chunk(const std::int64_t* original, float* values, double* error) { round_wide(original, values, error); }
void round_chunk(const std::uint64_t* original, float* values, double* error) { round_wide(original, values, error); }

WEIR_SIMD void count_chunk(const double* error, std::uint64_t* inexact, std::uint64_t* overflow, double* worst) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kChunk; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double e = error[i + lane];
      inexact[lane] += (e > 0.0 ? 1U : 0U) & (e < kInfinity ? 1U : 0U);
      overflow[lane] += e == kInfinity ? 1U : 0U;
      const double counted = e < kInfinity ? e : 0.0;
      worst[lane] = counted > worst[lane] ? counted : worst[lane];
    }
  }
}

template <typename T, bool Swap>
ConversionLoss convert_rounding(const std::byte* bytes, std::span<float> values) {
  std::array<T, kChunk> original;
  std::array<float, kChunk> rounded;
  std::array<double, kChunk> error;
  std::array<std::uint64_t, kLanes> inexact{};
  std::array<std::uint64_t, kLanes> overflow{};
  std::array<double, kLanes> worst{};
  for (std::size_t start = 0; start < values.size(); start += kChunk) {
    const std::size_t n = std::min(kChunk, values.size() - start);
    if (n < kChunk) original.fill(T{0});  // exact, so the rest of the chunk counts nothing
    for (std::size_t i = 0; i < n; ++i) original[i] = load<T, Swap>(bytes, start + i);
    round_chunk(original.data(), rounded.data(), error.data());
    std::copy_n(rounded.begin(), n, values.begin() + static_cast<std::ptrdiff_t>(start));
    count_chunk(error.data(), inexact.data(), overflow.data(), worst.data());
  }
  ConversionLoss loss;
  for (std::size_t lane = 0; lane < kLanes; ++lane) loss.add({inexact[lane], overflow[lane], worst[lane]});
  return loss;
}

template <bool Swap>
ConversionLoss convert(const std::byte* bytes, ScalarType type, std::span<float> values) {
  switch (type) {
    case ScalarType::uint8:
      return convert_exact<std::uint8_t, Swap>(bytes, values);
    case ScalarType::int8:
      return convert_exact<std::int8_t, Swap>(bytes, values);
    case ScalarType::uint16:
      return convert_exact<std::uint16_t, Swap>(bytes, values);
    case ScalarType::int16:
      return convert_exact<std::int16_t, Swap>(bytes, values);
    case ScalarType::uint32:
      return convert_rounding<std::uint32_t, Swap>(bytes, values);
    case ScalarType::int32:
      return convert_rounding<std::int32_t, Swap>(bytes, values);
    case ScalarType::uint64:
      return convert_rounding<std::uint64_t, Swap>(bytes, values);
    case ScalarType::int64:
      return convert_rounding<std::int64_t, Swap>(bytes, values);
    case ScalarType::float16:
      return convert_half<Swap>(bytes, values);
    case ScalarType::bfloat16:
      return convert_bfloat16<Swap>(bytes, values);
    case ScalarType::float32:
      return copy_float32<Swap>(bytes, values);
    case ScalarType::float64:
      return convert_rounding<double, Swap>(bytes, values);
  }
  return {};
}

}  // namespace

bool is_native_float32(ScalarType type, bool big_endian) {
  return type == ScalarType::float32 && big_endian == kNativeIsBig;
}

ConversionLoss convert_values(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                              std::span<float> values) {
  return big_endian == kNativeIsBig ? convert<false>(bytes.data(), type, values)
                                    : convert<true>(bytes.data(), type, values);
}

}  // namespace weir
