// Finds files that another file names.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace weir {

/// Returns the paths where the file `name`, named by `parent`, may be, in order of search. An absolute `name` gives
/// only itself. Otherwise: below the directory in the environment variable `prefix_variable` if it is set (${ORIGIN}
/// stands for parent's directory), beside `parent`, and in the working directory.
std::vector<std::string> side_file_places(const std::string& name, const std::string& parent,
                                          const char* prefix_variable);

/// Returns the first path of side_file_places() where a file exists.
std::optional<std::string> find_side_file(const std::string& name, const std::string& parent,
                                          const char* prefix_variable);

}  // namespace weir
