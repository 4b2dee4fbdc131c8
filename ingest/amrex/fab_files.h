// The files of a plotfile's FABs, a few of them open at a time: there may be thousands.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "ingest/amrex/plotfile.h"
#include "ingest/files/input_file.h"

namespace weir {

/// Thread-safe.
class FabFiles {
 public:
  /// Of the levels of `plotfile`, which outlives the object.
  FabFiles(const Plotfile& plotfile, DirectIo mode);

  /// The file of a FAB, which stays open as long as it is held.
  std::shared_ptr<InputFile> file_of(std::size_t level, std::uint32_t fab);

  /// Bytes from the beginning of `file`, which file_of gave, to the FAB's values. Reads the FAB's header, once, and
  /// compares it with Cell_H. Throws Error(input) with path and offset where they differ or the FAB reaches beyond the
  /// end.
  std::uint64_t values_offset(std::size_t level, std::uint32_t fab, InputFile& file);

  std::uint64_t bytes_read() const;

 private:
  static constexpr std::size_t kOpenFiles = 32;

  struct OpenFile {
    std::size_t level;
    std::uint32_t file;
    std::shared_ptr<InputFile> input;
  };

  std::uint16_t checked_header(std::size_t level, std::uint32_t fab, InputFile& file) const;

  const Plotfile& plotfile_;
  DirectIo mode_;
  /// Bytes of each FAB's header, kUnknown before it was read.
  std::vector<std::vector<std::atomic<std::uint16_t>>> header_bytes_;
  mutable std::mutex mutex_;
  std::list<OpenFile> open_;  ///< the last one used first
  std::shared_ptr<std::atomic<std::uint64_t>> closed_bytes_ = std::make_shared<std::atomic<std::uint64_t>>(0);
};

}  // namespace weir
