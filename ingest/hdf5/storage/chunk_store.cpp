#include "ingest/hdf5/storage/chunk_store.h"

#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/storage.h"

namespace weir {
namespace {

/// libhdf5 1.10 reports this as a failure, but it is an answer: the index was read and does not name the chunk. Later
/// versions return 0 bytes for such a chunk.
constexpr std::string_view kNotAllocated = "chunk storage is not allocated";

std::string chunk_place(const std::string& name, std::span<const hsize_t> corner) {
  return cat(name, ": chunk at ", corner_text(corner));
}

// Checks the lengths of chunks without filters. The library tells such a chunk's length by its extents, but reads as
// many bytes as the index says. Only a version 1 B-tree stores a length for each chunk; other indices store none.
void check_lengths(hid_t dataset, hid_t space, const std::vector<hsize_t>& chunk, const std::string& name) {
  H5D_chunk_index_t index = H5D_CHUNK_IDX_BTREE;
  H5Dget_chunk_index_type(dataset, &index);
  if (index != H5D_CHUNK_IDX_BTREE) return;
  const Hdf5Handle type(H5Dget_type(dataset));
  hsize_t chunks = 0;
  if (H5Dget_num_chunks(dataset, space, &chunks) < 0) throw hdf5_error(name, kUncountedChunks);
  hsize_t bytes = chunks * H5Tget_size(type.get());
  for (const hsize_t elements : chunk) bytes *= elements;
  const hsize_t by_index = H5Dget_storage_size(dataset);
  if (by_index == bytes) return;
  throw Error(ErrorKind::input, cat(name, ": its ", chunks, chunks == 1 ? " chunk takes " : " chunks take ", by_index,
                                    " bytes by the index, and must take ", bytes, "; the file is damaged"));
}

}  // namespace

bool ChunkLayout::is_partial(std::span<const hsize_t> corner) const {
  for (std::size_t axis = 0; axis < corner.size(); ++axis) {
    if (chunk[axis] > extent[axis] - corner[axis]) return true;
  }
  return false;
}

std::string corner_text(std::span<const hsize_t> corner) {
  std::string text;
  for (const hsize_t c : corner) text += cat(text.empty() ? "" : ", ", c);
  return text;
}

hsize_t stored_chunk_bytes(hid_t dataset, std::span<const hsize_t> corner, const std::string& name) {
  hsize_t bytes = 0;
  if (H5Dget_chunk_storage_size(dataset, corner.data(), &bytes) >= 0) return bytes;
  if (hdf5_reason() == kNotAllocated) return 0;
  throw hdf5_error(chunk_place(name, corner), "cannot be found, the file is damaged or being written");
}

ChunkStore::ChunkStore(hid_t dataset, std::string name)
    : dataset_(dataset), name_(std::move(name)), crash_line_(hdf5_crash_line(name_)) {
  const Hdf5Lock lock;
  const Hdf5Handle space(H5Dget_space(dataset_));
  const Hdf5Handle creation(H5Dget_create_plist(dataset_));
  const int rank = H5Sget_simple_extent_ndims(space.get());
  unsigned options = 0;
  if (rank > 0) {
    layout_.extent.resize(static_cast<std::size_t>(rank));
    layout_.chunk.resize(static_cast<std::size_t>(rank));
  }
  auto pipeline = own_pipeline(creation.get());
  if (rank <= 0 || H5Sget_simple_extent_dims(space.get(), layout_.extent.data(), nullptr) != rank ||
      H5Pget_chunk(creation.get(), rank, layout_.chunk.data()) != rank ||
      H5Pget_chunk_opts(creation.get(), &options) < 0 || !pipeline) {
    throw Error(ErrorKind::input, cat(name_, ": its chunks cannot be told; the file is damaged"));
  }
  layout_.partial_unfiltered = (options & H5D_CHUNK_DONT_FILTER_PARTIAL_CHUNKS) != 0;
  pipeline_ = std::move(*pipeline);
  if (pipeline_.empty()) check_lengths(dataset_, space.get(), layout_.chunk, name_);
}

std::optional<ChunkStore::Chunk> ChunkStore::fetch(std::span<const hsize_t> corner, std::span<std::byte> into) const {
  const auto where = [&] { return chunk_place(name_, corner); };
  const Hdf5ReadLock lock(crash_line_);
  // The library remembers the last chunk that it looked up, so both calls see the same chunk.
  const hsize_t bytes = stored_chunk_bytes(dataset_, corner, name_);
  if (bytes == 0) return std::nullopt;
  if (bytes > into.size()) {
    throw Error(ErrorKind::input, cat(where(), ": takes ", bytes, " bytes, and at most ", into.size(),
                                      " can be right; the file is damaged"));
  }
  Chunk chunk;
  chunk.bytes = static_cast<std::size_t>(bytes);
  if (H5Dread_chunk(dataset_, H5P_DEFAULT, corner.data(), &chunk.left_out, into.data()) < 0) {
    throw hdf5_error(where(), cat("its ", bytes, " bytes cannot be read, the file is cut short or damaged"));
  }
  if (layout_.partial_unfiltered && layout_.is_partial(corner)) chunk.left_out = kAllLeftOut;
  return chunk;
}

}  // namespace weir
