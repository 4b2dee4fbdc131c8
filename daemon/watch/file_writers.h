// Finds out whether a program has a file open for writing, or maps it writable. If so, the file may still change,
// whatever its size and times say.
#pragma once

#include <string>

#include "format/io/descriptor.h"

namespace weir {

/// Looks once, at construction. On a local file system it takes a read lease (fcntl(2), F_SETLEASE). The kernel
/// grants the lease only if nobody writes to the file or maps it writable, and only to the file's owner or a process
/// with CAP_LEASE. While the object holds the lease, a program that opens the file for writing waits, and one_waits()
/// reports it. If no lease is available (a file server's file, another user's file), the object searches the
/// descriptors and mappings of all processes that it may read.
class FileWriters {
 public:
  explicit FileWriters(const std::string& path);
  ~FileWriters();
  FileWriters(const FileWriters&) = delete;
  FileWriters& operator=(const FileWriters&) = delete;

  /// Returns whether a writer was found or the file cannot be opened.
  bool some() const { return some_; }
  /// Returns whether the look would have found every writer on this machine. It never finds those of other clients of
  /// a file server.
  bool known() const { return known_; }
  /// Returns whether a program has tried to open the file for writing since construction. The program waits for the
  /// end of this object, or has given up, or its wait timed out (/proc/sys/fs/lease-break-time). False if there is no
  /// lease.
  bool one_waits() const;

 private:
  Descriptor file_;
  bool leased_ = false;
  bool some_ = false;
  bool known_ = true;
};

}  // namespace weir
