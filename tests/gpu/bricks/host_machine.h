// The host as the machine of a brick cache: arrays are in host memory, and steps run one after the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "format/nanovdb/packed_data.h"
#include "gpu/cuda/bricks/block_source.h"
#include "gpu/cuda/bricks/brick_build.h"
#include "gpu/cuda/bricks/packed_pages.h"

namespace weir::test {

/// Replaces DeviceArray.
template <class T>
class HostArray {
 public:
  explicit HostArray(std::size_t size) : values_(size) {
    // A device does not clear its memory either.
    if (size > 0) std::memset(static_cast<void*>(values_.data()), 0xA5, size * sizeof(T));
  }
  T* data() const { return const_cast<T*>(values_.data()); }
  std::size_t size() const { return values_.size(); }
  std::size_t bytes() const { return values_.size() * sizeof(T); }
  void upload(std::span<const T> from) { std::copy(from.begin(), from.end(), values_.begin()); }
  void download(std::span<T> to) const { std::copy_n(values_.begin(), to.size(), to.begin()); }

 private:
  std::vector<T> values_;
};

struct HostThread {
  unsigned index() const { return 0; }
  unsigned count() const { return 1; }
  void meet() const {}
  MinMax widest(const MinMax& own, MinMax*) const { return own; }
};

struct HostMachine {
  template <class T>
  using Array = HostArray<T>;

  template <class Step>
  void each(std::uint32_t count, const Step& step) const {
    for (std::uint32_t i = 0; i < count; ++i) step(i);
  }
  template <class Step>
  void groups(std::uint32_t count, const Step& step) const {
    for (std::uint32_t g = 0; g < count; ++g) {
      typename Step::Shared shared;
      step(HostThread{}, shared, g);
    }
  }
  void wait() const {}
  template <class T>
  void clear(Array<T>& array) const {
    std::memset(static_cast<void*>(array.data()), 0, array.bytes());
  }
};

/// A texture in memory.
template <class Texel>
struct HostTexels {
  static constexpr bool kSixteenBits = sizeof(Texel) == 2;

  std::vector<Texel>* texels = nullptr;
  Int3 size;

  void write(const Int3& at, Texel value) const { (*texels)[table_index(at, size)] = value; }
  float read(const Int3& at) const {
    const auto texel = static_cast<float>((*texels)[table_index(at, size)]);
    return kSixteenBits ? texel / kMostTexel : texel;
  }
};

/// The blocks of a packed grid, decoded one after the other.
class HostPackedSource : public BlockSource {
 public:
  HostPackedSource(const PackedData& packed, const Box& domain)
      : packed_(packed), lattice_(block_lattice(domain)), copy_((packed.bytes().size() + 7) / 8) {
    std::memcpy(copy_.data(), packed.bytes().data(), packed.bytes().size());
    view_.data = reinterpret_cast<const std::byte*>(copy_.data());
    view_.bytes = packed.bytes().size();
    view_.table = packed.header().table;
    view_.regions = static_cast<std::uint64_t>(packed.regions().size());
    view_.constants = packed.header().constants();
  }

  BlockLattice lattice() const override { return lattice_; }
  std::vector<RegionEntry> regions() const override { return packed_regions(packed_); }
  void fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                  const PageTable& table) override {
    HostMachine{}.each(kRegionBlocks * count, FillPages<PackedBlocks>{{view_}, table, regions, pages});
  }
  void decode(const BlockId* blocks, std::uint32_t count, float* values) override {
    for (std::uint32_t i = 0; i < count; ++i) {
      const PackedRegion region =
          packed_.region(packed_.regions().position(static_cast<std::int64_t>(blocks[i] >> 12U)));
      const std::span<float, 512> block(values + std::size_t{512} * i, 512);
      std::ranges::fill(block, region.value);
      if (region.chunk == 0) continue;
      const PackedStream stream = packed_.stream(region, static_cast<unsigned>(blocks[i] & 4095U));
      if (stream.data != nullptr) packed_.decode(stream, block);
    }
  }
  void check() override {}

 private:
  const PackedData& packed_;
  BlockLattice lattice_;
  std::vector<std::uint64_t> copy_;  // at a multiple of 8, as on a device
  PackedView view_;
};

}  // namespace weir::test
