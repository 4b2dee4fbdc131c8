// The libhdf5 of Linux distributions keeps one state for the whole process and has no locks of its own. Hold an
// Hdf5Lock during every call of the library.
#pragma once

#include <mutex>
#include <string>

#include "ingest/drivers/hdf5_crash.h"

namespace weir {

/// Holds the process's only libhdf5 lock. The lock is recursive because handles (ingest/hdf5/file/hdf5_handle.h) take
/// it to close themselves when they go out of scope. While the lock is held the library prints no errors;
/// ingest/hdf5/file/hdf5_error.h asks the library for them.
class Hdf5Lock {
 public:
  Hdf5Lock();
  ~Hdf5Lock() = default;
  Hdf5Lock(const Hdf5Lock&) = delete;
  Hdf5Lock& operator=(const Hdf5Lock&) = delete;

 private:
  std::lock_guard<std::recursive_mutex> guard_;
};

/// Holds the lock while values are read. If the library crashes during this time, the crash is reported for the
/// dataset that `crash_line` names (hdf5_crash_line). `crash_line` outlives the object.
class Hdf5ReadLock {
 public:
  explicit Hdf5ReadLock(const std::string& crash_line);
  ~Hdf5ReadLock();
  Hdf5ReadLock(const Hdf5ReadLock&) = delete;
  Hdf5ReadLock& operator=(const Hdf5ReadLock&) = delete;

 private:
  Hdf5Lock lock_;
};

/// Returns the record of the thread that holds an Hdf5ReadLock.
const Hdf5Reads& hdf5_reads();

}  // namespace weir
