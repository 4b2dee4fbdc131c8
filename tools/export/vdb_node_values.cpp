#include "tools/export/vdb_node_values.h"

#include <array>
#include <bit>
#include <cstddef>
#include <vector>

#include "ingest/vdb/openvdb_library.h"

namespace weir {
namespace {

const OpenVdbLibrary& library() {
  static const OpenVdbLibrary& loaded = openvdb_library("OpenVDB files are to be written");
  return loaded;
}

/// The kinds of Compression.h that this writer uses.
enum Kind : std::uint8_t { inactive_background = 0, one_inactive = 2, mask_and_two = 5, all_values = 6 };

struct Inactive {
  Kind kind = inactive_background;
  std::array<std::uint32_t, 2> bits{};  ///< bits of the inactive values, as many as `kind` has
};

template <typename T>
void put(std::ostream& out, const T& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void put_all(std::ostream& out, const std::vector<T>& values) {
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

// Calls `visit` with the position of each set bit of `word`; bit 0 has position `first`.
template <typename Visit>
void for_each_bit(std::uint64_t word, std::size_t first, const Visit& visit) {
  for (; word != 0; word &= word - 1) visit(first + static_cast<std::size_t>(std::countr_zero(word)));
}

Inactive inactive_values(std::span<const float> values, std::span<const std::uint64_t> active,
                         std::span<const std::uint64_t> children, float background) {
  Inactive found;
  std::size_t different = 0;
  for (std::size_t w = 0; w < active.size(); ++w) {
    for_each_bit(~(active[w] | children[w]), 64 * w, [&](std::size_t i) {
      const auto bits = std::bit_cast<std::uint32_t>(values[i]);
      if ((different > 0 && bits == found.bits[0]) || (different > 1 && bits == found.bits[1])) return;
      if (different < 2) found.bits[different] = bits;
      ++different;
    });
    if (different > 2) return {all_values, {}};
  }
  if (different == 2) {
    found.kind = mask_and_two;
  } else if (different == 1 && found.bits[0] != std::bit_cast<std::uint32_t>(background)) {
    found.kind = one_inactive;
  }
  return found;
}

template <typename T>
void put_packed(std::ostream& out, const std::vector<T>& values, std::uint32_t compression) {
  const char* const bytes = reinterpret_cast<const char*>(values.data());
  if ((compression & kVdbBlosc) != 0) {
    library().write_blosc(out, bytes, sizeof(T), values.size());
  } else if ((compression & kVdbZip) != 0) {
    library().write_zip(out, bytes, sizeof(T) * values.size());
  } else {
    put_all(out, values);
  }
}

}  // namespace

float rounded_to_half(float value) { return library().value_of_half(library().half_of(value)); }

void write_vdb_values(std::ostream& out, std::span<const float> values, std::span<const std::uint64_t> active,
                      std::span<const std::uint64_t> children, const VdbStorage& storage) {
  const Inactive inactive = inactive_values(values, active, children, storage.background);
  put(out, inactive.kind);
  if (inactive.kind == one_inactive || inactive.kind == mask_and_two) put(out, inactive.bits[0]);
  if (inactive.kind == mask_and_two) {
    put(out, inactive.bits[1]);
    std::vector<std::uint64_t> second(active.size());
    for (std::size_t w = 0; w < active.size(); ++w) {
      for_each_bit(~(active[w] | children[w]), 64 * w, [&](std::size_t i) {
        if (std::bit_cast<std::uint32_t>(values[i]) == inactive.bits[1]) second[w] |= std::uint64_t{1} << i % 64;
      });
    }
    put_all(out, second);
  }

  std::vector<float> kept;
  if (inactive.kind == all_values) {
    kept.assign(values.begin(), values.end());
  } else {
    for (std::size_t w = 0; w < active.size(); ++w) {
      for_each_bit(active[w], 64 * w, [&](std::size_t i) { kept.push_back(values[i]); });
    }
  }
  if (!storage.half) return put_packed(out, kept, storage.compression);
  if (kept.empty()) return;  // without values, not even a length is written
  std::vector<std::uint16_t> halves;
  halves.reserve(kept.size());
  for (const float value : kept) halves.push_back(library().half_of(value));
  put_packed(out, halves, storage.compression);
}

}  // namespace weir
