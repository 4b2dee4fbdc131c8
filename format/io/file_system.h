// The operating-system calls of a conversion's output, behind an interface that
// a test can make fail. Every call throws Error(io) naming path and action.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "format/base/message.h"

namespace weir {

/// An open file. Positioned calls may be made from several threads at once. Closes on destruction.
class File {
 public:
  virtual ~File() = default;
  virtual const std::string& path() const = 0;
  virtual void write_at(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  /// Fills `bytes` entirely; fewer bytes in the file are an error.
  virtual void read_at(std::uint64_t offset, std::span<std::byte> bytes) = 0;
  /// Sets the size and reserves the blocks. Returns false where the file system cannot reserve (the
  /// size is set all the same, and a full disk shows later); a full disk throws.
  virtual bool preallocate(std::uint64_t bytes) = 0;
  /// Gives back all that was written and reserved: size 0.
  virtual void clear() = 0;
  /// Asks the system to begin writing what it holds to the device, so that sync has less to wait for; a
  /// hint, no error.
  virtual void start_writeback() = 0;
  virtual void sync() = 0;
  virtual std::uint64_t size() = 0;
  /// The system's descriptor, valid while this file is open; -1 where there is none.
  virtual int descriptor() const { return -1; }
  /// Its bytes where they lie in this process's memory, valid until it is written to; empty where they lie elsewhere.
  virtual std::span<const std::byte> memory() const { return {}; }
  /// Whether no other process writes it through a FileSystem: it is locked, or did not exist before. False for a file
  /// that existed before, on a file system without locks.
  virtual bool exclusive() const { return true; }
  /// Whether its path still leads to it: nobody has removed or replaced it since. True where that cannot be told.
  virtual bool has_its_name() const { return true; }
};

/// All paths are as the user wrote them. Thread-safe.
class FileSystem {
 public:
  virtual ~FileSystem() = default;
  /// Creates or truncates `path` for reading and writing and takes an exclusive lock on it; a lock
  /// held by another process, or by another File of this one, is Error(io) "is being written by another process or
  /// conversion". Anything there but a regular file with this one name, a symbolic link for instance, is not weir's:
  /// Error(usage).
  virtual std::unique_ptr<File> create(const std::string& path) = 0;
  /// The same, but what the file holds stays, and it may have further names.
  virtual std::unique_ptr<File> open(const std::string& path) = 0;
  /// An existing file to read, without a lock and whoever else has it open; symbolic links are followed. A missing one
  /// is Error(io) of ENOENT. By default open(), of what exists.
  virtual std::unique_ptr<File> open_to_read(const std::string& path);
  /// A file in `directory` without a name: nothing of it outlives the process.
  virtual std::unique_ptr<File> create_unnamed(const std::string& directory) = 0;
  virtual void rename(const std::string& from, const std::string& to) = 0;
  /// Like rename, but an existing `to` is an error.
  virtual void rename_new(const std::string& from, const std::string& to) = 0;
  /// Gives the file `from` a second name; false where the file system has no such links.
  [[nodiscard]] virtual bool link(const std::string& from, const std::string& to) = 0;
  virtual void remove(const std::string& path) = 0;            ///< a missing file is no error
  virtual void make_directory(const std::string& path) = 0;    ///< an existing one is no error
  virtual void remove_directory(const std::string& path) = 0;  ///< empty or missing
  virtual void sync_directory(const std::string& path) = 0;
  virtual bool exists(const std::string& path) = 0;
  /// Whether a rename to `path` would replace nothing but a regular file: `path` is missing or is one, symbolic links
  /// followed. It replaces a link itself: what that leads to stays.
  virtual bool is_replaceable(const std::string&) { return true; }
  virtual bool is_memory(const std::string& directory) = 0;  ///< tmpfs or ramfs
  virtual std::uint64_t free_bytes(const std::string& directory) = 0;
};

struct PosixFileSystemOptions {
  Notice notice;                                         ///< gets one line, once, where files cannot be locked
  int (*lock)(int descriptor, int operation) = nullptr;  ///< instead of flock, for tests
};

/// The real one.
std::unique_ptr<FileSystem> make_posix_file_system(PosixFileSystemOptions options = {});

}  // namespace weir
