#include "ingest/hdf5/storage/chunk_reader.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/space_axis.h"
#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {
namespace {

/// HDF5's own limit is 2^32 - 1. This limit leaves room for chunks that grow while they pass through filters.
constexpr std::uint64_t kMostChunkBytes = (std::uint64_t{1} << 32U) - (std::uint64_t{1} << 25U);

std::size_t chunk_bytes_of(const ChunkStore& store, ScalarType type) {
  std::uint64_t bytes = scalar_bytes(type);
  for (const hsize_t elements : store.layout().chunk) {
    if (elements == 0 || elements > kMostChunkBytes / bytes) {
      throw Error(ErrorKind::input, cat(store.name(), ": its chunks have ", corner_text(store.layout().chunk),
                                        " elements, more than ", kMostChunkBytes, " bytes; the file is damaged"));
    }
    bytes *= elements;
  }
  return static_cast<std::size_t>(bytes);
}

/// Returns the elements along the three axes after the leading axes.
Index3 volume_axes(const ChunkedSlice& slice, const std::vector<hsize_t>& elements) {
  const auto at = [&](std::size_t axis) { return static_cast<std::int64_t>(elements[slice.index.size() + axis]); };
  return {at(2), at(1), at(0)};
}

/// Checks the conditions that ChunkedSlice documents. All code below relies on them.
void check_slice(const ChunkedSlice& slice, const std::vector<hsize_t>& chunk) {
  const bool vectors = slice.components.count > 1;
  if (chunk.size() == slice.index.size() + kSpaceAxes + (vectors ? 1 : 0) &&
      slice.fill.size() == scalar_bytes(slice.type)) {
    return;
  }
  throw Error(ErrorKind::internal,
              cat(slice.name, ": ", slice.index.size(), " positions and ", slice.components.count, " components for ",
                  chunk.size(), " axes, fill value of ", slice.fill.size(), " bytes"));
}

/// Returns the bytes before the slice in a chunk that is several elements thick along leading axes.
std::size_t slice_offset(const ChunkedSlice& slice, const std::vector<hsize_t>& chunk,
                         const ChunkComponents& components) {
  std::size_t position = 0;
  for (std::size_t axis = 0; axis < slice.index.size(); ++axis) {
    position = position * chunk[axis] + static_cast<std::size_t>(slice.index[axis]) % chunk[axis];
  }
  return position * static_cast<std::size_t>(volume(volume_axes(slice, chunk)) * components.in_chunk) *
         scalar_bytes(slice.type);
}

/// Checks the slice, too.
ChunkComponents components_of(const ChunkedSlice& slice, const std::vector<hsize_t>& chunk) {
  check_slice(slice, chunk);
  return chunk_components(slice.components, slice.components.count > 1 ? static_cast<std::int64_t>(chunk.back()) : 1);
}

std::size_t gathered_bytes(const ChunkedSlice& slice, const ChunkStore& store, const ChunkComponents& components) {
  if (!components.gathers()) return 0;
  const auto voxels = static_cast<std::size_t>(volume(volume_axes(slice, store.layout().chunk)));
  return voxels * components.voxel_bytes(scalar_bytes(slice.type));
}

ScratchSize scratch_size(const ChunkedSlice& slice, const ChunkStore& store, const ChunkComponents& components,
                         std::size_t chunk_bytes) {
  return {chunk_bytes, most_stored_bytes(store.pipeline(), chunk_bytes), needs_other_buffer(store.pipeline()), 0,
          gathered_bytes(slice, store, components)};
}

ChunkedVolume chunked_volume(const ChunkedSlice& slice, const ChunkLayout& layout, const ChunkComponents& components) {
  return {slice.name,
          volume_axes(slice, layout.extent),
          volume_axes(slice, layout.chunk),
          slice.type,
          slice.big_endian,
          slice.mapping,
          components.read,
          slice.fill};
}

}  // namespace

bool ChunkReader::decodes(hid_t dataset) {
  const Hdf5Handle creation(H5Dget_create_plist(dataset));
  return own_pipeline(creation.get()).has_value();
}

ChunkReader::ChunkReader(ChunkedSlice slice, std::uint64_t memory)
    : slice_(std::move(slice)),
      store_(slice_.dataset, slice_.name),
      components_(components_of(slice_, store_.layout().chunk)),
      chunk_bytes_(chunk_bytes_of(store_, slice_.type)),
      scratch_(scratch_size(slice_, store_, components_, chunk_bytes_), memory, slice_.name),
      boxes_(chunked_volume(slice_, store_.layout(), components_), *this, scratch_),
      first_byte_(slice_offset(slice_, store_.layout().chunk, components_)) {}

ChunkCounts ChunkReader::counts() const { return {decoded_, unallocated_, bytes_read_}; }

std::vector<hsize_t> ChunkReader::corner_of(const Index3& chunk, std::int64_t component) const {
  const std::vector<hsize_t>& elements = store_.layout().chunk;
  const Index3& voxels = boxes_.volume().chunk;
  std::vector<hsize_t> corner(elements.size());
  for (std::size_t axis = 0; axis < slice_.index.size(); ++axis) {
    const auto at = static_cast<hsize_t>(slice_.index[axis]);
    corner[axis] = at - at % elements[axis];
  }
  const std::size_t first = slice_.index.size();
  corner[first] = static_cast<hsize_t>(chunk.z * voxels.z);
  corner[first + 1] = static_cast<hsize_t>(chunk.y * voxels.y);
  corner[first + 2] = static_cast<hsize_t>(chunk.x * voxels.x);
  if (slice_.components.count > 1) corner.back() = static_cast<hsize_t>(component);
  return corner;
}

std::span<const std::byte> ChunkReader::decode(const Index3& chunk, ChunkScratch& scratch) {
  if (!components_.gathers()) return decode_part(chunk, components_.first, scratch);
  const std::size_t bytes = gathered_bytes(slice_, store_, components_);
  ComponentGathering gathering(components_, slice_.fill, scratch.gathered.bytes().first(bytes));
  for (std::int64_t c = 0; c < components_.read.count; c += components_.in_chunk) {
    gathering.add(decode_part(chunk, c, scratch));
  }
  return gathering.gathered();
}

std::span<const std::byte> ChunkReader::decode_part(const Index3& chunk, std::int64_t component,
                                                    ChunkScratch& scratch) {
  const std::vector<hsize_t> corner = corner_of(chunk, component);
  const std::optional<ChunkStore::Chunk> stored = store_.fetch(corner, scratch.buffer.bytes());
  if (!stored && slice_.all_stored) {
    throw Error(ErrorKind::input, cat(slice_.name, ": chunk at ", corner_text(corner),
                                      ": is not in the file's index, which has as many as there must be; the file is "
                                      "damaged"));
  }
  if (!stored) {
    ++unallocated_;
    return {};
  }
  ++decoded_;
  bytes_read_ += stored->bytes;
  try {
    return undo_filters(store_.pipeline(), stored->left_out, chunk_bytes_, stored->bytes, scratch.buffer.bytes(),
                        scratch.other.bytes(), scratch.inflater)
        .subspan(first_byte_);
  } catch (const Error& error) {
    throw Error(error.kind(), compose(slice_.name, ": chunk at ", corner_text(corner), ": ", error.message(),
                                      "; the file is damaged"));
  }
}

}  // namespace weir
