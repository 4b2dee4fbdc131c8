#include "tools/export/vdb_writer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <mutex>
#include <span>
#include <sstream>
#include <tuple>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/leaf/leaf_decode.h"
#include "tools/export/export_tree.h"
#include "tools/export/file_sink.h"
#include "tools/export/packed_export_tree.h"
#include "tools/export/vdb_node_values.h"

namespace weir {
namespace {

constexpr std::size_t kLeavesAtOnce = 2048;  ///< leaves between two progress reports: some 4 MiB
constexpr std::size_t kChunk = 64;           ///< leaves in one task

template <typename MaskType>
std::uint64_t count(const MaskType& mask) {
  std::uint64_t bits = 0;
  for (const std::uint64_t word : mask) bits += static_cast<std::uint64_t>(std::popcount(word));
  return bits;
}

// Calls `visit` with each set entry of `children`, in order.
template <typename MaskType, typename Visit>
void for_each_set(const MaskType& children, const Visit& visit) {
  for (std::size_t w = 0; w < children.size(); ++w) {
    for (std::uint64_t word = children[w]; word != 0; word &= word - 1) {
      visit(64 * w + static_cast<std::size_t>(std::countr_zero(word)));
    }
  }
}

template <typename T>
void put_bytes(std::ostream& out, const T& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

class Writer {
 public:
  Writer(const NvdbGrid& grid, const std::string& path, const VdbWriterOptions& options, File& file)
      : grid_(grid),
        tree_(grid.packed() != nullptr ? make_packed_export_tree(grid) : make_stored_export_tree(grid)),
        path_(path),
        options_(options),
        file_(file) {
    entries_ = tree_->roots();
    // The order of OpenVDB's root map, in which readers expect the leaves' values.
    std::sort(entries_.begin(), entries_.end(), [](const ExportRoot& a, const ExportRoot& b) {
      return std::tie(a.origin.x, a.origin.y, a.origin.z) < std::tie(b.origin.x, b.origin.y, b.origin.z);
    });
  }

  VdbWritten run() {
    VdbHead head = empty_head();
    FileSink out(file_, vdb_head_bytes(head).size());
    storage_.compression = options_.compression;
    storage_.half = options_.half;
    storage_.background = stored(grid_.background());
    topology(out);
    head.leaves_begin = out.position();
    leaves(out);
    written_.bytes = head.end = out.position();
    head.metadata["file_voxel_count"] = static_cast<std::int64_t>(written_.active_voxels);
    if (options_.half) add_rounding(head.metadata);
    const std::string without_uuid = vdb_head_bytes(head);
    DigestStream content;
    content.update(piece_digest(std::as_bytes(std::span(without_uuid))));
    content.update(out.finish());
    head.content = content.digest();
    const std::string bytes = vdb_head_bytes(head);
    file_.write_at(0, std::as_bytes(std::span(bytes)));
    return written_;
  }

 private:
  void add_rounding(VdbMetadata& metadata) const {
    metadata["weir_half_max_abs_error"] = written_.half_max_abs_error;
    const auto lossless = metadata.find("weir_lossless");
    if (lossless != metadata.end() && written_.half_max_abs_error > 0) lossless->second = false;
  }

  VdbHead empty_head() {
    VdbHead head;
    head.creator = options_.creator;
    head.name = grid_.name();
    head.half = options_.half;
    head.compression = options_.compression | kVdbActiveMask;
    head.matrix = grid_.matrix();
    head.translation = grid_.world_origin();
    head.metadata = options_.metadata;
    head.metadata["name"] = grid_.name();
    written_.level_set = load<std::uint32_t>(grid_.data().data() + nvdb::grid::kGridClass) ==
                         static_cast<std::uint32_t>(GridClass::level_set);
    head.metadata["class"] = written_.level_set ? "level set" : "fog volume";
    head.metadata["is_saved_as_half_float"] = options_.half;
    head.metadata["file_voxel_count"] = std::int64_t{0};
    if (options_.half) head.metadata["weir_half_max_abs_error"] = 0.0;
    written_.topology.active = grid_.index_bbox();
    if (const Box& box = written_.topology.active; !box.empty()) {
      const auto corner = [](const Index3& i) {
        return std::array{static_cast<std::int32_t>(i.x), static_cast<std::int32_t>(i.y),
                          static_cast<std::int32_t>(i.z)};
      };
      head.metadata["file_bbox_min"] = corner(box.lo);
      head.metadata["file_bbox_max"] = corner(box.hi - Index3{1, 1, 1});
    }
    return head;
  }

  // Returns `value` as the file stores it; keeps the largest difference in `worst`.
  float stored(float value, double& worst) const {
    if (!options_.half) return value;
    const float rounded = rounded_to_half(value);
    if (!std::isfinite(value)) return rounded;
    if (!std::isfinite(rounded)) {
      throw Error(ErrorKind::usage,
                  cat(path_, ": --half holds values up to ", kMaxHalf, ", and one is ", value, "; leave --half out"));
    }
    worst = std::max(worst, std::abs(static_cast<double>(rounded) - static_cast<double>(value)));
    return rounded;
  }
  float stored(float value) { return stored(value, written_.half_max_abs_error); }

  void topology(std::ostream& out) {
    put_bytes(out, std::int32_t{1});  // buffers
    put_bytes(out, storage_.background);
    const auto tiles = std::count_if(entries_.begin(), entries_.end(), [](const auto& e) { return !e.child; });
    put_bytes(out, static_cast<std::uint32_t>(tiles));
    put_bytes(out, static_cast<std::uint32_t>(entries_.size()) - static_cast<std::uint32_t>(tiles));
    written_.topology.root_entries = entries_.size();
    for (const ExportRoot& entry : entries_) {
      if (entry.child) continue;
      put_origin(out, entry.origin);
      put_bytes(out, stored(entry.value));
      put_bytes(out, std::uint8_t{entry.active});
      if (entry.active) written_.active_voxels += cube(kUpperDim);
    }
    for (const ExportRoot& entry : entries_) {
      if (!entry.child) continue;
      put_origin(out, entry.origin);
      upper_topology(out, entry.upper);
    }
  }

  void upper_topology(std::ostream& out, const ExportNode& upper) {
    ++written_.topology.nodes[2];
    tree_->read_upper(upper, upper_);
    internal(out, upper_, kLowerDim);
    for_each_set(upper_.children, [&](std::size_t u) {
      lower_topology(out, tree_->lower_of(upper, u));
      // A lower node takes 33 KiB of pages even without leaves.
      if (written_.topology.nodes[1] % (kLeavesAtOnce / 16) == 0) report(0.1, written_.topology.nodes[0], 0);
    });
  }

  void lower_topology(std::ostream& out, const ExportNode& lower) {
    ++written_.topology.nodes[1];
    tree_->read_lower(lower, lower_);
    internal(out, lower_, kLeafDim);
    for_each_set(lower_.children, [&](std::size_t l) {
      const auto active = tree_->leaf_mask(tree_->leaf_of(lower, l));
      put_bytes(out, active);
      written_.active_voxels += count(active);
      if (++written_.topology.nodes[0] % kLeavesAtOnce == 0) report(0.1, written_.topology.nodes[0], 0);
    });
  }

  static void put_origin(std::ostream& out, const Index3& origin) {
    for (const std::int64_t c : {origin.x, origin.y, origin.z}) put_bytes(out, static_cast<std::int32_t>(c));
  }

  static std::uint64_t cube(std::int64_t dim) { return static_cast<std::uint64_t>(dim * dim * dim); }

  // Writes the masks and tiles of an upper or lower node whose entries have an edge of `dim` voxels.
  template <std::size_t Entries>
  void internal(std::ostream& out, InternalNode<Entries>& node, std::int64_t dim) {
    for (std::size_t i = 0; i < Entries; ++i) {
      const bool child = (node.children[i / 64] >> i % 64 & 1U) != 0;
      node.values[i] = child ? 0 : stored(node.values[i]);
    }
    put_bytes(out, node.children);
    put_bytes(out, node.active);
    write_vdb_values(out, node.values, node.active, node.children, storage_);
    written_.active_voxels += count(node.active) * cube(dim);
  }

  void leaves(std::ostream& out) {
    std::vector<ExportNode> batch;
    std::uint64_t done = 0;
    const auto flush = [&] {
      write_batch(out, batch);
      done += batch.size();
      batch.clear();
      report(0.9, done, 0.1);
    };
    for (const ExportRoot& entry : entries_) {
      if (!entry.child) continue;
      tree_->read_upper(entry.upper, upper_);
      for_each_set(upper_.children, [&](std::size_t u) {
        const ExportNode lower = tree_->lower_of(entry.upper, u);
        tree_->read_lower(lower, lower_);
        for_each_set(lower_.children, [&](std::size_t l) {
          batch.push_back(tree_->leaf_of(lower, l));
          if (batch.size() == kLeavesAtOnce) flush();
        });
      });
    }
    flush();
  }

  void write_batch(std::ostream& out, const std::vector<ExportNode>& batch) {
    std::vector<std::string> chunks((batch.size() + kChunk - 1) / kChunk);
    std::mutex mutex;
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
      std::ostringstream chunk;
      double worst = 0;
      for (std::size_t i = c * kChunk; i < std::min(batch.size(), (c + 1) * kChunk); ++i) {
        write_leaf(chunk, batch[i], worst);
      }
      chunks[c] = std::move(chunk).str();
      const std::lock_guard lock(mutex);
      written_.half_max_abs_error = std::max(written_.half_max_abs_error, worst);
    });
    for (const std::string& chunk : chunks) out.write(chunk.data(), static_cast<std::streamsize>(chunk.size()));
  }

