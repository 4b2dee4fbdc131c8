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

/// Links are followed, as reading the hierarchy follows them; each directory that links lead to is looked through once,
/// so that there are no loops. Holds a descriptor for each level of directories, kMostLevels at most. One thread.
class StoreLook {
 public:
  static constexpr std::size_t kMostLevels = 64;
  static constexpr std::size_t kMostLinked = 65536;  ///< directories that links lead to

  /// Of all files and directories: sums, whatever the order they are listed in.
  struct Found {
    std::uint64_t files = 0;
    std::uint64_t bytes = 0;
    std::uint64_t states = 0;

    bool operator==(const Found&) const = default;
  };

  explicit StoreLook(std::string directory) : path_(std::move(directory)), root_length_(path_.size()) {}

  /// Looks at a thousand files; whether there are more. What vanishes meanwhile is a change, which the next look finds;
  /// what may not be listed is left out, as it cannot be read either.
  bool step();
  const Found& found() const { return found_; }
  /// Why the look ended before all was seen, in words; empty: it did not.
  const std::string& fault() const { return fault_; }

 private:
  struct CloseDirectory {
    void operator()(DIR* stream) const { ::closedir(stream); }
  };
  struct Level {
    std::unique_ptr<DIR, CloseDirectory> stream;
    std::size_t path_length = 0;  ///< of its parent
  };

  bool begin();
  bool look_at(const char* name);
  void add(const struct stat& status);
  bool enter(const char* name, const struct stat& status, bool linked);
  /// Lists `directory`, which it owns from here on, next.
  bool hold(int directory, const char* name);
  /// False, and why; `name` is in the directory being listed, empty for that itself.
  bool fail(const char* name, const std::string& what);

  std::string path_;  ///< of the directory being listed
  std::size_t root_length_;
  std::vector<Level> levels_;
  std::set<std::pair<dev_t, ino_t>> linked_;  ///< and the hierarchy itself
  bool begun_ = false;
  Found found_;
  std::string fault_;
};

}  // namespace weir
