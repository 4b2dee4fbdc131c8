#include "ingest/synthetic/synthetic.h"

#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <limits>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/synthetic/cloud.h"
#include "ingest/synthetic/exceptions.h"
#include "ingest/synthetic/random_values.h"
#include "ingest/synthetic/shapes.h"
#include "ingest/synthetic/turbulence.h"

namespace weir {
namespace {

using Options = SyntheticOptions;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr auto kVerbatim = IntegerScaling::verbatim;
constexpr auto kStretch = IntegerScaling::stretch;
constexpr auto kNoIntegers = IntegerScaling::none;

constexpr std::array kKinds{
    SyntheticKind{"cloud", "sparse cumulus, exact zero around it, fractal density inside", 0, 1, kStretch, make_cloud},
    SyntheticKind{"turbulence", "dense signed band-limited noise, standard deviation 0.2", -1, 1, kStretch,
                  [](const Options& o) { return make_turbulence(o); }},
    SyntheticKind{"noise", "white noise in [0, 1)", 0, 1, kStretch, make_white_noise},
    SyntheticKind{"sphere", "four concentric shells, zero between them", 0, 1, kStretch, make_shells},
    SyntheticKind{"gradient", "linear ramp from 0 at the first voxel to 1 at the last", 0, 1, kStretch,
                  [](const Options& o) { return make_gradient(o, 0.0, 1.0); }},
    SyntheticKind{"constant", "0.5 everywhere", 0, 1, kStretch, [](const Options&) { return make_constant(0.5F); }},
    SyntheticKind{"zero", "0 everywhere", 0, 0, kStretch, [](const Options&) { return make_constant(0.0F); }},
    SyntheticKind{"nan", "NaN everywhere", 0, 0, kNoIntegers, [](const Options&) { return make_constant(kNaN); }},
    SyntheticKind{"some-nan", "the gradient with NaN, +Inf and -Inf at one voxel in 97 each", 0, 1, kNoIntegers,
                  make_some_nonfinite},
    SyntheticKind{"denormal", "k * 2^-149, k in 1..4096", 0, 0x1p-137F, kStretch, make_denormals},
    SyntheticKind{"negative-zero", "+0 and -0 at random", 0, 0, kStretch, make_signed_zeros},
    SyntheticKind{"huge", "linear ramp from -3e38 to 3e38: the range overflows float32", -3e38F, 3e38F, kStretch,
                  [](const Options& o) { return make_gradient(o, -3e38, 3e38); }},
    SyntheticKind{"tiny", "turbulence of magnitude 1e-16, like a galactic magnetic field", -1e-16F, 1e-16F, kStretch,
                  [](const Options& o) { return make_turbulence(o, 1e-16F); }},
    SyntheticKind{"offset", "1e8 + 8 k, |k| mostly below 32: steps of one unit in the last place", 1e8F - 256,
                  1e8F + 256, kVerbatim, [](const Options& o) { return make_stepped_turbulence(o, 1e8F, 8.0F); }},
    SyntheticKind{"big-integer", "even integers from 2^24 up to 2^24 + 2^21", 0x1p24F, 0x1p24F + 0x1p21F, kVerbatim,
                  make_big_integers},
    SyntheticKind{"ties", "four values exactly as frequent as each other", 0, 1, kStretch, make_ties},
    SyntheticKind{"background", "0.25 around a ball of turbulence with values on both sides of it", -2, 2, kStretch,
                  [](const Options& o) { return make_signed_ball(o, 0.25F); }},
    SyntheticKind{"signed", "0 around a ball of turbulence of both signs", -2, 2, kStretch,
                  [](const Options& o) { return make_signed_ball(o, 0.0F); }},
    SyntheticKind{"hot-voxel", "one voxel of 1 in a volume of 0", 0, 1, kStretch, make_hot_voxel},
    SyntheticKind{"plateau", "1 everywhere but for two spikes, +1e6 and -1e6", -1e6F, 1e6F, kStretch, make_plateau},
    SyntheticKind{"checkerboard", "0 and 1 at alternate voxels", 0, 1, kStretch,
                  [](const Options&) { return make_checkerboard(); }},
    SyntheticKind{"nearly-constant", "leaves of 1 with one voxel of 2 each", 0, 2, kStretch, make_nearly_constant},
};

class SyntheticSource final : public VolumeSource {
 public:
  SyntheticSource(const SyntheticKind& kind, const SyntheticOptions& options) : field_(kind.make(options)) {
    info_.path = cat("synthetic:", kind.name);
    info_.format = "synthetic";
    info_.extent = options.extent;
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {}; }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    const Index3 extent = box.extent();
    // Tiles lie on global multiples of their size, so that the noise lattices need the fewest nodes.
    const NodeLattice tiles = make_lattice(box, kTileDim);
    tbb::parallel_for(std::int64_t{0}, tiles.size(), [&](std::int64_t i) {
      const Box part = tiles.voxels(tiles.position(i));
      float* first = values.data() + linear_index(part.lo - box.lo, extent);
      field_->fill({part, first, extent.x, extent.x * extent.y});
    });
    bytes_made_ += values.size_bytes();
    return {};
  }

  std::uint64_t bytes_read() const override { return bytes_made_; }

 private:
  SourceInfo info_;
  std::unique_ptr<SyntheticField> field_;
  std::atomic<std::uint64_t> bytes_made_{0};
};

}  // namespace

bool is_synthetic_extent(const Index3& e) {
  const auto fits = [](std::int64_t n) { return n >= 1 && n < std::int64_t{1} << 31; };
  constexpr std::int64_t kMostVoxels = std::int64_t{1} << 60;
  return fits(e.x) && fits(e.y) && fits(e.z) && e.x * e.y <= kMostVoxels / e.z;
}

std::span<const SyntheticKind> synthetic_kinds() { return kKinds; }

const SyntheticKind& find_synthetic_kind(std::string_view name) {
  std::string known;
  for (const SyntheticKind& kind : kKinds) {
    if (kind.name == name) return kind;
    known += cat(known.empty() ? "" : ", ", kind.name);
  }
  throw Error(ErrorKind::usage, cat("kind of volume is \"", name, "\", it must be one of ", known));
}

std::unique_ptr<VolumeSource> open_synthetic(std::string_view kind, const SyntheticOptions& options) {
  if (const Index3& e = options.extent; !is_synthetic_extent(e)) {
    throw usage_error(cat("extent ", e.x, ',', e.y, ',', e.z, " is out of range; ", kSyntheticExtents));
  }
  return std::make_unique<SyntheticSource>(find_synthetic_kind(kind), options);
}

}  // namespace weir
