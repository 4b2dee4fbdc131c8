// Encodes kept leaves as float or quantised leaves.
#pragma once

#include <memory>

#include "compressor/encode/layer_encoder.h"

namespace weir {

/// Returns an encoder that gathers kept leaves, computes their statistics in batches, and writes runs of leaves that
/// are adjacent in the file. `target` must outlive the encoder.
std::unique_ptr<LayerEncoder> make_leaf_encoder(const EncodeTarget& target);

}  // namespace weir
