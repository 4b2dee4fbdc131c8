#include "tools/view/frame_pace.h"

#include <algorithm>
#include <cmath>

namespace weir {
namespace {

constexpr double kNewest = 0.4;       // weight of the newest measurement
constexpr double kStepsPerHalf = 4;   // size steps per halving, so that the size rarely changes
constexpr double kLongestFrame = 10;  // longest measurement that counts, seconds: a machine that slept tells nothing

}  // namespace

FrameSize scaled(std::int32_t width, std::int32_t height, double share) {
  const auto of = [&](std::int32_t edge) {
    return std::max(1, static_cast<std::int32_t>(std::lround(static_cast<double>(edge) * share)));
  };
  return {of(width), of(height), 1};
}

FrameSize FramePace::next(std::int32_t width, std::int32_t height, int layers, int viewers) const {
  const double full = static_cast<double>(width) * height * std::max(layers, 1);
  const double affordable = kFrame_s / std::max(viewers, 1) / sample_s_;
  const double share = std::sqrt(affordable / full);
  if (share >= 1) {
    FrameSize size{width, height, 1};
    size.samples = static_cast<std::uint32_t>(std::clamp(affordable / full, 1.0, static_cast<double>(kMostSamples)));
    return size;
  }
  const auto stepped = [](double of) { return std::exp2(std::floor(std::log2(of) * kStepsPerHalf) / kStepsPerHalf); };
  const double bearable = stepped(share * std::sqrt(kLongest_s / kFrame_s));
  return scaled(width, height, std::max({stepped(share), std::min(kSmallest, bearable), kLeast}));
}

void FramePace::add(std::uint64_t samples, double seconds) {
  if (samples == 0 || !(seconds > 0)) return;
  const double measured = std::min(seconds, kLongestFrame) / static_cast<double>(samples);
  // A much higher cost, as of another mode, is believed at once, so that the next picture is not late too.
  sample_s_ = measured > 3 * sample_s_ ? measured : sample_s_ + kNewest * (measured - sample_s_);
}

}  // namespace weir