  void write_leaf(std::ostream& out, const ExportNode& leaf, double& worst) const {
    static constexpr NodeMask<kLeafVoxels> kNoChildren{};
    std::array<float, kLeafVoxels> values;
    tree_->read_leaf(leaf, values);
    for (float& value : values) value = stored(value, worst);
    const auto active = tree_->leaf_mask(leaf);
    put_bytes(out, active);
    write_vdb_values(out, values, active, kNoChildren, storage_);
  }

  // Reports that `leaves` of all leaves are done in a pass that begins at `from` and makes up `share` of the work.
  void report(double share, std::uint64_t leaves, double from) const {
    const auto all = static_cast<double>(std::max<std::uint64_t>(tree_->leaves(), 1));
    if (options_.progress) options_.progress(from + share * static_cast<double>(leaves) / all);
    if (options_.release_pages) options_.release_pages();
  }

  const NvdbGrid& grid_;
  std::unique_ptr<ExportTree> tree_;
  const std::string& path_;
  const VdbWriterOptions& options_;
  File& file_;
  std::vector<ExportRoot> entries_;
  UpperNode upper_;  // the upper node read last
  LowerNode lower_;
  VdbStorage storage_;
  VdbWritten written_;
};

}  // namespace

VdbWritten write_vdb(const NvdbGrid& grid, const std::string& path, const VdbWriterOptions& options, File& file) {
  if (const std::string obstacle = vdb_transform_obstacle(grid.matrix(), grid.world_origin()); !obstacle.empty()) {
    throw Error(ErrorKind::input, cat(path, ": ", obstacle));
  }
  return Writer(grid, path, options, file).run();
}

}  // namespace weir
