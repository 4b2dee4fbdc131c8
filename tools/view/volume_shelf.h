// The volumes that all viewers share. A volume is loaded once and kept until others need its place. A separate thread
// loads the next step of a series ahead.
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
  /// Holds at most `capacity` volumes (at least 1), and one more while it is loaded. `backend` must outlive the
  /// object.
  VolumeShelf(Backend& backend, std::size_t capacity);
  ~VolumeShelf();
  VolumeShelf(const VolumeShelf&) = delete;
  VolumeShelf& operator=(const VolumeShelf&) = delete;

  /// Returns the volume of the file that the path names now, and loads it if it is not held. If there is no room for
  /// it, all others are dropped. Only the render thread may call this. Throws as Backend::load and NvdbFile.
  std::shared_ptr<LoadedVolume> get(const std::string& path);
  /// Returns whether get() would return at once.
  bool has(const std::string& path) const;
  /// Begins to load the volume. A failure is ignored here; get() meets it again.
  void prefetch(const std::string& path);

 private:
  struct Entry {
    std::string path;
    std::string identity;  // file_identity
    std::shared_ptr<LoadedVolume> volume;
  };

  std::shared_ptr<LoadedVolume> find(const std::string& identity);  // mutex_ held
  std::shared_ptr<LoadedVolume> load(const std::string& path, bool ahead);
  bool clear();  // returns false if it was empty
  void fetch_ahead();

  Backend& backend_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::mutex loading_;  // a back end loads one volume at a time
  std::condition_variable wanted_changed_;
  std::list<Entry> entries_;  // most recently used first
  std::string wanted_;        // to be loaded ahead; empty: nothing
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace weir
