// From values to colour and opacity: a piecewise-linear RGBA table over a value
// range. Values beyond the range take the end's colour; NaN and infinities are
// transparent. Bounds of the opacity over an interval are exact, for majorants.
#pragma once

#include <vector>

#include "format/range_max.h"
#include "gpu/portable.h"

namespace weir {

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

  /// Position of a finite value in the table, in [0, last]; the middle where the range is one value.
  WEIR_HOST_DEVICE float position(float value) const {
    const float offset = value * scale - low;
    if (width == 0.0F) return offset < 0.0F ? 0.0F : (offset > 0.0F ? last : 0.5F * last);
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

class TransferFunction {
 public:
  /// `table` (2 or more entries) over [low, high], both finite, low <= high. Throws Error(internal)
  /// where that does not hold.
  TransferFunction(std::vector<Rgba> table, float low, float high);

  TransferFunctionView view() const { return view_; }
  float low() const { return low_; }
  float high() const { return high_; }
  Rgba at(float value) const { return view_.at(value); }
  /// No lookup of a value in [low, high] gives a larger opacity. Where an end is not finite or the
  /// interval is empty, the largest opacity of all.
  float max_opacity(float low, float high) const;

 private:
  std::vector<Rgba> table_;
  RangeMax opacities_;
  float low_;
  float high_;
  TransferFunctionView view_;
};

}  // namespace weir
