// One text for options that ask for the same, however they were written.
#pragma once

#include <map>
#include <string>

namespace weir {

/// `options` as a command line or a configuration gave them, those of input and method reduced to what they say:
/// "size" = "1MiB" and "1048576", "rate" = "8" and "8.0", and a value that is the standard one and none at all, give
/// one map. For comparisons; the texts are not for people. Options of other tables stay as they are, and so does
/// everything where an option is wrong or unknown, as another version's may be.
std::map<std::string, std::string> canonical_options(const std::map<std::string, std::string>& options);

}  // namespace weir
