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

  /// Returns why the file system is not mounted, for a test that skips; empty if it is mounted.
  const std::string& refused() const noexcept { return refused_; }
  /// From now on nobody can write, not even root.
  void make_read_only();

 private:
  std::string directory_;
  std::string refused_;
};

}  // namespace weir
