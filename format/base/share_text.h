// A part of a whole as a percentage for people.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// Returns 100 part / whole to a tenth of a percent, "15.4 %". Returns "less than 0.1 %" or "more than 99.9 %" if a
/// share that is neither 0 nor 1 would round to none or all. `whole` is not 0, `part` is at most `whole`.
std::string share_text(std::uint64_t part, std::uint64_t whole);

}  // namespace weir
