// The name that was probably meant by one that does not exist.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// The one of `names` that takes the fewest slips to become `word`, where a slip is a letter more, less or another, or
/// two neighbours swapped; empty where all take more than one slip in three letters.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace weir
