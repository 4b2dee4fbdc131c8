// One look through all files of a Zarr hierarchy in a directory.
#pragma once

#include <dirent.h>
#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace weir {

/// Follows links, as the reader of a hierarchy does. Each directory that links lead to is looked through once, so
/// there are no loops. Holds a descriptor for each level of directories, at most kMostLevels. One thread.
class StoreLook {
 public:
  static constexpr std::size_t kMostLevels = 64;
  static constexpr std::size_t kMostLinked = 65536;  ///< directories that links lead to

  /// Sums over all files and directories; they do not depend on the order of listing.
  struct Found {
    std::uint64_t files = 0;
    std::uint64_t bytes = 0;
    std::uint64_t states = 0;

    bool operator==(const Found&) const = default;
  };

  explicit StoreLook(std::string directory) : path_(std::move(directory)), root_length_(path_.size()) {}

  /// Looks at a thousand files. Returns whether there are more. A file that vanishes meanwhile is a change, which the
  /// next look finds. A directory that may not be listed is left out, because it cannot be read either.
  bool step();
  const Found& found() const { return found_; }
  /// Returns in words why the look ended early; empty if it did not.
  const std::string& fault() const { return fault_; }

 private:
  struct CloseDirectory {
    void operator()(DIR* stream) const { ::closedir(stream); }
  };
  struct Level {
    std::unique_ptr<DIR, CloseDirectory> stream;
    std::size_t path_length = 0;  ///< length of the parent's path
  };

  bool begin();
  bool look_at(const char* name);
  void add(const struct stat& status);
  bool enter(const char* name, const struct stat& status, bool linked);
  /// Lists `directory` next, and owns the descriptor from here on.
  bool hold(int directory, const char* name);
  /// Records the fault and returns false. `name` is an entry of the directory being listed; empty: that directory
  /// itself.
  bool fail(const char* name, const std::string& what);

  std::string path_;  ///< of the directory being listed
  std::size_t root_length_;
  std::vector<Level> levels_;
  std::set<std::pair<dev_t, ino_t>> linked_;  ///< directories that links lead to, and the hierarchy itself
  bool begun_ = false;
  Found found_;
  std::string fault_;
};

}  // namespace weir
