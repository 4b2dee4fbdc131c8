// The files of a plotfile's FABs. There may be thousands, so only a few are open at a time.
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

/// Opens and keeps the files. Thread-safe.
class FabFiles {
 public:
  /// Serves the levels of `plotfile`, which must outlive this object.
  FabFiles(const Plotfile& plotfile, DirectIo mode);

  /// Returns the file of a FAB. The file stays open as long as the pointer is held.
  std::shared_ptr<InputFile> file_of(std::size_t level, std::uint32_t fab);

  /// Returns the offset of the FAB's values in `file`, which file_of() returned. On the first call, reads the FAB's
  /// header and compares it with Cell_H. Throws Error(input) with path and offset if they differ or the FAB reaches
  /// beyond the end of the file.
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
  /// Bytes of each FAB's header; kUnknown until it is read.
  std::vector<std::vector<std::atomic<std::uint16_t>>> header_bytes_;
  mutable std::mutex mutex_;
  std::list<OpenFile> open_;  ///< most recently used first
  std::shared_ptr<std::atomic<std::uint64_t>> closed_bytes_ = std::make_shared<std::atomic<std::uint64_t>>(0);
};

}  // namespace weir
