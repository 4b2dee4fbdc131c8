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

/// Leaves of a volume, as they come, until a given memory is full; of those whose values have the same bits only one.
/// Leaves may be added by several threads at once, each once.
class LeafCache final : public HeldLeaves {
 public:
  /// For the leaves of `leaves` in `bytes` of memory, index included; pages of it are taken as they are needed. Throws
  /// Error(io) where the kernel refuses.
  LeafCache(const NodeLattice& leaves, std::uint64_t bytes);

  /// The same; null where the kernel refuses: nothing is lost without them but time.
  static std::unique_ptr<LeafCache> where_there_is_room(const NodeLattice& leaves, std::uint64_t bytes);

  /// Bytes of the index alone: with less, nothing is cached.
  static std::uint64_t index_bytes(const NodeLattice& leaves);
  /// Bytes of all leaves and the index: more is never taken.
  static std::uint64_t whole_bytes(const NodeLattice& leaves);

  /// `values` are those of the leaf's voxels in the domain, x fastest; `uniform`: all have the same bits.
  void add(std::int64_t leaf, std::span<const float> values, bool uniform);

  /// Only of a leaf that has() tells of.
  std::span<const float> leaf(const Box& inside, std::array<float, kLeafVoxels>& room) const override;

  /// Whether all leaves under `voxels`, which lies in the domain, are cached.
  bool has(const Box& voxels) const;
  /// Their values, x fastest over `voxels`, by up to `threads` threads. Only where has(voxels).
  void copy(const Box& voxels, std::span<float> values, std::size_t threads) const;

 private:
  struct Entry {
    std::uint32_t place = 0;  // kNone, kUniform, or that of the values and kFirst
    float value = 0;          // of a uniform leaf
  };
  static constexpr std::uint32_t kNone = 0;
  static constexpr std::uint32_t kUniform = 1;
  static constexpr std::uint32_t kFirst = 2;

  void copy_leaf(const Index3& leaf, const Box& voxels, std::span<float> values) const;

  NodeLattice leaves_;
  PageBuffer values_;  // kLeafVoxels for each place
  std::vector<Entry> entries_;
  std::size_t places_;
  std::atomic<std::size_t> taken_{0};  // places; beyond places_ where there were more leaves
};

}  // namespace weir
