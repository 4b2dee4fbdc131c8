#include "ingest/synthetic/turbulence.h"

#include <algorithm>
#include <array>

#include "ingest/synthetic/spline_noise.h"

namespace weir {
namespace {

constexpr float kTurbulenceGain = 0.7937005F;  // 2^(-1/3)
constexpr float kTurbulenceDeviation = 0.2F;

SplineNoise inertial_range(const SyntheticOptions& options) {
  return SplineNoise(options.seed, options.extent, kTurbulenceGain, kTurbulenceDeviation);
}

/// Turbulence with a last step: finish(x, y, z, turbulence) is the voxel's value.
template <typename Finish>
class Turbulence final : public SyntheticField {
 public:
  Turbulence(const SyntheticOptions& options, Finish finish) : noise_(inertial_range(options)), finish_(finish) {}

  void fill(const Tile& tile) const override {
    const Box& box = tile.box;
    TileNoise noise(noise_, box);
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      noise.set_plane(z);
      for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
        float* row = tile.row(y, z);
        std::fill_n(row, box.extent().x, 0.0F);
        noise.add_row(y, row);
        for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
          float& value = row[x - box.lo.x];
          value = finish_(x, y, z, value);
        }
      }
    }
  }

 private:
  SplineNoise noise_;
  Finish finish_;
};

template <typename Finish>
std::unique_ptr<SyntheticField> make_turbulent(const SyntheticOptions& options, Finish finish) {
  return std::make_unique<Turbulence<Finish>>(options, finish);
}

// Rounds to the nearest integer, ties away from zero, for |v| far below 2^24. Unlike std::round it vectorises.
float nearest_integer(float v) { return static_cast<float>(static_cast<int>(v + (v < 0.0F ? -0.5F : 0.5F))); }

}  // namespace

std::unique_ptr<SyntheticField> make_turbulence(const SyntheticOptions& options, float scale) {
  return make_turbulent(options, [scale](std::int64_t, std::int64_t, std::int64_t, float v) { return scale * v; });
}

std::unique_ptr<SyntheticField> make_stepped_turbulence(const SyntheticOptions& options, float base, float step) {
  return make_turbulent(options, [base, step](std::int64_t, std::int64_t, std::int64_t, float v) {
    return base + step * nearest_integer(32.0F * v);
  });
}

std::unique_ptr<SyntheticField> make_signed_ball(const SyntheticOptions& options, float background) {
  constexpr float kRadius = 0.4F;
  const std::array<float, 3> slope{1.0F / (kRadius * static_cast<float>(options.extent.x)),
                                   1.0F / (kRadius * static_cast<float>(options.extent.y)),
                                   1.0F / (kRadius * static_cast<float>(options.extent.z))};
  return make_turbulent(options, [background, slope](std::int64_t x, std::int64_t y, std::int64_t z, float v) {
    const float dx = (static_cast<float>(x) + 0.5F) * slope[0] - 0.5F / kRadius;
    const float dy = (static_cast<float>(y) + 0.5F) * slope[1] - 0.5F / kRadius;
    const float dz = (static_cast<float>(z) + 0.5F) * slope[2] - 0.5F / kRadius;
    const float inside = 1.0F - ((dx * dx + dy * dy) + dz * dz);
    return inside > 0.0F ? background + 2.0F * inside * v : background;
  });
}

}  // namespace weir
