// Reads back what the encode pass of an earlier process has written, to check it.
#pragma once

#include "compressor/encode/layer_encoder.h"
#include "format/base/box_set.h"

namespace weir {

/// Returns the checksums of what the files of `target` hold for the leaves in `done` (positions of the leaf lattice):
/// of the leaves or streams, and of the records. Works on all threads. Throws as File::read_at.
EncodedSums sums_of_written(const EncodeTarget& target, const BoxSet& done);

/// Returns whether all bytes between the end of the file's content and the requested size are 0. Nothing writes there.
bool has_empty_padding(const EncodeTarget& target);

}  // namespace weir
