// Builds a small valid NanoVDB file of any grid type field by field. The fuzzer damages it. It has two root entries (a
// child and a value tile), an upper node with two lower nodes and a tile, a lower tile, three leaves, and macrocells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "format/layout/nanovdb_layout.h"
#include "format/leaf/leaf_decode.h"

namespace weir::test {

/// The file, and the offsets of its parts from the file's start.
struct TinyGrid {
  std::vector<std::byte> file;
  std::uint64_t grid = 0;
  std::uint64_t upper = 0;
  std::uint64_t lower = 0;  ///< the first of two lower nodes
  std::uint64_t leaf = 0;   ///< the first of three leaves
  std::uint64_t blind = 0;  ///< the record of the macrocells
  std::uint64_t end = 0;    ///< end of the data; padding follows
};

class TinyGridBuilder {
 public:
  static TinyGrid build(GridType type) {
    TinyGridBuilder builder(type);
    builder.head();
    builder.nodes();
    builder.leaves();
    builder.macrocells();
    return builder.tiny_;
  }

 private:
  static constexpr std::uint64_t kPadding = 37;

  explicit TinyGridBuilder(GridType type) : type_(type) {
    tiny_.grid = nvdb::kNameOffset + 32;
    tiny_.upper = tiny_.grid + nvdb::kRootTilesOffset + 2 * nvdb::kRootTileBytes;
    tiny_.lower = tiny_.upper + nvdb::kUpperBytes;
    tiny_.leaf = tiny_.lower + 2 * nvdb::kLowerBytes;
    leaf_offsets_[0] = tiny_.leaf;
    for (std::size_t i = 1; i < 4; ++i) leaf_offsets_[i] = leaf_offsets_[i - 1] + leaf_bytes(i - 1);
    tiny_.blind = leaf_offsets_[3];
    tiny_.end = tiny_.blind + nvdb::kBlindMetaBytes + 8;
    tiny_.file.resize(tiny_.end + kPadding);
  }

  // Returns log2 of the bits per value of a leaf. FpN leaves have 1, 4 and 16 bits.
  unsigned bits_log2(std::size_t leaf) const {
    switch (type_) {
      case GridType::fp4:
        return 2;
      case GridType::fp8:
        return 3;
      case GridType::fp16:
        return 4;
      default:
        return static_cast<unsigned>(2 * leaf);
    }
  }
  std::uint64_t leaf_bytes(std::size_t leaf) const {
    return type_ == GridType::float32 ? nvdb::kFloatLeafBytes : quantised_leaf_bytes(bits_log2(leaf));
  }

  template <typename T>
  void put(std::uint64_t offset, T value) {
    std::memcpy(tiny_.file.data() + offset, &value, sizeof value);
  }
  void put_text(std::uint64_t offset, const char* text) {
    std::memcpy(tiny_.file.data() + offset, text, std::strlen(text));
  }
  void set_bit(std::uint64_t mask, unsigned n) { tiny_.file[mask + n / 8] |= std::byte(1U << (n % 8)); }

  void head() {
    const std::uint64_t grid_bytes = tiny_.file.size() - tiny_.grid;
    put(0, nvdb::kMagic);
    put(8, nvdb::kVersion);
    put<std::uint16_t>(12, 1);
    put(nvdb::meta::kGridSize, grid_bytes);
    put(nvdb::meta::kFileSize, grid_bytes);
    put(nvdb::meta::kGridType, type_);
    put<std::uint32_t>(nvdb::meta::kNameSize, 32);
    put_text(nvdb::kNameOffset, "tiny");
    put(tiny_.grid + nvdb::grid::kMagic, nvdb::kMagic);
    put(tiny_.grid + nvdb::grid::kVersion, nvdb::kVersion);
    put<std::uint32_t>(tiny_.grid + nvdb::grid::kGridCount, 1);
    put(tiny_.grid + nvdb::grid::kGridSize, grid_bytes);
    put_text(tiny_.grid + nvdb::grid::kName, "tiny");
    for (unsigned axis = 0; axis < 3; ++axis) put(tiny_.grid + nvdb::grid::kVoxelSize + 8 * axis, 1.0);
    put(tiny_.grid + nvdb::grid::kGridType, type_);
    put(tiny_.grid + nvdb::grid::kBlindOffset, tiny_.blind - tiny_.grid);
    put<std::uint32_t>(tiny_.grid + nvdb::grid::kBlindCount, 1);
    const std::uint64_t tree = tiny_.grid + nvdb::kTreeOffset;
    put(tree + nvdb::tree::kLeafOffset, tiny_.leaf - tree);
    put(tree + nvdb::tree::kLowerOffset, tiny_.lower - tree);
    put(tree + nvdb::tree::kUpperOffset, tiny_.upper - tree);
    put(tree + nvdb::tree::kRootOffset, nvdb::kTreeBytes);
    put<std::uint32_t>(tree + nvdb::tree::kNodeCount, 3);
    put<std::uint32_t>(tree + nvdb::tree::kNodeCount + 4, 2);
    put<std::uint32_t>(tree + nvdb::tree::kNodeCount + 8, 1);
    const std::uint64_t root = tiny_.grid + nvdb::kRootOffset;
    for (unsigned axis = 0; axis < 3; ++axis) put<std::int32_t>(root + nvdb::root::kBBox + 12 + 4 * axis, 15);
    put<std::uint32_t>(root + nvdb::root::kTableSize, 2);
    put(root + nvdb::root::kBackground, 0.5F);
  }

