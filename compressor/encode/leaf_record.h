// What the encode pass records of each kept leaf for the nodes above it: its statistics in double, and the bounds of
// its outer layers, which reach into the aprons of neighbouring macrocells. Spilled by leaf ordinal.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compressor/leaf/bounds.h"
#include "compressor/team/team.h"
#include "format/base/index.h"
#include "format/io/file_system.h"
#include "format/leaf/leaf_codec.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

struct LeafRecord {
  double mean = 0;
  double m2 = 0;
  MinMax bounds = kNoBounds;  ///< of the active values, NaN left out
  /// Bounds of the layer that faces out of the leaf's macrocell: entry d - 1, bit 0 of d for the x side,
  /// bit 1 for y, bit 2 for z. A leaf of an even coordinate faces down, of an odd one up.
  std::array<MinMax, 7> outward{kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds, kNoBounds};
  // Of a quantised leaf, decoded, over the finite in-domain values.
  double squared_error = 0;
  double max_abs = 0;
  std::uint32_t exact = 1;       ///< 0: some voxel reads other bits than it should
  std::uint32_t zeros_lost = 0;  ///< zeros that read another value
};
static_assert(sizeof(LeafRecord) == 104, "records are spilled as they are");

/// Record of a leaf as it will be decoded; `inside` are its in-domain voxels.
LeafRecord make_leaf_record(const LeafValues& values, const Box& node, const Box& inside,
                            const NodeStatistics& statistics);

/// Records by leaf ordinal. Thread-safe for different leaves.
class RecordStore {
 public:
  RecordStore(std::shared_ptr<File> file, std::uint64_t leaves) : file_(std::move(file)) {
    file_->preallocate(leaves * sizeof(LeafRecord));
  }
  void write(std::uint64_t first, std::span<const LeafRecord> records) {
    file_->write_at(first * sizeof(LeafRecord), std::as_bytes(records));
  }
  std::vector<LeafRecord> read(std::uint64_t first, std::uint32_t count) const {
    std::vector<LeafRecord> records(count);
    file_->read_at(first * sizeof(LeafRecord), std::as_writable_bytes(std::span(records)));
    return records;
  }
  /// After each rank has written those of its leaves.
  void publish(Team& team) { team.publish(*file_); }

 private:
  std::shared_ptr<File> file_;
};

}  // namespace weir
