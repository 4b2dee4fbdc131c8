#include "ingest/hdf5/file/hdf5_lock.h"

#include <hdf5.h>

namespace weir {
namespace {

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

}  // namespace

// A library built with thread-safety has one error stack per thread, so silencing it once would not do.
Hdf5Lock::Hdf5Lock() : guard_(library_mutex()) { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

}  // namespace weir
