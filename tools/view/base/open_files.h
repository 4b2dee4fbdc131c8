// The files in which values are looked up, each mapped and checked once for several look-ups. Any thread may ask.
#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "format/nanovdb/nvdb_file.h"
#include "tools/view/base/file_identity.h"

namespace weir {

class OpenFiles {
 public:
  /// Returns the file that the path names now. Throws as NvdbFile.
  std::shared_ptr<const NvdbFile> get(const std::string& path) {
    const std::string identity = file_identity(path);
    {
      const std::lock_guard lock(mutex_);
      const auto found =
          std::find_if(files_.begin(), files_.end(), [&](const Entry& e) { return e.identity == identity; });
      if (found != files_.end()) {
        files_.splice(files_.begin(), files_, found);
        return files_.front().file;
      }
    }
    auto file = std::make_shared<const NvdbFile>(path);
    const std::lock_guard lock(mutex_);
    files_.push_front({identity, file});
    if (files_.size() > kMost) files_.pop_back();
    return file;
  }

 private:
  struct Entry {
    std::string identity;
    std::shared_ptr<const NvdbFile> file;
  };
  static constexpr std::size_t kMost = 4;

  std::mutex mutex_;
  std::list<Entry> files_;  // most recently used first
};

}  // namespace weir
