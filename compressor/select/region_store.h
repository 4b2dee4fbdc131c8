// A file with one record per region.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "compressor/team/team.h"
#include "format/io/file_system.h"

namespace weir {

/// Records by region index. Thread-safe for different regions.
template <class Record>
class RegionStore {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  RegionStore(std::unique_ptr<File> file, std::int64_t regions) : file_(std::move(file)) {
    file_->preallocate(static_cast<std::uint64_t>(regions) * sizeof(Record));
  }
  void write(std::int64_t region, const Record& record) {
    file_->write_at(at(region), std::as_bytes(std::span(&record, 1)));
  }
  Record read(std::int64_t region) const {
    Record record;
    read_into(region, record);
    return record;
  }
  /// Returns a region's record on the heap, for records too large for the stack.
  std::unique_ptr<Record> read_allocated(std::int64_t region) const {
    auto record = std::make_unique<Record>();
    read_into(region, *record);
    return record;
  }
  /// Shares the file among the ranks. Call it after each rank has written the records of its regions.
  void publish(Team& team) { team.publish(*file_); }

 private:
  static std::uint64_t at(std::int64_t region) { return static_cast<std::uint64_t>(region) * sizeof(Record); }
  void read_into(std::int64_t region, Record& record) const {
    file_->read_at(at(region), std::as_writable_bytes(std::span(&record, 1)));
  }

  std::unique_ptr<File> file_;
};

}  // namespace weir
