// Decides whether a Zarr hierarchy in a directory is written completely. Its metadata come first, and no file says
// which chunk is the last. So the hierarchy counts as complete when nothing in it changes any more.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/watch/store_look.h"
#include "daemon/watch/store_turns.h"

namespace weir {

/// The least time between two looks for changes that no event reports; used if `settle` is shorter.
inline constexpr std::chrono::milliseconds kLeastPause{100};

/// Returns whether `path` is the file that makes a directory NAME.zarr a Zarr hierarchy, and that directory lies in
/// no other hierarchy. Looks at the name alone.
bool is_store_head(std::string_view path);

/// Returns whether `path` lies in a directory NAME.zarr.
bool is_in_store(std::string_view path);

/// Looks through a directory, a thousand files at a time, because the event loop serves others, too. One thread.
class StoreQuiet {
 public:
  using Time = std::chrono::steady_clock::time_point;

  StoreQuiet(std::string directory, std::chrono::nanoseconds settle, StoreTurn turn = {})
      : directory_(std::move(directory)), settle_(settle), turn_(std::move(turn)) {}

  struct Answer {
    bool quiet = false;  ///< two looks, `settle` or more between them, found the same files, sizes and times
    Time until{};        ///< if not quiet: when to look again
    std::string reason;  ///< if not quiet: why, in words
  };
  Answer look(Time now);
  /// Ends the present look and discards its result.
  void stop();

 private:
  std::string directory_;
  std::chrono::nanoseconds settle_;
  StoreTurn turn_;
  std::optional<StoreLook> look_;  ///< the look in progress
  Time begun_{};
  std::optional<StoreLook::Found> before_;  ///< result of the last complete look
  Time before_end_{};
};

}  // namespace weir
