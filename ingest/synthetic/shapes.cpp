#include "ingest/synthetic/shapes.h"

#include <algorithm>
#include <cmath>

namespace weir {
namespace {

template <typename Value>
std::unique_ptr<SyntheticField> make_shape(Value value) {
  return std::make_unique<VoxelField<Value>>(value);
}

}  // namespace

std::unique_ptr<SyntheticField> make_constant(float value) {
  return make_shape([value](std::int64_t, std::int64_t, std::int64_t) { return value; });
}

std::unique_ptr<SyntheticField> make_gradient(const SyntheticOptions& options, double lo, double hi) {
  const std::int64_t last = options.extent.x + options.extent.y + options.extent.z - 3;
  const auto steps = static_cast<double>(std::max<std::int64_t>(1, last));
  return make_shape([lo, hi, steps](std::int64_t x, std::int64_t y, std::int64_t z) {
    const double t = static_cast<double>(x + y + z) / steps;
    return static_cast<float>(lo * (1.0 - t) + hi * t);
  });
}

std::unique_ptr<SyntheticField> make_shells(const SyntheticOptions& options) {
  const Index3& e = options.extent;
  const float unit = 2.0F / static_cast<float>(std::min({e.x, e.y, e.z}));
  const float cx = 0.5F * static_cast<float>(e.x);
  const float cy = 0.5F * static_cast<float>(e.y);
  const float cz = 0.5F * static_cast<float>(e.z);
  return make_shape([=](std::int64_t x, std::int64_t y, std::int64_t z) {
    const float dx = (static_cast<float>(x) + 0.5F - cx) * unit;
    const float dy = (static_cast<float>(y) + 0.5F - cy) * unit;
    const float dz = (static_cast<float>(z) + 0.5F - cz) * unit;
    const float fifths = 5.0F * std::sqrt((dx * dx + dy * dy) + dz * dz);
    const auto shell = static_cast<float>(static_cast<int>(std::min(fifths + 0.5F, 9.0F)));
    const float t = (fifths - shell) * 4.0F;
    const float value = 0.25F * shell * (1.0F - t * t);
    return shell >= 1.0F && shell <= 4.0F && value > 0.0F ? value : 0.0F;
  });
}

}  // namespace weir
