// The operating-system calls of a conversion's output, behind an interface that a test can make fail. Every call throws
// Error(io) that names path and action.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "format/base/message.h"

namespace weir {

/// An open file. Several threads may make positioned calls at once. Closes on destruction.
class File {
 public:
  virtual ~File() = default;
  virtual const std::string& path() const = 0;
  virtual void write_at(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  /// Fills `bytes` entirely; throws if the file has fewer bytes.
  virtual void read_at(std::uint64_t offset, std::span<std::byte> bytes) = 0;
  /// Sets the size and reserves the blocks. Returns false if the file system cannot reserve: the size is set all the
  /// same, and a full disk shows later. Throws if the disk is full.
  virtual bool preallocate(std::uint64_t bytes) = 0;
  /// Sets the size to 0, which gives back all that was written and reserved.
  virtual void clear() = 0;
  /// Asks the system to begin writing its cached data to the device, so that sync() has less to wait for. A hint:
  /// reports no error.
  virtual void start_writeback() = 0;
  virtual void sync() = 0;
  virtual std::uint64_t size() = 0;
  /// Returns the system's descriptor, valid while this file is open; -1 if there is none.
  virtual int descriptor() const { return -1; }
  /// Returns the file's bytes if they lie in this process's memory, valid until the file is written to; otherwise
  /// empty.
  virtual std::span<const std::byte> memory() const { return {}; }
  /// Returns whether no other process writes the file through a FileSystem: it is locked, or did not exist before it
  /// was opened. False for a file that existed before, on a file system without locks.
  virtual bool exclusive() const { return true; }
  /// Returns whether the file's path still leads to it: nobody has removed or replaced it since. True if the system
  /// cannot tell.
  virtual bool has_its_name() const { return true; }
};

/// Paths are as the user wrote them. Thread-safe.
class FileSystem {
 public:
  virtual ~FileSystem() = default;
  /// Creates or truncates `path` for reading and writing and takes an exclusive lock on it. Throws Error(io) "is being
  /// written by another process or conversion" if another process, or another File of this process, holds the lock.
  /// Throws Error(usage) if something at `path` is not a regular file with this one name, for instance a symbolic link:
  /// weir did not write that.
  virtual std::unique_ptr<File> create(const std::string& path) = 0;
  /// Like create(), but keeps the file's content; the file may have further names.
  virtual std::unique_ptr<File> open(const std::string& path) = 0;
  /// Opens an existing file to read, without a lock, even if others have it open; follows symbolic links. Throws
  /// Error(io) with ENOENT if it is missing. By default: open(), if the file exists.
  virtual std::unique_ptr<File> open_to_read(const std::string& path);
  /// Creates a file without a name in `directory`: nothing of it outlives the process.
  virtual std::unique_ptr<File> create_unnamed(const std::string& directory) = 0;
  virtual void rename(const std::string& from, const std::string& to) = 0;
  /// Like rename(), but throws if `to` exists.
  virtual void rename_new(const std::string& from, const std::string& to) = 0;
  /// Gives the file `from` a second name; returns false if the file system has no such links.
  [[nodiscard]] virtual bool link(const std::string& from, const std::string& to) = 0;
  virtual void remove(const std::string& path) = 0;            ///< no error if the file is missing
  virtual void make_directory(const std::string& path) = 0;    ///< no error if the directory exists
  virtual void remove_directory(const std::string& path) = 0;  ///< the directory is empty or missing
  virtual void sync_directory(const std::string& path) = 0;
  virtual bool exists(const std::string& path) = 0;
  /// Returns whether a rename to `path` replaces at most a regular file: `path` is missing or leads, through symbolic
  /// links, to a regular file. A rename replaces a symbolic link itself; the file that the link leads to stays.
  virtual bool is_replaceable(const std::string&) { return true; }
  virtual bool is_memory(const std::string& directory) = 0;  ///< returns whether it is tmpfs or ramfs
  virtual std::uint64_t free_bytes(const std::string& directory) = 0;
};

struct PosixFileSystemOptions {
  Notice notice;                                         ///< gets one line, once, if files cannot be locked
  int (*lock)(int descriptor, int operation) = nullptr;  ///< instead of flock, for tests
};

/// Returns the file system of the operating system.
std::unique_ptr<FileSystem> make_posix_file_system(PosixFileSystemOptions options = {});

}  // namespace weir
