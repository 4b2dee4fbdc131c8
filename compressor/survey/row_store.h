// The survey's rows, 64 bytes a leaf, and, where a scene decides what matters,
// which values can be seen around each, of packed files the blocks' ladders, and
// the values of as many leaves as there is memory for.
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

/// Memory that selection may take.
struct SelectionRoom {
  std::int64_t segment_regions = 1;  ///< rows of so many regions are held per thread
  std::uint64_t step_bytes = 0;      ///< of steps that are held instead of being found again (held_steps.h)
};

/// Thread-safe but for its setters.
class RowStore : public LeafStore<LeafRow> {
 public:
  /// `team` are the processes that fill the store together, each the rows of its own leaves (region_share.h), and
  /// decide what comes of them.
  RowStore(std::shared_ptr<File> file, const NodeLattice& leaves, const SelectionRoom& room, Team& team = no_team())
      : LeafStore(std::move(file), leaves), room_(room), team_(team) {}

  const SelectionRoom& room() const { return room_; }
  Team& team() const { return team_; }

  /// Of each leaf (leaf_reach.h); null where everything counts alike.
  const LeafStore<MinMax>* reaches() const { return reaches_.get(); }
  void set_reaches(std::unique_ptr<LeafStore<MinMax>> reaches) { reaches_ = std::move(reaches); }

  /// Of each block; null where none is packed.
  LeafStore<PackedLadder>* ladders() const { return ladders_.get(); }
  void set_ladders(std::unique_ptr<LeafStore<PackedLadder>> ladders) { ladders_ = std::move(ladders); }

  /// The values of leaves; null where none are cached.
  LeafCache* cache() const { return cache_.get(); }
  void set_cache(std::unique_ptr<LeafCache> cache) { cache_ = std::move(cache); }
  /// For whoever frees their memory.
  std::unique_ptr<LeafCache> give_up_cache() { return std::move(cache_); }

 private:
  SelectionRoom room_;
  Team& team_;
  std::unique_ptr<LeafStore<MinMax>> reaches_;
  std::unique_ptr<LeafStore<PackedLadder>> ladders_;
  std::unique_ptr<LeafCache> cache_;
};

}  // namespace weir
