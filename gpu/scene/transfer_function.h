// Maps values to colour and opacity by a piecewise-linear RGBA table over a value range. Values outside the range
// take the colour of its end. NaN and infinities are transparent. Bounds of the opacity over an interval are exact,
// as majorants need.
#pragma once

#include <cfloat>
#include <vector>

#include "format/nanovdb/range_max.h"
#include "gpu/math/portable.h"

namespace weir {

/// A filtered value may exceed the voxels that it came from by this fraction of the larger voxel, through rounding.
inline constexpr float kBlendRounding = 4 * FLT_EPSILON;

/// Linear RGB and opacity in [0, 1].
struct Rgba {
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 0;

  friend constexpr bool operator==(const Rgba&, const Rgba&) = default;
};

/// The part of a TransferFunction that a kernel needs.
struct TransferFunctionView {
  const Rgba* table = nullptr;  ///< last + 1 entries, evenly spaced over the range
  float last = 0;
  float low = 0;    ///< low end of the range times scale
  float width = 0;  ///< width of the range times scale; 0 for a single value
  float scale = 1;  ///< keeps the width finite for ranges that overflow float32

  /// Returns the position of a finite value in the table, in [0, last]. If the range is a single value, returns the
  /// middle for it; a blend of voxels that all have this value may miss it by a few ulp.
  WEIR_HOST_DEVICE float position(float value) const {
    const float offset = value * scale - low;
    if (width == 0.0F) {
      if (std::abs(offset) <= kBlendRounding * std::abs(low)) return 0.5F * last;
      return offset < 0.0F ? 0.0F : last;
    }
    return clamped(offset / width, 0.0F, 1.0F) * last;
  }

  WEIR_HOST_DEVICE Rgba at(float value) const {
    if (!is_finite(value)) return {};
    const float u = position(value);
    const auto i = static_cast<std::int32_t>(u);
    const Rgba& a = table[i];
    const Rgba& b = table[lesser(i + 1, static_cast<std::int32_t>(last))];
    const float f = u - static_cast<float>(i);
    return {mix(a.r, b.r, f), mix(a.g, b.g, f), mix(a.b, b.b, f), mix(a.a, b.a, f)};
  }
};

/// The largest opacity that any look-up in an interval of values gives.
struct OpacityBounds {
  TransferFunctionView transfer;
  RangeMaxView opacities;  ///< of the table's entries

  /// Returns an opacity that no look-up of a value in [low, high] exceeds. If an end is not finite or the interval is
  /// empty, returns the largest opacity of all.
  WEIR_HOST_DEVICE float max_opacity(float low, float high) const {
    if (!(low <= high) || !is_finite(low) || !is_finite(high)) return opacities.between(0, opacities.size - 1);
    const float slack = kBlendRounding * greater(std::abs(low), std::abs(high));
    const float first = transfer.position(greater(low - slack, -FLT_MAX));
    const float last = transfer.position(lesser(high + slack, FLT_MAX));
    // Positions grow with values, and the opacity is linear between entries. So its largest value is at an entry
    // inside the interval or at one of the ends.
    float result = greater(opacity(first), opacity(last));
    const auto from = static_cast<std::uint32_t>(std::ceil(first));
    const auto until = static_cast<std::uint32_t>(last);
    if (from <= until) result = greater(result, opacities.between(from, until));
    return result * (1.0F + 4 * FLT_EPSILON);
  }

 private:
  WEIR_HOST_DEVICE float opacity(float u) const {
    const auto i = static_cast<std::uint32_t>(u);
    return mix(transfer.table[i].a, transfer.table[lesser(i + 1, opacities.size - 1)].a, u - static_cast<float>(i));
  }
};

class TransferFunction {
 public:
  /// `table` has 2 or more entries over [low, high]; both ends are finite, and low <= high. Throws Error(internal)
  /// otherwise.
  TransferFunction(std::vector<Rgba> table, float low, float high);

  TransferFunctionView view() const { return view_; }
  float low() const { return low_; }
  float high() const { return high_; }
  Rgba at(float value) const { return view_.at(value); }
  OpacityBounds bounds() const { return {view_, opacities_.view()}; }
  float max_opacity(float low, float high) const { return bounds().max_opacity(low, high); }
  const std::vector<Rgba>& table() const { return table_; }
  const RangeMax& opacities() const { return opacities_; }

 private:
  std::vector<Rgba> table_;
  RangeMax opacities_;
  float low_;
  float high_;
  TransferFunctionView view_;
};

}  // namespace weir
