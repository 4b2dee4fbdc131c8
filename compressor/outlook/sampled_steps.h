// What is bought of the sampled blocks of a packed volume, and how far from there the cut of the whole may lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compressor/packed/ladder_window.h"
#include "compressor/select/leaf_gain.h"
#include "format/packed/near_rungs.h"

namespace weir {

/// Bytes of streams, and of those that are near rungs or floats in order, of sparse blocks and of others.
struct BoughtBytes {
  double all = 0;
  double near_sparse = 0;
  double near_other = 0;

  void add(const BoughtBytes& bytes);
  /// Which blocks' near rungs are worth the time to look at them.
  NearBlocks near() const;
};

/// What a budget buys of a sample.
struct SampledCut {
  NearBlocks near{};                  ///< whose near rungs are worth the time to look at them
  std::optional<KeyWindow> window{};  ///< that the cut of the volume lies in; none where all is bought
  double bytes = 0;                   ///< of what is bought
  double least_key = 0;               ///< that it has, about
};

/// The steps of a sample's blocks, counted by their keys.
class SampledSteps {
 public:
  /// Of a sample of so many rows of blocks, whose values lie in a range of that width.
  SampledSteps(float width, std::size_t rows) : width_(width), rows_(rows) {}

  struct Block {
    std::size_t row;  ///< of the sample
    bool sparse;
    bool ordered;  ///< its exact kind is that of floats in order
  };
  void add(const Block& block, const LeafStep& step);

  /// Of what is bought for so many bytes.
  SampledCut within_bytes(double bytes) const;
  /// Of what must be bought so that no more than that error is left; nullopt where nothing must.
  std::optional<SampledCut> within_error(double squared_error) const;

 private:
  struct Bucket {
    BoughtBytes bytes{};
    double gain = 0;
  };
  struct Step {
    std::uint32_t bucket;
    std::uint32_t row;
    double bytes;
  };
  static constexpr int kDropped = 48;  // bits of a key: 16 to an octave remain

  static double key_of(std::size_t bucket);
  // By which factor the cut of the volume may differ from the key of bucket `cut`, at which so many bytes are bought.
  double reach_at(std::size_t cut, double bytes) const;
  // Standard deviation of the bytes bought there, among samples of this many rows.
  double deviation_at(std::size_t cut) const;

  float width_;
  std::size_t rows_;
  std::vector<Step> steps_;
  std::vector<Bucket> buckets_ = std::vector<Bucket>(std::size_t{1} << (64 - kDropped));
};

}  // namespace weir
