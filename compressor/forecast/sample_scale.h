// Between a volume and its sample: what a budget is for the sample, and what its file stands for.
#pragma once

#include <cstdint>

#include "compressor/conversion_options.h"
#include "compressor/select/budget.h"
#include "format/base/index.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Lower nodes that a file of a volume has, and one of its sample.
struct SampledNodes {
  std::uint64_t of_volume = 0;
  std::uint64_t of_sample = 0;
};

/// A file is what is fixed (fixed_bytes.h) and what is bought for its leaves; the second is in proportion to their
/// number.
class SampleScale {
 public:
  SampleScale(const Box& volume, const Box& sample, const ConversionOptions& options, const SampledNodes& nodes);

  /// Part of the volume's leaves, and of its voxels.
  double share() const { return share_; }
  /// What the options ask for, of the sample. A rate becomes a size.
  Budget budget() const;
  /// Of the volume, from the file made of the sample.
  double file_bytes(const Sidecar& of_sample) const;

 private:
  double fixed_of_volume(Encoding encoding, Preview preview, std::uint64_t asked) const;
  double fixed_of_sample(Encoding encoding, Preview preview, std::uint64_t asked) const;

  Box volume_;
  Box sample_;
  const ConversionOptions& options_;
  SampledNodes nodes_;
  double share_;
};

}  // namespace weir
