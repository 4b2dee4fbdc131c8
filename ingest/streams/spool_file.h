// Where compressed streams, which cannot seek, are unpacked to: a file without a
// name on a disk, of exactly the bytes expected. A crash leaves nothing behind.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "format/io/file_system.h"
#include "ingest/files/input_file.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Written once from its beginning to its end, then read as any input file. Not thread-safe. Holds no
/// buffer: every write goes to the file, so hand over many bytes at a time.
class SpoolFile {
 public:
  /// For `bytes` > 0 bytes unpacked from the file at `packed_path`, in options.spool_directory or, where
  /// that is empty, that file's directory; where this is a memory file system, or empty and not writable,
  /// in /var/tmp. Reserves the bytes. Throws Error(io) where there is no room or no such directory.
  SpoolFile(FileSystem& files, const SourceOptions& options, std::string packed_path, std::uint64_t bytes);

  /// Throws Error(interrupted) where options.cancel is set; write looks, too.
  void check_cancel() const;

  /// Appends. Throws Error(input) where that makes more bytes than expected, Error(io) where the device
  /// fails.
  void write(std::span<const std::byte> bytes);

  /// The file for reading by options.direct_io, its path() that of the packed file, said to be unpacked.
  /// It outlives this object. Throws Error(input) where bytes are missing.
  std::unique_ptr<InputFile> finish();

 private:
  std::string packed_path_;
  std::uint64_t bytes_;
  DirectIo direct_io_;
  const std::atomic<bool>* cancel_;
  std::unique_ptr<File> file_;
  std::uint64_t written_ = 0;
};

}  // namespace weir
