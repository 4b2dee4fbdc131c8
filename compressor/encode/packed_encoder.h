// Encodes the streams of packed blocks.
#pragma once

#include <memory>

#include "compressor/encode/coded_regions.h"
#include "compressor/encode/layer_encoder.h"
#include "compressor/encode/left_leaves.h"

namespace weir {

class PackedLayerEncoder : public LayerEncoder {
 public:
  /// Adds the kept leaves of one x layer of a region that lies on a device. `left` holds the values of the leaves that
  /// are not coded. `records` receives the records of the leaves, until finish().
  virtual void add_layer(std::int64_t region, const RegionPlaces& places, const SurveyedLeaves& surveyed,
                         std::int64_t x, const CodedRegion& coded, const LeftLeaves& left, RecordSink& records) = 0;
  using LayerEncoder::add_layer;
};

/// Returns an encoder that writes the stream of each kept block as planned and its end in the directory. In a file with
/// a preview it also writes the two corner leaves. `target` must have a packed target and must outlive the encoder.
std::unique_ptr<PackedLayerEncoder> make_packed_encoder(const EncodeTarget& target);

}  // namespace weir
