#include "compressor/push/leaf_spool.h"

#include <cstring>
#include <utility>

namespace weir {
namespace {

/// Copies `part` out of an array over `whole`, both x fastest, without gaps.
void gather(const Box& part, const Box& whole, std::size_t value_bytes, const std::byte* values, std::byte* out) {
  const Index3 extent = part.extent();
  const auto bytes = [value_bytes](std::int64_t count) { return static_cast<std::size_t>(count) * value_bytes; };
  const std::byte* const corner = values + bytes(linear_index(part.lo - whole.lo, whole.extent()));
  const std::size_t row = bytes(extent.x);
  for (std::int64_t z = 0; z < extent.z; ++z) {
    for (std::int64_t y = 0; y < extent.y; ++y) {
      std::memcpy(out, corner + bytes(linear_index({0, y, z}, whole.extent())), row);
      out += row;
    }
  }
}

SpooledLeaf state_of(std::span<const std::byte> values, std::size_t value_bytes) {
  // Each value has the bits of the one before it.
  const bool constant = std::memcmp(values.data(), values.data() + value_bytes, values.size() - value_bytes) == 0;
  if (!constant) return {SpooledLeaf::State::spooled, {}};
  SpooledLeaf leaf{SpooledLeaf::State::constant, {}};
  std::memcpy(leaf.value.data(), values.data(), value_bytes);
  return leaf;
}

}  // namespace

LeafSpool::LeafSpool(std::shared_ptr<File> values, std::shared_ptr<File> states, const NodeLattice& leaves,
                     ScalarType type)
    : values_(std::move(values)), states_(std::move(states), leaves), type_(type) {}

void LeafSpool::write(const Box& box, std::span<const std::byte> values) {
  const Box leaf_box = leaves().positions(box);
  std::vector<SpooledLeaf> states(static_cast<std::size_t>(leaf_box.voxels()));
  std::vector<std::byte> row(static_cast<std::size_t>(leaf_box.extent().x) * leaf_bytes());
  auto row_states = states.begin();
  for (std::int64_t z = leaf_box.lo.z; z < leaf_box.hi.z; ++z) {
    for (std::int64_t y = leaf_box.lo.y; y < leaf_box.hi.y; ++y) {
      write_row({leaf_box.lo.x, y, z}, std::span(row_states, row_states + leaf_box.extent().x), row, box, values);
      row_states += leaf_box.extent().x;
    }
  }
  states_.write_box(leaf_box, states);
}

void LeafSpool::write_row(const Index3& first, std::span<SpooledLeaf> states, std::span<std::byte> row, const Box& box,
                          std::span<const std::byte> values) {
  const std::size_t value_bytes = scalar_bytes(type_);
  const std::int64_t linear = leaves().linear(first);
  std::size_t held = 0;  // leaves at the end of those so far, to be written in one go
  const auto flush = [&](std::size_t end) {
    if (held == 0) return;
    const std::size_t begin = end - held;
    values_->write_at(place_of(linear + static_cast<std::int64_t>(begin)),
                      row.subspan(begin * leaf_bytes(), held * leaf_bytes()));
    held = 0;
  };
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Box inside = leaves().voxels(first + Index3{static_cast<std::int64_t>(i), 0, 0});
    const Box part = intersect(inside, box);
    const std::span<std::byte> leaf =
        row.subspan(i * leaf_bytes(), static_cast<std::size_t>(part.voxels()) * value_bytes);
    gather(part, box, value_bytes, values.data(), leaf.data());
    if (part != inside) {
      flush(i);
      states[i] = {SpooledLeaf::State::spooled, {}};
      write_part(linear + static_cast<std::int64_t>(i), part, inside, leaf);
      continue;
    }
    states[i] = state_of(leaf, value_bytes);
    if (states[i].state == SpooledLeaf::State::spooled) {
      ++held;
    } else {
      flush(i);
    }
  }
  flush(states.size());
}

void LeafSpool::write_part(std::int64_t leaf, const Box& part, const Box& inside, std::span<const std::byte> values) {
  const Index3 e = part.extent();
  const Index3 all = inside.extent();
  // Rows without a gap between them are written as one row.
  const std::int64_t run = e.x * (e.x == all.x ? e.y : 1) * (e.x == all.x && e.y == all.y ? e.z : 1);
  const std::size_t value_bytes = scalar_bytes(type_);
  const std::size_t run_bytes = static_cast<std::size_t>(run) * value_bytes;
  for (std::int64_t i = 0; i < part.voxels(); i += run) {
    const std::int64_t at = linear_index(part.lo - inside.lo + index_at(i, e), all);
    values_->write_at(place_of(leaf) + static_cast<std::uint64_t>(at) * value_bytes,
                      values.subspan(static_cast<std::size_t>(i) * value_bytes, run_bytes));
  }
}

void LeafSpool::read_values(std::int64_t first, std::span<std::byte> values) const {
  values_->read_at(place_of(first), values);
}

void LeafSpool::park(std::int64_t first, std::uint64_t at, std::span<const std::byte> bytes) {
  values_->write_at(place_of(first) + at, bytes);
}

void LeafSpool::unpark(std::int64_t first, std::uint64_t at, std::span<std::byte> bytes) const {
  values_->read_at(place_of(first) + at, bytes);
}

}  // namespace weir
