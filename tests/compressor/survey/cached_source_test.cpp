#include "compressor/survey/cached_source.h"

#include <gtest/gtest.h>

#include "tests/compressor/support/memory_volume.h"

namespace weir::cached_source_test {
namespace {

using test::MemoryVolume;

const Box kDomain{{0, 0, 0}, {16, 8, 8}};

TEST(CachedSource, WhatIsCached_IsNotReadAgain_ByOneThreadOrSeveral) {
  MemoryVolume volume(kDomain, [](const Index3& i) { return static_cast<float>(i.x + 100 * i.y); });
  const NodeLattice leaves = make_lattice(kDomain, kLeafDim);
  LeafCache cache(leaves, LeafCache::whole_bytes(leaves));
  cache.add(0, volume.in(leaves.voxels(leaves.position(0))), false);  // the other leaf is not cached
  CachedSource source(volume, &cache);
  const Box cached{{1, 0, 0}, {8, 8, 8}};
  const Box other{{1, 0, 0}, {9, 8, 8}};
  for (const bool alone : {false, true}) {
    for (const Box& box : {cached, other}) {
      const std::uint64_t before = source.bytes_read();
      std::vector<float> values(static_cast<std::size_t>(box.voxels()));
      if (alone) {
        source.read_alone(box, values);
      } else {
        source.read(box, values);
      }
      EXPECT_EQ(values, volume.in(box));
      EXPECT_EQ(source.bytes_read() > before, box == other);
    }
  }
  EXPECT_EQ(source.held(cached), &cache);
  EXPECT_EQ(source.held(other), nullptr);
}

}  // namespace
}  // namespace weir::cached_source_test
