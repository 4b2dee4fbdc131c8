// Checksums of what the survey spills of a leaf, for a conversion that is continued by what an earlier process left on
// disk. Sums of one checksum a record, with its place: they do not depend on order, and take no room in the journal.
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

/// Which ladders are built anew after the survey, by their rows.
enum class LadderPart : std::uint8_t {
  kept,    ///< none: all values are the same, or none is finite
  filled,  ///< where the background takes the place of some values
  whole,   ///< where others are asked for than the survey built
};

/// Of a leaf with that many voxels in the domain.
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

/// Which ladders need not be as they were summed: they are built anew.
struct RebuiltLadders {
  bool filled = false;
  bool whole = false;
};

/// "rows", "faces" or "ladders": the first of these whose records of the leaves in `done` are not those that were
/// summed; nullopt where all are. `faces` may be null. Reads them once, on all threads. Throws as LeafStore::read.
std::optional<std::string_view> damaged_spill(const RowStore& rows, const LeafStore<LeafFaces>* faces,
                                              const BoxSet& done, const SpillSums& summed, RebuiltLadders rebuilt);

}  // namespace weir
