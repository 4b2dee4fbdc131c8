// Whether a program has a file open for writing, or maps it so: then it may still be written to, whatever its size and
// times say.
#pragma once

#include <string>

#include "format/io/descriptor.h"

namespace weir {

/// Looks once, at construction. On local file systems it takes a read lease (fcntl(2), F_SETLEASE), which the kernel
/// grants where nobody writes, mappings counted, and to a file's owner or a process with CAP_LEASE only; while the
/// object lives, whoever opens the file for writing waits, and one_waits() tells of it. Where there is no lease to be
/// had (a file server's file, another user's), it looks through the descriptors and mappings of the processes that it
/// may look at.
class FileWriters {
 public:
  explicit FileWriters(const std::string& path);
  ~FileWriters();
  FileWriters(const FileWriters&) = delete;
  FileWriters& operator=(const FileWriters&) = delete;

  /// A writer was found, or the file cannot be opened.
  bool some() const { return some_; }
  /// Whether all writers on this machine would have been found; never those of other clients of a file server.
  bool known() const { return known_; }
  /// Whether a program has asked for the file for writing since: it waits for this object's end, or gave up, or lost
  /// its patience (/proc/sys/fs/lease-break-time). False where there was no lease to be had.
  bool one_waits() const;

 private:
  Descriptor file_;
  bool leased_ = false;
  bool some_ = false;
  bool known_ = true;
};

}  // namespace weir
