// Leaves in a spool, and the volume that is read from the spool.
#include "compressor/push/leaf_spool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "compressor/push/spool_source.h"
#include "format/base/error.h"
#include "tests/compressor/support/crash_file_system.h"

namespace weir::leaf_spool_test {
namespace {

using State = SpooledLeaf::State;

// Leaves overhang at both ends of every axis.
constexpr Box kDomain{{-5, 3, 6}, {37, 30, 25}};

class LeafSpoolTest : public testing::Test {
 protected:
  LeafSpoolTest() {
    for_each_index(kDomain, [&](const Index3& i) { values_.push_back(value(i)); });
    info_.extent = kDomain.extent();
    info_.index_origin = kDomain.lo;
    info_.type = ScalarType::float64;
    info_.path = "density";
  }

  // Constant in some leaves; beyond float32 in a few voxels.
  static double value(const Index3& i) {
    if (i.x >= 8 && i.x < 24) return i.y < 16 ? 7.25 : 0.1;
    return i == Index3{30, 20, 20} ? 1e300 : static_cast<double>(i.x + 100 * i.y + 10000 * i.z);
  }

  std::vector<double> in(const Box& box) const {
    std::vector<double> values;
    for_each_index(box, [&](const Index3& i) {
      values.push_back(values_[static_cast<std::size_t>(linear_index(i - kDomain.lo, kDomain.extent()))]);
    });
    return values;
  }

  void write(const Box& box) {
    const std::vector<double> values = in(box);
    spool_.write(box, std::as_bytes(std::span(values)));
  }

  std::vector<State> states() const {
    std::vector<SpooledLeaf> leaves(static_cast<std::size_t>(spool_.leaves().size()));
    spool_.read_states(0, leaves);
    std::vector<State> states;
    for (const SpooledLeaf& leaf : leaves) states.push_back(leaf.state);
    return states;
  }

  void expect_reads(const Box& box) {
    std::vector<float> expected;
    ConversionLoss lost;
    for (const double v : in(box)) {
      expected.push_back(static_cast<float>(v));
      if (static_cast<double>(expected.back()) == v) continue;
      ++(std::isfinite(expected.back()) ? lost.inexact : lost.overflow);
    }
    const auto source = open_spool(spool_, info_);
    for (const bool alone : {false, true}) {
      std::vector<float> read(expected.size());
      const ConversionLoss loss = alone ? source->read_alone(box, read) : source->read(box, read);
      EXPECT_EQ(read, expected);
      EXPECT_EQ(loss.inexact, lost.inexact);
      EXPECT_EQ(loss.overflow, lost.overflow);
    }
  }

  void expect_reads_everything() {
    expect_reads(kDomain);
    expect_reads({{-5, 3, 6}, {37, 8, 8}});
    expect_reads({{-1, 4, 7}, {29, 29, 24}});
    expect_reads({{30, 20, 20}, {31, 21, 21}});
  }

