// The progress of an encode pass. Together with the written part of the volume and its records, the state suffices to
// continue the pass.
#pragma once

#include <cstdint>

#include "format/base/box_set.h"

namespace weir {

/// Sums of the checksums (format/io/digest.h, placed_checksum) of all written leaves or streams, and of all written
/// records. The sums do not depend on the order.
struct EncodedSums {
  std::uint64_t volume = 0;
  std::uint64_t records = 0;

  void add(const EncodedSums& other) {
    volume += other.volume;
    records += other.records;
  }
  friend bool operator==(const EncodedSums&, const EncodedSums&) = default;
};

struct EncodedState {
  BoxSet done;       ///< positions of the leaf lattice with written leaves and records
  EncodedSums sums;  ///< checksums of the leaves in `done`
};

}  // namespace weir
