#include "ingest/hdf5/storage/chunk_reader.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/source/extent.h"
#include "ingest/values/decode_values.h"

namespace weir {
namespace {

constexpr std::size_t kVolumeAxes = 3;
/// HDF5's own limit is 2^32 - 1; what chunks can grow by on their way through filters stays below it too.
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

Index3 last_axes(const std::vector<hsize_t>& elements) {
  const auto at = [&](std::size_t from_end) { return static_cast<std::int64_t>(elements[elements.size() - from_end]); };
  return {at(1), at(2), at(3)};
}

/// Bytes before the slice in a chunk that is several thick along leading axes.
std::size_t slice_offset(const ChunkedSlice& slice, const std::vector<hsize_t>& chunk) {
  std::size_t position = 0;
  for (std::size_t axis = 0; axis < slice.index.size(); ++axis) {
    position = position * chunk[axis] + static_cast<std::size_t>(slice.index[axis]) % chunk[axis];
  }
  return position * static_cast<std::size_t>(volume(last_axes(chunk))) * scalar_bytes(slice.type);
}

ConversionLoss times(const ConversionLoss& loss, std::int64_t voxels) {
  const auto n = static_cast<std::uint64_t>(voxels);
  return {loss.inexact * n, loss.overflow * n, loss.max_abs_error};
}

/// Calls visit(first voxel of the run in `part`, voxels) for the longest runs of `part` that are contiguous
/// both in a chunk of `chunk` voxels and in `box`.
template <typename Visit>
void for_each_run(const Box& part, const Index3& chunk, const Box& box, const Visit& visit) {
  const Index3 e = part.extent();
  const std::int64_t rows = e.x == chunk.x && e.x == box.extent().x ? e.y : 1;
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int64_t y = part.lo.y; y < part.hi.y; y += rows) visit(Index3{part.lo.x, y, z}, e.x * rows);
  }
}

}  // namespace

bool ChunkReader::decodes(hid_t dataset) {
  const Hdf5Handle creation(H5Dget_create_plist(dataset));
  return own_pipeline(creation.get()).has_value();
}

ChunkReader::ChunkReader(ChunkedSlice slice, std::uint64_t memory)
    : slice_(std::move(slice)),
      store_(slice_.dataset, slice_.name),
      chunk_(last_axes(store_.layout().chunk)),
      chunk_bytes_(chunk_bytes_of(store_, slice_.type)),
      scratch_(store_.pipeline(), chunk_bytes_, memory, slice_.name) {
  if (store_.layout().chunk.size() != slice_.index.size() + kVolumeAxes ||
      slice_.fill.size() != scalar_bytes(slice_.type)) {
    throw Error(ErrorKind::internal,
                cat(slice_.name, ": ", slice_.index.size(), " positions for ", store_.layout().chunk.size(),
                    " axes, fill value of ", slice_.fill.size(), " bytes"));
  }
  first_byte_ = slice_offset(slice_, store_.layout().chunk);
  fill_loss_ = decode_values(slice_.fill, slice_.type, slice_.big_endian, slice_.mapping, {&fill_, 1});
}

AccessShape ChunkReader::access() const { return {scalar_bytes(slice_.type), chunk_, {}}; }

ChunkCounts ChunkReader::counts() const {
  const std::lock_guard lock(mutex_);
  return {decoded_, unallocated_, bytes_read_, threads_.size()};
}

std::vector<hsize_t> ChunkReader::corner_of(const Index3& chunk) const {
  const std::vector<hsize_t>& elements = store_.layout().chunk;
  std::vector<hsize_t> corner(elements.size());
  for (std::size_t axis = 0; axis < slice_.index.size(); ++axis) {
    const auto at = static_cast<hsize_t>(slice_.index[axis]);
    corner[axis] = at - at % elements[axis];
  }
  const std::size_t first = slice_.index.size();
  corner[first] = static_cast<hsize_t>(chunk.z * chunk_.z);
  corner[first + 1] = static_cast<hsize_t>(chunk.y * chunk_.y);
  corner[first + 2] = static_cast<hsize_t>(chunk.x * chunk_.x);
  return corner;
}

