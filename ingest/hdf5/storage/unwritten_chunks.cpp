#include "ingest/hdf5/storage/unwritten_chunks.h"

#include <algorithm>
#include <limits>

#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/chunk_store.h"

namespace weir {
namespace {

// The most chunks that are looked up one by one, which takes some seconds. A damaged file may state any number of
// chunks.
constexpr std::uint64_t kMostLookedUp = std::uint64_t{1} << 20U;

std::vector<hsize_t> extent_of(hid_t space, std::size_t rank) {
  std::vector<hsize_t> extent(rank);
  if (H5Sget_simple_extent_ndims(space) != static_cast<int>(rank)) return {};
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return extent;
}

// Returns how many chunks of `chunk` elements have elements in the range, at most the largest 64-bit number.
std::uint64_t chunks_in(const ElementRange& range, const std::vector<hsize_t>& chunk) {
  std::uint64_t count = 1;
  for (std::size_t axis = 0; axis < chunk.size(); ++axis) {
    const hsize_t along = (range.hi[axis] - 1) / chunk[axis] - range.lo[axis] / chunk[axis] + 1;
    if (__builtin_mul_overflow(count, std::uint64_t{along}, &count)) return std::numeric_limits<std::uint64_t>::max();
  }
  return count;
}

/// Counts the unwritten chunks among those that have elements in `range` and that `counts` accepts by their first
/// element.
template <typename Counts>
UnwrittenChunks unwritten_in(hid_t dataset, const std::vector<hsize_t>& chunk, const ElementRange& range,
                             const Counts& counts, const std::string& where) {
  const std::size_t rank = chunk.size();
  const Hdf5Handle space(H5Dget_space(dataset));
  const ElementRange whole{std::vector<hsize_t>(rank), extent_of(space.get(), rank)};
  hsize_t written = 0;
  if (whole.hi.empty() || H5Dget_num_chunks(dataset, space.get(), &written) < 0) {
    throw hdf5_error(where, kUncountedChunks);
  }
  const std::uint64_t all = chunks_in(whole, chunk);
  const std::uint64_t in_range = chunks_in(range, chunk);
  if (written >= all) return {0, all, {}};
  if (in_range > kMostLookedUp) return {all - written, all, {}, in_range < all};
  std::vector<hsize_t> begin(rank);  // first elements of the range's first chunk
  for (std::size_t axis = 0; axis < rank; ++axis) begin[axis] = range.lo[axis] / chunk[axis] * chunk[axis];
  UnwrittenChunks unwritten;
  std::vector<hsize_t> corner = begin;
  for (std::uint64_t i = 0; i < in_range; ++i) {
    if (counts(corner)) {
      ++unwritten.all;
      if (stored_chunk_bytes(dataset, corner, where) == 0 && unwritten.count++ == 0) unwritten.first = corner;
    }
    for (std::size_t axis = rank; axis-- > 0;) {
      corner[axis] += chunk[axis];
      if (corner[axis] < range.hi[axis]) break;
      corner[axis] = begin[axis];
    }
  }
  return unwritten;
}

}  // namespace

UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, const ElementRange& range,
                                 const std::string& where) {
  return unwritten_in(
      dataset, chunk, range, [](const std::vector<hsize_t>&) { return true; }, where);
}

UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, hid_t selected,
                                 const std::string& where) {
  ElementRange range{std::vector<hsize_t>(chunk.size()), std::vector<hsize_t>(chunk.size())};
  H5Sget_select_bounds(selected, range.lo.data(), range.hi.data());
  for (hsize_t& hi : range.hi) ++hi;
  const auto has_selected = [&](const std::vector<hsize_t>& corner) {
    std::vector<hsize_t> last = corner;
    for (std::size_t axis = 0; axis < last.size(); ++axis) {
      last[axis] = std::min(corner[axis] + chunk[axis], range.hi[axis]) - 1;
    }
    return H5Sselect_intersect_block(selected, corner.data(), last.data()) > 0;
  };
  return unwritten_in(dataset, chunk, range, has_selected, where);
}

}  // namespace weir
