#include "ingest/drivers/driver.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

#include "format/base/error.h"

#define WEIR_TEXT_OF(symbol) #symbol
#define WEIR_TEXT(symbol) WEIR_TEXT_OF(symbol)

namespace weir {
namespace {

namespace fs = std::filesystem;

// Of the program or the library that this code is linked into.
fs::path folder_of_this_code() {
  Dl_info info{};
  void* map = nullptr;
  std::error_code ignored;
  const bool found = ::dladdr1(reinterpret_cast<const void*>(&load_driver), &info, &map, RTLD_DL_LINKMAP) != 0;
  const char* const name = found ? static_cast<const link_map*>(map)->l_name : "";
  // The main program has no name there.
  const fs::path file = *name == '\0' ? fs::path("/proc/self/exe") : fs::path(name);
  return fs::canonical(file, ignored).parent_path();
}

std::vector<fs::path> driver_folders() {
  if (const char* const chosen = std::getenv("WEIR_DRIVERS")) return {chosen};
  const fs::path here = folder_of_this_code();
  std::vector<fs::path> folders;
  // A build's program, its benchmarks and its Python module; an installation's program, library and Python module.
  for (const char* const relative : {"drivers", "../drivers", "../../drivers", "../" WEIR_LIBRARY_FOLDER "/weir",
                                     "weir", "../../../weir", "../../../" WEIR_ARCHITECTURE "/weir"}) {
    folders.push_back((here / relative).lexically_normal());
  }
  return folders;
}

std::string file_of(const std::string& name) { return "weir_" + name + ".so"; }

/// Empty where there is none.
fs::path find_file(const std::string& name) {
  std::error_code ignored;
  for (const fs::path& folder : driver_folders()) {
    if (fs::exists(folder / file_of(name), ignored)) return folder / file_of(name);
  }
  return {};
}

const void* find_driver(const std::string& name, const std::string& what) {
  const std::string file = file_of(name);
  if (const fs::path path = find_file(name); !path.empty()) {
    void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      std::string option = name;
  std::transform(option.begin(), option.end(), option.begin(), [](unsigned char c) { return std::toupper(c); });
  throw Error(ErrorKind::input,
                  cat(what, ", and ", path.string(), " cannot be loaded: ", ::dlerror(), "; install what it needs"));
    }
    using Entry = const void* (*)();
    const auto entry = reinterpret_cast<Entry>(::dlsym(library, WEIR_TEXT(WEIR_DRIVER_SYMBOL)));
    if (entry != nullptr) return entry();
    throw Error(ErrorKind::input,
                cat(what, ", and ", path.string(), " is of another version of weir; install ", file, " of this one"));
  }
  std::string key = name;
  std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  throw Error(ErrorKind::input, cat(what, ", and this weir has no ", file, ", which it takes; build it with -DWEIR_", key,
                                    "=ON, or name the folder it lies in by the environment's WEIR_DRIVERS"));
}

}  // namespace

bool driver_is_there(const std::string& name) { return !find_file(name).empty(); }

const void* load_driver(const std::string& name, const std::string& what) {
  static std::mutex mutex;
  static std::map<std::string, const void*> loaded;
  const std::scoped_lock lock(mutex);
  const void*& driver = loaded[name];
  if (driver == nullptr) driver = find_driver(name, what);
  return driver;
}

}  // namespace weir
