#include "tools/export/vdb_writer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <mutex>
#include <span>
#include <sstream>
#include <tuple>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/leaf/leaf_decode.h"
#include "tools/export/file_sink.h"
#include "tools/export/vdb_node_values.h"

namespace weir {
namespace {

constexpr std::size_t kLeavesAtOnce = 2048;  ///< leaves between two looks at progress: some 4 MiB
constexpr std::size_t kChunk = 64;           ///< leaves of one task
constexpr std::uint32_t kLevelSet = 1;       ///< NanoVDB's GridClass

template <std::size_t Bits>
using Mask = std::array<std::uint64_t, Bits / 64>;

template <std::size_t Bits>
Mask<Bits> mask_at(const std::byte* at) {
  Mask<Bits> mask;
  std::memcpy(mask.data(), at, sizeof mask);
  return mask;
}

template <typename MaskType>
std::uint64_t count(const MaskType& mask) {
  std::uint64_t bits = 0;
  for (const std::uint64_t word : mask) bits += static_cast<std::uint64_t>(std::popcount(word));
  return bits;
}

// Calls `visit` with the address of each child of `node`, in the order of its table.
template <std::size_t Entries, typename Visit>
void for_each_child(const std::byte* node, const nvdb::InternalLayout& layout, const Visit& visit) {
  const auto children = mask_at<Entries>(node + layout.child_mask);
  for (std::size_t w = 0; w < children.size(); ++w) {
    for (std::uint64_t word = children[w]; word != 0; word &= word - 1) {
      const std::size_t i = 64 * w + static_cast<std::size_t>(std::countr_zero(word));
      visit(node + load<std::int64_t>(node + layout.table + 8 * i));
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
      : grid_(grid), path_(path), options_(options), file_(file) {
    grid_.for_each_root_entry([&](const RootEntry& entry) { entries_.push_back(entry); });
    // Of OpenVDB's map, in whose order the leaves' values are looked for.
    std::sort(entries_.begin(), entries_.end(), [](const RootEntry& a, const RootEntry& b) {
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
    if (options_.half) head.metadata["weir_half_max_abs_error"] = written_.half_max_abs_error;
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
    written_.level_set = load<std::uint32_t>(grid_.data().data() + nvdb::grid::kGridClass) == kLevelSet;
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

  // What the file holds of `value`; keeps the largest difference in `worst`.
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
    const auto tiles =
        std::count_if(entries_.begin(), entries_.end(), [](const auto& e) { return e.upper == nullptr; });
    put_bytes(out, static_cast<std::uint32_t>(tiles));
    put_bytes(out, static_cast<std::uint32_t>(entries_.size()) - static_cast<std::uint32_t>(tiles));
    written_.topology.root_entries = entries_.size();
    for (const RootEntry& entry : entries_) {
      if (entry.upper != nullptr) continue;
      put_origin(out, entry.origin);
      put_bytes(out, stored(entry.value));
      put_bytes(out, std::uint8_t{entry.active});
      if (entry.active) written_.active_voxels += cube(kUpperDim);
    }
    for (const RootEntry& entry : entries_) {
      if (entry.upper == nullptr) continue;
      put_origin(out, entry.origin);
      ++written_.topology.nodes[2];
      internal<nvdb::kUpper.entries>(out, entry.upper, nvdb::kUpper, kLowerDim);
      for_each_child<nvdb::kUpper.entries>(entry.upper, nvdb::kUpper, [&](const std::byte* lower) {
        ++written_.topology.nodes[1];
        internal<nvdb::kLower.entries>(out, lower, nvdb::kLower, kLeafDim);
        for_each_child<nvdb::kLower.entries>(lower, nvdb::kLower, [&](const std::byte* leaf) {
          const auto active = mask_at<kLeafVoxels>(leaf + nvdb::leaf::kValueMask);
          put_bytes(out, active);
          written_.active_voxels += count(active);
          if (++written_.topology.nodes[0] % kLeavesAtOnce == 0) report(0.1, written_.topology.nodes[0], 0);
        });
        // One without leaves is 33 KiB of pages too.
        if (written_.topology.nodes[1] % (kLeavesAtOnce / 16) == 0) report(0.1, written_.topology.nodes[0], 0);
      });
    }
  }

  static void put_origin(std::ostream& out, const Index3& origin) {
    for (const std::int64_t c : {origin.x, origin.y, origin.z}) put_bytes(out, static_cast<std::int32_t>(c));
  }

  static std::uint64_t cube(std::int64_t dim) { return static_cast<std::uint64_t>(dim * dim * dim); }

  // The masks and tiles of an upper or lower node whose entries have an edge of `dim` voxels.
  template <std::size_t Entries>
  void internal(std::ostream& out, const std::byte* node, const nvdb::InternalLayout& layout, std::int64_t dim) {
    const auto children = mask_at<Entries>(node + layout.child_mask);
    const auto active = mask_at<Entries>(node + layout.value_mask);
    std::vector<float> values(Entries);
    for (std::size_t i = 0; i < Entries; ++i) {
      const bool child = (children[i / 64] >> i % 64 & 1U) != 0;
      values[i] = child ? 0 : stored(load<float>(node + layout.table + 8 * i));
    }
    put_bytes(out, children);
    put_bytes(out, active);
    write_vdb_values(out, values, active, children, storage_);
    written_.active_voxels += count(active) * cube(dim);
  }

  void leaves(std::ostream& out) {
    std::vector<const std::byte*> batch;
    std::uint64_t done = 0;
    const auto flush = [&] {
      write_batch(out, batch);
      done += batch.size();
      batch.clear();
      report(0.9, done, 0.1);
    };
    for (const RootEntry& entry : entries_) {
      if (entry.upper == nullptr) continue;
      for_each_child<nvdb::kUpper.entries>(entry.upper, nvdb::kUpper, [&](const std::byte* lower) {
        for_each_child<nvdb::kLower.entries>(lower, nvdb::kLower, [&](const std::byte* leaf) {
          batch.push_back(leaf);
          if (batch.size() == kLeavesAtOnce) flush();
        });
      });
    }
    flush();
  }

  void write_batch(std::ostream& out, const std::vector<const std::byte*>& batch) {
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

  void write_leaf(std::ostream& out, const std::byte* leaf, double& worst) const {
    static constexpr Mask<kLeafVoxels> kNoChildren{};
    std::array<float, kLeafVoxels> values;
    grid_.decode_leaf(leaf, values);
    for (float& value : values) value = stored(value, worst);
    const auto active = mask_at<kLeafVoxels>(leaf + nvdb::leaf::kValueMask);
    put_bytes(out, active);
    write_vdb_values(out, values, active, kNoChildren, storage_);
  }

  // `leaves` of all are done in a pass that has `share` of the work and begins at `from`.
  void report(double share, std::uint64_t leaves, double from) const {
    const auto all = static_cast<double>(std::max(grid_.node_counts()[0], 1U));
    if (options_.progress) options_.progress(from + share * static_cast<double>(leaves) / all);
    if (options_.release_pages) options_.release_pages();
  }

  const NvdbGrid& grid_;
  const std::string& path_;
  const VdbWriterOptions& options_;
  File& file_;
  std::vector<RootEntry> entries_;
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
