// Values that the survey caches in memory for the encode pass, so that it need not read them again.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "ingest/plan/page_buffer.h"
#include "ingest/source/held_leaves.h"

namespace weir {

/// Caches leaves in the order in which they are added, until a given memory is full. Of a uniform leaf, whose values
/// all have the same bits, only one value is kept. Several threads may add leaves at once. Add each leaf once.
class LeafCache final : public HeldLeaves {
 public:
  /// Makes a cache for the leaves of `leaves` in `bytes` of memory, index included. Memory pages are taken when they
  /// are first used. Throws Error(io) if the kernel refuses the memory.
  LeafCache(const NodeLattice& leaves, std::uint64_t bytes);

  /// The same, but returns null if the kernel refuses the memory: a missing cache costs only time.
  static std::unique_ptr<LeafCache> where_there_is_room(const NodeLattice& leaves, std::uint64_t bytes);

  /// Returns the bytes of the index alone. With less memory nothing is cached.
  static std::uint64_t index_bytes(const NodeLattice& leaves);
  /// Returns the bytes of all leaves and the index. A cache never takes more.
  static std::uint64_t whole_bytes(const NodeLattice& leaves);

  /// Adds the leaf with linear index `leaf`. `values` are the leaf's in-domain voxels, x fastest. `uniform` says that
  /// all values have the same bits.
  void add(std::int64_t leaf, std::span<const float> values, bool uniform);

  /// Returns the values of the leaf with the in-domain voxels `inside`. Call it only if has(inside).
  std::span<const float> leaf(const Box& inside, std::array<float, kLeafVoxels>& room) const override;

  /// Returns whether all leaves under `voxels` are cached. `voxels` must lie in the domain.
  bool has(const Box& voxels) const;
  /// Copies the values of `voxels` to `values`, x fastest, on up to `threads` threads. Call it only if has(voxels).
  void copy(const Box& voxels, std::span<float> values, std::size_t threads) const;

 private:
  struct Entry {
    std::uint32_t place = 0;  // kNone, kUniform, or kFirst plus the place of the values in values_
    float value = 0;          // of a uniform leaf
  };
  static constexpr std::uint32_t kNone = 0;
  static constexpr std::uint32_t kUniform = 1;
  static constexpr std::uint32_t kFirst = 2;

  void copy_leaf(const Index3& leaf, const Box& voxels, std::span<float> values) const;

  NodeLattice leaves_;
  PageBuffer values_;  // kLeafVoxels values per place
  std::vector<Entry> entries_;
  std::size_t places_;
  std::atomic<std::size_t> taken_{0};  // places; more than places_ if more leaves were added than fit
};

}  // namespace weir
