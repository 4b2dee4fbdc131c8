// Whether a Zarr hierarchy in a directory is written yet. Its metadata come first, and nothing in it says which chunk
// is the last one: what can be known is that nothing in it changes any more.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace weir {

/// Whether `path` is the file in a directory NAME.zarr that says that this is a Zarr hierarchy, one that lies in no
/// other. Looks at the name alone.
bool is_store_head(std::string_view path);

/// Whether `path` lies in a directory NAME.zarr.
bool is_in_store(std::string_view path);

/// Looks through a directory, a thousand files at a time: an event loop has others to serve. One thread.
class StoreQuiet {
 public:
  using Time = std::chrono::steady_clock::time_point;

  StoreQuiet(std::string directory, std::chrono::nanoseconds settle)
      : directory_(std::move(directory)), settle_(settle) {}

  struct Answer {
    bool quiet = false;  ///< two looks, `settle` or more between them, found the same files, sizes and times
    Time until{};        ///< else when to look again
    std::string reason;  ///< else, in words
  };
  Answer look(Time now);

 private:
  /// Of all files and directories: sums, whatever the order they are listed in.
  struct Found {
    std::uint64_t files = 0;
    std::uint64_t bytes = 0;
    std::uint64_t states = 0;

    bool operator==(const Found&) const = default;
  };

  bool step();
  void add(const std::filesystem::path& path);

  std::string directory_;
  std::chrono::nanoseconds settle_;
  std::optional<std::filesystem::recursive_directory_iterator> at_;  ///< of a look in progress
  Found found_;                                                      ///< in it
  Time begun_{};
  std::optional<Found> before_;  ///< of the last whole look
  Time before_end_{};
};

}  // namespace weir
