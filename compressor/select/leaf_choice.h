// The choices for the leaves of a 128^3 region: each leaf becomes a tile or is kept at some level. Choices are in the
// order of the lower node's masks (x<<8 | y<<4 | z), and are spilled to a file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "compressor/select/region_store.h"
#include "format/layout/nanovdb_layout.h"

namespace weir {

/// How a leaf is kept. The values are those in LeafChoices.
enum class LeafWidth : std::uint8_t { tile = 0, bits1 = 1, bits2 = 2, bits4 = 3, bits8 = 4, bits16 = 5, float32 = 6 };

/// log2(bits a voxel) of a kept leaf: 0 to 4, 5 for float32.
constexpr unsigned bits_log2_of(LeafWidth width) { return static_cast<unsigned>(width) - 1; }
constexpr LeafWidth width_of(unsigned bits_log2) { return static_cast<LeafWidth>(bits_log2 + 1); }

/// Bytes of a leaf in the file: its head and its values or codes.
constexpr std::uint32_t leaf_bytes(LeafWidth width) {
  return width == LeafWidth::tile ? 0 : static_cast<std::uint32_t>(nvdb::kLeafHeadBytes) + (64U << bits_log2_of(width));
}
static_assert(leaf_bytes(LeafWidth::float32) == nvdb::kFloatLeafBytes);

/// How a block is kept: a LeafWidth, or for a packed block a level of its ladder (compressor/packed/packed_ladder.h).
/// 0: as a tile, or without a stream.
using KeptLevel = std::uint8_t;

/// The level of each leaf of a region, and whether anything of the leaf can be seen. Without a scene, all can be seen.
class LeafChoices {
 public:
  static constexpr std::size_t kLeaves = 4096;

  /// `level` is below 128.
  void set(std::size_t position, KeptLevel level) {
    std::uint8_t& leaf = leaves_[position];
    leaf = static_cast<std::uint8_t>((leaf & kSeenBit) | level);
  }
  void set(std::size_t position, LeafWidth width) { set(position, static_cast<KeptLevel>(width)); }
  KeptLevel level(std::size_t position) const { return leaves_[position] & kLevelBits; }
  LeafWidth width(std::size_t position) const { return static_cast<LeafWidth>(level(position)); }
  void set_seen(std::size_t position) {
    std::uint8_t& leaf = leaves_[position];
    leaf = static_cast<std::uint8_t>(leaf | kSeenBit);
  }
  bool seen(std::size_t position) const { return (leaves_[position] & kSeenBit) != 0; }
  bool kept(std::size_t position) const { return level(position) != 0; }

 private:
  static constexpr std::uint8_t kLevelBits = 127;
  static constexpr std::uint8_t kSeenBit = 128;

  std::array<std::uint8_t, kLeaves> leaves_{};
};
static_assert(sizeof(LeafChoices) == 4096, "choices are spilled as they are");

/// The place of each kept leaf among the kept leaves of its region.
class LeafPlaces {
 public:
  explicit LeafPlaces(const LeafChoices& choices) : choices_(choices) {
    for (std::size_t row = 0; row < kRows; ++row) {
      rows_[row + 1] = rows_[row];
      for (std::size_t i = 0; i < kRow; ++i) advance(rows_[row + 1], row * kRow + i);
    }
  }

  struct Place {
    std::uint32_t leaves = 0;  ///< kept before this position
    std::uint32_t bytes = 0;   ///< of these leaves
  };

  LeafWidth width(std::size_t position) const { return choices_.width(position); }
  bool kept(std::size_t position) const { return choices_.kept(position); }
  Place before(std::size_t position) const {
    Place place = rows_[position / kRow];
    for (std::size_t p = position / kRow * kRow; p < position; ++p) advance(place, p);
    return place;
  }
  /// Returns the number and bytes of all kept leaves.
  Place total() const { return rows_.back(); }

 private:
  static constexpr std::size_t kRow = 16;
  static constexpr std::size_t kRows = LeafChoices::kLeaves / kRow;

  void advance(Place& place, std::size_t position) const {
    const LeafWidth width = choices_.width(position);
    place.leaves += width == LeafWidth::tile ? 0 : 1;
    place.bytes += leaf_bytes(width);
  }

  LeafChoices choices_;
  std::array<Place, kRows + 1> rows_{};
};

using ChoiceStore = RegionStore<LeafChoices>;

}  // namespace weir
