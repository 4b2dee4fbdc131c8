// Finds the existing name that a misspelt word probably meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// Returns the name of `names` that needs the fewest slips to become `word`. A slip is a letter added, removed or
/// replaced, or two neighbours swapped. Empty if every name needs more than one slip per three letters.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace weir
