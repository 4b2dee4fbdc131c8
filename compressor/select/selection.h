// Selection under a byte budget: decides which leaves are kept, which 128^3 regions become lower nodes, and which
// 4096^3 blocks become upper nodes.
//
// Every purchase has a key, the error it saves per byte. The purchases are a leaf's step to its next better width
// (leaf_gain.h), a lower node (33,856 bytes) and an upper node (270,400 bytes). A node's key is at least the key of
// anything below it. A region's key is the best ratio of saved error to bytes, over all k, of opening the region and
// taking the k best steps of its leaves (its step on the convex hull). No step in the region has a higher key. The
// budget buys in the order of keys, so a larger budget buys a superset: error never grows with size. If an error must
// be met instead of a size, buying ends in the same way, but saved error is counted in place of bytes.
//
// The stages: region_keys.h gives regions and upper nodes their keys, then cut_search.h finds the cut. Of the purchases
// whose key equals the cut, as many are bought as fit: by region index, then by key, then by leaf index (step_keys.h).
// Memory is that of TreeRegions, for any number of leaves, plus the steps that are held if there is room
// (held_steps.h).
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

/// The decided cut. Keys above `threshold` are bought. Of the keys equal to it, all in regions before `tie_region`, the
/// first `tie_steps` steps in `tie_region`, and none after it are bought.
struct Cut {
  double threshold = 0;
  std::int64_t tie_region = 0;
  std::uint32_t tie_steps = 0;
};

/// The bytes that a selection can take in the file.
struct SelectionBytes {
  TreeLayout minimum;              ///< the smallest file that the rule allows
  TreeLayout full;                 ///< the file with every step of every leaf: more bytes buy nothing
  std::uint64_t lossy_leaves = 0;  ///< leaves that lose something even in the full file; 0 for float leaves
  bool by_scene = false;           ///< all figures leave out leaves that a scene cannot show
};

class Selection {
 public:
  /// The kind of cut that will be searched for. Steps are held for it if there is room.
  enum class Search { no, of_bytes, of_error };

  /// Computes sums and keys of all regions and upper nodes: one pass over the rows.
  Selection(const GainRule& rule, const RowStore& rows, TreeRegions& tree, Search search = Search::of_bytes);

  SelectionBytes bytes() const { return bytes_; }

  /// Buys for a file of at most `file_bytes`, which is at least bytes().minimum. Sets `open` of regions and upper nodes
  /// in the tree.
  void choose(std::uint64_t file_bytes);

  /// Buys as little as brings the expected squared error of the finite voxels, weighted if the rule weighs, down to
  /// `squared_error`. Buys everything if that is not enough. For Metric::sse.
  void choose_error(double squared_error);

  /// Returns the choices for the leaves of a region, after choose(). `gains` is scratch memory.
  LeafChoices choices(std::int64_t region, const RegionRows& rows, RegionGains& gains) const;
  /// Frees the steps that are held for choose() and choices(). Both take longer without the steps.
  void release_steps();

  const Cut& cut() const { return cut_; }
  /// Returns the key at which buying ended; nullopt if all or only required steps were bought.
  std::optional<double> cut_key() const {
    const bool between = cut_.threshold > 0 && cut_.threshold < std::numeric_limits<double>::max();
    return between ? std::optional(cut_.threshold) : std::nullopt;
  }
  const GainRule& rule() const { return rule_; }

  /// For a packed file with a preview, after choose() or choose_error(): a bound of its bytes, which rounding may
  /// exceed by a few thousandths, and the bytes of its preview. nullopt if no bound is known.
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
  // The place of a region's held steps.
  struct HeldRegion {
    const HeldSteps::Part* part = nullptr;
    std::size_t first = 0;
    std::size_t count = 0;
  };
  void begin_holding(Search search);
  void hold(std::int64_t region, const RegionGains& gains);
  // Returns the choices by the held steps; nullopt if the held steps do not decide them.
  std::optional<LeafChoices> held_choices(std::int64_t region) const;
  TreeLayout layout_of(const Purchases& bought) const;
  void buy_for(PurchaseGoal goal);
  void resolve_ties(const PurchaseGoal& goal, const Threshold& threshold);

  GainRule rule_;
  const RowStore& rows_;
  TreeRegions& tree_;
  SelectionBytes bytes_;
  std::uint64_t required_bytes_ = 0;  // of purchases that every goal requires
  std::unique_ptr<HeldSteps> held_;
  std::vector<HeldRegion> held_regions_;  // empty: choices are found from the rows
  // By region and position: the level of a leaf's last step with a key above the held range. Null: no such steps.
  std::unique_ptr<PageBuffer> levels_;
  std::unique_ptr<KeyCounts> counts_;  // of steps that are too many to be held
  Cut cut_;
  std::optional<std::uint64_t> most_bytes_;  // of the chosen file
};

}  // namespace weir
