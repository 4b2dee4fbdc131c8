// Which file a path leads to, whatever its names.
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

/// By way of symbolic links; nullopt where there is none.
std::optional<FileId> file_id(const std::string& path);

/// Of those of the files that there are.
std::vector<FileId> file_ids(std::span<const std::string> paths);

/// Throws Error(usage) where one of `inputs` is the file at `output` or at one of weir's own names beside it, and so
/// would be replaced or removed.
void require_not_input(std::span<const FileId> inputs, const std::string& output);

}  // namespace weir
