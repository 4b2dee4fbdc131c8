// The value that a region's blocks without a stream share, against the rule of packed_region.h evaluated step by step,
// without its short cuts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "compressor/leaf/certificate.h"
#include "compressor/leaf/leaf_summary.h"
#include "compressor/select/packed_region.h"

namespace weir::shared_values_test {
namespace {

const Index3 kBlocks{5, 4, 3};

struct Region {
  std::vector<LeafRow> rows;
  std::vector<PackedLadder> ladders;
};

std::uint64_t weight(const LeafRow& row) { return row.finite == 0 ? 512 : row.finite; }

// Blocks of one value, of nearly one value, of other values, of voxels without a value, in random shares.
Region random_region(std::mt19937& random, bool has_rungs) {
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<>(low, high)(random));
  };
  // Half of the kinds are absent, and one often dominates.
  std::array<float, 5> shares{};
  for (float& share : shares) share = uniform(0, 1) < 0.5F ? 0 : std::pow(uniform(0.1, 1), 4.0F);
  shares[3] += 1e-3F;
  std::discrete_distribution<int> kind(shares.begin(), shares.end());
  const float noise = std::pow(10.0F, uniform(-7, 0));
  const float level = uniform(-3, 3);
  Region region;
  for (std::int64_t block = 0; block < volume(kBlocks); ++block) {
    std::vector<float> values(uniform(0, 1) < 0.1F ? 64 : 512);  // fewer: at a border of the domain
    switch (kind(random)) {
      case 0:  // the background
        break;
      case 1:  // one of a few values
        std::ranges::fill(values, static_cast<float>(std::uniform_int_distribution<>(1, 3)(random)));
        break;
      case 2:  // nearly one value
        for (float& value : values) value = level + noise * uniform(-1, 1);
        break;
      case 3:  // anything
        for (float& value : values) value = level + uniform(-1, 1);
        break;
      default:  // without a value, some or all
        for (float& value : values) value = uniform(0, 1) < 0.7F ? std::numeric_limits<float>::quiet_NaN() : level;
        if (uniform(0, 1) < 0.5F) std::ranges::fill(values, std::numeric_limits<float>::quiet_NaN());
    }
    region.rows.push_back(summarize_leaf(values, 0));
  }
  region.ladders.resize(region.rows.size());
  for (PackedLadder& ladder : region.ladders) ladder.count = has_rungs ? 1 : 0;
  return region;
}

float expected(const Region& region, const Fill& fill, const SharedUse& use) {
  const std::vector<LeafRow>& rows = region.rows;
  const bool fills = fill.non_finite != NonFinitePolicy::keep;
  std::map<std::uint32_t, int> uniform;
  CompensatedSum sum;
  std::uint64_t finite = 0;
  std::uint64_t all = 0;
  for (const LeafRow& row : rows) {
    if (row.uniform()) ++uniform[std::bit_cast<std::uint32_t>(row.mean)];
    if (row.finite == 0 && fills) ++uniform[std::bit_cast<std::uint32_t>(fill.background)];
    sum.add(static_cast<double>(row.mean) * row.finite);
    finite += row.finite;
    all += weight(row);
  }
  const float mean = finite == 0 ? fill.background : static_cast<float>(sum.value() / static_cast<double>(finite));
  std::optional<float> commonest;
  const auto most = std::ranges::max_element(uniform, [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != uniform.end()) commonest = std::bit_cast<float>(most->first);
  if (use.weighed) return commonest.value_or(mean);

  const bool exact = !use.max_error && region.ladders.front().count == 0;
  CompensatedSum about_mean;
  for (const LeafRow& row : rows) about_mean.add(row.sse_about(mean));
  const double small = about_mean.value() / static_cast<double>(64 * all);
  const auto spared = [&](float value) {
    std::uint64_t voxels = 0;
    for (const LeafRow& row : rows) {
      const bool does = row.finite == 0 ? fills && Fill::same_bits(fill.background, value)
                        : use.max_error ? row.max_abs_about(value) <= *use.max_error
                        : exact         ? Fill::keeps_values(row, value)
                                        : row.sse_about(value) <= small * row.finite;
      if (does) voxels += weight(row);
    }
    return voxels;
  };
  if (commonest && 2 * spared(*commonest) >= all) return *commonest;
  std::vector<std::pair<float, std::uint64_t>> means;
  for (const LeafRow& row : rows) {
    if (row.finite > 0) means.emplace_back(row.mean, row.finite);
  }
  std::ranges::sort(means);
  float median = fill.background;
  std::uint64_t below = 0;
  for (const auto& [value, voxels] : means) {
    below += voxels;
    if (2 * below < finite) continue;
    median = value;
    break;
  }
  if (8 * spared(median) >= 7 * all) return median;
  const bool strict = use.max_error || exact;
  return commonest && (strict || 128 * spared(*commonest) >= all) ? *commonest : mean;
}

TEST(SharedValues, AreThoseOfTheRule) {
  std::mt19937 random(7);
  const Box box{{0, 0, 0}, kBlocks};
  const NodeLattice leaves = make_lattice({{0, 0, 0}, kBlocks * kLeafDim}, kLeafDim);
  std::map<std::string, int> seen;
  for (int trial = 0; trial < 2000; ++trial) {
    const Region region = random_region(random, trial % 3 != 0);
    for (const NonFinitePolicy policy : {NonFinitePolicy::background, NonFinitePolicy::keep}) {
      const Fill fill{FillMode::mean, 0.0F, policy};
      const RegionRows rows(region.rows.data(), kBlocks, box, nullptr, region.ladders.data());
      for (const SharedUse& use : {SharedUse{}, SharedUse{{}, true}, SharedUse{0.0}, SharedUse{1e-4}, SharedUse{0.9}}) {
        const float value = shared_values(rows, leaves, fill, use).value;
        const float wanted = expected(region, fill, use);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(value), std::bit_cast<std::uint32_t>(wanted))
            << trial << ": " << value << ", not " << wanted;
        const bool is_uniform = std::ranges::any_of(
            region.rows, [&](const LeafRow& row) { return row.uniform() && Fill::same_bits(row.mean, value); });
        const bool is_mean = std::ranges::any_of(region.rows, [&](const LeafRow& row) { return row.mean == value; });
        ++seen[is_uniform ? "uniform" : is_mean ? "median" : "mean"];
      }
    }
  }
  for (const char* kind : {"uniform", "median", "mean"}) EXPECT_GT(seen[kind], 100) << kind;
}

}  // namespace
}  // namespace weir::shared_values_test
