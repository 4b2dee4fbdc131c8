#include "ingest/amrex/composite.h"

#include <algorithm>
#include <bit>
#include <mutex>
#include <utility>
#include <variant>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/amrex/linear_cells.h"
#include "ingest/amrex/repeated_leaves.h"
#include "ingest/plan/for_pieces.h"
#include "ingest/plan/staging.h"
#include "ingest/source/extent.h"
#include "ingest/values/decode_values.h"

namespace weir {
namespace {

/// A box with fewer values per thread is not worth another thread.
constexpr std::int64_t kValuesPerThread = 64 * 1024;
/// Linear values are computed tile by tile, which bounds the values of coarser levels that are held.
constexpr std::int64_t kTile = 64;

/// Returns the parts grouped by FAB. The parts of a FAB lie side by side in `parts`.
std::vector<std::span<const CoverPart>> by_fab(std::span<const CoverPart> parts) {
  std::vector<std::span<const CoverPart>> groups;
  while (!parts.empty()) {
    const CoverPart& first = parts.front();
    const auto end = std::find_if(parts.begin(), parts.end(), [&](const CoverPart& part) {
      return part.level != first.level || part.fab != first.fab;
    });
    const auto count = static_cast<std::size_t>(end - parts.begin());
    groups.push_back(parts.first(count));
    parts = parts.subspan(count);
  }
  return groups;
}

std::size_t threads_for(const Box& box) {
  return static_cast<std::size_t>(
      std::clamp<std::int64_t>(box.voxels() / kValuesPerThread, 1, static_cast<std::int64_t>(kIoThreads)));
}

Error uncovered(const Plotfile& plotfile, const Box& box) {
  return Error(ErrorKind::internal, cat(plotfile.path, ": no level has the cells ", box_text(box)));
}

Box bounds_of_boxes(const std::vector<Box>& boxes) {
  Box bounds = boxes.front();
  for (const Box& box : boxes) bounds = {min(bounds.lo, box.lo), max(bounds.hi, box.hi)};
  return bounds;
}

/// Returns `mapping`, changed so that "no data" reads as missing_value(), which is not finite and so never
/// interpolated.
ValueMapping marking(ValueMapping mapping) {
  mapping.keeps_missing = false;
  return mapping;
}

template <typename T>
float kept_value_of(const ValueMapping& mapping, ScalarType type) {
  const T value = std::visit([](const auto v) { return static_cast<T>(v); }, mapping.missing.front());
  float read = 0;
  decode_values(std::as_bytes(std::span(&value, 1)), type, std::endian::native == std::endian::big, mapping,
                std::span(&read, 1));
  return read;
}

/// Returns the value that a stored "no data" value reads as. Plotfiles name no such value; only --missing does.
float value_of_missing(const ValueMapping& mapping, ScalarType type) {
  if (mapping.missing.empty() || !holds(type, mapping.missing.front())) return missing_value();
  return type == ScalarType::float32 ? kept_value_of<float>(mapping, type) : kept_value_of<double>(mapping, type);
}

/// Returns the tiles of `box`, cut at the planes of a grid of kTile cells.
std::vector<Box> tiles_of(const Box& box) {
  const Index3 first = floor_div(box.lo, kTile);
  const Index3 end = floor_div(box.hi - Index3{1, 1, 1}, kTile) + Index3{1, 1, 1};
  std::vector<Box> tiles;
  for_each_index({first, end}, [&](const Index3& i) {
    tiles.push_back(intersect({i * kTile, (i + Index3{1, 1, 1}) * kTile}, box));
  });
  return tiles;
}

}  // namespace

Composite::Composite(const Plotfile& plotfile, std::size_t component, const ValueMapping& mapping,
                     Upsampling upsampling, DirectIo mode, const Notice& notice)
    : plotfile_(plotfile),
      wanted_(plotfile.levels.size() - 1),
      upsampling_(upsampling),
      mapping_(mapping),
      coarse_mapping_(marking(mapping)),
      kept_value_(value_of_missing(mapping, plotfile.layout.type)),
      reader_(plotfile, component, mode, notice) {}

Composite::Composite(const Plotfile& plotfile, std::size_t component, const ValueMapping& mapping, std::size_t own,
                     DirectIo mode, const Notice& notice)
    : plotfile_(plotfile), wanted_(own), own_(true), mapping_(mapping), reader_(plotfile, component, mode, notice) {}

ConversionLoss Composite::read(const Box& box, std::span<float> values) {
  return upsampling_ == Upsampling::linear && wanted_ > 0 ? read_linear(box, values) : read_constant(box, values);
}

std::vector<Box> Composite::voxels_with_values(const Box& box) const {
  if (!own_) return {box};
  std::vector<Box> boxes;
  for (const CoverPart& part : own_parts(plotfile_.levels, wanted_, plotfile_.levels.size() - 1, box))
    boxes.push_back(part.box);
  return boxes;
}

std::vector<RepeatedPart> Composite::repeated_parts(const Box& box) const {
  if (own_ || upsampling_ != Upsampling::constant || wanted_ == 0) return {{box}};
  return repeated_leaves(plotfile_.levels, composite_parts(wanted_, box), box);
}

ConversionLoss Composite::read_repeated(const RepeatedPart& part, std::span<float> values) {
  if (!part.repeats()) return read(part.box, values);
  std::size_t level = wanted_;
  while (refinement(plotfile_.levels, level, wanted_) != part.by) --level;
  const Box cells = coarsened(part.box, part.by);
  const std::vector<CoverPart> parts = composite_parts(level, cells);
  ConversionLoss loss;
  for (const auto& of_fab : by_fab(parts)) loss.add(reader_.read(level, of_fab, cells, mapping_, values));
  return loss.times(static_cast<std::uint64_t>(volume(part.by)));
}

std::vector<CoverPart> Composite::composite_parts(std::size_t level, const Box& box) const {
  LevelCover cover = cover_box(plotfile_.levels, level, 0, box);
  if (!cover.rest.empty()) throw uncovered(plotfile_, cover.rest.front());
  return std::move(cover.parts);
}

std::vector<CoverPart> Composite::parts_of(const Box& box, std::span<float> values) const {
  if (!own_) return composite_parts(wanted_, box);
  std::vector<CoverPart> parts = own_parts(plotfile_.levels, wanted_, plotfile_.levels.size() - 1, box);
  std::int64_t cells = 0;
  for (const CoverPart& part : parts) cells += part.box.voxels();
  if (cells < box.voxels()) std::fill(values.begin(), values.end(), missing_value());
  return parts;
}

ConversionLoss Composite::read_constant(const Box& box, std::span<float> values) {
  const std::vector<CoverPart> parts = parts_of(box, values);
  const auto groups = by_fab(parts);
  const auto slabs = static_cast<std::int64_t>(threads_for(box));
  ConversionLoss total;
  std::mutex mutex;
  if (std::ssize(groups) < slabs && box.extent().z >= slabs) {  // few large boxes: several threads share each
    const std::int64_t plane = box.extent().x * box.extent().y;
    for_pieces(slabs, static_cast<std::size_t>(slabs), [&](std::int64_t i) {
      Box slab = box;
      slab.lo.z = box.lo.z + box.extent().z * i / slabs;
      slab.hi.z = box.lo.z + box.extent().z * (i + 1) / slabs;
      const auto in_slab = values.subspan(static_cast<std::size_t>((slab.lo.z - box.lo.z) * plane),
                                          static_cast<std::size_t>(slab.voxels()));
      const std::vector<CoverPart> parts_of_slab = parts_of(slab, in_slab);
      for (const auto& of_fab : by_fab(parts_of_slab)) {
        const ConversionLoss loss = reader_.read(wanted_, of_fab, slab, mapping_, in_slab);
        const std::lock_guard lock(mutex);
        total.add(loss);
      }
    });
    return total;
  }
  for_pieces(std::ssize(groups), threads_for(box), [&](std::int64_t i) {
    const ConversionLoss loss = reader_.read(wanted_, groups[static_cast<std::size_t>(i)], box, mapping_, values);
    const std::lock_guard lock(mutex);
    total.add(loss);
  });
  return total;
}

ConversionLoss Composite::read_linear(const Box& box, std::span<float> values) {
  const std::vector<Box> tiles = tiles_of(box);
  ConversionLoss total;
  std::mutex mutex;
  for_pieces(std::ssize(tiles), threads_for(box), [&](std::int64_t i) {
    const Box& tile = tiles[static_cast<std::size_t>(i)];
    const Index3 e = tile.extent();
    std::vector<float> of_tile(static_cast<std::size_t>(tile.voxels()));
    const ConversionLoss loss = read_tile(wanted_, tile, mapping_, of_tile);
    for (std::int64_t row = 0; row < e.y * e.z; ++row) {
      const Index3 first{0, row % e.y, row / e.y};
      std::copy_n(of_tile.begin() + row * e.x, e.x,
                  values.begin() + linear_index(tile.lo - box.lo + first, box.extent()));
    }
    const std::lock_guard lock(mutex);
    total.add(loss);
  });
  return total;
}

ConversionLoss Composite::read_tile(std::size_t level, const Box& box, const ValueMapping& mapping,
                                    std::span<float> values) {
  const LevelCover cover = cover_box(plotfile_.levels, level, level, box);
  ConversionLoss loss;
  for (const auto& parts : by_fab(cover.parts)) loss.add(reader_.read(level, parts, box, mapping, values));
  if (cover.rest.empty()) return loss;
  if (level == 0) throw uncovered(plotfile_, cover.rest.front());
  const Index3 by = plotfile_.levels[level].ratio;
  const Box support = linear_support(bounds_of_boxes(cover.rest), by, plotfile_.levels[level - 1].extent);
  std::vector<float> coarse(static_cast<std::size_t>(support.voxels()));
  read_tile(level - 1, support, coarse_mapping_, coarse);
  for (const Box& part : cover.rest) {
    upsample_linear({support, coarse}, by, part, box, values);
    if (mapping.keeps_missing && !mapping.missing.empty()) loss.unmarked += keep_missing(part, box, values);
  }
  return loss;
}

std::uint64_t Composite::keep_missing(const Box& part, const Box& box, std::span<float> values) const {
  std::uint64_t count = 0;
  for_each_index(part, [&](const Index3& i) {
    float& value = values[static_cast<std::size_t>(linear_index(i - box.lo, box.extent()))];
    if (!is_missing(value)) return;
    value = kept_value_;
    ++count;
  });
  return count;
}

std::uint64_t Composite::working_bytes() const {
  std::uint64_t boxes = 0;
  for (const PlotfileLevel& level : plotfile_.levels) boxes += level.boxes.size() * kBytesPerBox;
  for (std::size_t level = wanted_ + 1; level < plotfile_.levels.size(); ++level)
    boxes += plotfile_.levels[level].boxes.size() * kBytesPerFinerBox;
  constexpr std::uint64_t kParts = std::uint64_t{2} << 20U;  // for the parts of a block with the smallest boxes
  constexpr std::uint64_t kTileBytes = kTile * kTile * kTile * sizeof(float);
  return boxes + kParts + (upsampling_ == Upsampling::linear ? 2 * kIoThreads * kTileBytes : 0);
}

}  // namespace weir
