// Decides which problems are the same: a run that writes a thousand truncated files has one problem, not a thousand.
#pragma once

#include <string>
#include <string_view>

namespace weir {

/// Returns the key of the problem `reason` of the job of `source`: the reason without the source's path, with the
/// names of its outputs as "*" and every number as "#". The key is ASCII, so that a client returns it unchanged, and
/// never empty.
std::string problem_key(std::string_view source, std::string_view reason);

/// Returns `reason` without the source's path in front.
std::string_view without_path(std::string_view source, std::string_view reason);

}  // namespace weir
