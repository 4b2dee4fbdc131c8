// A small memory file system over a directory, for tests of a full disk and of a read-only one. Root only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace weir {

class ScopedMount {
 public:
  /// Mounts over the existing `directory`; `bytes` is its capacity.
  ScopedMount(const std::filesystem::path& directory, std::uint64_t bytes);
  ~ScopedMount();
  ScopedMount(const ScopedMount&) = delete;
  ScopedMount& operator=(const ScopedMount&) = delete;

  /// Empty where it is mounted, else why not: what a test says when it skips.
  const std::string& refused() const noexcept { return refused_; }
  /// From now on nothing can be written, by root either.
  void make_read_only();

 private:
  std::string directory_;
  std::string refused_;
};

}  // namespace weir
