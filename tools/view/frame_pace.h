// How large a picture may be while the view moves, so that the next one is there in time: a viewer measures what a
// sample of a pixel costs it, from the start of a picture to its being shown, and takes fewer pixels where that is too
// much.
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
  static constexpr double kFrame_s = 0.05;          ///< between two pictures: 20 a second
  static constexpr double kSmallest = 1.0 / 10;     ///< of the full width, at least, where that does not take
  static constexpr double kLongest_s = 0.5;         ///< so long; else
  static constexpr double kLeast = 1.0 / 100;       ///< of it
  static constexpr std::uint32_t kMostSamples = 4;  ///< of a pixel, while the view moves

  /// The size to draw now, of a full picture of `width` x `height` pixels with `layers` of them above each other, where
  /// `viewers` move at a time and share the machine.
  FrameSize next(std::int32_t width, std::int32_t height, int layers, int viewers) const;
  /// A picture of `samples` pixel samples in all layers took `seconds` from its start until it was shown.
  void add(std::uint64_t samples, double seconds);

 private:
  double sample_s_ = 4e-7;  // of a pixel sample; as of two cores and a dense cloud, until it is known
};

/// `width` x `height` smaller by `share`, in (0, 1], at least 1 x 1.
FrameSize scaled(std::int32_t width, std::int32_t height, double share);

}  // namespace weir
