// The two files of a conversion, OUT.nvdb and OUT.nvdb.json, from their first
// byte to their names: a reader never sees half of one, a crash loses nothing
// that was there before, and a failure leaves the directory as it was.
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
  /// Checks the place and takes the lock on OUT.nvdb.partial. Throws Error(io) where the directory is
  /// missing or not writable or another process writes the output, Error(usage) where it exists and `overwrite` is
  /// false, where its name is too long for the names beside it, or where something else than a regular file would be
  /// replaced, Error(io) where what a killed commit left cannot be read, and so not be told from the output's own. A
  /// sidecar that a killed commit left without its volume is no output, and is removed; one that it put
  /// beside the previous volume is replaced by that volume's own.
  OutputFiles(FileSystem& files, const std::string& path, bool overwrite);
  /// Removes what was not committed; nothing where OUT.nvdb.partial is another file by now, or in a process that was
  /// forked since: the output is its parent's.
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Directory of the output, "." where the path has none.
  const std::string& directory() const { return directory_; }

  /// Takes the volume's bytes from `file`, on the same file system, and not from OUT.nvdb.partial, which stays the lock
  /// until this object ends. A failure leaves `file`, which its owner must remove.
  void write_to(std::shared_ptr<File> file);

  /// Whether pages of a memory file system are cleared once they are reserved, for who will write by a mapping.
  enum class Pages { as_they_are, cleared };
  /// Begins to reserve blocks of the volume, nothing of which is written yet, beside what its caller goes on with:
  /// in a memory file system that takes as long as writing them. What goes wrong is left to reserve().
  void reserve_ahead(std::uint64_t bytes, Pages pages = Pages::as_they_are);
  /// Makes the volume empty, so that it can be reserve()d and written. `bytes` is what it will be.
  void clear_for(std::uint64_t bytes);
  /// Sets the volume's size and reserves its blocks, unless they are; false where the file system cannot reserve.
  bool reserve(std::uint64_t bytes) { return reserved_ == bytes || volume().preallocate(bytes); }
  File& volume() { return volume_ ? *volume_ : *partial_; }
  /// Whether the volume lies in a memory file system.
  bool in_memory() const { return files_.is_memory(directory_); }

  /// The protocol's end, see the numbered steps in the source. After it returned, both files are
  /// durable under their names. Where committed() it has failed to make them durable alone. Throws Error(io), besides,
  /// where OUT.nvdb.partial, or the file of write_to, was removed or replaced while it was written.
  void commit(const std::string& sidecar_text);
  /// Whether both files have their names.
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
  std::shared_ptr<File> volume_;            // where not partial_
  std::atomic<bool> enough_ahead_ = false;  // no further pages are to be cleared
  std::future<bool> ahead_;                 // whether ahead_bytes_ of the volume are reserved, and nothing is written
  std::uint64_t ahead_bytes_ = 0;
  std::optional<std::uint64_t> reserved_;  // of the volume that clear_for() has left as it was
};

}  // namespace weir
