// Predicts what a budget buys of the sampled blocks of a packed volume, and how far the cut of the whole volume may lie
// from the sample's cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compressor/packed/ladder_window.h"
#include "compressor/select/leaf_gain.h"
#include "format/packed/near_rungs.h"

namespace weir {

/// Bytes of all streams, and of the streams that are near rungs or floats in order, for sparse blocks and for others.
struct BoughtBytes {
  double all = 0;
  double near_sparse = 0;
  double near_other = 0;

  void add(const BoughtBytes& bytes);
  /// Returns the kinds of blocks with near rungs that are worth the time to look at them.
  NearBlocks near() const;
};

/// What a budget buys of a sample.
struct SampledCut {
  NearBlocks near{};                  ///< the kinds of blocks with near rungs that are worth the time to look at them
  std::optional<KeyWindow> window{};  ///< in which the volume's cut lies; nullopt if all is bought
  double bytes = 0;                   ///< of all purchases
  double least_key = 0;               ///< the least key of a purchase, approximately
};

/// A sampled block.
struct SampledBlock {
  std::size_t row;     ///< row of the sample
  std::size_t region;  ///< number among the sampled regions
  bool sparse;
  bool ordered;  ///< its exact kind is ExactKind::ordered
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

  /// Takes the steps of a sample of `rows` rows of blocks with values in a range of `width`. Results do not depend on
  /// the threads as long as `parts` does not.
  SampledSteps(float width, std::size_t rows, std::vector<Part> parts);

  /// Returns the cut if purchases of `bytes` are made.
  SampledCut within_bytes(double bytes) const;
  /// Returns the cut if at most `squared_error` may be left; nullopt if nothing needs to be bought.
  std::optional<SampledCut> within_error(double squared_error) const;

  /// Calls visit(region, gain, bytes) for each step with a key of at least `key`, the key of a cut.
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
  // Returns the factor by which the volume's cut may differ from the key of bucket `cut`, at which `bytes` are bought.
  double reach_at(std::size_t cut, double bytes) const;
  // Returns the standard deviation of the bytes bought at bucket `cut`, among samples of as many rows.
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
