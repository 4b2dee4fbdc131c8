#include "ingest/values/decode_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "format/base/error.h"
#include "format/base/load_scalar.h"
#include "ingest/values/convert_values.h"
#include "ingest/values/half_values.h"

namespace weir {
namespace {

/// Number of values decoded at a time: the temporaries stay in the first-level cache.
constexpr std::size_t kAtOnce = 512;

using MissingMask = std::array<bool, kAtOnce>;

template <typename T>
class Decoder {
 public:
  Decoder(ScalarType type, const ValueMapping& mapping) : type_(type), mapping_(mapping), guards_(mapping.gaps) {
    for (const StoredValue& value : mapping.missing) {
      if (!holds(type, value)) continue;
      std::visit([this](const auto v) { missing_.push_back(static_cast<T>(v)); }, value);
    }
    guards_ = guards_ || !missing_.empty();
  }

  ConversionLoss decode(std::span<T> stored, std::span<float> values) const {
    MissingMask missing{};
    for (const T m : missing_) mark(stored, m, missing);
    if (mapping_.keeps_missing) return decode_as_data(stored, missing, values);
    // A missing value, for instance 1e36 in a double, must not count as rounded.
    for (std::size_t i = 0; i < stored.size(); ++i) stored[i] = missing[i] ? T{} : stored[i];
    const ConversionLoss loss = convert(stored, missing, values);
    if (guards_) mark_values(missing, values);
    return loss;
  }

 private:
  ConversionLoss decode_as_data(std::span<T> stored, const MissingMask& missing, std::span<float> values) const {
    ConversionLoss loss = convert(stored, MissingMask{}, values);
    loss.unmarked = static_cast<std::uint64_t>(
        std::count(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(stored.size()), true));
    if (mapping_.gaps) mark_values(MissingMask{}, values);
    return loss;
  }

  // Writes missing_value() in the place of missing values. Another value of the same bits, a NaN, gets other bits.
  static void mark_values(const MissingMask& missing, std::span<float> values) {
    const float mark = missing_value();
    const float other = std::bit_cast<float>(kMissingBits ^ 1U);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (missing[i]) {
        std::memcpy(&values[i], &mark, sizeof mark);
      } else if (is_missing(values[i])) {
        std::memcpy(&values[i], &other, sizeof other);
      }
    }
  }

  ConversionLoss convert(std::span<const T> stored, const MissingMask& missing, std::span<float> values) const {
    return mapping_.scales() ? scale(stored, missing, values)
                             : convert_values(std::as_bytes(stored), type_, kNativeIsBig, values);
  }

  static void mark(std::span<const T> stored, T value, MissingMask& missing) {
    if (value != value) {
      for (std::size_t i = 0; i < stored.size(); ++i) missing[i] |= stored[i] != stored[i];
    } else {
      for (std::size_t i = 0; i < stored.size(); ++i) missing[i] |= stored[i] == value;
    }
  }

  ConversionLoss scale(std::span<const T> stored, const MissingMask& missing, std::span<float> values) const {
    if constexpr (std::is_integral_v<T> && sizeof(T) == 8) return scale_wide(stored, missing, values);
    std::array<double, kAtOnce> scaled;
    for (std::size_t i = 0; i < stored.size(); ++i) {
      scaled[i] = missing[i] ? 0.0 : static_cast<double>(mapping_.scaled(stored[i]));
    }
    const auto used = std::span<const double>(scaled).first(stored.size());
    return convert_values(std::as_bytes(used), ScalarType::float64, kNativeIsBig, values);
  }

