#include "ingest/synthetic/spline_noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "format/base/simd.h"
#include "ingest/synthetic/hash.h"

namespace weir {
namespace {

constexpr std::int64_t kTaps = 4;
constexpr float kWeightRounding = 1e-5F;  // a voxel's weights sum to one only up to rounding

// Variance of one octave of amplitude 1. Nodes uniform in [-1, 1) have the variance 1/3. The B-spline multiplies it
// by the integral of its square, 151/315, along each axis.
constexpr double kOctaveVariance = 1.0 / 3.0 * (151.0 / 315.0) * (151.0 / 315.0) * (151.0 / 315.0);

using Weights = std::array<float, kTaps>;

// Returns the weights of the uniform cubic B-spline at phase (i + 1/2) / period.
Weights spline_weights(std::int64_t i, std::int64_t period) {
  const float t = (static_cast<float>(i) + 0.5F) / static_cast<float>(period);
  const float s = 1.0F - t;
  return {s * s * s / 6.0F, (3.0F * t * t * t - 6.0F * t * t + 4.0F) / 6.0F,
          (3.0F * s * s * s - 6.0F * s * s + 4.0F) / 6.0F, t * t * t / 6.0F};
}

// Weights of every phase of every period. Each tap has its own array, so the weights of neighbours are adjacent.
struct WeightTable {
  WeightTable() {
    for (unsigned shift = SplineNoise::kFinestShift; shift <= SplineNoise::kCoarsestShift; ++shift) {
      const std::int64_t period = std::int64_t{1} << shift;
      const std::int64_t length = std::max(period, kTileDim);
      for (auto& tap : taps.at(shift)) tap.resize(static_cast<std::size_t>(length));
      for (std::int64_t i = 0; i < length; ++i) {
        const Weights w = spline_weights(i % period, period);
        for (std::size_t t = 0; t < kTaps; ++t) taps.at(shift)[t][static_cast<std::size_t>(i)] = w[t];
      }
    }
  }
  std::array<std::array<std::vector<float>, kTaps>, SplineNoise::kCoarsestShift + 1> taps;
};

const WeightTable& weight_table() {
  static const WeightTable kTable;
  return kTable;
}

using TapRows = std::array<const float*, kTaps>;

// Returns the weights from `position` on: kTileDim of them if `position` is a multiple of kTileDim.
TapRows tap_rows(unsigned shift, std::int64_t position) {
  const std::int64_t phase = position & ((std::int64_t{1} << shift) - 1);
  const auto& taps = weight_table().taps[shift];
  return {taps[0].data() + phase, taps[1].data() + phase, taps[2].data() + phase, taps[3].data() + phase};
}

// Interpolates four arrays, `stride` apart, into `out`. The order of the additions is part of the definition of the
// noise.
inline void blend(const Weights& w, const float* nodes, std::int64_t stride, float* __restrict out,
                  std::int64_t count) {
  const float* nodes1 = nodes + stride;
  const float* nodes2 = nodes1 + stride;
  const float* nodes3 = nodes2 + stride;
  for (std::int64_t i = 0; i < count; ++i) {
    out[i] = (w[0] * nodes[i] + w[1] * nodes1[i]) + (w[2] * nodes2[i] + w[3] * nodes3[i]);
  }
}

WEIR_SIMD void blend_plane(const Weights& w, const float* nodes, std::int64_t stride, float* out, std::int64_t count) {
  blend(w, nodes, stride, out, count);
}

// Four floats at once (gcc and clang), each with the arithmetic of a single float. Without it, the compiler shuffles
// short cells into long vectors, which takes twice as long.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 load(const float* values) {
  Float4 result;
  std::memcpy(&result, values, sizeof(result));
  return result;
}

// Adds one octave to the kTileDim voxels of a row. Interpolates the row's nodes in y, then cells of kPeriod voxels
// (kTileDim for longer periods) in x. `w` holds the weights in y; `nodes` points at the row's first node.
template <std::int64_t kPeriod>
inline void add_octave(const Weights& w, const float* nodes, std::int64_t stride, const TapRows& x_weights,
                       float* __restrict values) {
  constexpr std::int64_t kCells = kTileDim / kPeriod;
  constexpr std::int64_t kNodes = (kCells + kTaps - 1 + 3) / 4 * 4;
  std::array<float, kNodes> line;
  blend(w, nodes, stride, line.data(), kNodes);
  for (std::int64_t cell = 0; cell < kCells; ++cell) {
    const float* n = line.data() + cell;
    for (std::int64_t i = cell * kPeriod; i < (cell + 1) * kPeriod; i += 4) {
      const Float4 sum = (load(x_weights[0] + i) * n[0] + load(x_weights[1] + i) * n[1]) +
                         (load(x_weights[2] + i) * n[2] + load(x_weights[3] + i) * n[3]) + load(values + i);
      std::memcpy(values + i, &sum, sizeof(sum));
    }
  }
}

WEIR_SIMD void add_octaves(const std::vector<NoiseLattice>& lattices, const WeightTable& table, std::int64_t y,
                           float* __restrict values) {
  for (const NoiseLattice& lattice : lattices) {
    const unsigned shift = lattice.octave.shift;
    const std::int64_t position = y + lattice.octave.offset.y;
    const std::int64_t stride = lattice.count.x;
    const float* nodes = lattice.plane.data() + ((position >> shift) - lattice.first.y) * stride;
    const auto phase = static_cast<std::size_t>(position & ((std::int64_t{1} << shift) - 1));
    const auto& taps = table.taps[shift];
    const Weights w{taps[0][phase], taps[1][phase], taps[2][phase], taps[3][phase]};
    switch (shift) {
      case 2:
        add_octave<4>(w, nodes, stride, lattice.x_weights, values);
        break;
      case 3:
        add_octave<8>(w, nodes, stride, lattice.x_weights, values);
        break;
      case 4:
        add_octave<16>(w, nodes, stride, lattice.x_weights, values);
        break;
      default:
        add_octave<kTileDim>(w, nodes, stride, lattice.x_weights, values);
    }
  }
}

std::int64_t round_down(std::int64_t v) { return floor_div(v, kTileDim) * kTileDim; }

}  // namespace

