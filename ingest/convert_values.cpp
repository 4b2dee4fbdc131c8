#include "ingest/convert_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace weir {
namespace {

static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

template <std::size_t Bytes>
using Word = std::conditional_t<
    Bytes == 1, std::uint8_t,
    std::conditional_t<Bytes == 2, std::uint16_t, std::conditional_t<Bytes == 4, std::uint32_t, std::uint64_t>>>;

constexpr std::uint8_t swap_bytes(std::uint8_t v) { return v; }
constexpr std::uint16_t swap_bytes(std::uint16_t v) { return __builtin_bswap16(v); }
constexpr std::uint32_t swap_bytes(std::uint32_t v) { return __builtin_bswap32(v); }
constexpr std::uint64_t swap_bytes(std::uint64_t v) { return __builtin_bswap64(v); }

template <typename T, bool Swap>
T load(const std::byte* bytes, std::size_t i) {
  Word<sizeof(T)> word;
  std::memcpy(&word, bytes + i * sizeof(T), sizeof(T));
  if constexpr (Swap) word = swap_bytes(word);
  return std::bit_cast<T>(word);
}

/// Maxima and counts kept in lanes, so that the compiler can vectorise without reordering anything
/// that matters: maxima and integer sums do not depend on order.
constexpr std::size_t kLanes = 16;

template <typename T, bool Swap>
ConversionLoss convert_exact(const std::byte* bytes, std::span<float> values) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(load<T, Swap>(bytes, i));
  return {};
}

template <bool Swap>
ConversionLoss copy_float32(const std::byte* bytes, std::span<float> values) {
  // Through integers: loading a signalling NaN as a float could quieten it.
  auto* out = reinterpret_cast<std::byte*>(values.data());
  if constexpr (Swap) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto word = load<std::uint32_t, true>(bytes, i);
      std::memcpy(out + i * sizeof word, &word, sizeof word);
    }
  } else {
    std::memcpy(out, bytes, values.size_bytes());
  }
  return {};
}

template <typename T, bool Swap>
ConversionLoss convert_rounding(const std::byte* bytes, std::span<float> values) {
  // Inside double every difference below is exact: |double(f) - double(v)| spans at most the 53 bits
  // of v (float64) or 32 bits (integers).
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<std::uint64_t, kLanes> inexact{};
  std::array<std::uint64_t, kLanes> overflow{};
  std::array<double, kLanes> worst{};
  const auto step = [&](std::size_t i, std::size_t lane) {
    const T original = load<T, Swap>(bytes, i);
    const auto value = static_cast<float>(original);
    values[i] = value;
    // NaN where both are the same infinity or NaN; infinite where the value overflowed.
    const double error = std::fabs(static_cast<double>(value) - static_cast<double>(original));
    const bool rounded = error > 0.0 && error < kInfinity;
    inexact[lane] += rounded ? 1U : 0U;
    if constexpr (std::floating_point<T>) overflow[lane] += error == kInfinity ? 1U : 0U;
    const double counted = rounded ? error : 0.0;
    worst[lane] = counted > worst[lane] ? counted : worst[lane];
  };
  std::size_t i = 0;
  for (; i + kLanes <= values.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) step(i + lane, lane);
  }
  for (; i < values.size(); ++i) step(i, 0);

  ConversionLoss loss;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    loss.add({inexact[lane], overflow[lane], worst[lane]});
  }
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
    case ScalarType::float32:
      return copy_float32<Swap>(bytes, values);
    case ScalarType::float64:
      return convert_rounding<double, Swap>(bytes, values);
  }
  return {};
}

constexpr bool kNativeIsBig = std::endian::native == std::endian::big;

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
