#include "tools/verify/volume_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "tools/verify/packed_census.h"

namespace weir {
namespace {

template <typename T>
std::string text_of(const T& value) {
  return cat(value);
}
std::string text_of(const Index3& i) { return cat('(', i.x, ", ", i.y, ", ", i.z, ')'); }
std::string text_of(const Box& box) { return cat(text_of(box.lo), " .. ", text_of(box.hi)); }
template <typename T, std::size_t N>
std::string text_of(const std::array<T, N>& values) {
  std::string text = "(";
  for (const T& value : values) text += cat(text.size() > 1 ? ", " : "", value);
  return text + ')';
}

template <typename T>
VolumeCheck equal(const std::string& name, const T& found, const T& expected) {
  return {name, text_of(found), text_of(expected), found == expected};
}

// Returns whether the values agree; the sidecar has null for any value that is not finite.
bool same_value(double stored, double from_sidecar) {
  return stored == from_sidecar || (!std::isfinite(stored) && !std::isfinite(from_sidecar));
}

VolumeCheck head_checksum(const NvdbGrid& grid) {
  if (grid.head_checksum() == static_cast<std::uint32_t>(nvdb::kNoChecksum)) {
    return {"head checksum", "none stored", hex(computed_head_checksum(grid), 8), false};
  }
  return {"head checksum", hex(computed_head_checksum(grid), 8), hex(grid.head_checksum(), 8),
          computed_head_checksum(grid) == grid.head_checksum()};
}

VolumeCheck stored_range(const NvdbGrid& grid, const TreeCensus& census) {
  if ((load<std::uint32_t>(grid.data().data() + nvdb::grid::kFlags) & nvdb::grid::kFlagMinMax) == 0) {
    return {"stored range", "none stored", cat(census.min, " .. ", census.max), true};
  }
  const bool none = census.valued_voxels == census.nonfinite;  // nothing to bound
  const bool exact = grid.value_min() == census.min && grid.value_max() == census.max;
  return {"stored range", cat(grid.value_min(), " .. ", grid.value_max()), cat(census.min, " .. ", census.max),
          none || census.nonfinite != 0 || exact};
}

// Checks that every decoded value is within max_abs of a source value, or is the background.
VolumeCheck source_range(const NvdbGrid& grid, const TreeCensus& census, const Sidecar& sidecar) {
  const auto [lo, hi] = sidecar.value_range;
  const auto widened = [&](double bound, double away) {
    const double moved = std::isfinite(sidecar.error.max_abs) ? bound + away * sidecar.error.max_abs : away * HUGE_VAL;
    return std::nextafter(static_cast<float>(moved), static_cast<float>(away * HUGE_VAL));
  };
  const float least = std::min(widened(lo, -1), grid.background());
  const float most = std::max(widened(hi, 1), grid.background());
  const bool ok = census.valued_voxels == census.nonfinite || !std::isfinite(lo) || !std::isfinite(hi) ||
                  (census.min >= least && census.max <= most);
  return {"sidecar value_range", cat(census.min, " .. ", census.max), cat("within ", least, " .. ", most), ok};
}

// Checks the counts of missing and non-finite voxels. With a policy that refuses them there must be none.
std::vector<VolumeCheck> validity_checks(const TreeCensus& census, const Sidecar& s) {
  const auto all = static_cast<std::uint64_t>(volume(s.source.extent));
  const std::uint64_t others = s.nonfinite.count + s.missing.count;
  std::vector<VolumeCheck> checks{{"sidecar missing.count", cat(s.missing.count), cat("at most ", all), others <= all}};
  const bool refused = s.missing.policy == "error" && s.missing.count > 0;
  if (refused)
    checks.push_back({"sidecar missing.policy", s.missing.policy, "another one, with missing voxels", false});
  if (s.nonfinite.policy != "keep") checks.push_back(equal("non-finite voxels", census.nonfinite, std::uint64_t{0}));
  return checks;
}

// Counts the kinds of blocks again and compares them with the sidecar.
std::vector<VolumeCheck> packed_checks(const PackedData& packed, const Sidecar& sidecar) {
  if (!sidecar.packed || !sidecar.selection.blocks)
    return {{"sidecar packed, selection.blocks", "no such objects", "those of a packed file", false}};
  const PackedCensus census = take_packed_census(packed);
  const std::array<std::uint64_t, 5> blocks{census.none, census.blocks[0], census.blocks[1], census.blocks[2],
                                            census.blocks[3]};
  const std::uint64_t kept = std::accumulate(census.blocks.begin(), census.blocks.end(), std::uint64_t{0});
  return {equal("sidecar packed.preview", packed.header().preview, sidecar.packed->preview),
          equal("sidecar selection.blocks", blocks, *sidecar.selection.blocks),
          equal("sidecar selection.leaves_kept", kept, sidecar.selection.leaves_kept),
          equal("sidecar selection.bits", decltype(sidecar.selection.bits){}, sidecar.selection.bits)};
}

}  // namespace

std::vector<VolumeCheck> check_structure(const NvdbGrid& grid, const TreeCensus& census) {
  std::vector<VolumeCheck> checks;
  checks.push_back(head_checksum(grid));
  std::array<std::uint64_t, 3> stored_tiles{};
  std::copy_n(grid.tile_counts().begin(), stored_tiles.size(), stored_tiles.begin());
  checks.push_back(equal("active tiles", stored_tiles, census.active_tiles));
  checks.push_back(equal("active voxels", grid.active_voxels(), census.active_voxels));
  // Without a preview only the header and the root know the domain.
  if (grid.packed() == nullptr || grid.packed()->header().preview) {
    checks.push_back(equal("bounding box", grid.index_bbox(), census.active_bbox));
  }
  checks.push_back(stored_range(grid, census));
  if (!grid.macrocells().cells.empty()) {
    const auto& outside = census.outside_macrocell;
    const auto& apron = census.outside_apron;
    checks.push_back({"macrocells",
                      outside ? "the block at " + text_of(*outside) + " exceeds its cell"
                      : apron ? "values around the cell at " + text_of(*apron) + " exceed it"
                              : "all hold",
                      "bounds of every decoded value", !outside && !apron});
  }
  return checks;
}

std::vector<VolumeCheck> check_sidecar(const NvdbGrid& grid, const TreeCensus& census, const std::string& digest,
                                       const Sidecar& s) {
  std::vector<VolumeCheck> checks;
  checks.push_back(equal("sidecar file.bytes", std::uint64_t{grid.bytes().size()}, s.file.bytes));
  checks.push_back(equal("sidecar budget.file_bytes", std::uint64_t{grid.bytes().size()}, s.budget.file_bytes));
  checks.push_back(equal("sidecar file.grid_offset", grid.grid_offset(), s.file.grid_offset));
  checks.push_back({"sidecar file.head_checksum", hex(grid.head_checksum(), 8), hex(s.file.head_checksum, 8),
                    grid.head_checksum() == s.file.head_checksum});
  checks.push_back(equal("sidecar file.digest", digest, s.file.digest));
  checks.push_back(equal("sidecar grid.name", grid.name(), s.grid.name));
  checks.push_back(equal("sidecar grid.type", std::string(grid_type_name(grid.type())), s.grid.type));
  checks.push_back(equal("sidecar grid.index_bbox", grid.index_bbox(), s.grid.index_bbox));
  checks.push_back(equal("sidecar grid.extent", grid.index_bbox().extent(), s.grid.extent));
  checks.push_back(equal("sidecar grid.voxel_size", grid.voxel_size(), s.grid.voxel_size));
  checks.push_back(equal("sidecar grid.origin", grid.world_origin(), s.grid.origin));
  checks.push_back({"sidecar background.value", cat(grid.background()), cat(s.background.value),
                    same_value(grid.background(), s.background.value)});
  checks.push_back(source_range(grid, census, s));
  for (VolumeCheck& check : validity_checks(census, s)) checks.push_back(std::move(check));
  if (grid.packed() == nullptr) {  // a packed grid's selection is not of leaves
    checks.push_back(equal("sidecar selection.bits", census.leaves_by_bits, s.selection.bits));
    checks.push_back(equal("sidecar selection.leaves_kept", census.leaves, s.selection.leaves_kept));
  } else {
    for (VolumeCheck& check : packed_checks(*grid.packed(), s)) checks.push_back(std::move(check));
  }
  const MacrocellView cells = grid.macrocells();
  checks.push_back(equal("sidecar macrocells.cell", cells.cell, s.macrocells.cell));
  checks.push_back(equal("sidecar macrocells.dims", cells.lattice.count, s.macrocells.dims));
  checks.push_back(equal("sidecar macrocells.apron", cells.apron, s.macrocells.apron));
  return checks;
}

}  // namespace weir
