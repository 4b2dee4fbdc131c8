// Which ranges of a remote file to ask for, where each request takes as long as many bytes do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/remote/byte_range.h"

namespace weir {

/// Gaps shorter than this are read rather than left out, in bytes.
inline constexpr std::uint64_t kShortestGap = 4096;

/// Ranges that hold all of `wanted`, sorted and apart from each other: what overlaps, touches or has a gap below
/// kShortestGap is one, and the shortest of the other gaps are read, too, until there are at most `most` ranges
/// (1 or more). Empty ranges are left out.
std::vector<ByteRange> plan_requests(std::vector<ByteRange> wanted, std::size_t most);

}  // namespace weir
