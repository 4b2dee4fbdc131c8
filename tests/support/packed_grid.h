// Builds NanoVDB files with packed data field by field, for tests and fuzzers of readers, independently of what the
// compressor writes. Has only streams that need no entropy coder. The tree consists of root tiles of background.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "format/base/little_endian.h"
#include "format/nanovdb/grid_head.h"
#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/packed_chunk.h"
#include "format/packed/packed_layout.h"

namespace weir::test {

using PackedBytes = std::vector<std::byte>;

/// Returns a raw stream (kind 3) of 512 values at index x<<6 | y<<3 | z.
inline PackedBytes raw_stream(std::span<const float, 512> values) {
  PackedBytes stream(1 + values.size_bytes(), std::byte{3});
  std::memcpy(stream.data() + 1, values.data(), values.size_bytes());
  return stream;
}

/// Returns a stream (kind 3) of one value for all voxels.
inline PackedBytes constant_stream(float value) {
  PackedBytes stream(1 + sizeof value, std::byte{7});
  std::memcpy(stream.data() + 1, &value, sizeof value);
  return stream;
}

/// Returns a stream (kind 0) of the region's lowest mean at step field `step`. `code_bytes` is the length of its code.
inline PackedBytes mean_stream(unsigned step, std::size_t code_bytes) {
  PackedBytes stream(1 + code_bytes, std::byte{0});
  stream[0] = static_cast<std::byte>(step << 2U);
  return stream;
}

struct PackedGridOptions {
  Box domain;
  float background = 0;
  MinMax range{-1000, 1000};  ///< range of the values in the root and in the macrocells
  MeanRange means{0, 1};      ///< range of the means of every region
  std::int32_t coarsest = 0;
  bool preview = false;  ///< whether the flags announce a preview
  /// Returns the stream of the block at `block` (voxel / 8), which touches the domain; empty if it has no stream.
  std::function<PackedBytes(const Index3& block)> stream;
  /// Returns the value of the region at `region` (voxel / 128).
  std::function<float(const Index3& region)> value = [](const Index3&) { return 0.0F; };
};

struct PackedFile {
  PackedBytes file;
  std::uint64_t record = 0;                      ///< offset of the record of the packed data, from the file's start
  std::uint64_t packed = 0;                      ///< offset of the packed data, from the file's start
  std::uint64_t table = 0;                       ///< offset of the region table, from the file's start
  std::map<std::int64_t, std::uint64_t> chunks;  ///< offset of each chunk from the file's start, by the region's number
};

class PackedGridBuilder {
 public:
  static PackedFile build(const PackedGridOptions& options) {
    PackedGridBuilder builder(options);
    builder.data();
    builder.whole_file();
    return std::move(builder.made_);
  }

 private:
  explicit PackedGridBuilder(const PackedGridOptions& options)
      : options_(options), regions_(make_lattice(options.domain, kLowerDim)) {}

  template <typename T>
  void put(std::uint64_t offset, const T& value) {
    store(std::span(data_), offset, value);
  }
  template <typename T>
  void put3(std::uint64_t offset, const Index3& i) {
    put(offset, std::array{static_cast<T>(i.x), static_cast<T>(i.y), static_cast<T>(i.z)});
  }

  void data() {
    using namespace packed::header;
    const auto entries = static_cast<std::uint64_t>(regions_.size());
    data_.resize(packed::kRegionsOffset + entries * packed::region::kEntryBytes);
    put(packed::header::kVersion, packed::kVersion);
    put(kFlags, options_.preview ? kFlagPreview : 0U);
    put3<std::int32_t>(kFirstRegion, regions_.first);
    put3<std::uint32_t>(kRegionCount, regions_.count);
    put(kMinimum, options_.range.min);
    put(kMaximum, options_.range.max);
    put(kCoarsest, options_.coarsest);
    put(packed::header::kBelowOne, 0.1F);
    put(packed::header::kBelowMore, 0.05F);
    put(kTables, static_cast<std::uint32_t>(packed::kHeaderBytes));
    put(kTableCount, std::uint32_t{kPackedTables});
    put(kRegions, packed::kRegionsOffset);
    for (unsigned i = 0; i < kPackedTables * kPackedSymbols; ++i) {
      put(packed::kHeaderBytes + 2 * std::uint64_t{i}, static_cast<std::uint16_t>(i % kPackedSymbols * 256));
    }
    for (std::int64_t i = 0; i < regions_.size(); ++i) add_region(i);
    put(packed::header::kBytes, static_cast<std::uint64_t>(data_.size()));
  }

