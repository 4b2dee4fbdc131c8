#include "format/nanovdb/node_image.h"

#include <algorithm>

#include "format/base/little_endian.h"

namespace weir {
namespace {

void set_bit(std::span<std::byte> image, std::uint64_t mask, std::size_t bit) {
  image[mask + bit / 8] |= static_cast<std::byte>(1U << (bit % 8));
}

}  // namespace

NodeImage::NodeImage(Level level, float background)
    : layout_(level == Level::lower ? nvdb::kLower : nvdb::kUpper),
      log2_entries_(level == Level::lower ? 4 : 5),
      background_(background),
      image_(layout_.bytes) {
  reset();
}

void NodeImage::reset() {
  std::fill(image_.begin(), image_.end(), std::byte{0});
  for (std::uint64_t i = 0; i < layout_.entries; ++i) store(std::span(image_), layout_.table + 8 * i, background_);
}

std::size_t NodeImage::position(const Index3& entry) const {
  return static_cast<std::size_t>(entry.x << (2 * log2_entries_) | entry.y << log2_entries_ | entry.z);
}

void NodeImage::set_child(const Index3& entry, std::uint64_t bytes_from_node) {
  const std::size_t i = position(entry);
  set_bit(image_, layout_.child_mask, i);
  store(std::span(image_), layout_.table + 8 * i, bytes_from_node);
}

void NodeImage::set_tile(const Index3& entry, float value, bool active) {
  const std::size_t i = position(entry);
  if (active) set_bit(image_, layout_.value_mask, i);
  store(std::span(image_), layout_.table + 8 * i, std::uint64_t{0});
  store(std::span(image_), layout_.table + 8 * i, value);
}

void NodeImage::set_statistics(const NodeStatistics& statistics) {
  const std::span image(image_);
  const Index3 lo = statistics.bbox.lo;
  const Index3 hi = statistics.bbox.hi - Index3{1, 1, 1};
  std::size_t offset = nvdb::kNodeBBox;
  for (const std::int64_t c : {lo.x, lo.y, lo.z, hi.x, hi.y, hi.z}) {
    store(image, offset, static_cast<std::int32_t>(c));
    offset += 4;
  }
  // Bit 1: has active values; bit 0: a renderer may skip the node.
  store(image, nvdb::kNodeFlags, std::uint64_t{statistics.count > 0 ? 2U : 1U});
  store(image, layout_.min, statistics.min);
  store(image, layout_.max, statistics.max);
  store(image, layout_.average, statistics.average());
  store(image, layout_.stddev, statistics.deviation());
}

}  // namespace weir
