// How the encode pass makes the records of kept leaves (format/leaf/leaf_record.h), and the store that spills them to
// disk by leaf ordinal.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compressor/team/team.h"
#include "format/base/index.h"
#include "format/io/digest.h"
#include "format/io/file_system.h"
#include "format/leaf/leaf_codec.h"
#include "format/leaf/leaf_record.h"

namespace weir {

/// Returns the record of a leaf with the decoded values `values`. `inside` are the leaf's in-domain voxels.
LeafRecord make_leaf_record(const LeafValues& values, const Box& node, const Box& inside,
                            const NodeStatistics& statistics);

/// Sets the active voxels of `record`, which was made from all in-domain voxels. `mask` are the active voxels, and
/// `statistics` are theirs.
void set_active(LeafRecord& record, const LeafMask& mask, const Box& node, const Box& inside,
                const NodeStatistics& statistics);

/// Returns the statistics of the active voxels of the leaf at `node` with the in-domain voxels `inside`.
NodeStatistics active_statistics(const LeafRecord& record, const Box& node, const Box& inside);

/// Returns the checksum of a record that includes its ordinal.
inline std::uint64_t record_checksum(std::uint64_t ordinal, const LeafRecord& record) {
  return placed_checksum(ordinal, std::as_bytes(std::span(&record, 1)));
}

/// Takes records by leaf ordinal. Thread-safe for different leaves.
class RecordSink {
 public:
  RecordSink() = default;
  virtual ~RecordSink() = default;
  RecordSink(const RecordSink&) = delete;
  RecordSink& operator=(const RecordSink&) = delete;

  virtual void write(std::uint64_t first, std::span<const LeafRecord> records) = 0;
};

/// Keeps all records in a file.
class RecordStore final : public RecordSink {
 public:
  RecordStore(std::shared_ptr<File> file, std::uint64_t leaves) : file_(std::move(file)) {
    file_->preallocate(leaves * sizeof(LeafRecord));
  }
  void write(std::uint64_t first, std::span<const LeafRecord> records) override {
    file_->write_at(first * sizeof(LeafRecord), std::as_bytes(records));
  }
  std::vector<LeafRecord> read(std::uint64_t first, std::uint32_t count) const {
    std::vector<LeafRecord> records(count);
    file_->read_at(first * sizeof(LeafRecord), std::as_writable_bytes(std::span(records)));
    return records;
  }
  /// Returns the same records as read(). All records must be written. The span points into the file's memory if the
  /// file lies in memory, otherwise into `room`.
  std::span<const LeafRecord> view(std::uint64_t first, std::uint32_t count, std::vector<LeafRecord>& room) const {
    const std::span<const std::byte> memory = file_->memory();
    if (!memory.empty()) return {reinterpret_cast<const LeafRecord*>(memory.data()) + first, count};
    room = read(first, count);
    return room;
  }
  /// Call it after each rank has written the records of its leaves.
  void publish(Team& team) { team.publish(*file_); }

 private:
  std::shared_ptr<File> file_;
};

}  // namespace weir
