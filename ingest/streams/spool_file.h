// A spool file that compressed streams, which cannot seek, are unpacked to: a file without a name on a disk, of
// exactly the expected bytes. A crash leaves nothing behind.
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

/// A file that is written once from its beginning to its end, then read as any input file. Not thread-safe. Has no
/// buffer: every write goes to the file, so callers should write many bytes at a time.
class SpoolFile {
 public:
  /// Reserves `bytes` > 0 bytes for what is unpacked from the file at `packed_path`. The spool file lies in
  /// options.spool_directory or, if that is empty, in the packed file's directory. It lies in /var/tmp if the
  /// directory is on a memory file system, or if none was given and the packed file's directory is not writable.
  /// Throws Error(io) if there is no room or no such directory.
  SpoolFile(FileSystem& files, const SourceOptions& options, std::string packed_path, std::uint64_t bytes);

  /// Throws Error(interrupted) if options.cancel is set. write() checks this, too.
  void check_cancel() const;

  /// Appends `bytes`. Throws Error(input) if the file would exceed the expected bytes, Error(io) if the device fails.
  void write(std::span<const std::byte> bytes);

  /// Returns the file for reading by options.direct_io; it outlives this object. Its path() is that of the packed
  /// file, marked as unpacked. Throws Error(input) if bytes are missing.
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
