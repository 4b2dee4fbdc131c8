#include "ingest/hdf5/file/hdf5_lock.h"

#include <hdf5.h>
#include <unistd.h>

namespace weir {
namespace {

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

Hdf5Reads& reads() {
  static Hdf5Reads now;
  return now;
}

}  // namespace

// A thread-safe libhdf5 has one error stack per thread, so it must be silenced on each thread, not once.
Hdf5Lock::Hdf5Lock() : guard_(library_mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Hdf5ReadLock::Hdf5ReadLock(const std::string& crash_line) {
  keep_handler_stack();
  reads().line = &crash_line;
  reads().thread = ::gettid();
}

Hdf5ReadLock::~Hdf5ReadLock() { reads().thread = 0; }

const Hdf5Reads& hdf5_reads() { return reads(); }

}  // namespace weir
