// The EXAMPLES of the manual pages.
#pragma once

#include <span>
#include <string_view>

namespace weir {

struct ManExample {
  std::string_view command;  ///< "convert"; "weir": of the command itself
  std::string_view text;     ///< what it does, half a sentence
  std::string_view line;     ///< as it is typed
};

/// All of them, those of one command together.
std::span<const ManExample> man_examples();

}  // namespace weir
