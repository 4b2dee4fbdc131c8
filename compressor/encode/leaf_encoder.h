// Encodes kept leaves, float or quantised.
#pragma once

#include <memory>

#include "compressor/encode/layer_encoder.h"

namespace weir {

/// Gathers kept leaves, computes their statistics a batch at a time, and writes runs of leaves that follow each other
/// in the file. `target` must outlive it.
std::unique_ptr<LayerEncoder> make_leaf_encoder(const EncodeTarget& target);

}  // namespace weir
