// Whether a Zarr hierarchy in a directory is written yet. Its metadata come first, and nothing in it says which chunk
// is the last one: what can be known is that nothing in it changes any more.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/watch/store_look.h"
#include "daemon/watch/store_turns.h"

namespace weir {

/// Between two looks at what no event tells of, where `settle` is shorter.
inline constexpr std::chrono::milliseconds kLeastPause{100};

/// Whether `path` is the file in a directory NAME.zarr that says that this is a Zarr hierarchy, one that lies in no
/// other. Looks at the name alone.
bool is_store_head(std::string_view path);

/// Whether `path` lies in a directory NAME.zarr.
bool is_in_store(std::string_view path);

/// Looks through a directory, a thousand files at a time: an event loop has others to serve. One thread.
class StoreQuiet {
 public:
  using Time = std::chrono::steady_clock::time_point;

  StoreQuiet(std::string directory, std::chrono::nanoseconds settle, StoreTurn turn = {})
      : directory_(std::move(directory)), settle_(settle), turn_(std::move(turn)) {}

  struct Answer {
    bool quiet = false;  ///< two looks, `settle` or more between them, found the same files, sizes and times
    Time until{};        ///< else when to look again
    std::string reason;  ///< else, in words
  };
  Answer look(Time now);
  /// Ends a look in progress, which then has found nothing.
  void stop();

 private:
  std::string directory_;
  std::chrono::nanoseconds settle_;
  StoreTurn turn_;
  std::optional<StoreLook> look_;  ///< in progress
  Time begun_{};
  std::optional<StoreLook::Found> before_;  ///< of the last look, where it was a whole one
  Time before_end_{};
};

}  // namespace weir
