// Encodes the streams of packed blocks.
#pragma once

#include <memory>

#include "compressor/encode/coded_regions.h"
#include "compressor/encode/layer_encoder.h"
#include "compressor/encode/left_leaves.h"

namespace weir {

class PackedLayerEncoder : public LayerEncoder {
 public:
  /// The kept leaves of one x layer of a region that lies on a device; `left` has the values of those that are not
  /// coded. `records` gets theirs, until finish().
  virtual void add_layer(std::int64_t region, const RegionPlaces& places, const SurveyedLeaves& surveyed,
                         std::int64_t x, const CodedRegion& coded, const LeftLeaves& left, RecordSink& records) = 0;
  using LayerEncoder::add_layer;
};

/// Writes each kept block's stream as planned, with its end in the directory, and of a file with a preview the two
/// corner leaves. `target`, which has a packed one, must outlive it.
std::unique_ptr<PackedLayerEncoder> make_packed_encoder(const EncodeTarget& target);

}  // namespace weir
