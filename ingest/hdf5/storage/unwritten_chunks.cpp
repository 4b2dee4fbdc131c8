#include "ingest/hdf5/storage/unwritten_chunks.h"

#include <algorithm>

#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/chunk_store.h"

namespace weir {
namespace {

// More are not looked up one by one: a damaged file may say any number.
constexpr std::uint64_t kMostLookedUp = std::uint64_t{1} << 16U;

std::vector<hsize_t> extent_of(hid_t space, std::size_t rank) {
  std::vector<hsize_t> extent(rank);
  if (H5Sget_simple_extent_ndims(space) != static_cast<int>(rank)) return {};
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return extent;
}

/// Elements from `lo` to `hi`, exclusive, of a dataset whose chunks have `chunk` elements.
struct ChunkedRange {
  const std::vector<hsize_t>& chunk;
  std::vector<hsize_t> lo;
  std::vector<hsize_t> hi;
};

/// Of the chunks that have elements in `range` those that `counts` takes by their first element.
template <typename Counts>
UnwrittenChunks unwritten_in(hid_t dataset, const ChunkedRange& range, const Counts& counts, const std::string& where) {
  const std::vector<hsize_t>& chunk = range.chunk;
  const std::size_t rank = chunk.size();
  const Hdf5Handle space(H5Dget_space(dataset));
  const std::vector<hsize_t> extent = extent_of(space.get(), rank);
  hsize_t written = 0;
  if (extent.empty() || H5Dget_num_chunks(dataset, space.get(), &written) < 0) {
    throw hdf5_error(where, kUncountedChunks);
  }
  std::uint64_t all = 1;
  std::uint64_t in_range = 1;
  std::vector<hsize_t> begin(rank);  // first elements of the range's first chunk
  for (std::size_t axis = 0; axis < rank; ++axis) {
    all *= (extent[axis] + chunk[axis] - 1) / chunk[axis];
    begin[axis] = range.lo[axis] / chunk[axis] * chunk[axis];
    in_range *= (range.hi[axis] - begin[axis] + chunk[axis] - 1) / chunk[axis];
  }
  if (written >= all) return {0, all, {}};
  if (in_range > kMostLookedUp) return {all - written, all, {}};
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

UnwrittenChunks unwritten_chunks(hid_t dataset, const Storage& storage, std::span<const std::int64_t> leading,
                                 const std::string& where) {
  const Hdf5Handle space(H5Dget_space(dataset));
  ChunkedRange range{storage.chunk, std::vector<hsize_t>(storage.chunk.size()),
                     extent_of(space.get(), storage.chunk.size())};
  for (std::size_t axis = 0; axis < std::min(leading.size(), range.hi.size()); ++axis) {
    range.lo[axis] = static_cast<hsize_t>(leading[axis]);
    range.hi[axis] = range.lo[axis] + 1;
  }
  return unwritten_in(
      dataset, range, [](const std::vector<hsize_t>&) { return true; }, where);
}

UnwrittenChunks unwritten_chunks(hid_t dataset, const std::vector<hsize_t>& chunk, hid_t selected,
                                 const std::string& where) {
  ChunkedRange range{chunk, std::vector<hsize_t>(chunk.size()), std::vector<hsize_t>(chunk.size())};
  H5Sget_select_bounds(selected, range.lo.data(), range.hi.data());
  for (hsize_t& hi : range.hi) ++hi;
  const auto has_selected = [&](const std::vector<hsize_t>& corner) {
    std::vector<hsize_t> last = corner;
    for (std::size_t axis = 0; axis < last.size(); ++axis) {
      last[axis] = std::min(corner[axis] + chunk[axis], range.hi[axis]) - 1;
    }
    return H5Sselect_intersect_block(selected, corner.data(), last.data()) > 0;
  };
  return unwritten_in(dataset, range, has_selected, where);
}

}  // namespace weir
