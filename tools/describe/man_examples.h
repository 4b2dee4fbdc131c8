// The EXAMPLES of the manual pages.
#pragma once

#include <span>
#include <string_view>

namespace weir {

struct ManExample {
  std::string_view command;  ///< "convert", or "weir" for the command itself
  std::string_view text;     ///< what it does, half a sentence
  std::string_view line;     ///< the line to type
};

/// Returns all examples; the examples of one command are adjacent.
std::span<const ManExample> man_examples();

}  // namespace weir
