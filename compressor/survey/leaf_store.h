// One fixed-size record per leaf of a lattice, in a file in linear order (x fastest), so that 10^12 voxels take disk
// space and not memory. The file itself lies in memory if there is room for it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "format/base/index.h"
#include "format/io/file_system.h"

namespace weir {

/// Thread-safe, because it only uses positioned reads and writes.
template <typename Record>
class LeafStore {
  static_assert(std::is_trivially_copyable_v<Record>, "records are spilled as they are");

 public:
  /// Reserves space in `file` for the records of `leaves`. A full disk fails here and not later.
  LeafStore(std::shared_ptr<File> file, const NodeLattice& leaves) : file_(std::move(file)), leaves_(leaves) {
    file_->preallocate(static_cast<std::uint64_t>(leaves.size()) * sizeof(Record));
    if (!file_->memory().empty()) held_ = reinterpret_cast<const Record*>(file_->memory().data());
  }

  const NodeLattice& leaves() const { return leaves_; }
  File& file() { return *file_; }
  /// Returns all records in linear order if the file lies in memory, otherwise null.
  const Record* held() const { return held_; }

  /// Writes the records of consecutive leaves, from linear index `first` on. read() reads them.
  void write(std::int64_t first, std::span<const Record> records) {
    file_->write_at(static_cast<std::uint64_t>(first) * sizeof(Record), std::as_bytes(records));
  }
  void read(std::int64_t first, std::span<Record> records) const {
    file_->read_at(static_cast<std::uint64_t>(first) * sizeof(Record), std::as_writable_bytes(records));
  }

  /// Writes the records of the leaves in `box` (lattice positions), x fastest. read_box() reads them.
  void write_box(const Box& box, std::span<const Record> records) {
    for_each_run(box,
                 [&](std::int64_t first, std::size_t at, std::size_t run) { write(first, records.subspan(at, run)); });
  }
  void read_box(const Box& box, std::vector<Record>& records) const {
    records.resize(static_cast<std::size_t>(box.voxels()));
    for_each_run(box, [&](std::int64_t first, std::size_t at, std::size_t run) {
      read(first, std::span(records).subspan(at, run));
    });
  }

 private:
  // Calls visit(first, at, run) for each run of records that is consecutive in the file: an x row of `box`, or all rows
  // of a plane if they span the lattice along x.
  template <typename Visit>
  void for_each_run(const Box& box, const Visit& visit) const {
    const Index3 extent = box.extent();
    const std::int64_t run_rows = extent.x == leaves_.count.x ? extent.y : 1;
    const auto run = static_cast<std::size_t>(extent.x * run_rows);
    std::size_t at = 0;
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; y += run_rows) {
        visit(leaves_.linear({box.lo.x, y, z}), at, run);
        at += run;
      }
    }
  }

  std::shared_ptr<File> file_;
  NodeLattice leaves_;
  const Record* held_ = nullptr;  // stays valid: the file does not grow any more
};

}  // namespace weir
