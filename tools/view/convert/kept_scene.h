// The scene of a conversion as a file without a name, which leaves nothing behind however this process ends. Others of
// the same user read it as long as the object is there.
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
  /// The path of a new file with that text, in place of the one before. Throws Error(io).
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
