#include "ingest/hdf5/filters/filter_pipeline.h"

#include <algorithm>
#include <array>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/chunks/unshuffle.h"
#include "ingest/hdf5/filters/library_lzf.h"
#include "ingest/hdf5/filters/undo_filters.h"

namespace weir {
namespace {

bool applied(FilterMask left_out, std::size_t i) { return i >= 32 || (left_out >> i & 1U) == 0; }

/// Returns the bytes of a chunk before filter `i` was applied; no filter before `i` is deflate or lzf.
std::size_t bytes_before(const FilterPipeline& pipeline, FilterMask left_out, std::size_t chunk_bytes, std::size_t i) {
  std::size_t bytes = chunk_bytes;
  for (std::size_t k = 0; k < i; ++k) {
    if (pipeline[k].kind == FilterKind::fletcher32 && applied(left_out, k)) bytes += kFletcher32Bytes;
  }
  return bytes;
}

}  // namespace

std::optional<FilterPipeline> own_pipeline(hid_t creation_properties) {
  const int count = H5Pget_nfilters(creation_properties);
  if (count < 0) return std::nullopt;
  FilterPipeline pipeline;
  bool packs = false;
  for (int i = 0; i < count; ++i) {
    std::array<unsigned, 8> parameters{};
    std::size_t parameter_count = parameters.size();
    unsigned flags = 0;
    const H5Z_filter_t id = H5Pget_filter2(creation_properties, static_cast<unsigned>(i), &flags, &parameter_count,
                                           parameters.data(), 0, nullptr, nullptr);
    if (id == H5Z_FILTER_DEFLATE && !std::exchange(packs, true)) {
      pipeline.push_back({FilterKind::deflate, 1});
    } else if (id == kLzfFilter && !std::exchange(packs, true)) {
      pipeline.push_back({FilterKind::lzf, 1});
    } else if (id == H5Z_FILTER_SHUFFLE && parameter_count == 1 && parameters[0] > 0) {
      pipeline.push_back({FilterKind::shuffle, parameters[0]});
    } else if (id == H5Z_FILTER_FLETCHER32) {
      pipeline.push_back({FilterKind::fletcher32, 1});
    } else {
      return std::nullopt;
    }
  }
  return pipeline;
}

std::size_t most_stored_bytes(const FilterPipeline& pipeline, std::size_t chunk_bytes) {
  std::size_t bytes = chunk_bytes;
  for (const ChunkFilter& filter : pipeline) {
    if (filter.kind == FilterKind::fletcher32) bytes += kFletcher32Bytes;
    // HDF5 gives deflate a buffer of 1.001 times the size plus 12 bytes. If that is too small, it leaves deflate out
    // for this chunk.
    if (filter.kind == FilterKind::deflate) bytes += bytes / 256 + 64;
  }
  return bytes;
}

bool needs_other_buffer(const FilterPipeline& pipeline) {
  return std::ranges::any_of(pipeline, [](const ChunkFilter& filter) { return filter.kind != FilterKind::fletcher32; });
}

std::span<const std::byte> undo_filters(const FilterPipeline& pipeline, FilterMask left_out, std::size_t chunk_bytes,
                                        std::size_t stored, std::span<std::byte> buffer, std::span<std::byte> other,
                                        ChunkInflater& inflater) {
  std::span<std::byte> bytes = buffer.first(stored);
  for (std::size_t i = pipeline.size(); i-- > 0;) {
    if (!applied(left_out, i)) continue;
    switch (pipeline[i].kind) {
      case FilterKind::fletcher32:
        bytes = check_fletcher32(bytes);
        continue;
      case FilterKind::deflate: {
        const std::span<std::byte> inflated = other.first(bytes_before(pipeline, left_out, chunk_bytes, i));
        inflater.inflate(bytes, inflated);
        bytes = inflated;
        break;
      }
      case FilterKind::lzf: {
        const std::span<std::byte> unpacked = other.first(bytes_before(pipeline, left_out, chunk_bytes, i));
        unpack_lzf(bytes, unpacked);
        bytes = unpacked;
        break;
      }
      case FilterKind::shuffle:
        unshuffle(bytes, pipeline[i].value_bytes, other);
        bytes = other.first(bytes.size());
        break;
    }
    std::swap(buffer, other);
  }
  if (bytes.size() != chunk_bytes) {
    throw Error(ErrorKind::input, cat("holds ", bytes.size(), " bytes, not ", chunk_bytes));
  }
  return bytes;
}

}  // namespace weir
