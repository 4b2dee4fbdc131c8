// The pages that the kernel gives memory and the page cache out in.
#pragma once

#include <unistd.h>

#include <cstdint>

namespace weir {

/// Bytes of a page.
inline std::uint64_t page_bytes() {
  static const auto bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return bytes;
}

/// The last border of pages that is not behind `offset`.
inline std::uint64_t round_down_to_page(std::uint64_t offset) { return offset / page_bytes() * page_bytes(); }

/// The first border of pages that is not before `offset`; what whole pages for `offset` bytes take.
inline std::uint64_t round_up_to_page(std::uint64_t offset) { return round_down_to_page(offset + page_bytes() - 1); }

}  // namespace weir
