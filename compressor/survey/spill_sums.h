// Checksums of the records that the survey spills to disk, for a conversion that continues from what an earlier process
// left there. Each sum adds one checksum per record, which includes the record's place. The sums do not depend on the
// order of the records and take nearly no room in the journal.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "compressor/leaf/leaf_row.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/survey/leaf_faces.h"
#include "format/base/box_set.h"

namespace weir {

class RowStore;
template <typename Record>
class LeafStore;

/// When the ladder of a leaf is built anew after the survey. The leaf's row decides.
enum class LadderPart : std::uint8_t {
  kept,    ///< never: all values are the same, or none is finite
  filled,  ///< when the background is known: it replaces some values of the leaf
  whole,   ///< when the conversion needs other ladders than the survey built
};

/// Returns the part of a leaf with `voxels` in-domain voxels.
inline LadderPart ladder_part(const LeafRow& row, std::int64_t voxels) {
  if (row.finite < voxels) return row.finite > 0 ? LadderPart::filled : LadderPart::kept;
  return row.uniform() ? LadderPart::kept : LadderPart::whole;
}

struct SpillSums {
  std::uint64_t rows = 0;
  std::uint64_t faces = 0;
  std::array<std::uint64_t, 3> ladders{};  ///< by LadderPart

  void add(std::int64_t leaf, const LeafRow& row);
  void add(std::int64_t leaf, const LeafFaces& leaf_faces);
  void add(std::int64_t leaf, const PackedLadder& ladder, LadderPart part);
  void add(const SpillSums& other);
  friend bool operator==(const SpillSums&, const SpillSums&) = default;
};

/// Which ladders need not match their sums, because they are built anew.
struct RebuiltLadders {
  bool filled = false;
  bool whole = false;
};

/// Returns the first of "rows", "faces" and "ladders" with records of the leaves in `done` that do not match `summed`;
/// nullopt if all match. `faces` may be null. Reads the records once, on all threads. Throws as LeafStore::read.
std::optional<std::string_view> damaged_spill(const RowStore& rows, const LeafStore<LeafFaces>* faces,
                                              const BoxSet& done, const SpillSums& summed, RebuiltLadders rebuilt);

}  // namespace weir
