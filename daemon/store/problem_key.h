// Which problems are the same one: a run that writes a thousand cut files has one
// problem, not a thousand.
#pragma once

#include <string>
#include <string_view>

namespace weir {

/// `reason`, that of the job of `source`, without the source's path, with the names of its outputs as "*" and every
/// number as "#"; in ASCII, so that it comes back from a client as it went, and never empty.
std::string problem_key(std::string_view source, std::string_view reason);

/// `reason` without the source's path in front.
std::string_view without_path(std::string_view source, std::string_view reason);

}  // namespace weir
