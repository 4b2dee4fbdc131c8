// The values of a volume that cannot be read again, leaf by leaf, as they were
// stored: those of leaf i in a sparse file from byte 512 i on (times the bytes of
// a value), and beside them what there is of each leaf. Leaves of one value are
// not in the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "compressor/survey/leaf_store.h"
#include "format/base/index.h"
#include "format/base/scalar_type.h"
#include "format/io/file_system.h"

namespace weir {

/// What there is of a leaf. All zero bytes: nothing.
struct SpooledLeaf {
  enum class State : std::uint64_t { absent, constant, spooled };
  State state = State::absent;
  std::array<std::byte, 8> value{};  ///< of a constant leaf, its first bytes: every in-domain voxel has these bits
};
static_assert(sizeof(SpooledLeaf) == 16, "spilled as they are");

/// Thread-safe: positioned reads and writes only. Several processes can write different voxels of the same two files.
class LeafSpool {
 public:
  /// Reserves 16 bytes a leaf in `states`; of `values` it cannot be known how much is needed, and a full disk shows
  /// when it is written.
  LeafSpool(std::shared_ptr<File> values, std::shared_ptr<File> states, const NodeLattice& leaves, ScalarType type);

  const NodeLattice& leaves() const { return states_.leaves(); }
  ScalarType type() const { return type_; }

  /// Writes the voxels of `box` (index space, inside the domain, not empty), stored values in this machine's byte
  /// order, x fastest. A leaf that lies in it with all of its in-domain voxels is written whole, or is constant from
  /// then on; one that lies in it in part is spooled from then on, and complete once its other voxels are written too.
  /// Needs as much memory as a row of leaves of the box.
  void write(const Box& box, std::span<const std::byte> values);

  /// What there is of consecutive leaves from `first` on.
  void read_states(std::int64_t first, std::span<SpooledLeaf> states) const { states_.read(first, states); }
  /// Values of consecutive spooled leaves from `first` on, leaf_bytes() apart: the in-domain ones of a leaf, x fastest,
  /// and, where it overhangs the domain, anything behind them. The last leaf's may be asked for without that.
  void read_values(std::int64_t first, std::span<std::byte> values) const;

  /// Bytes that the values of a leaf take in the file.
  std::size_t leaf_bytes() const { return kLeafVoxels * scalar_bytes(type_); }

  /// The room of consecutive leaves that are absent, from `first` on, holds whatever its owner wants back before they
  /// are written; `at` is an offset in bytes.
  void park(std::int64_t first, std::uint64_t at, std::span<const std::byte> bytes);
  void unpark(std::int64_t first, std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  std::uint64_t place_of(std::int64_t leaf) const { return static_cast<std::uint64_t>(leaf) * leaf_bytes(); }
  // Leaves from `first` on along x; `row` has room for them.
  void write_row(const Index3& first, std::span<SpooledLeaf> states, std::span<std::byte> row, const Box& box,
                 std::span<const std::byte> values);
  // Some voxels of a leaf, x fastest.
  void write_part(std::int64_t leaf, const Box& part, const Box& inside, std::span<const std::byte> values);

  std::shared_ptr<File> values_;
  LeafStore<SpooledLeaf> states_;
  ScalarType type_;
};

}  // namespace weir
