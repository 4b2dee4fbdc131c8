// A part of a whole as people read it.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// 100 part / whole to a tenth of a percent, "15.4 %"; "less than 0.1 %" and "more than 99.9 %" where that would round
/// to none or to all and is neither. `whole` is not 0, `part` at most that.
std::string share_text(std::uint64_t part, std::uint64_t whole);

}  // namespace weir
