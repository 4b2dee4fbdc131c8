// What the parser of command lines, CLI11, says of a wrong value, in weir's words.
#pragma once

#include <functional>
#include <string>

namespace weir {

/// "--spp: 1 required N missing" as "--spp needs a value, N"; "--volume: both not in {file,dense}" as "--volume is
/// "both", it must be file or dense". One line; a text of any other form stays. `values_of` names the values that an
/// option takes, "V V.nvdb W W.nvdb"; without it they are only counted.
std::string parser_wording(const std::string& text,
                           const std::function<std::string(const std::string& option)>& values_of = {});

}  // namespace weir
