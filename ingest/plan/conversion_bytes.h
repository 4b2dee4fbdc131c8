// The memory that a conversion takes besides its source, for messages about sources that take much.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// The memory in bytes of a small conversion besides its source. A larger conversion reports its own lack of memory.
inline constexpr std::uint64_t kConversionBytes = std::uint64_t{64} << 20U;

/// Returns a sufficient --memory of a small conversion, such as "117MiB", for a source that holds `bytes` and may take
/// at most half of it.
std::string memory_beside_conversion(std::uint64_t bytes);

}  // namespace weir
