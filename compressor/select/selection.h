// Selection under a byte budget: which leaves are kept, which 128^3 regions become lower nodes, which 4096^3 blocks
// upper nodes.
//
// Everything that can be bought has a key, the error it saves per byte: a leaf's step to its next better width
// (leaf_gain.h), a lower node (33,856 bytes) and an upper node (270,400). A node's key is at least that of anything
// below it: a region's is the best ratio over all k of what opening it and taking the k best steps of its leaves saves
// to what they cost (its step on the convex hull), and no step in it has a higher one. The budget then buys in the
// order of keys, so that any larger budget buys a superset: error never grows with size. An error to be met instead of
// a size ends the same way, with the error saved counted in place of the bytes. The steps: region_keys.h gives regions
// and upper nodes their keys, cut_search.h finds the cut, and of what has the cut's own key as much is bought as fits:
// by region index, then by key, then by leaf index (step_keys.h). Memory is that of TreeRegions, for any number of
// leaves, and that of the steps that are held where there is room (held_steps.h).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "compressor/select/cut_search.h"
#include "compressor/select/held_steps.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/select/region_rows.h"
#include "compressor/select/tree_regions.h"
#include "format/layout/tree_layout.h"
#include "ingest/plan/page_buffer.h"

namespace weir {

/// The decided cut. Keys above `threshold` are bought; of those equal to it, all in regions before
/// `tie_region`, the first `tie_steps` steps in it, and none after it.
struct Cut {
  double threshold = 0;
  std::int64_t tie_region = 0;
  std::uint32_t tie_steps = 0;
};

/// What a selection comes to in the file.
struct SelectionBytes {
  TreeLayout minimum;              ///< the smallest file these rules allow
  TreeLayout full;                 ///< every step of every leaf: more bytes buy nothing
  std::uint64_t lossy_leaves = 0;  ///< leaves that lose something even then; 0 for float leaves
  bool by_scene = false;           ///< what a scene cannot show is left out of all this
};

class Selection {
 public:
  /// Which cut will be searched for: steps are held for it, where there is room.
  enum class Search { no, of_bytes, of_error };

  /// Computes sums and keys of all regions and upper nodes: one pass over the rows.
  Selection(const GainRule& rule, const RowStore& rows, TreeRegions& tree, Search search = Search::of_bytes);

  SelectionBytes bytes() const { return bytes_; }

  /// Buys for a file of at most `file_bytes`, which is at least bytes().minimum: sets `open` of regions
  /// and upper nodes in the tree.
  void choose(std::uint64_t file_bytes);

  /// Buys as little as brings the squared error expected of the finite voxels, weighted where the rule weighs, down
  /// to `squared_error`; all there is where that is not enough. For Metric::sse.
  void choose_error(double squared_error);

  /// What becomes of the leaves of a region, after choose(). `gains` is room to work in.
  LeafChoices choices(std::int64_t region, const RegionRows& rows, RegionGains& gains) const;
  /// Gives back the memory of the steps that are held for choose() and choices(), which take longer without them.
  void release_steps();

  const Cut& cut() const { return cut_; }
  /// The key at which buying ended; nullopt where all was bought, or only what is required.
  std::optional<double> cut_key() const {
    const bool between = cut_.threshold > 0 && cut_.threshold < std::numeric_limits<double>::max();
    return between ? std::optional(cut_.threshold) : std::nullopt;
  }
  const GainRule& rule() const { return rule_; }

  /// Of a packed file with a preview, after choose() or choose_error(): a bound of its bytes, which rounding may exceed
  /// by a few thousandths, and the bytes of its preview. Nullopt where no bound is known.
  struct PreviewedBytes {
    std::uint64_t most_of_file = 0;
    std::uint64_t preview = 0;
  };
  std::optional<PreviewedBytes> previewed_bytes() const;

 private:
  struct Purchases {
    std::uint64_t uppers = 0;
    std::uint64_t regions = 0;
    std::uint64_t leaves = 0;
    std::uint64_t leaf_bytes = 0;
  };
  // Where the steps of a region are held.
  struct HeldRegion {
    const HeldSteps::Part* part = nullptr;
    std::size_t first = 0;
    std::size_t count = 0;
  };
  void begin_holding(Search search);
  void hold(std::int64_t region, const RegionGains& gains);
  // By the held steps; nullopt where these do not tell.
  std::optional<LeafChoices> held_choices(std::int64_t region) const;
  TreeLayout layout_of(const Purchases& bought) const;
  void buy_for(PurchaseGoal goal);
  void resolve_ties(const PurchaseGoal& goal, const Threshold& threshold);

  GainRule rule_;
  const RowStore& rows_;
  TreeRegions& tree_;
  SelectionBytes bytes_;
  std::uint64_t required_bytes_ = 0;  // of what is bought whatever the goal
  std::unique_ptr<HeldSteps> held_;
  std::vector<HeldRegion> held_regions_;  // empty: what is chosen is found by the rows
  // By region and position: a leaf's last step whose key is above the range of the held ones. Null: there are none.
  std::unique_ptr<PageBuffer> levels_;
  std::unique_ptr<KeyCounts> counts_;  // of steps that are too many to be held
  Cut cut_;
  std::optional<std::uint64_t> most_bytes_;  // of the chosen file
};

}  // namespace weir
