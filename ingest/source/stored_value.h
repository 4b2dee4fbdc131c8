// The meaning of stored values: the values that stand for "no data", and the scale and offset of packed values.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "format/base/scalar_type.h"

namespace weir {

/// A value as a file stores it, before scale and offset. Integers stay integers, because a double cannot represent
/// the ends of the 64-bit ranges exactly.
using StoredValue = std::variant<std::int64_t, std::uint64_t, double>;

/// Parses "-9999", "18446744073709551615", "1e20" or "nan". Returns nullopt for anything else.
std::optional<StoredValue> parse_stored_value(std::string_view text);
/// Returns the shortest text that parse_stored_value reads back as the same value.
std::string stored_value_text(const StoredValue& value);
double as_double(const StoredValue& value);
/// Returns whether a file of `type` can hold `value`. A floating-point type holds values that round to a finite
/// value, NaN and infinities.
bool holds(ScalarType type, const StoredValue& value);

/// How stored values become the volume's: value = stored * scale + offset, computed by scaled(). If the stored value
/// is one of `missing`, the voxel reads as missing_value() instead; with keeps_missing it reads as any other.
struct ValueMapping {
  double scale = 1;
  double offset = 0;
  std::vector<StoredValue> missing;
  bool keeps_missing = false;  ///< stored values that stand for "no data" are taken as data
  bool gaps = false;           ///< some voxels have no stored value; they always read as missing_value()

  /// Computes in double. For 64-bit integers, which a double may round, it computes in long double.
  template <typename T>
  auto scaled(T stored) const {
    using Wide = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, long double, double>;
    return static_cast<Wide>(stored) * static_cast<Wide>(scale) + static_cast<Wide>(offset);
  }
  bool scales() const { return scale != 1 || offset != 0; }
  bool identity() const { return !scales() && missing.empty() && !gaps; }
  /// Returns whether voxels may read as missing_value().
  bool marks_missing() const { return gaps || (!missing.empty() && !keeps_missing); }
};

/// The value of a missing voxel: a quiet NaN that no arithmetic produces, so it differs from a NaN that a simulation
/// writes. The background replaces it unless non-finite voxels are kept. It means "missing" only in volumes with a
/// mapping that names missing values or has gaps: decode_values gives stored NaNs of these bits other bits in such
/// volumes. In all other volumes it is an ordinary NaN.
inline constexpr std::uint32_t kMissingBits = 0x7FE0DA7AU;
inline float missing_value() { return std::bit_cast<float>(kMissingBits); }
inline bool is_missing(float value) { return std::bit_cast<std::uint32_t>(value) == kMissingBits; }

}  // namespace weir
