// Checks that a resident volume surveys rows of blocks as it surveys the same blocks of a box.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/packed/block_coder.h"

namespace weir::test {

/// Returns the figures, costs and summaries of `count` blocks as bytes.
inline std::string bytes_of(const SurveyedBlocks& found, std::size_t first, std::size_t count) {
  const auto part = [&](const auto& all) {
    const std::size_t each = all.size() / found.figures.size();
    const auto bytes = std::as_bytes(all.subspan(each * first, each * count));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  return part(found.figures) + part(found.costs) + part(found.near) + part(found.summaries);
}

/// Expects the same findings and values for four rows of three blocks: the first and the last of the volume, and two
/// that overlap. The volume must have at least 7 blocks along each axis.
inline void expect_rows_surveyed_as_in_a_box(ResidentVolume& resident) {
  const NodeLattice leaves = make_lattice(resident.voxels(), kLeafDim);
  const auto box = resident.open(leaves.nodes_box({{0, 0, 0}, leaves.count}));
  ASSERT_NE(box, nullptr);
  const RungAsk ask{true, 0, {NearBlocks::all}};
  box->begin_survey(ask);
  const auto expected = box->end_survey();
  ASSERT_TRUE(expected);

  constexpr std::int64_t kLength = 3;
  const std::vector<Index3> firsts{{0, 0, 0}, leaves.count - Index3{kLength, 1, 1}, {4, 3, 2}, {3, 3, 2}};
  std::vector<Box> rows;
  for (const Index3& first : firsts) rows.push_back(leaves.nodes_box({first, first + Index3{kLength, 1, 1}}));
  const auto opened = resident.open_rows(rows);
  ASSERT_NE(opened, nullptr);
  opened->begin_survey(ask);
  const auto found = opened->end_survey();
  ASSERT_TRUE(found);
  ASSERT_EQ(found->figures.size(), rows.size() * kLength);
  std::vector<std::uint32_t> of_rows;
  std::vector<std::uint32_t> of_box;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto first = static_cast<std::size_t>(leaves.linear(firsts[i]));
    EXPECT_EQ(bytes_of(*found, i * kLength, kLength) == bytes_of(*expected, first, kLength), true) << "row " << i;
    of_rows.push_back(static_cast<std::uint32_t>(i * kLength + 2));
    of_box.push_back(static_cast<std::uint32_t>(first + 2));
  }
  const auto values = opened->values(of_rows);
  ASSERT_TRUE(values);
  const std::vector<float> copied(values->begin(), values->end());
  const auto same = box->values(of_box);
  ASSERT_TRUE(same);
  EXPECT_EQ(std::ranges::equal(copied, *same), true);
}

}  // namespace weir::test
