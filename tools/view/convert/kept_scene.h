// The scene of a conversion in an unnamed file, so that nothing is left behind however this process ends. Other
// processes of the same user can read it while the object exists.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"

namespace weir {

class KeptScene {
 public:
  /// Writes `text` to a new file, which replaces the previous one, and returns its path. Throws Error(io).
  std::string write(const std::string& text) {
    file_.reset(::memfd_create("scene.toml", MFD_CLOEXEC));
    std::string path = cat("/proc/", ::getpid(), "/fd/", file_.get());
    if (!file_) throw io_error("scene.toml", "make a file in memory", errno);
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file) throw io_error(path, "write the scene", errno);
    return path;
  }

 private:
  Descriptor file_;
};

}  // namespace weir
