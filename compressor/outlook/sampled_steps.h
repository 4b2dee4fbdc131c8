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

/// A sampled block.
struct SampledBlock {
  std::size_t row;     ///< of the sample
  std::size_t region;  ///< of those that were sampled
  bool sparse;
  bool ordered;  ///< its exact kind is that of floats in order
};

/// The steps of some blocks, counted by their keys.
class SampledSteps {
 public:
  /// Steps that one thread finds.
  class Part {
   public:
    void add(const SampledBlock& block, const LeafStep& step);

   private:
    friend class SampledSteps;
    enum class Near : std::uint8_t { no, of_sparse, of_other };
    struct Step {
      double gain;
      std::uint32_t bytes;
      std::uint32_t bucket;
      std::uint32_t row;
      std::uint32_t region;
      Near near;
    };
    std::vector<Step> steps_;
  };

  /// Of a sample of so many rows of blocks, whose values lie in a range of that width. What is found does not depend on
  /// the threads as long as the parts do not.
  SampledSteps(float width, std::size_t rows, std::vector<Part> parts);

  /// Of what is bought for so many bytes.
  SampledCut within_bytes(double bytes) const;
  /// Of what must be bought so that no more than that error is left; nullopt where nothing must.
  std::optional<SampledCut> within_error(double squared_error) const;

  /// Calls visit(region, gain, bytes) for each step of `key`, which is a cut's, or a higher one.
  template <typename Visit>
  void for_each_from(double key, const Visit& visit) const {
    const std::size_t cut = bucket_of(key);
    for (const Part& part : parts_) {
      for (const Part::Step& step : part.steps_) {
        if (step.bucket >= cut) visit(step.region, step.gain, static_cast<double>(step.bytes));
      }
    }
  }

 private:
  struct Bucket {
    BoughtBytes bytes{};
    double gain = 0;
  };
  static constexpr int kDropped = 48;  // bits of a key: 16 to an octave remain

  static std::size_t bucket_of(double key);
  static double key_of(std::size_t bucket);
  // By which factor the cut of the volume may differ from the key of bucket `cut`, at which so many bytes are bought.
  double reach_at(std::size_t cut, double bytes) const;
  // Standard deviation of the bytes bought there, among samples of this many rows.
  double deviation_at(std::size_t cut) const;
  std::size_t end() const { return first_ + buckets_.size(); }
  const Bucket& bucket(std::size_t i) const { return buckets_[i - first_]; }

  float width_;
  std::size_t rows_;
  std::vector<Part> parts_;
  std::size_t first_ = 0;  // no step's bucket is lower
  std::vector<Bucket> buckets_;
};

}  // namespace weir