SplineNoise::SplineNoise(std::uint64_t seed, const Index3& extent, float gain, float deviation) {
  const auto longest = static_cast<std::uint64_t>(std::max({extent.x, extent.y, extent.z}));
  // Periods start at the power of two in (longest / 6, longest / 3].
  const auto coarsest = static_cast<unsigned>(std::bit_width(longest / 3));
  float amplitude = 1.0F;
  double variance = 0.0;
  for (unsigned shift = std::clamp(coarsest, kFinestShift + 1, kCoarsestShift + 1); shift-- > kFinestShift;) {
    const std::uint64_t key = derive_key(seed, 100 + shift);
    const auto offset = [&](std::uint64_t axis) {
      const std::int64_t period = std::int64_t{1} << shift;
      return round_down(static_cast<std::int64_t>(derive_key(key, axis) & static_cast<std::uint64_t>(period - 1)));
    };
    octaves_.push_back({shift, amplitude, key, {offset(0), offset(1), offset(2)}});
    variance += static_cast<double>(amplitude) * static_cast<double>(amplitude) * kOctaveVariance;
    amplitude *= gain;
  }
  const float scale = deviation / static_cast<float>(std::sqrt(variance));
  for (NoiseOctave& octave : octaves_) {
    octave.amplitude *= scale;
    amplitude_sum_ += octave.amplitude;
  }
}

TileNoise::TileNoise(const SplineNoise& noise, const Box& box) : box_(box) {
  const Index3 lo{round_down(box.lo.x), box.lo.y, box.lo.z};
  const Index3 hi{lo.x + kTileDim, box.hi.y, box.hi.z};
  lattices_.reserve(noise.octaves().size());
  for (const NoiseOctave& octave : noise.octaves()) {
    NoiseLattice& lattice = lattices_.emplace_back();
    lattice.octave = octave;
    const std::int64_t period = std::int64_t{1} << octave.shift;
    lattice.first = floor_div(lo + octave.offset, period);
    const Index3 last = floor_div(hi + octave.offset - Index3{1, 1, 1}, period);
    lattice.count = last - lattice.first + Index3{kTaps, kTaps, kTaps};
    lattice.count.x = (lattice.count.x + 3) / 4 * 4;
    lattice.nodes.resize(static_cast<std::size_t>(volume(lattice.count)));
    lattice.plane.resize(static_cast<std::size_t>(lattice.count.x * lattice.count.y));
    float highest = -octave.amplitude;
    auto node = lattice.nodes.begin();
    for (std::int64_t z = 0; z < lattice.count.z; ++z) {
      for (std::int64_t y = 0; y < lattice.count.y; ++y) {
        for (std::int64_t x = 0; x < lattice.count.x; ++x, ++node) {
          const Index3 i = lattice.first + Index3{x, y, z};
          *node = (2.0F * unit_float(hash_position(octave.key, i.x, i.y, i.z)) - 1.0F) * octave.amplitude;
          highest = std::max(highest, *node);
        }
      }
    }
    lattice.x_weights = tap_rows(octave.shift, lo.x + octave.offset.x);
    upper_bound_ += highest + octave.amplitude * kWeightRounding;
  }
}

float TileNoise::set_plane(std::int64_t z) {
  float bound = 0.0F;
  for (NoiseLattice& lattice : lattices_) {
    const std::int64_t position = z + lattice.octave.offset.z;
    const std::int64_t plane_nodes = lattice.count.x * lattice.count.y;
    const std::int64_t first = (position >> lattice.octave.shift) - lattice.first.z;
    const TapRows rows = tap_rows(lattice.octave.shift, position);
    blend_plane({*rows[0], *rows[1], *rows[2], *rows[3]}, lattice.nodes.data() + first * plane_nodes, plane_nodes,
                lattice.plane.data(), plane_nodes);
    bound += *std::max_element(lattice.plane.begin(), lattice.plane.end()) + lattice.octave.amplitude * kWeightRounding;
  }
  return bound;
}

void TileNoise::add_row(std::int64_t y, float* values) const {
  std::array<float, kTileDim> whole{};
  add_octaves(lattices_, weight_table(), y, whole.data());
  const float* first = whole.data() + (box_.lo.x - round_down(box_.lo.x));
  for (std::int64_t x = 0; x < box_.extent().x; ++x) values[x] += first[x];
}

}  // namespace weir
