// What a file's values mean: the one that stands for "no data", and the scale
// and offset of packed ones.
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

/// A value as a file stores it, before scale and offset. Whole numbers are kept as such: a double cannot
/// tell the ends of the 64-bit integers apart.
using StoredValue = std::variant<std::int64_t, std::uint64_t, double>;

/// "-9999", "18446744073709551615", "1e20" or "nan"; nullopt for anything else.
std::optional<StoredValue> parse_stored_value(std::string_view text);
/// The shortest text that parse_stored_value reads back as the same value.
std::string stored_value_text(const StoredValue& value);
double as_double(const StoredValue& value);
/// Whether a file of `type` can hold `value`; a floating-point type holds what rounds to a finite value,
/// and NaN and infinities.
bool holds(ScalarType type, const StoredValue& value);

/// How stored values become the volume's: value = stored * scale + offset, computed by scaled(), except
/// where the stored value is one of `missing`: such a voxel reads as missing_value(), or, with keeps_missing, as any
/// other.
struct ValueMapping {
  double scale = 1;
  double offset = 0;
  std::vector<StoredValue> missing;
  bool keeps_missing = false;  ///< stored values that stand for "no data" are taken as data
  bool gaps = false;           ///< there are voxels without a stored value, which read as missing_value() in any case

  /// In double; of 64-bit integers, whose last bits a double may not have, in long double.
  template <typename T>
  auto scaled(T stored) const {
    using Wide = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, long double, double>;
    return static_cast<Wide>(stored) * static_cast<Wide>(scale) + static_cast<Wide>(offset);
  }
  bool scales() const { return scale != 1 || offset != 0; }
  bool identity() const { return !scales() && missing.empty() && !gaps; }
  /// Whether voxels may read as missing_value().
  bool marks_missing() const { return gaps || (!missing.empty() && !keeps_missing); }
};

/// What a missing voxel reads as: a quiet NaN that no arithmetic makes, told from the NaN a simulation
/// writes. The background takes its place unless non-finite voxels are kept. It means that only in volumes whose
/// mapping names missing values or has gaps: there decode_values gives stored NaN of these bits other bits; elsewhere
/// it is an ordinary NaN.
inline constexpr std::uint32_t kMissingBits = 0x7FE0DA7AU;
inline float missing_value() { return std::bit_cast<float>(kMissingBits); }
inline bool is_missing(float value) { return std::bit_cast<std::uint32_t>(value) == kMissingBits; }

}  // namespace weir
