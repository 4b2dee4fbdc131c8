#include "compressor/leaf/taken_codes.h"

#include <array>
#include <cstddef>

#include "format/base/simd.h"

namespace weir {
namespace {

// Counts one code after the other. For up to 16 codes this is faster than a table, in which each increment waits for
// the previous one.
WEIR_SIMD unsigned count_in_turn(const std::uint16_t* codes, std::size_t count, unsigned end, unsigned few) {
  unsigned taken = 0;
  for (unsigned code = 0; code < end; ++code) {
    const auto wanted = static_cast<std::uint16_t>(code);
    std::uint16_t found = 0;  // `wanted` and `found` are as wide as the codes, for SIMD
    for (std::size_t i = 0; i < count; ++i) found = static_cast<std::uint16_t>(found + (codes[i] == wanted ? 1U : 0U));
    taken += found > few ? 1 : 0;
  }
  return taken;
}

}  // namespace

unsigned taken_codes(std::span<const std::uint16_t> codes, unsigned bits, unsigned few) {
  if (bits <= 4) return count_in_turn(codes.data(), codes.size(), 1U << bits, few);
  std::array<std::uint16_t, 256> found{};
  for (const std::uint16_t code : codes) ++found[code];
  std::uint16_t taken = 0;  // as wide as the counts
  for (const std::uint16_t count : found) taken = static_cast<std::uint16_t>(taken + (count > few ? 1U : 0U));
  return taken;
}

}  // namespace weir
