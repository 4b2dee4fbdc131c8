// What the encode pass of an earlier process has written, read back.
#pragma once

#include "compressor/encode/layer_encoder.h"
#include "format/base/box_set.h"

namespace weir {

/// Checksums of the leaves or streams, and of the records, that `target` has of the leaves in `done` (positions of the
/// leaf lattice); on all threads. Throws as File::read_at.
EncodedSums sums_of_written(const EncodeTarget& target, const BoxSet& done);

/// Whether the bytes behind all that a file holds, up to the size that was asked for, are 0: nobody writes them.
bool has_empty_padding(const EncodeTarget& target);

}  // namespace weir
