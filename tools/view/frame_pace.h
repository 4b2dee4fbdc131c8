// Chooses the size of pictures while the view moves, so that the next picture is there in time. The time per pixel
// sample is measured from the start of a picture until it is shown; if it is too long, fewer pixels are drawn.
#pragma once

#include <cstdint>

namespace weir {

struct FrameSize {
  std::int32_t width = 1;
  std::int32_t height = 1;
  std::uint32_t samples = 1;

  friend bool operator==(const FrameSize&, const FrameSize&) = default;
};

class FramePace {
 public:
  static constexpr double kFrame_s = 0.05;          ///< seconds between two pictures: 20 a second
  static constexpr double kSmallest = 1.0 / 10;     ///< least share of the full width, if that takes at most kLongest_s
  static constexpr double kLongest_s = 0.5;         ///< seconds; if kSmallest takes longer, kLeast is the limit
  static constexpr double kLeast = 1.0 / 100;       ///< least share of the full width in any case
  static constexpr std::uint32_t kMostSamples = 4;  ///< samples per pixel while the view moves

  /// Returns the size to draw now, for a full picture of `width` x `height` pixels with `layers` pictures above each
  /// other. `viewers` viewers move at the same time and share the machine.
  FrameSize next(std::int32_t width, std::int32_t height, int layers, int viewers) const;
  /// Records that a picture of `samples` pixel samples in all layers took `seconds` from its start until it was shown.
  void add(std::uint64_t samples, double seconds);

 private:
  double sample_s_ = 4e-7;  // seconds per pixel sample; the initial value is of two cores and a dense cloud
};

/// Returns `width` x `height` scaled by `share`, in (0, 1], at least 1 x 1.
FrameSize scaled(std::int32_t width, std::int32_t height, double share);

}  // namespace weir
