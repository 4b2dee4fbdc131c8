// From values to colour and opacity: a piecewise-linear RGBA table over a value
// range. Values beyond the range take the end's colour; NaN and infinities are
// transparent. Bounds of the opacity over an interval are exact, for majorants.
#pragma once

#include <cfloat>
#include <vector>

#include "format/nanovdb/range_max.h"
#include "gpu/math/portable.h"

namespace weir {

/// A filtered value may round past the voxels it came from by this share of the larger of them.
inline constexpr float kBlendRounding = 4 * FLT_EPSILON;

/// Linear RGB and opacity in [0, 1].
struct Rgba {
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 0;

  friend constexpr bool operator==(const Rgba&, const Rgba&) = default;
};

/// What a kernel needs of a TransferFunction.
struct TransferFunctionView {
  const Rgba* table = nullptr;  ///< last + 1 entries, at equal distances over the range
  float last = 0;
  float low = 0;    ///< range's low end times scale
  float width = 0;  ///< range's width times scale; 0 for a single value
  float scale = 1;  ///< keeps the width finite for ranges that overflow float32

  /// Position of a finite value in the table, in [0, last]; the middle where the range is that one value, which a blend
  /// of voxels that all have it may miss by a few ulp.
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

/// The largest opacity that any lookup of a stretch of values gives.
struct OpacityBounds {
  TransferFunctionView transfer;
  RangeMaxView opacities;  ///< of the table's entries

  /// No lookup of a value in [low, high] gives a larger opacity. Where an end is not finite or the
  /// interval is empty, the largest opacity of all.
  WEIR_HOST_DEVICE float max_opacity(float low, float high) const {
    if (!(low <= high) || !is_finite(low) || !is_finite(high)) return opacities.between(0, opacities.size - 1);
    const float slack = kBlendRounding * greater(std::abs(low), std::abs(high));
    const float first = transfer.position(greater(low - slack, -FLT_MAX));
    const float last = transfer.position(lesser(high + slack, FLT_MAX));
    // Positions grow with values and the opacity is linear between entries: its largest value is at an
    // entry inside the interval or at one of the two ends.
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
  /// `table` (2 or more entries) over [low, high], both finite, low <= high. Throws Error(internal)
  /// where that does not hold.
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
