// Pushes volumes in memory, slab by slab, and returns the result of the conversion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "tests/compressor/support/converted.h"

namespace weir::test {

/// The planes [z0, z0 + nz).
struct Slab {
  std::int64_t z0 = 0;
  std::int64_t nz = 0;
};

/// Returns all planes of a volume of `planes` planes in slabs of `height` planes, in order.
std::vector<Slab> slabs_in_order(std::int64_t planes, std::int64_t height);
/// Returns all planes in slabs of 1 to `highest` planes, in random order.
std::vector<Slab> shuffled_slabs(std::int64_t planes, std::int64_t highest, std::uint32_t seed);

/// Pushes `values`, x fastest, from `threads` threads and ends the push. Treats `options` as convert() does. Passes a
/// copy of each slab and overwrites the copy afterwards.
Converted push(const SourceInfo& info, std::span<const std::byte> values, ConversionOptions options,
               const std::vector<Slab>& slabs, std::size_t threads = 1);

/// Expects the same bytes, notices and sidecar, except for what they say about the source's file and about time.
void expect_same(const Converted& pushed, const Converted& expected);

}  // namespace weir::test
