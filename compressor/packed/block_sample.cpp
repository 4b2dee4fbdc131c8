#include "compressor/packed/block_sample.h"

#include <algorithm>
#include <cstdint>

namespace weir {

BlockSample::BlockSample(const NodeLattice& leaves) : count_(leaves.count) {
  constexpr std::int64_t kPart = 64;  // one block in so many
  constexpr std::int64_t kLeast = 1024;
  constexpr std::int64_t kMost = 8192;
  rows_along_x_ = (count_.x + kLongestRow - 1) / kLongestRow;
  row_length_ = ceil_div(count_.x, rows_along_x_);
  const std::int64_t all = rows_along_x_ * count_.y * count_.z;
  const std::int64_t blocks = std::clamp(leaves.size() / kPart, kLeast, kMost);
  const std::int64_t wanted = std::min(all, ceil_div(blocks, row_length_));
  // The order of rows is divided into `wanted` equal parts. One row of each part is sampled, at places that do not
  // repeat along y.
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
  for (std::int64_t part = 0; part < wanted; ++part) {
    const std::int64_t begin = part * all / wanted;
    const std::int64_t end = (part + 1) * all / wanted;
    const std::uint64_t fraction = static_cast<std::uint64_t>(part) * kGolden >> 32U;  // of 2^32
    const auto width = static_cast<std::uint64_t>(end - begin);
    places_.push_back(begin + static_cast<std::int64_t>(width * fraction >> 32U));
  }
}

bool BlockSample::has(const Index3& leaf) const {
  const std::int64_t place = leaf.x / row_length_ + rows_along_x_ * (leaf.y + count_.y * leaf.z);
  return std::binary_search(places_.begin(), places_.end(), place);
}

Box BlockSample::row_at(std::int64_t place) const {
  const Index3 row = index_at(place, {rows_along_x_, count_.y, count_.z});
  const Index3 lo{row.x * row_length_, row.y, row.z};
  return {lo, {std::min(lo.x + row_length_, count_.x), lo.y + 1, lo.z + 1}};
}

std::vector<Box> BlockSample::rows() const {
  std::vector<Box> rows;
  rows.reserve(places_.size());
  for (const std::int64_t place : places_) rows.push_back(row_at(place));
  return rows;
}

std::int64_t BlockSample::size() const {
  std::int64_t blocks = 0;
  for (const Box& row : rows()) blocks += row.voxels();
  return blocks;
}

}  // namespace weir