  test::CrashFileSystem files_;
  std::shared_ptr<File> file_ = files_.create("values");
  LeafSpool spool_{file_, files_.create("states"), make_lattice(kDomain, kLeafDim), ScalarType::float64};
  SourceInfo info_;
  std::vector<double> values_;
};

TEST_F(LeafSpoolTest, KeepsConstantLeavesOutOfTheFile) {
  write({{8, 8, 8}, {24, 16, 16}});
  EXPECT_EQ(file_->size(), 0U);
  std::vector<SpooledLeaf> leaves(4);
  // There are six leaves along x, from index -8 on, and five along y, from index 0 on.
  spool_.read_states(1 + 6 * (1 + 4 * 1), leaves);
  EXPECT_EQ(leaves[0].state, State::absent);
  for (const std::size_t i : {1U, 2U}) {
    double value = 0;
    std::memcpy(&value, leaves[i].value.data(), sizeof value);
    EXPECT_EQ(leaves[i].state, State::constant);
    EXPECT_EQ(value, 7.25);
  }
  EXPECT_EQ(leaves[3].state, State::absent);
  expect_reads({{9, 8, 8}, {24, 15, 16}});
}

TEST_F(LeafSpoolTest, KeepsNoLeafForConstantThatDiffersInASign) {
  std::vector<double> zeros(512);
  spool_.write({{8, 8, 8}, {16, 16, 16}}, std::as_bytes(std::span(zeros)));
  zeros.back() = -0.0;
  spool_.write({{16, 8, 8}, {24, 16, 16}}, std::as_bytes(std::span(zeros)));
  std::vector<SpooledLeaf> leaves(2);
  spool_.read_states(2 + 6 * (1 + 4 * 1), leaves);
  EXPECT_EQ(leaves[0].state, State::constant);
  EXPECT_EQ(leaves[1].state, State::spooled);
}

TEST_F(LeafSpoolTest, ReadsBackWhatWasWrittenAtOnce) {
  write(kDomain);
  EXPECT_EQ(std::ranges::count(states(), State::absent), 0);
  EXPECT_GT(std::ranges::count(states(), State::constant), 4);
  expect_reads_everything();
}

// The parts come from several processes and are cut anywhere.
TEST_F(LeafSpoolTest, PutsPartsOfLeavesTogether) {
  std::mt19937 random(5);
  std::vector<Box> boxes{kDomain};
  for (int cut = 0; cut < 40; ++cut) {
    const std::size_t i = random() % boxes.size();
    Box low = boxes[i];
    Box high = boxes[i];
    const auto at = [&](std::int64_t lo, std::int64_t hi) {
      return lo + 1 + static_cast<std::int64_t>(random()) % (hi - lo - 1);
    };
    const Index3 e = low.extent();
    switch (random() % 3) {
      case 0:
        if (e.x > 1) low.hi.x = high.lo.x = at(low.lo.x, low.hi.x);
        break;
      case 1:
        if (e.y > 1) low.hi.y = high.lo.y = at(low.lo.y, low.hi.y);
        break;
      default:
        if (e.z > 1) low.hi.z = high.lo.z = at(low.lo.z, low.hi.z);
    }
    if (low == high) continue;
    boxes[i] = low;
    boxes.push_back(high);
  }
  std::ranges::shuffle(boxes, random);
  for (const Box& box : boxes) write(box);
  EXPECT_EQ(std::ranges::count(states(), State::absent), 0);
  expect_reads_everything();
}

TEST_F(LeafSpoolTest, ParkedBytesReadBackUntilTheLeavesAreWritten) {
  const std::vector<std::byte> parked(spool_.leaf_bytes(), std::byte{9});
  spool_.park(6, 17, parked);
  std::vector<std::byte> back(parked.size());
  spool_.unpark(6, 17, back);
  EXPECT_EQ(back, parked);
  EXPECT_EQ(std::ranges::count(states(), State::absent), spool_.leaves().size());
  write(kDomain);
  expect_reads(kDomain);
}

TEST_F(LeafSpoolTest, ReadsOnlyTheStoredLeavesOfABox) {
  write(kDomain);
  const auto source = open_spool(spool_, info_);
  std::vector<float> read(64);
  const Box constant{{8, 8, 8}, {12, 12, 12}};
  source->read(constant, read);
  EXPECT_EQ(source->bytes_read(), 0U);
  // The leaf at index 24 has 8 voxels along x in the domain, and the last leaf has 5.
  source->read({{24, 8, 8}, {25, 9, 9}}, std::span(read).first(1));
  EXPECT_EQ(source->bytes_read(), 4096U);
  std::vector<float> row(13);
  source->read({{24, 8, 8}, {37, 9, 9}}, row);
  EXPECT_EQ(source->bytes_read(), 4096U + 4096U + 5 * 64 * 8U);
}

TEST_F(LeafSpoolTest, RefusesToReadWhatWasNeverWritten) {
  write({{-5, 3, 6}, {37, 30, 24}});
  const auto source = open_spool(spool_, info_);
  std::vector<float> read(2);
  try {
    source->read({{0, 5, 23}, {1, 6, 25}}, read);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::internal);
    EXPECT_STREQ(error.what(), "density: leaf 1,0,3 is read from the spool before it was written");
  }
  try {
    source->read({{0, 0, 8}, {1, 1, 9}}, std::span(read).first(1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "density: read of box 0:1,0:1,8:9 into 1 values does not fit -5:37,3:30,6:25");
  }
}

}  // namespace
}  // namespace weir::leaf_spool_test
