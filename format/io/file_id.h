// The identity of a file (device and inode), whichever of its names a path uses.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace weir {

struct FileId {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  auto operator<=>(const FileId&) const = default;
};

/// Returns the identity of the file at `path`, symbolic links followed; nullopt if there is no file.
std::optional<FileId> file_id(const std::string& path);

/// Returns the identities of those files of `paths` that exist.
std::vector<FileId> file_ids(std::span<const std::string> paths);

/// Throws Error(usage) if one of `inputs` is the file at `output` or at one of weir's own names beside it, because a
/// conversion would replace or remove that file.
void require_not_input(std::span<const FileId> inputs, const std::string& output);

}  // namespace weir
