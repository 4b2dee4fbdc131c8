// libhdf5 as distributions build it keeps one state for the whole process and no
// locks of its own. Every call of it happens while an Hdf5Lock is held.
#pragma once

#include <mutex>
#include <string>

#include "ingest/drivers/hdf5_crash.h"

namespace weir {

/// Holds the process's one lock of libhdf5. Recursive: handles (ingest/hdf5/file/hdf5_handle.h) close themselves
/// under it wherever they go out of scope. The library prints nothing while it is held: what went wrong is
/// asked of it (ingest/hdf5/file/hdf5_error.h).
class Hdf5Lock {
 public:
  Hdf5Lock();
  ~Hdf5Lock() = default;
  Hdf5Lock(const Hdf5Lock&) = delete;
  Hdf5Lock& operator=(const Hdf5Lock&) = delete;

 private:
  std::lock_guard<std::recursive_mutex> guard_;
};

/// Holds the lock for reading values: a crash of the library meanwhile is one at what `crash_line` names
/// (hdf5_crash_line), which outlives the object.
class Hdf5ReadLock {
 public:
  explicit Hdf5ReadLock(const std::string& crash_line);
  ~Hdf5ReadLock();
  Hdf5ReadLock(const Hdf5ReadLock&) = delete;
  Hdf5ReadLock& operator=(const Hdf5ReadLock&) = delete;

 private:
  Hdf5Lock lock_;
};

/// Who holds an Hdf5ReadLock.
const Hdf5Reads& hdf5_reads();

}  // namespace weir
