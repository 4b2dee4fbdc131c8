// The volumes that all viewers share: loaded once, kept until others need their place, the next step of a series loaded
// ahead by a thread of its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "gpu/render/backend.h"

namespace weir {

class VolumeShelf {
 public:
  /// Holds at most `capacity` volumes, at least 1, and one more while it is loaded. `backend` must outlive the object.
  VolumeShelf(Backend& backend, std::size_t capacity);
  ~VolumeShelf();
  VolumeShelf(const VolumeShelf&) = delete;
  VolumeShelf& operator=(const VolumeShelf&) = delete;

  /// The volume of the file that has the path now, which is loaded where it is not here. One thread, that which
  /// renders. Where it finds no room beside the others, these go. Throws as Backend::load and NvdbFile.
  std::shared_ptr<LoadedVolume> get(const std::string& path);
  /// Whether get() would return at once.
  bool has(const std::string& path) const;
  /// Begins to load it; a failure is kept quiet, get() finds it again.
  void prefetch(const std::string& path);

 private:
  struct Entry {
    std::string path;
    std::string identity;  // file_identity
    std::shared_ptr<LoadedVolume> volume;
  };

  std::shared_ptr<LoadedVolume> find(const std::string& identity);  // mutex_ held
  std::shared_ptr<LoadedVolume> load(const std::string& path, bool ahead);
  bool clear();  // false: it was empty
  void fetch_ahead();

  Backend& backend_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::mutex loading_;  // a back end loads one volume at a time
  std::condition_variable wanted_changed_;
  std::list<Entry> entries_;  // used last first
  std::string wanted_;        // to be loaded ahead; empty: nothing
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace weir
