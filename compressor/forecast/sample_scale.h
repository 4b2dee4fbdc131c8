// Scales the budget of a volume to its sample, and the size of the sample's file to the volume.
#pragma once

#include <cstdint>

#include "compressor/conversion_options.h"
#include "compressor/select/budget.h"
#include "format/base/index.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// The number of lower nodes in a file of the volume, and in a file of its sample.
struct SampledNodes {
  std::uint64_t of_volume = 0;
  std::uint64_t of_sample = 0;
};

/// A file has fixed bytes (fixed_bytes.h) and bytes bought for its leaves. The bought bytes are in proportion to the
/// number of leaves.
class SampleScale {
 public:
  SampleScale(const Box& volume, const Box& sample, const ConversionOptions& options, const SampledNodes& nodes);

  /// Returns the sample's share of the volume's leaves, which also serves as its share of the voxels.
  double share() const { return share_; }
  /// Returns the budget of the options for the sample. A rate becomes a size.
  Budget budget() const;
  /// Returns the expected bytes of the volume's file, given the sidecar of the sample's file.
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
