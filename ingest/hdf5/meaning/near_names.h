// Names that a mistyped one may have meant.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// Those of `names` (paths with slashes) whose last part is that of `wanted` or differs from it by case or by
/// up to two insertions, deletions and replacements of characters (Levenshtein's distance; a third of
/// its length at most), nearest first, `count` at most.
std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> names, std::size_t count);

}  // namespace weir