  void nodes() {
    const std::uint64_t root = tiny_.grid + nvdb::kRootOffset;
    const std::uint64_t tiles = tiny_.grid + nvdb::kRootTilesOffset;
    put(tiles + nvdb::root::kTileChild, static_cast<std::int64_t>(tiny_.upper - root));
    put(tiles + nvdb::kRootTileBytes + nvdb::root::kTileKey, (std::uint64_t{1} << 20U) - 1);  // z = -4096
    put(tiles + nvdb::kRootTileBytes + nvdb::root::kTileValue, 2.0F);
    for (unsigned n = 0; n < 2; ++n) {
      set_bit(tiny_.upper + nvdb::kUpper.child_mask, n);
      put(tiny_.upper + nvdb::kUpper.table + 8 * n,
          static_cast<std::int64_t>(tiny_.lower + n * nvdb::kLowerBytes - tiny_.upper));
    }
    set_bit(tiny_.upper + nvdb::kUpper.value_mask, 2);
    put(tiny_.upper + nvdb::kUpper.table + 16, 3.0F);
    child(tiny_.lower, 0, leaf_offsets_[0]);
    child(tiny_.lower, 17, leaf_offsets_[1]);
    child(tiny_.lower + nvdb::kLowerBytes, 4095, leaf_offsets_[2]);
    set_bit(tiny_.lower + nvdb::kLower.value_mask, 1);
    put(tiny_.lower + nvdb::kLower.table + 8, 4.0F);
  }

  void child(std::uint64_t lower, unsigned n, std::uint64_t leaf) {
    set_bit(lower + nvdb::kLower.child_mask, n);
    put(lower + nvdb::kLower.table + 8 * n, static_cast<std::int64_t>(leaf - lower));
  }

  void leaves() {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t leaf = leaf_offsets_[i];
      std::memset(tiny_.file.data() + leaf + nvdb::leaf::kValueMask, 0x5a, 64);
      put(leaf + nvdb::leaf::kQuantMinimum, -1.0F);
      put(leaf + nvdb::leaf::kQuantum, 0.25F);
      if (type_ == GridType::fpn) put(leaf + nvdb::leaf::kFlags, static_cast<std::uint8_t>(bits_log2(i) << 5U));
      for (std::uint64_t b = nvdb::leaf::kValues; b < leaf_bytes(i); ++b) {
        tiny_.file[leaf + b] = static_cast<std::byte>(b * 29);
      }
    }
  }

  void macrocells() {
    put<std::int64_t>(tiny_.blind + nvdb::blind::kDataOffset, nvdb::kBlindMetaBytes);
    put<std::uint64_t>(tiny_.blind + nvdb::blind::kCount, 2);
    put<std::uint32_t>(tiny_.blind + nvdb::blind::kType, 1);
    put_text(tiny_.blind + nvdb::blind::kName, "weir_macrocells:16:1");
    put(tiny_.blind + nvdb::kBlindMetaBytes, -1.0F);
    put(tiny_.blind + nvdb::kBlindMetaBytes + 4, 5.0F);
  }

  GridType type_;
  TinyGrid tiny_;
  std::uint64_t leaf_offsets_[4] = {};
};

}  // namespace weir::test
