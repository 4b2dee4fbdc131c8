// Reduces options to one canonical text, so that options with the same meaning are equal however they were written.
#pragma once

#include <map>
#include <string>

namespace weir {

/// Returns `options`, as a command line or a configuration gave them, with the options of input and method reduced to
/// their meaning. "size" = "1MiB" and "1048576" give the same map; so do "rate" = "8" and "8.0", and a standard value
/// and no value. For comparisons; the texts are not for people. Options of other tables stay as they are. If an option
/// is wrong or unknown, for example from another version, all options stay as they are.
std::map<std::string, std::string> canonical_options(const std::map<std::string, std::string>& options);

}  // namespace weir
