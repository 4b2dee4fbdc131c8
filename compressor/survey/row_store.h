// What the survey stores: a row of 64 bytes per leaf; with a scene, the reach of each leaf (leaf_reach.h), the values
// that lookups in or next to it can give; for packed files each block's ladder; and cached values of leaves.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "compressor/leaf/leaf_row.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/survey/leaf_cache.h"
#include "compressor/survey/leaf_store.h"
#include "compressor/team/team.h"
#include "format/leaf/bounds.h"

namespace weir {

/// The memory that selection may use.
struct SelectionRoom {
  std::int64_t segment_regions = 1;  ///< number of regions per thread that have their rows in memory
  std::uint64_t step_bytes = 0;      ///< bytes for steps that are held instead of being found again (held_steps.h)
};

/// Thread-safe except for the setters.
class RowStore : public LeafStore<LeafRow> {
 public:
  /// `team` is the set of processes that fill the store together and then select together. Each process writes the rows
  /// of its own leaves (region_share.h).
  RowStore(std::shared_ptr<File> file, const NodeLattice& leaves, const SelectionRoom& room, Team& team = no_team())
      : LeafStore(std::move(file), leaves), room_(room), team_(team) {}

  const SelectionRoom& room() const { return room_; }
  Team& team() const { return team_; }

  /// Returns the reach of each leaf (leaf_reach.h); null if all values count alike.
  const LeafStore<MinMax>* reaches() const { return reaches_.get(); }
  void set_reaches(std::unique_ptr<LeafStore<MinMax>> reaches) { reaches_ = std::move(reaches); }

  /// Returns the ladder of each block; null if no block is packed.
  LeafStore<PackedLadder>* ladders() const { return ladders_.get(); }
  void set_ladders(std::unique_ptr<LeafStore<PackedLadder>> ladders) { ladders_ = std::move(ladders); }

  /// Returns the cached values of leaves; null if none are cached.
  LeafCache* cache() const { return cache_.get(); }
  void set_cache(std::unique_ptr<LeafCache> cache) { cache_ = std::move(cache); }
  /// Hands the cache over to a caller that frees its memory.
  std::unique_ptr<LeafCache> give_up_cache() { return std::move(cache_); }

 private:
  SelectionRoom room_;
  Team& team_;
  std::unique_ptr<LeafStore<MinMax>> reaches_;
  std::unique_ptr<LeafStore<PackedLadder>> ladders_;
  std::unique_ptr<LeafCache> cache_;
};

}  // namespace weir
