#include "ingest/drivers/driver.h"

#include <dlfcn.h>

#include <map>
#include <mutex>

#include "format/base/ascii.h"
#include "format/base/error.h"

#define WEIR_TEXT_OF(symbol) #symbol
#define WEIR_TEXT(symbol) WEIR_TEXT_OF(symbol)

namespace weir {
namespace {

// Returns the path for dlopen. A name without a slash lets the dynamic linker find the file.
std::string place_of(const std::string& file, const std::string& what) {
  const char* const folder = ::secure_getenv("WEIR_DRIVERS");
  if (folder == nullptr || *folder == '\0') return file;
  if (*folder != '/') {
    throw Error(ErrorKind::usage,
                cat(what, ", and WEIR_DRIVERS is \"", folder, "\", it must be an absolute path; unset it or mend it"));
  }
  return cat(folder, "/", file);
}

const void* open_driver(const std::string& name, const std::string& what) {
  const std::string file = cat("weir_", name, ".so");
  void* const library = ::dlopen(place_of(file, what).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw Error(ErrorKind::io, cat(what, ", for which weir loads ", file, ", and that failed: ", ::dlerror(),
                                   "; install it with weir, or build weir with -DWEIR_", upper_case(name), "=ON"));
  }
  using Entry = const void* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(library, WEIR_TEXT(WEIR_DRIVER_SYMBOL)));
  if (entry != nullptr) return entry();
  throw Error(ErrorKind::io, cat(what, ", for which weir loads ", file,
                                 ", and that is of another build of weir; start weir again after an update, or install "
                                 "both of one build"));
}

}  // namespace

const void* load_driver(const std::string& name, const std::string& what) {
  static std::mutex mutex;
  static std::map<std::string, const void*> loaded;
  const std::scoped_lock lock(mutex);
  const void*& driver = loaded[name];
  if (driver == nullptr) driver = open_driver(name, what);
  return driver;
}

}  // namespace weir
