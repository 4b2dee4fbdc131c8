// Files that another file names: where they are.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace weir {

/// The places where `name`, which `parent` gives, may be, in order: itself where it is absolute; else below the
/// directory in the environment variable `prefix_variable` (with ${ORIGIN} for parent's directory), where that is
/// set, beside `parent`, and in the working directory.
std::vector<std::string> side_file_places(const std::string& name, const std::string& parent,
                                          const char* prefix_variable);

/// The first of them where a file is.
std::optional<std::string> find_side_file(const std::string& name, const std::string& parent,
                                          const char* prefix_variable);

}  // namespace weir
