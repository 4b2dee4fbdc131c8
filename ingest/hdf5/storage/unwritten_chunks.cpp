#include "ingest/hdf5/storage/unwritten_chunks.h"

#include <algorithm>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/chunk_store.h"

namespace weir {
namespace {

// More are not looked up one by one: a damaged file may say any number.
constexpr std::uint64_t kMostLookedUp = std::uint64_t{1} << 16U;

// Of the whole dataset.
UnwrittenChunks count_all(hid_t dataset, const Storage& storage, const std::string& where) {
  const Hdf5Handle space(H5Dget_space(dataset));
  std::vector<hsize_t> extent(storage.chunk.size());
  hsize_t written = 0;
  if (H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr) != static_cast<int>(extent.size()) ||
      H5Dget_num_chunks(dataset, space.get(), &written) < 0) {
    throw hdf5_error(where, "its chunks cannot be counted, the file is damaged or being written");
  }
  UnwrittenChunks unwritten;
  unwritten.all = 1;
  for (std::size_t axis = 0; axis < extent.size(); ++axis) {
    unwritten.all *= (extent[axis] + storage.chunk[axis] - 1) / storage.chunk[axis];
  }
  unwritten.count = unwritten.all - std::min<std::uint64_t>(written, unwritten.all);
  return unwritten;
}

bool is_written(hid_t dataset, const std::vector<hsize_t>& corner, const std::string& where) {
  hsize_t bytes = 0;
  if (H5Dget_chunk_storage_size(dataset, corner.data(), &bytes) >= 0) return bytes > 0;
  if (hdf5_reason() == kNotAllocated) return false;
  throw hdf5_error(cat(where, ": chunk at ", corner_text(corner)),
                   "cannot be found, the file is damaged or being written");
}

}  // namespace

UnwrittenChunks unwritten_chunks(hid_t dataset, const Storage& storage, std::span<const hsize_t> low,
                                 std::span<const hsize_t> high, const std::string& where) {
  const UnwrittenChunks of_dataset = count_all(dataset, storage, where);
  if (of_dataset.count == 0) return of_dataset;
  std::vector<hsize_t> begin(low.begin(), low.end());
  std::uint64_t chunks = 1;
  for (std::size_t axis = 0; axis < begin.size(); ++axis) {
    begin[axis] -= begin[axis] % storage.chunk[axis];
    chunks *= (high[axis] - begin[axis] + storage.chunk[axis] - 1) / storage.chunk[axis];
  }
  if (chunks > kMostLookedUp) return of_dataset;
  UnwrittenChunks unwritten;
  std::vector<hsize_t> corner = begin;
  for (bool more = true; more;) {
    ++unwritten.all;
    if (!is_written(dataset, corner, where)) {
      if (unwritten.count++ == 0) unwritten.first = corner;
    }
    more = false;
    for (std::size_t axis = corner.size(); axis > 0 && !more; --axis) {
      corner[axis - 1] += storage.chunk[axis - 1];
      more = corner[axis - 1] < high[axis - 1];
      if (!more) corner[axis - 1] = begin[axis - 1];
    }
  }
  return unwritten;
}

}  // namespace weir
