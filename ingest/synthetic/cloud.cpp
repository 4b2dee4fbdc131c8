#include "ingest/synthetic/cloud.h"

#include <algorithm>
#include <array>

#include "format/base/simd.h"
#include "ingest/synthetic/ellipsoids.h"
#include "ingest/synthetic/spline_noise.h"

namespace weir {
namespace {

constexpr float kCloudGain = 0.66F;
constexpr float kCloudDeviation = 0.34F;
constexpr float kCore = 0.45F;           // the most that the envelope adds, so that noise also shows inside
constexpr float kBoundRounding = 1e-3F;  // more than the rounding error of a bound

// Turns a row of noise into density, in place.
WEIR_SIMD void finish(const std::array<float, kTileDim>& q, float* row, std::int64_t count) {
  for (std::int64_t x = 0; x < count; ++x) {
    const float envelope = 1.0F - q[static_cast<std::size_t>(x)];
    const float s = (envelope < kCore ? envelope : kCore) + row[x];
    const float positive = s > 0.0F ? s : 0.0F;
    row[x] = positive / (positive + 0.5F);
  }
}

class Cloud final : public SyntheticField {
 public:
  explicit Cloud(const SyntheticOptions& options)
      : noise_(options.seed, options.extent, kCloudGain, kCloudDeviation), heap_(make_heap(options)) {}

  void fill(const Tile& tile) const override {
    const TileEllipsoids ellipsoids(heap_, tile.box);
    // Far outside, noise cannot lift the density above zero. Three tests find this: with the bound of any tile's
    // noise, with the bound of this tile's noise, and row by row.
    if (empty(ellipsoids.least(), noise_.amplitude_sum())) return clear(tile);
    TileNoise noise(noise_, tile.box);
    if (empty(ellipsoids.least(), noise.upper_bound())) return clear(tile);

    const std::int64_t width = tile.box.extent().x;
    std::array<float, kTileDim> q{};
    for (std::int64_t z = tile.box.lo.z; z < tile.box.hi.z; ++z) {
      const float most_noise = noise.set_plane(z);
      for (std::int64_t y = tile.box.lo.y; y < tile.box.hi.y; ++y) {
        float* row = tile.row(y, z);
        std::fill_n(row, width, 0.0F);
        if (empty(ellipsoids.least_in_row(y, z), most_noise)) continue;
        noise.add_row(y, row);
        ellipsoids.row(y, z, q);
        finish(q, row, width);
      }
    }
  }

 private:
  static bool empty(float least_q, float most_noise) { return 1.0F - least_q + most_noise <= -kBoundRounding; }

  static void clear(const Tile& tile) {
    for (std::int64_t z = tile.box.lo.z; z < tile.box.hi.z; ++z) {
      for (std::int64_t y = tile.box.lo.y; y < tile.box.hi.y; ++y) {
        std::fill_n(tile.row(y, z), tile.box.extent().x, 0.0F);
      }
    }
  }

  SplineNoise noise_;
  EllipsoidHeap heap_;
};

}  // namespace

std::unique_ptr<SyntheticField> make_cloud(const SyntheticOptions& options) { return std::make_unique<Cloud>(options); }

}  // namespace weir