std::span<const std::byte> ChunkReader::decode(std::span<const hsize_t> corner, ChunkScratch& scratch) {
  const std::optional<ChunkStore::Chunk> stored = store_.fetch(corner, scratch.buffer.bytes());
  if (!stored) {
    ++unallocated_;
    return {};
  }
  ++decoded_;
  bytes_read_ += stored->bytes;
  try {
    return undo_filters(store_.pipeline(), stored->left_out, chunk_bytes_, stored->bytes, scratch.buffer.bytes(),
                        scratch.other.bytes(), scratch.inflater);
  } catch (const Error& error) {
    throw Error(error.kind(), compose(slice_.name, ": chunk at ", corner_text(corner), ": ", error.message(),
                                      "; the file is damaged"));
  }
}

ConversionLoss ChunkReader::read_chunk(const Index3& chunk, const Box& box, std::span<float> values,
                                       ChunkScratch& scratch) {
  const Index3 lo{chunk.x * chunk_.x, chunk.y * chunk_.y, chunk.z * chunk_.z};
  const Box part = intersect({lo, lo + chunk_}, box);
  const std::span<const std::byte> bytes = decode(corner_of(chunk), scratch);
  ConversionLoss loss;
  for_each_run(part, chunk_, box, [&](const Index3& first, std::int64_t voxels) {
    const auto count = static_cast<std::size_t>(voxels);
    const auto run = values.subspan(static_cast<std::size_t>(linear_index(first - box.lo, box.extent())), count);
    if (bytes.empty()) {
      std::ranges::fill(run, fill_);
      loss.add(times(fill_loss_, voxels));
      return;
    }
    const std::size_t value_bytes = scalar_bytes(slice_.type);
    const std::size_t at = first_byte_ + static_cast<std::size_t>(linear_index(first - lo, chunk_)) * value_bytes;
    loss.add(
        decode_values(bytes.subspan(at, count * value_bytes), slice_.type, slice_.big_endian, slice_.mapping, run));
  });
  return loss;
}

ConversionLoss ChunkReader::read(const Box& box, std::span<float> values) {
  const Box slice{{0, 0, 0}, last_axes(store_.layout().extent)};
  if (box.empty() || !slice.contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
    throw Error(ErrorKind::internal, cat(slice_.name, ": read of box ", box_text(box), " into ", values.size(),
                                         " values does not fit ", box_text(slice)));
  }
  const auto chunks_to = [](std::int64_t voxel, std::int64_t chunk) { return voxel / chunk; };
  const Index3 first{chunks_to(box.lo.x, chunk_.x), chunks_to(box.lo.y, chunk_.y), chunks_to(box.lo.z, chunk_.z)};
  const Index3 last{chunks_to(box.hi.x - 1, chunk_.x), chunks_to(box.hi.y - 1, chunk_.y),
                    chunks_to(box.hi.z - 1, chunk_.z)};
  const Index3 count = last - first + Index3{1, 1, 1};

  std::atomic<std::int64_t> next{0};
  ConversionLoss total;
  const auto lanes = std::min(static_cast<std::int64_t>(scratch_.size()), volume(count));
  tbb::parallel_for(std::int64_t{0}, lanes, [&](std::int64_t) {
    const ScratchPool::Lease scratch(scratch_);
    ConversionLoss loss;
    bool worked = false;
    try {
      for (std::int64_t i = next++; i < volume(count); i = next++) {
        loss.add(read_chunk(first + index_at(i, count), box, values, *scratch));
        worked = true;
      }
    } catch (...) {
      next = volume(count);  // the other lanes end too
      throw;
    }
    const std::lock_guard lock(mutex_);
    total.add(loss);
    if (worked) threads_.insert(std::this_thread::get_id());
  });
  return total;
}

}  // namespace weir
