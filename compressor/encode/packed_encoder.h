// Encodes the streams of packed blocks.
#pragma once

#include <memory>

#include "compressor/encode/layer_encoder.h"

namespace weir {

/// Writes each kept block's stream as planned, with its end in the directory, and of a file with a preview the two
/// corner leaves. `target`, which has a packed one, must outlive it.
std::unique_ptr<LayerEncoder> make_packed_encoder(const EncodeTarget& target);

}  // namespace weir
