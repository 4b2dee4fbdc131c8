// What becomes of the levels of refinement of a file.
#pragma once

#include <string_view>

namespace weir {

enum class Levels {
  composite,  ///< one volume, of the cells of the finest level that is read
  separate    ///< a volume of each level; of cells that a finer level has, and of those that it lacks itself, no value
};

constexpr std::string_view levels_name(Levels levels) { return levels == Levels::composite ? "composite" : "separate"; }

}  // namespace weir
