// The scene of a conversion as a file, in a directory of its own that is made with it and goes with the object.
#pragma once

#include <cerrno>
#include <fstream>
#include <optional>
#include <string>

#include "format/base/error.h"
#include "tools/view/base/temporary_folder.h"

namespace weir {

class KeptScene {
 public:
  /// The path of the file, which has that text from now on. Throws Error(io).
  std::string write(const std::string& text) {
    if (!folder_) folder_.emplace();
    std::string path = (folder_->path() / "scene.toml").string();
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file) throw io_error(path, "write the scene", errno);
    return path;
  }

 private:
  std::optional<TemporaryFolder> folder_;
};

}  // namespace weir
