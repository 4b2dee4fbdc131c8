// Decides which ranges of a remote file to ask for, given that a request takes as long as reading many bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/remote/byte_range.h"

namespace weir {

/// Gaps shorter than this, in bytes, are read instead of left out.
inline constexpr std::uint64_t kShortestGap = 4096;

/// Returns ranges that hold all of `wanted`, sorted and apart from each other. Ranges that overlap, touch or have a gap
/// below kShortestGap become one. The shortest remaining gaps are read too until there are at most `most` ranges (1 or
/// more). Empty ranges are left out.
std::vector<ByteRange> plan_requests(std::vector<ByteRange> wanted, std::size_t most);

}  // namespace weir
