#include "compressor/survey/spill_sums.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <vector>

#include "compressor/survey/row_store.h"
#include "format/io/digest.h"

namespace weir {
namespace {

template <typename Record>
std::uint64_t sum_of(std::int64_t leaf, const Record& record) {
  return placed_checksum(static_cast<std::uint64_t>(leaf), std::as_bytes(std::span(&record, 1)));
}

// The buffers and the sums of one thread.
struct SpillBuffers {
  std::vector<LeafRow> rows;
  std::vector<LeafFaces> faces;
  std::vector<PackedLadder> ladders;
  SpillSums sums;
};

void add_box(const RowStore& rows, const LeafStore<LeafFaces>* faces, const Box& box, SpillBuffers& to) {
  rows.read_box(box, to.rows);
  if (faces != nullptr) faces->read_box(box, to.faces);
  if (rows.ladders() != nullptr) rows.ladders()->read_box(box, to.ladders);
  const NodeLattice& lattice = rows.leaves();
  for (std::size_t i = 0; i < to.rows.size(); ++i) {
    const Index3 at = box.lo + index_at(static_cast<std::int64_t>(i), box.extent());
    const std::int64_t leaf = lattice.linear(at);
    to.sums.add(leaf, to.rows[i]);
    if (faces != nullptr) to.sums.add(leaf, to.faces[i]);
    if (rows.ladders() == nullptr) continue;
    to.sums.add(leaf, to.ladders[i], ladder_part(to.rows[i], lattice.voxels(at).voxels()));
  }
}

}  // namespace

void SpillSums::add(std::int64_t leaf, const LeafRow& row) { rows += sum_of(leaf, row); }

void SpillSums::add(std::int64_t leaf, const LeafFaces& leaf_faces) { faces += sum_of(leaf, leaf_faces); }

void SpillSums::add(std::int64_t leaf, const PackedLadder& ladder, LadderPart part) {
  ladders.at(static_cast<std::size_t>(part)) += sum_of(leaf, ladder);
}

void SpillSums::add(const SpillSums& other) {
  rows += other.rows;
  faces += other.faces;
  for (std::size_t i = 0; i < ladders.size(); ++i) ladders.at(i) += other.ladders.at(i);
}

std::optional<std::string_view> damaged_spill(const RowStore& rows, const LeafStore<LeafFaces>* faces,
                                              const BoxSet& done, const SpillSums& summed, RebuiltLadders rebuilt) {
  constexpr std::int64_t kMostLeaves = 1024;  // read together; 400 KiB per thread
  tbb::enumerable_thread_specific<SpillBuffers> buffers;
  for (const Box& box : done.boxes()) {
    const Index3 extent = box.extent();
    const std::int64_t x_most = std::min(extent.x, kMostLeaves);
    const std::int64_t y_most = std::clamp<std::int64_t>(kMostLeaves / x_most, 1, extent.y);
    const Index3 parts{ceil_div(extent.x, x_most), ceil_div(extent.y, y_most), extent.z};
    tbb::parallel_for(std::int64_t{0}, volume(parts), [&](std::int64_t i) {
      const Index3 part = index_at(i, parts);
      const Index3 lo = box.lo + Index3{part.x * x_most, part.y * y_most, part.z};
      add_box(rows, faces, {lo, min(lo + Index3{x_most, y_most, 1}, box.hi)}, buffers.local());
    });
  }
  SpillSums found;
  for (const SpillBuffers& some : buffers) found.add(some.sums);
  if (found.rows != summed.rows) return "rows";
  if (faces != nullptr && found.faces != summed.faces) return "faces";
  if (rows.ladders() == nullptr) return std::nullopt;
  const auto differs = [&](LadderPart part) {
    const auto at = static_cast<std::size_t>(part);
    return found.ladders.at(at) != summed.ladders.at(at);
  };
  const bool damaged = differs(LadderPart::kept) || (differs(LadderPart::filled) && !rebuilt.filled) ||
                       (differs(LadderPart::whole) && !rebuilt.whole);
  return damaged ? std::optional<std::string_view>("ladders") : std::nullopt;
}

}  // namespace weir
