// Functions that tell where a path leads, whether something exists there, and whether it lies below another path.
#pragma once

#include <filesystem>
#include <string>

namespace weir {

/// Resolves symbolic links as far as `path` exists. If the path cannot be looked at, only normalises it lexically.
std::filesystem::path real_path(const std::string& path);

/// Returns real_path() from the root on, whatever the working directory.
std::string absolute_real_path(const std::string& path);

/// Returns whether `path` is `directory` or lies below it, component by component. Both are absolute and normal. False
/// if `directory` is empty.
bool lies_below(const std::filesystem::path& path, const std::filesystem::path& directory);

/// Returns whether something exists at `path`, links followed. Also false if that cannot be known, as for a name that
/// is too long: the next use of the path reports the reason.
bool is_there(const std::string& path);

}  // namespace weir
