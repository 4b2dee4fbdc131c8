#include "ingest/hdf5/virtual/selection_blocks.h"

#include <utility>

namespace weir {
namespace {

struct Regular {
  explicit Regular(std::size_t rank) : start(rank), stride(rank), count(rank), block(rank) {}

  std::vector<hsize_t> start;
  std::vector<hsize_t> stride;
  std::vector<hsize_t> count;
  std::vector<hsize_t> block;
};

std::optional<std::vector<AxisBox>> regular_blocks(Regular slab, std::size_t most) {
  const std::size_t rank = slab.start.size();
  std::size_t total = 1;
  for (std::size_t axis = 0; axis < rank; ++axis) {
    if (slab.count[axis] > 1 && slab.stride[axis] == slab.block[axis]) {
      slab.block[axis] *= slab.count[axis];
      slab.count[axis] = 1;
    }
    if (slab.count[axis] == 0 || slab.count[axis] > most / total) return std::nullopt;
    total *= slab.count[axis];
  }
  std::vector<AxisBox> blocks;
  for (std::size_t i = 0; i < total; ++i) {
    AxisBox box{slab.start, slab.start};
    std::size_t rest = i;
    for (std::size_t axis = rank; axis-- > 0;) {
      box.lo[axis] += rest % slab.count[axis] * slab.stride[axis];
      box.hi[axis] = box.lo[axis] + slab.block[axis];
      rest /= slab.count[axis];
    }
    blocks.push_back(std::move(box));
  }
  return blocks;
}

}  // namespace

std::optional<std::vector<AxisBox>> selection_blocks(hid_t space, std::size_t most) {
  const int axes = H5Sget_simple_extent_ndims(space);
  if (axes <= 0) return std::nullopt;
  const auto rank = static_cast<std::size_t>(axes);
  Regular slab(rank);
  if (H5Sis_regular_hyperslab(space) > 0) {
    if (H5Sget_regular_hyperslab(space, slab.start.data(), slab.stride.data(), slab.count.data(), slab.block.data()) <
        0) {
      return std::nullopt;
    }
    return regular_blocks(std::move(slab), most);
  }
  const hssize_t count = H5Sget_select_hyper_nblocks(space);
  if (count < 0 || static_cast<std::size_t>(count) > most) return std::nullopt;
  // The first and last element of each block.
  std::vector<hsize_t> corners(static_cast<std::size_t>(count) * 2 * rank);
  if (H5Sget_select_hyper_blocklist(space, 0, static_cast<hsize_t>(count), corners.data()) < 0) return std::nullopt;
  std::vector<AxisBox> blocks;
  for (auto at = corners.begin(); at != corners.end(); at += 2 * axes) {
    AxisBox box{{at, at + axes}, {at + axes, at + 2 * axes}};
    for (hsize_t& hi : box.hi) ++hi;
    blocks.push_back(std::move(box));
  }
  return blocks;
}

}  // namespace weir
