#include "format/nanovdb/packed_header.h"

#include <cmath>

#include "format/packed/block_steps.h"
#include "format/packed/packed_layout.h"

namespace weir {
namespace {

class PackedHeaderReader {
 public:
  explicit PackedHeaderReader(const NvdbBytes& data) : data_(data) {}

  PackedHeader read(const Box& bbox) {
    if (data_.size() < packed::kHeaderBytes) {
      data_.fail(0, "packed data of ", data_.size(), " bytes, less than its header's ", packed::kHeaderBytes);
    }
    if (bbox.empty()) data_.fail(0, "packed data of a grid without active voxels");
    size_and_version();
    regions(bbox);
    constants();
    tables();
    region_table();
    return header_;
  }

 private:
  void size_and_version() {
    const auto version = data_.get<std::uint32_t>(packed::header::kVersion);
    if (version != packed::kVersion) {
      data_.fail(packed::header::kVersion, "packed data of version ", version, ", and this weir reads version ",
                 packed::kVersion, "; use a newer one");
    }
    header_.bytes = data_.get<std::uint64_t>(packed::header::kBytes);
    if (header_.bytes != data_.size()) {
      data_.fail(packed::header::kBytes, "the packed data says ", header_.bytes, " bytes, its record ", data_.size());
    }
    const auto flags = data_.get<std::uint32_t>(packed::header::kFlags);
    if ((flags & ~packed::header::kFlagPreview) != 0)
      data_.fail(packed::header::kFlags, "unknown flags 0x", hex(flags, 8));
    header_.preview = (flags & packed::header::kFlagPreview) != 0;
  }

  void regions(const Box& bbox) {
    const NodeLattice lattice = make_lattice(bbox, kLowerDim);
    const auto first = triple<std::int32_t>(packed::header::kFirstRegion);
    const auto count = triple<std::uint32_t>(packed::header::kRegionCount);
    if (first != lattice.first) {
      data_.fail(packed::header::kFirstRegion, "the first region is ", text(first), ", the index box begins in ",
                 text(lattice.first));
    }
    if (count != lattice.count) {
      data_.fail(packed::header::kRegionCount, "there are ", text(count), " regions, the index box lies in ",
                 text(lattice.count));
    }
    header_.regions = lattice;
  }

  void constants() {
    BlockConstants& c = header_.values;
    c.minimum = finite(packed::header::kMinimum, "minimum");
    c.maximum = finite(packed::header::kMaximum, "maximum");
    if (c.minimum > c.maximum)
      data_.fail(packed::header::kMaximum, "maximum ", c.maximum, " is below minimum ", c.minimum);
    c.coarsest = data_.get<std::int32_t>(packed::header::kCoarsest);
    if (c.coarsest < kLeastStep || c.coarsest > kMostStep) {
      data_.fail(packed::header::kCoarsest, "the coarsest step is ", c.coarsest, ", it must be from ", kLeastStep,
                 " to ", kMostStep);
    }
    c.lattice_minimum = finite(packed::header::kLatticeMinimum, "lattice minimum");
    c.lattice_quantum = finite(packed::header::kLatticeQuantum, "lattice quantum");
    c.lattice_bits = data_.get<std::uint32_t>(packed::header::kLatticeBits);
    if (c.lattice_bits > kMostLatticeBits) {
      data_.fail(packed::header::kLatticeBits, "codes of ", c.lattice_bits, " bits on the lattice, at most ",
                 kMostLatticeBits);
    }
    c.below_one = finite(packed::header::kBelowOne, "recovery point");
    c.below_more = finite(packed::header::kBelowMore, "recovery point");
  }

