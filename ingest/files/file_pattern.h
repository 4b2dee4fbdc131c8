// Finds files by a shell pattern of *, ? and [...] that no shell expanded, because it was in quotes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// Compares texts with runs of digits as numbers: "step_9" is before "step_10".
bool natural_less(std::string_view a, std::string_view b);

/// Returns whether `path` has *, ? or [ in it and is not the name of an existing file.
bool is_file_pattern(const std::string& path);

/// Returns the paths that `pattern` matches, in natural order. Throws Error(input) if there is none.
std::vector<std::string> matching_files(const std::string& pattern);

}  // namespace weir
