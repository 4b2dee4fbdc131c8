// Volumes pushed in memory, slab by slab, and what a conversion of them gives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "tests/compressor/support/converted.h"

namespace weir::test {

/// Planes [z0, z0 + nz).
struct Slab {
  std::int64_t z0 = 0;
  std::int64_t nz = 0;
};

/// All planes of a volume of `planes`, in slabs of `height`, from the first one on.
std::vector<Slab> slabs_in_order(std::int64_t planes, std::int64_t height);
/// All planes in slabs of 1 to `highest`, in any order.
std::vector<Slab> shuffled_slabs(std::int64_t planes, std::int64_t highest, std::uint32_t seed);

/// Pushes `values`, x fastest, from `threads` threads, and ends. As convert for the options. A copy of each slab is
/// handed over and spoiled afterwards.
Converted push(const SourceInfo& info, std::span<const std::byte> values, ConversionOptions options,
               const std::vector<Slab>& slabs, std::size_t threads = 1);

/// The same bytes, notices and sidecar, but for what they say of the source's file and of time.
void expect_same(const Converted& pushed, const Converted& expected);

}  // namespace weir::test
