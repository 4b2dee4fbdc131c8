// The size of the kernel's pages of memory and page cache.
#pragma once

#include <unistd.h>

#include <cstdint>

namespace weir {

/// Returns the bytes of a page.
inline std::uint64_t page_bytes() {
  static const auto bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return bytes;
}

/// Returns the last page boundary at or before `offset`.
inline std::uint64_t round_down_to_page(std::uint64_t offset) { return offset / page_bytes() * page_bytes(); }

/// Returns the first page boundary at or after `offset`: the bytes that `offset` bytes take in whole pages.
inline std::uint64_t round_up_to_page(std::uint64_t offset) { return round_down_to_page(offset + page_bytes() - 1); }

}  // namespace weir
