// The sources that an interrupted deletion (source_deletion.h) has left under a hidden name, which no watch takes.
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

/// What the source of `job` is called while it is deleted: .weir-delete-ID, beside it.
std::string hidden_name(const Job& job);

struct HiddenSource {
  std::string path;
  std::int64_t job = 0;  ///< as the name says
};

/// Looks through watched directories for them, those below where the watch is recursive, a piece at a time. One thread.
class HiddenSources {
 public:
  /// Has the directories of `watches` looked through, but for those that were before; one that is not there has not
  /// been.
  void look_through(const std::vector<WatchConfig>& watches);
  /// Whether nothing more is to be looked through.
  bool idle() const { return waiting_.empty() && at_ == std::filesystem::directory_iterator(); }
  /// Looks at some entries, for about a millisecond on a local disk; those of them that are hidden sources.
  std::vector<HiddenSource> step();

 private:
  using Key = std::pair<std::string, bool>;  // directory and recursive
  struct Watched {
    WatchConfig config;
    PathFilter filter;
  };
  struct Waiting {
    std::string directory;
    std::size_t watch;  // its place in watches_
  };

  void open_next();
  void next();
  void enter(const std::filesystem::directory_entry& entry);

  std::set<Key> looked_;
  std::vector<Watched> watches_;
  std::deque<Waiting> waiting_;
  std::filesystem::directory_iterator at_;
  std::size_t watch_ = 0;  ///< of at_
};

}  // namespace weir