  void add_region(std::int64_t number) {
    const Index3 region = regions_.first + regions_.position(number);
    const std::uint64_t entry =
        packed::kRegionsOffset + static_cast<std::uint64_t>(number) * packed::region::kEntryBytes;
    put(entry + packed::region::kValue, options_.value(region));
    const PackedBytes chunk = chunk_of(region);
    if (chunk.empty()) return;
    put(entry + packed::region::kChunk, static_cast<std::uint64_t>(data_.size()));
    put(entry + packed::region::kChunkBytes, static_cast<std::uint32_t>(chunk.size()));
    made_.chunks[number] = data_.size();
    data_.insert(data_.end(), chunk.begin(), chunk.end());
  }

  // Returns the chunk of a region; empty if no block of the region has a stream.
  PackedBytes chunk_of(const Index3& region) const {
    using namespace packed::chunk;
    PackedBytes chunk(kGroups);
    store(std::span(chunk), kMeanLow, options_.means.low);
    store(std::span(chunk), kMeanHigh, options_.means.high);
    bool any = false;
    for (unsigned g = 0; g < kGroupCount; ++g) {
      store(std::span(chunk), kBases + 4 * std::uint64_t{g}, static_cast<std::uint32_t>(chunk.size()));
      any |= add_group(region, g, chunk);
    }
    chunk.resize((chunk.size() + kAlignment - 1) / kAlignment * kAlignment);
    store(std::span(chunk), kBases + 4 * kGroupCount, static_cast<std::uint32_t>(chunk.size()));
    return any ? chunk : PackedBytes{};
  }

  bool add_group(const Index3& region, unsigned group, PackedBytes& chunk) const {
    std::uint16_t mask = 0;
    std::vector<PackedBytes> streams;
    for (unsigned bit = 0; bit < packed::chunk::kGroupBlocks; ++bit) {
      const Index3 block = region * kLowerLeaves + packed_block(16 * group + bit);
      const Box voxels{block * kLeafDim, (block + Index3{1, 1, 1}) * kLeafDim};
      if (intersect(voxels, options_.domain).empty()) continue;
      PackedBytes stream = options_.stream ? options_.stream(block) : PackedBytes{};
      if (stream.empty()) continue;
      mask = static_cast<std::uint16_t>(mask | 1U << bit);
      streams.push_back(std::move(stream));
    }
    store(std::span(chunk), packed::chunk::kMasks + 2 * std::uint64_t{group}, mask);
    std::size_t end = packed::chunk::kEndBytes * streams.size();
    for (const PackedBytes& stream : streams) {
      end += stream.size();
      const auto stored = static_cast<std::uint16_t>(end);
      chunk.resize(chunk.size() + sizeof stored);
      store(std::span(chunk).last(sizeof stored), 0, stored);
    }
    for (const PackedBytes& stream : streams) chunk.insert(chunk.end(), stream.begin(), stream.end());
    return mask != 0;
  }

  void whole_file() {
    GridHead head;
    head.name = "packed";
    head.background = options_.background;
    head.statistics.bbox = options_.domain;
    head.statistics.min = options_.range.min;
    head.statistics.max = options_.range.max;
    const NodeLattice roots = make_lattice(options_.domain, kUpperDim);
    for_each_index({roots.first, roots.first + roots.count}, [&](const Index3& i) {
      head.tiles.push_back({i * kUpperDim, 0, false, options_.background});
    });
    NodeCounts counts;
    counts.root_tiles = head.tiles.size();
    counts.macrocells = static_cast<std::uint64_t>(make_lattice(options_.domain, kMacrocell).size());
    counts.packed_bytes = data_.size();
    const TreeLayout layout = make_layout(counts);
    PackedBytes& file = made_.file;
    file = encode_head(head, layout);
    file.resize(layout.file_bytes);
    const PackedBytes records = encode_blind_records(layout);
    std::memcpy(file.data() + layout.blind_meta, records.data(), records.size());
    for (std::uint64_t i = 0; i < counts.macrocells; ++i) {
      store(std::span(file), layout.blind_data + 8 * i, options_.range);
    }
    std::memcpy(file.data() + layout.packed_data, data_.data(), data_.size());
    made_.record = layout.blind_meta + nvdb::kBlindMetaBytes;
    made_.packed = layout.packed_data;
    made_.table = layout.packed_data + packed::kRegionsOffset;
    for (auto& [number, chunk] : made_.chunks) chunk += layout.packed_data;
  }

  const PackedGridOptions& options_;
  NodeLattice regions_;
  PackedBytes data_;
  PackedFile made_;
};

}  // namespace weir::test
