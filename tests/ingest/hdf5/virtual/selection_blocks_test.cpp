// Tests how a selection of the library is split into boxes.
#include "ingest/hdf5/virtual/selection_blocks.h"

#include <gtest/gtest.h>

#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir::selection_blocks_test {
namespace {

using Dims = std::vector<hsize_t>;

Hdf5Handle space_of(const Dims& dims) {
  return Hdf5Handle(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr));
}

TEST(SelectionBlocks, RegularOnesAreJoinedWhereTheyTouch) {
  const Hdf5Handle space = space_of({20, 20});
  const Dims start{2, 3};
  const Dims stride{2, 5};
  const Dims count{4, 3};
  const Dims block{2, 1};
  H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), stride.data(), count.data(), block.data());
  const auto blocks = selection_blocks(space.get(), 3);
  ASSERT_TRUE(blocks);
  ASSERT_EQ(blocks->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*blocks)[i].lo, (Dims{2, 3 + 5 * i}));
    EXPECT_EQ((*blocks)[i].hi, (Dims{10, 4 + 5 * i}));
  }
  EXPECT_FALSE(selection_blocks(space.get(), 2));
}

TEST(SelectionBlocks, IrregularOnesAreListed) {
  const Hdf5Handle space = space_of({10, 10});
  const Dims start{0, 0};
  const Dims count{2, 2};
  H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  const Dims other{5, 7};
  const Dims wide{1, 3};
  H5Sselect_hyperslab(space.get(), H5S_SELECT_OR, other.data(), nullptr, wide.data(), nullptr);
  const auto blocks = selection_blocks(space.get(), 8);
  ASSERT_TRUE(blocks);
  ASSERT_EQ(blocks->size(), 2U);
  EXPECT_EQ((*blocks)[0].lo, (Dims{0, 0}));
  EXPECT_EQ((*blocks)[0].hi, (Dims{2, 2}));
  EXPECT_EQ((*blocks)[1].lo, (Dims{5, 7}));
  EXPECT_EQ((*blocks)[1].hi, (Dims{6, 10}));
  EXPECT_FALSE(selection_blocks(space.get(), 1));
}

}  // namespace
}  // namespace weir::selection_blocks_test
