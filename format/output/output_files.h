// The two files of a conversion, OUT.nvdb and OUT.nvdb.json, from their first byte until they have their names. A
// reader never sees half of a file, a crash loses nothing that was there before, and a failure leaves the directory as
// it was.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "format/io/file_system.h"

namespace weir {

class OutputFiles {
 public:
  /// Checks the place and takes the lock on OUT.nvdb.partial.
  /// Throws Error(io) if the directory is missing or not writable, if another process writes the output, or if what a
  /// killed commit left cannot be read and so not be told from the output's own files.
  /// Throws Error(usage) if the output exists and `overwrite` is false, if its name is too long for the names beside
  /// it, or if something that is not a regular file would be replaced.
  /// A sidecar that a killed commit left without its volume is no output, and is removed. A sidecar that a killed
  /// commit put beside the previous volume is replaced by that volume's own.
  OutputFiles(FileSystem& files, const std::string& path, bool overwrite);
  /// Removes what was not committed. Removes nothing if OUT.nvdb.partial is another file by now, or in a process that
  /// was forked since, because the output belongs to the parent.
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Returns the directory of the output, "." if the path has none.
  const std::string& directory() const { return directory_; }

  /// Takes the volume's bytes from `file`, on the same file system, instead of OUT.nvdb.partial, which stays the lock
  /// until this object ends. After a failure `file` remains, and its owner must remove it.
  void write_to(std::shared_ptr<File> file);

  /// Whether the pages of a memory file system are cleared once they are reserved, for a caller that writes through a
  /// mapping.
  enum class Pages { as_they_are, cleared };
  /// Begins to reserve blocks of the volume on another thread, before anything is written: in a memory file system that
  /// takes as long as writing. reserve() handles errors.
  void reserve_ahead(std::uint64_t bytes, Pages pages = Pages::as_they_are);
  /// Empties the volume, so that it can be reserved and written. `bytes` is its future size.
  void clear_for(std::uint64_t bytes);
  /// Sets the volume's size and reserves its blocks, unless they are reserved; false if the file system cannot reserve.
  bool reserve(std::uint64_t bytes) { return reserved_ == bytes || volume().preallocate(bytes); }
  File& volume() { return volume_ ? *volume_ : *partial_; }
  /// Returns whether the volume lies in a memory file system.
  bool in_memory() const { return files_.is_memory(directory_); }

  /// Ends the protocol; see the numbered steps in the source. When it returns, both files are durable under their
  /// names. If it throws and committed() is true, only making them durable has failed. Also throws Error(io) if
  /// OUT.nvdb.partial, or the file of write_to(), was removed or replaced while it was written.
  void commit(const std::string& sidecar_text);
  /// Returns whether both files have their names.
  bool committed() const { return committed_; }

 private:
  void require_names() const;
  bool holds_lock() const noexcept;
  void undo_killed_commit(bool left_over);
  void restore_previous(bool left_over);
  void keep_previous(const std::string& previous);
  void remove_quietly(const std::string& path) noexcept;

  FileSystem& files_;
  pid_t owner_;
  std::string path_;
  std::string sidecar_;
  std::string directory_;
  bool overwrite_;
  bool committed_ = false;
  std::unique_ptr<File> partial_;
  std::shared_ptr<File> volume_;            // the file of write_to(); null: the volume is partial_
  std::atomic<bool> enough_ahead_ = false;  // tells reserve_ahead() to clear no further pages
  std::future<bool> ahead_;                 // whether ahead_bytes_ of the volume are reserved; nothing is written yet
  std::uint64_t ahead_bytes_ = 0;
  std::optional<std::uint64_t> reserved_;  // bytes reserved, if clear_for() has kept the reservation
};

}  // namespace weir
