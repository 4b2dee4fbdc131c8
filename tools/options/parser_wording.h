// Rewords CLI11's messages about wrong values.
#pragma once

#include <functional>
#include <string>

namespace weir {

/// Returns CLI11's message `text` reworded, on one line: "--spp: 1 required N missing" becomes "--spp needs a value,
/// N"; "--volume: both not in {file,dense}" becomes "--volume is "both", it must be file or dense". Text of any other
/// form is returned unchanged. `values_of` names the values that an option takes, "V V.nvdb W W.nvdb"; without
/// `values_of` they are only counted.
std::string parser_wording(const std::string& text,
                           const std::function<std::string(const std::string& option)>& values_of = {});

}  // namespace weir
