// Files named by a pattern as shells have them, *, ? and [...], where no shell took it apart: in quotes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// Text order with runs of digits as numbers: "step_9" before "step_10".
bool natural_less(std::string_view a, std::string_view b);

/// Whether `path` has *, ? or [ in it and is no file's name.
bool is_file_pattern(const std::string& path);

/// The paths that `pattern` matches, in natural order. Throws Error(input) where there is none.
std::vector<std::string> matching_files(const std::string& pattern);

}  // namespace weir
