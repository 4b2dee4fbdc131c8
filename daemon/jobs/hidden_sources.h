// Finds the sources that an interrupted deletion (source_deletion.h) left under a hidden name, which no watch
// accepts.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/store/job.h"
#include "daemon/watch/path_filter.h"

namespace weir {

/// Returns the hidden name of the source of `job` while it is deleted: .weir-delete-ID, in the source's directory.
std::string hidden_name(const Job& job);

struct HiddenSource {
  std::string path;
  std::int64_t job = 0;  ///< the job's id, parsed from the name
};

/// Looks through watched directories for hidden sources, a piece at a time. Looks into subdirectories if the watch is
/// recursive. One thread.
class HiddenSources {
 public:
  /// Queues the directories of `watches` for a look, except those that were queued before with the same `recursive`. A
  /// directory that is missing now may be queued by a later call.
  void look_through(const std::vector<WatchConfig>& watches);
  /// Returns whether nothing is left to look through.
  bool idle() const { return waiting_.empty() && at_ == std::filesystem::directory_iterator(); }
  /// Looks at some entries, for about a millisecond on a local disk. Returns the hidden sources among them.
  std::vector<HiddenSource> step();

 private:
  using Key = std::pair<std::string, bool>;  // directory and recursive
  struct Watched {
    WatchConfig config;
    PathFilter filter;
  };
  struct Waiting {
    std::string directory;
    std::size_t watch;  // index in watches_
  };

  void open_next();
  void next();
  void enter(const std::filesystem::directory_entry& entry);

  std::set<Key> looked_;
  std::vector<Watched> watches_;
  std::deque<Waiting> waiting_;
  std::filesystem::directory_iterator at_;
  std::size_t watch_ = 0;  ///< the watch (index in watches_) that at_ belongs to
};

}  // namespace weir
