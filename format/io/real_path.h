// Where a path leads, whether something exists there, and whether it lies below another path.
#pragma once

#include <filesystem>
#include <string>

namespace weir {

/// Symbolic links resolved, as far as the path exists; lexically normal where even that cannot be looked at.
std::filesystem::path real_path(const std::string& path);

/// The same of the path from the root on, whatever the working directory.
std::string absolute_real_path(const std::string& path);

/// Whether `path` is `directory` or lies below it, by their components: both are absolute and normal. False
/// where `directory` is empty.
bool lies_below(const std::filesystem::path& path, const std::filesystem::path& directory);

/// Whether something exists at `path`, links followed; false, too, where that cannot be known, as for a name that is
/// too long: the next use of the path reports why.
bool is_there(const std::string& path);

}  // namespace weir
