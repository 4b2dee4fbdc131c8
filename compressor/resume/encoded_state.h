// How far an encode pass has come: with the volume and the records of what is done, enough to go on from there.
#pragma once

#include <cstdint>

#include "format/base/box_set.h"

namespace weir {

/// Sums of the checksums (format/io/digest.h, placed_checksum) of all leaves or streams, and of all records, that were
/// written. They do not depend on order.
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
  BoxSet done;       ///< positions of the leaf lattice whose leaves and records are written
  EncodedSums sums;  ///< of those
};

}  // namespace weir