  // Scales 64-bit integers. An offset may turn large integers into small differences, for which every bit counts.
  ConversionLoss scale_wide(std::span<const T> stored, const MissingMask& missing, std::span<float> values) const {
    ConversionLoss loss;
    for (std::size_t i = 0; i < stored.size(); ++i) {
      const long double exact = missing[i] ? 0.0L : static_cast<long double>(mapping_.scaled(stored[i]));
      values[i] = static_cast<float>(exact);
      const auto error = static_cast<double>(std::fabs(static_cast<long double>(values[i]) - exact));
      loss.overflow += std::isinf(error) ? 1U : 0U;
      if (std::isinf(error) || error == 0.0) continue;
      ++loss.inexact;
      loss.max_abs_error = std::max(loss.max_abs_error, error);
    }
    return loss;
  }

  ScalarType type_;
  const ValueMapping& mapping_;
  std::vector<T> missing_;
  bool guards_;  // voxels may be missing, so no stored NaN may have the bits of missing_value()
};

template <typename T>
void load(const std::byte* bytes, bool big_endian, std::span<T> into) {
  if (big_endian == kNativeIsBig) {
    std::memcpy(into.data(), bytes, into.size_bytes());
    return;
  }
  for (std::size_t i = 0; i < into.size(); ++i) into[i] = load_scalar<T>(bytes + i * sizeof(T), big_endian);
}

template <typename T>
ConversionLoss decode_as(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                         const ValueMapping& mapping, std::span<float> values) {
  const Decoder<T> decoder(type, mapping);
  std::array<T, kAtOnce> stored;
  ConversionLoss loss;
  for (std::size_t start = 0; start < values.size(); start += kAtOnce) {
    const auto part = values.subspan(start, std::min(kAtOnce, values.size() - start));
    const auto used = std::span(stored).first(part.size());
    load<T>(bytes.data() + start * sizeof(T), big_endian, used);
    loss.add(decoder.decode(used, part));
  }
  return loss;
}

// Decodes float16 and bfloat16 through float32, which holds each of their values exactly, because not every machine
// has arithmetic for them.
ConversionLoss decode_half(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                           const ValueMapping& mapping, std::span<float> values) {
  const ValueMapping stored = with_stored_missing(mapping, type);
  const Decoder<float> decoder(ScalarType::float32, stored);
  std::array<float, kAtOnce> widened;
  ConversionLoss loss;
  for (std::size_t start = 0; start < values.size(); start += kAtOnce) {
    const auto part = values.subspan(start, std::min(kAtOnce, values.size() - start));
    const auto used = std::span(widened).first(part.size());
    convert_values(bytes.subspan(2 * start, 2 * part.size()), type, big_endian, used);
    loss.add(decoder.decode(used, part));
  }
  return loss;
}

// Gives stored NaNs with the bits of missing_value() other bits.
void tell_from_missing(std::span<float> values) {
  for (float& value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    value = std::bit_cast<float>(bits ^ static_cast<std::uint32_t>(bits == kMissingBits));
  }
}

}  // namespace

ConversionLoss decode_values(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                             const ValueMapping& mapping, std::span<float> values) {
  if (mapping.identity()) return convert_values(bytes, type, big_endian, values);
  if (!mapping.scales() && mapping.missing.empty()) {  // the usual case of a plotfile's level
    const ConversionLoss loss = convert_values(bytes, type, big_endian, values);
    tell_from_missing(values);
    return loss;
  }
  switch (type) {
    case ScalarType::uint8:
      return decode_as<std::uint8_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::int8:
      return decode_as<std::int8_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::uint16:
      return decode_as<std::uint16_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::int16:
      return decode_as<std::int16_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::uint32:
      return decode_as<std::uint32_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::int32:
      return decode_as<std::int32_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::uint64:
      return decode_as<std::uint64_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::int64:
      return decode_as<std::int64_t>(bytes, type, big_endian, mapping, values);
    case ScalarType::float16:
    case ScalarType::bfloat16:
      return decode_half(bytes, type, big_endian, mapping, values);
    case ScalarType::float32:
      return decode_as<float>(bytes, type, big_endian, mapping, values);
    case ScalarType::float64:
      return decode_as<double>(bytes, type, big_endian, mapping, values);
  }
  throw Error(ErrorKind::internal, "unknown scalar type");
}

}  // namespace weir
