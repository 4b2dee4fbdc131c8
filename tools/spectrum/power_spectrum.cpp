#include "tools/spectrum/power_spectrum.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "compressor/compare/pair_stream.h"
#include "compressor/compare/window_begins.h"
#include "compressor/leaf/exact_sum.h"
#include "tools/spectrum/block_transform.h"
#include "tools/spectrum/wave_shells.h"

namespace weir {
namespace {

using Frequencies = std::vector<std::complex<double>>;

WindowBegins blocks_along(std::int64_t extent) {
  const std::int64_t block = std::min(extent, kSpectrumBlock);
  return {extent, block, std::max<std::int64_t>(block / 2, 1)};
}

std::vector<double> hann(std::int64_t block) {
  std::vector<double> weights;
  for (std::int64_t n = 0; n < block; ++n) {
    const double s = std::sin(std::numbers::pi * (static_cast<double>(n) + 0.5) / static_cast<double>(block));
    weights.push_back(s * s);
  }
  return weights;
}

/// The data that all blocks share.
struct Method {
  VolumeWindows windows;
  Index3 block;  ///< voxels of each
  WaveShells shells;
  BlockTransform transform;
  std::vector<double> window;  ///< x fastest
  double window_sum = 0;
  double window_squares = 0;

  Method(const Index3& extent, const std::array<double, 3>& spacing)
      : windows{blocks_along(extent.x), blocks_along(extent.y), blocks_along(extent.z)},
        block{windows.x.size, windows.y.size, windows.z.size},
        shells(block, spacing),
        transform(block) {
    const std::array<std::vector<double>, 3> axes{hann(block.x), hann(block.y), hann(block.z)};
    for_each_index({{}, block}, [&](const Index3& i) {
      const auto at = [](std::int64_t n) { return static_cast<std::size_t>(n); };
      const double weight = axes[0][at(i.x)] * axes[1][at(i.y)] * axes[2][at(i.z)];
      window.push_back(weight);
      window_sum += weight;
      window_squares += weight * weight;
    });
  }
};

struct ShellSums {
  ExactSum source;
  ExactSum decoded;
  ExactSum error;
};

/// The sums of one thread; they do not depend on order and grouping.
class SpectrumTally {
 public:
  explicit SpectrumTally(const Method& method) : method_(&method), sums_(method.shells.count()) {}

  /// Adds the blocks that begin in `part`.
  void add(const ValuePair& values, const Box& part) {
    const Index3& lo = values.domain.lo;
    for_each_index(method_->windows.in({part.lo - lo, part.hi - lo}), [&](const Index3& number) {
      const Index3 corner = lo + method_->windows.at(number);
      add_block(values, {corner, corner + method_->block});
    });
  }

  void merge(const SpectrumTally& other) {
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      sums_[i].source.add(other.sums_[i].source);
      sums_[i].decoded.add(other.sums_[i].decoded);
      sums_[i].error.add(other.sums_[i].error);
    }
    blocks_ += other.blocks_;
    left_out_ += other.left_out_;
  }

  PowerSpectrum result() const {
    PowerSpectrum all;
    all.block = method_->block;
    all.blocks = blocks_;
    all.left_out = left_out_;
    if (blocks_ == 0) return all;
    const double scale = 1 / static_cast<double>(blocks_);
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      if (method_->shells.modes(i) == 0) continue;
      all.shells.push_back({method_->shells.wave_number(i), method_->shells.modes(i), sums_[i].source.value() * scale,
                            sums_[i].decoded.value() * scale, sums_[i].error.value() * scale,
                            method_->shells.lowest(i)});
    }
    return all;
  }

 private:
  struct Powers {
    double source = 0;
    double decoded = 0;
    double error = 0;
  };

  void add_block(const ValuePair& values, const Box& box) {
    if (!transform(values, box, values.source, source_) || !transform(values, box, values.decoded, decoded_)) {
      ++left_out_;
      return;
    }
    ++blocks_;
    // By Parseval's equation, the powers of all frequencies sum up to the mean square under the window.
    const double scale = 1 / (static_cast<double>(volume(method_->block)) * method_->window_squares);
    std::vector<Powers> powers(sums_.size());
    const std::vector<WaveShells::Place>& places = method_->shells.places();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double weight = places[i].weight * scale;
      Powers& shell = powers[places[i].shell];
      shell.source += weight * std::norm(source_[i]);
      shell.decoded += weight * std::norm(decoded_[i]);
      shell.error += weight * std::norm(decoded_[i] - source_[i]);
    }
    for (std::size_t i = 0; i < powers.size(); ++i) {
      sums_[i].source.add(powers[i].source);
      sums_[i].decoded.add(powers[i].decoded);
      sums_[i].error.add(powers[i].error);
    }
  }

  // Returns false if a value is not finite.
  bool transform(const ValuePair& values, const Box& box, std::span<const float> all, Frequencies& result) {
    const Index3 extent = box.extent();
    block_.resize(static_cast<std::size_t>(volume(extent)));
    result.resize(static_cast<std::size_t>(volume(BlockTransform::frequencies(extent))));
    double sum = 0;
    std::size_t to = 0;
    for_each_index(box, [&](const Index3& i) {
      block_[to] = static_cast<double>(all[values.at(i)]);
      sum += block_[to] * method_->window[to];
      ++to;
    });
    if (!std::isfinite(sum)) return false;
    const double mean = sum / method_->window_sum;
    for (std::size_t i = 0; i < block_.size(); ++i) block_[i] = (block_[i] - mean) * method_->window[i];
    method_->transform.run(block_, result);
    return true;
  }

  const Method* method_;
  std::vector<ShellSums> sums_;
  std::uint64_t blocks_ = 0;
  std::uint64_t left_out_ = 0;
  std::vector<double> block_;
  Frequencies source_;
  Frequencies decoded_;
};

}  // namespace

PowerSpectrum power_spectrum(VolumeSource& source, const NvdbGrid& grid, const CompareOptions& options) {
  const SourceInfo& info = source.info();
  const Method method(info.extent, info.spacing);
  const SpectrumTally none(method);
  tbb::enumerable_thread_specific<SpectrumTally> tallies(none);
  const Index3& block = method.block;
  const PairMargin margin{0, std::max({block.x, block.y, block.z}) - 1};
  stream_pairs(source, grid, margin, options,
               [&](const ValuePair& values, const Box& part) { tallies.local().add(values, part); });
  SpectrumTally total = none;
  for (const SpectrumTally& tally : tallies) total.merge(tally);
  return total.result();
}

}  // namespace weir
