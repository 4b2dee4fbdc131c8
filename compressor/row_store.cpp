#include "compressor/row_store.h"

namespace weir {

RowStore::RowStore(std::unique_ptr<File> file, const NodeLattice& leaves, std::int64_t segment_regions)
    : file_(std::move(file)), leaves_(leaves), segment_regions_(segment_regions) {
  file_->preallocate(static_cast<std::uint64_t>(leaves.size()) * sizeof(LeafRow));
}

void RowStore::write(std::int64_t first, std::span<const LeafRow> rows) {
  file_->write_at(static_cast<std::uint64_t>(first) * sizeof(LeafRow), std::as_bytes(rows));
}

void RowStore::read(std::int64_t first, std::span<LeafRow> rows) const {
  file_->read_at(static_cast<std::uint64_t>(first) * sizeof(LeafRow), std::as_writable_bytes(rows));
}

void RowStore::read_box(const Box& box, std::vector<LeafRow>& rows) const {
  const Index3 extent = box.extent();
  rows.resize(static_cast<std::size_t>(volume(extent)));
  // Runs of whole x rows, or of whole planes, are consecutive in the file.
  const bool whole_rows = extent.x == leaves_.count.x;
  const std::int64_t run_rows = whole_rows ? extent.y : 1;
  const auto run = static_cast<std::size_t>(extent.x * run_rows);
  std::size_t at = 0;
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; y += run_rows) {
      read(leaves_.linear({box.lo.x, y, z}), std::span(rows).subspan(at, run));
      at += run;
    }
  }
}

}  // namespace weir
