// Keeps the values of a volume that cannot be read again, leaf by leaf, as they were stored. The values of leaf i lie
// in a sparse file from byte 512 * i * (bytes of a value) on; leaves of one value are not in the file. A second file
// holds the state of each leaf.
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

/// The state of a leaf. All zero bytes: the leaf is absent.
struct SpooledLeaf {
  enum class State : std::uint64_t { absent, constant, spooled };
  State state = State::absent;
  std::array<std::byte, 8> value{};  ///< for a constant leaf: its first bytes are the bits of every in-domain voxel
};
static_assert(sizeof(SpooledLeaf) == 16, "spilled as they are");

/// Thread-safe: positioned reads and writes only. Several processes can write different voxels of the same two files.
class LeafSpool {
 public:
  /// Reserves 16 bytes per leaf in `states`. The space that `values` needs is not known beforehand, so a full disk
  /// shows only when values are written.
  LeafSpool(std::shared_ptr<File> values, std::shared_ptr<File> states, const NodeLattice& leaves, ScalarType type);

  const NodeLattice& leaves() const { return states_.leaves(); }
  ScalarType type() const { return type_; }

  /// Writes the voxels of `box` (index space, inside the domain, not empty): stored values in this machine's byte
  /// order, x fastest. A leaf with all its in-domain voxels in `box` is written whole, or becomes constant. A leaf with
  /// only some of them in `box` becomes spooled, and is complete once its other voxels are written too. Needs as much
  /// memory as a row of leaves of the box.
  void write(const Box& box, std::span<const std::byte> values);

  /// Reads the states of consecutive leaves from `first` on.
  void read_states(std::int64_t first, std::span<SpooledLeaf> states) const { states_.read(first, states); }
  /// Reads the values of consecutive spooled leaves from `first` on, leaf_bytes() apart. Each leaf has its in-domain
  /// values, x fastest, followed by arbitrary bytes if the leaf overhangs the domain. `values` may end before the
  /// arbitrary bytes of the last leaf.
  void read_values(std::int64_t first, std::span<std::byte> values) const;

  /// Returns the bytes that the values of a leaf take in the file.
  std::size_t leaf_bytes() const { return kLeafVoxels * scalar_bytes(type_); }

  /// park() stores bytes of the caller's in the room of consecutive absent leaves from `first` on, and unpark() reads
  /// them back. The bytes are lost when the leaves are written. `at` is an offset in bytes.
  void park(std::int64_t first, std::uint64_t at, std::span<const std::byte> bytes);
  void unpark(std::int64_t first, std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  std::uint64_t place_of(std::int64_t leaf) const { return static_cast<std::uint64_t>(leaf) * leaf_bytes(); }
  // Writes the leaves from `first` on along x. `row` has room for their values.
  void write_row(const Index3& first, std::span<SpooledLeaf> states, std::span<std::byte> row, const Box& box,
                 std::span<const std::byte> values);
  // Writes some voxels of a leaf, x fastest.
  void write_part(std::int64_t leaf, const Box& part, const Box& inside, std::span<const std::byte> values);

  std::shared_ptr<File> values_;
  LeafStore<SpooledLeaf> states_;
  ScalarType type_;
};

}  // namespace weir