  void tables() {
    const std::uint64_t at = data_.get<std::uint32_t>(packed::header::kTables);
    const auto count = data_.get<std::uint32_t>(packed::header::kTableCount);
    if (count != kPackedTables) {
      data_.fail(packed::header::kTableCount, count, " tables of frequencies instead of ", kPackedTables);
    }
    if (at < packed::kHeaderBytes || at % 4 != 0 || !data_.holds(at, packed::kTablesBytes)) {
      data_.fail(packed::header::kTables, "tables at offset ", at,
                 ", not a multiple of 4 between the header and the end at ", data_.size());
    }
    for (std::size_t i = 0; i < header_.frequencies.size(); ++i) {
      const auto entry = data_.get<std::uint16_t>(at + 2 * i);
      const bool first = i % kPackedSymbols == 0;
      if (first ? entry != 0 : entry <= header_.frequencies[i - 1] || entry >= kFrequencyTotal) {
        data_.fail(at + 2 * i, "cumulative frequency ", i % kPackedSymbols, " of table ", i / kPackedSymbols, " is ",
                   entry,
                   first ? ", not 0" : cat(", not between ", header_.frequencies[i - 1], " and ", kFrequencyTotal));
      }
      header_.frequencies[i] = entry;
    }
  }

  void region_table() {
    header_.table = data_.get<std::uint64_t>(packed::header::kRegions);
    const Index3 count = header_.regions.count;
    const std::uint64_t room =
        header_.table <= data_.size() ? (data_.size() - header_.table) / packed::region::kEntryBytes : 0;
    // The product of three counts may not fit 64 bits.
    const auto most = static_cast<std::int64_t>(room);
    if (header_.table < packed::kHeaderBytes || header_.table % 8 != 0 || count.x > most || count.y > most / count.x ||
        count.z > most / count.x / count.y) {
      data_.fail(packed::header::kRegions, "the region table at offset ", header_.table, " with ", text(count),
                 " entries does not lie between the header and the end at ", data_.size());
    }
    for (std::int64_t i = 0; i < header_.regions.size(); ++i) check_region(i);
  }

  void check_region(std::int64_t i) {
    const Index3 position = header_.regions.position(i);
    const PackedRegion entry = packed_region(data_, header_, position);
    const std::uint64_t at = header_.table + static_cast<std::uint64_t>(i) * packed::region::kEntryBytes;
    if (entry.chunk == 0) {
      if (entry.bytes == 0) return;
      data_.fail(at + packed::region::kChunkBytes, "region ", text(position), " has no chunk, but ", entry.bytes,
                 " bytes");
    }
    if (entry.chunk < packed::kHeaderBytes || entry.chunk % packed::chunk::kAlignment != 0 ||
        !data_.holds(entry.chunk, entry.bytes)) {
      data_.fail(at + packed::region::kChunk, "the chunk of region ", text(position), ", ", entry.bytes,
                 " bytes at offset ", entry.chunk, ", does not lie between the header and the end at ", data_.size());
    }
    if (entry.bytes < packed::chunk::kGroups || entry.bytes % packed::chunk::kAlignment != 0) {
      data_.fail(at + packed::region::kChunkBytes, "the chunk of region ", text(position), " has ", entry.bytes,
                 " bytes, not a multiple of ", packed::chunk::kAlignment, " from ", packed::chunk::kGroups);
    }
  }

  template <typename T>
  Index3 triple(std::uint64_t at) const {
    return {data_.get<T>(at), data_.get<T>(at + 4), data_.get<T>(at + 8)};
  }
  static std::string text(const Index3& i) { return cat('(', i.x, ", ", i.y, ", ", i.z, ')'); }

  float finite(std::uint64_t at, const char* what) const {
    const auto value = data_.get<float>(at);
    if (!std::isfinite(value)) data_.fail(at, what, ' ', value, " is not finite");
    return value;
  }

  const NvdbBytes& data_;
  PackedHeader header_;
};

}  // namespace

PackedHeader read_packed_header(const NvdbBytes& data, const Box& bbox) { return PackedHeaderReader(data).read(bbox); }

PackedRegion packed_region(const NvdbBytes& data, const PackedHeader& header, const Index3& position) {
  const std::uint64_t at =
      header.table + static_cast<std::uint64_t>(header.regions.linear(position)) * packed::region::kEntryBytes;
  return {data.get<std::uint64_t>(at + packed::region::kChunk),
          data.get<std::uint32_t>(at + packed::region::kChunkBytes), data.get<float>(at + packed::region::kValue)};
}

}  // namespace weir
