// How the levels of refinement of a file become volumes.
#pragma once

#include <string_view>

namespace weir {

enum class Levels {
  composite,  ///< one volume, made of the finest cells that are read
  separate    ///< one volume per level; cells that a finer level covers, or that the level lacks, have no value
};

constexpr std::string_view levels_name(Levels levels) { return levels == Levels::composite ? "composite" : "separate"; }

}  // namespace weir
