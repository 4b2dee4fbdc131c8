#include "ingest/hdf5/storage/unwritten_chunks.h"

#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/chunk_store.h"

namespace weir {
namespace {

// More are not looked up one by one: a damaged file may say any number.
constexpr std::uint64_t kMostLookedUp = std::uint64_t{1} << 16U;

}  // namespace

UnwrittenChunks unwritten_chunks(hid_t dataset, const Storage& storage, std::span<const std::int64_t> leading,
                                 const std::string& where) {
  const std::vector<hsize_t>& chunk = storage.chunk;
  const std::size_t rank = chunk.size();
  const Hdf5Handle space(H5Dget_space(dataset));
  std::vector<hsize_t> extent(rank);
  hsize_t written = 0;
  if (H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr) != static_cast<int>(rank) ||
      H5Dget_num_chunks(dataset, space.get(), &written) < 0) {
    throw hdf5_error(where, kUncountedChunks);
  }
  std::uint64_t all = 1;
  std::uint64_t of_part = 1;
  std::vector<hsize_t> begin(rank);  // first elements of the part's first chunk
  for (std::size_t axis = 0; axis < rank; ++axis) {
    const hsize_t chunks = (extent[axis] + chunk[axis] - 1) / chunk[axis];
    all *= chunks;
    if (axis < leading.size()) {
      begin[axis] = static_cast<hsize_t>(leading[axis]) / chunk[axis] * chunk[axis];
    } else {
      of_part *= chunks;
    }
  }
  if (written >= all) return {0, all, {}};
  if (of_part > kMostLookedUp) return {all - written, all, {}};
  UnwrittenChunks unwritten;
  unwritten.all = of_part;
  std::vector<hsize_t> corner = begin;
  for (std::uint64_t i = 0; i < of_part; ++i) {
    if (stored_chunk_bytes(dataset, corner, where) == 0 && unwritten.count++ == 0) unwritten.first = corner;
    for (std::size_t axis = rank; axis > leading.size(); --axis) {
      corner[axis - 1] += chunk[axis - 1];
      if (corner[axis - 1] < extent[axis - 1]) break;
      corner[axis - 1] = 0;
    }
  }
  return unwritten;
}

}  // namespace weir
