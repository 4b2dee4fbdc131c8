#include "compressor/packed/exact_block.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "compressor/leaf/leaf_lattice.h"
#include "format/base/simd.h"

namespace weir {
namespace {

BlockConstants constants_of(const std::optional<Lattice>& lattice) {
  BlockConstants constants;
  constants.tables = built_in_tables();
  if (lattice) {
    constants.lattice_minimum = lattice->minimum;
    constants.lattice_quantum = lattice->quantum;
    constants.lattice_bits = lattice->bits;
  }
  return constants;
}

// The least and the largest value of a block; none if a value is not finite.
struct FiniteRange {
  float low;
  float high;
  bool finite;
};

WEIR_SIMD FiniteRange finite_range(const float* values) {
  Floats8 low;
  std::memcpy(&low, values, sizeof low);
  Floats8 high = low;
  Floats8 differences{};  // each value minus itself: not 0 if the value is not finite
  for (unsigned i = 0; i < kLeafVoxels; i += 8) {
    Floats8 v;
    std::memcpy(&v, values + i, sizeof v);
    differences += v - v;
    low = v < low ? v : low;
    high = v > high ? v : high;
  }
  FiniteRange range{low[0], high[0], true};
  for (int l = 0; l < 8; ++l) {
    range.low = low[l] < range.low ? low[l] : range.low;
    range.high = high[l] > range.high ? high[l] : range.high;
    range.finite = range.finite && differences[l] == 0;
  }
  return range;
}

std::optional<Lattice> own_lattice(const LeafValues& block) {
  const FiniteRange range = finite_range(block.data());
  if (!range.finite || !(range.low < range.high)) return std::nullopt;
  const auto lattice = find_lattice(block, range.low, range.high);
  if (!lattice) return std::nullopt;
  return Lattice{range.low, lattice->step, static_cast<std::uint32_t>(std::bit_width(lattice->largest))};
}

constexpr double kMostCodes = 1U << kMostLatticeBits;  // of a lattice

}  // namespace

std::uint32_t ExactBlock::write(const LeafValues& block, const std::optional<Lattice>& lattice,
                                std::span<std::byte> out, FloatOrder order) const {
  if (lattice) return encode_exact(coder_, constants_of(lattice), std::nullopt, block, out, order);
  const std::optional<Lattice> own = own_lattice(block);
  // A block has smaller codes on a coarser lattice of its own.
  const bool whole = own && own->quantum == kWholeNumbers.quantum;
  return encode_exact(coder_, constants_of(whole ? std::optional(kWholeNumbers) : std::nullopt), own, block, out,
                      order);
}

std::uint32_t ExactBlock::write_bounded(const LeafValues& block, double max_error, std::span<std::byte> out) const {
  const auto [low, high] = std::minmax_element(block.begin(), block.end());
  const float minimum = *low;
  // The error is half a quantum plus the two roundings of the decoder.
  const double magnitude = static_cast<double>(std::max(std::fabs(*low), std::fabs(*high)));
  const double allowed = max_error - magnitude * 0x1p-22;
  if (!(allowed > 0)) return 0;
  const auto quantum = static_cast<float>(2 * allowed * (1 - 0x1p-23));
  if (!(quantum > 0) || !std::isfinite(quantum)) return 0;
  const double largest = (static_cast<double>(*high) - static_cast<double>(minimum)) / static_cast<double>(quantum) + 1;
  if (!(largest < kMostCodes)) return 0;
  LeafValues rounded;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const double code =
        std::nearbyint((static_cast<double>(block[i]) - static_cast<double>(minimum)) / static_cast<double>(quantum));
    const float product = static_cast<float>(code) * quantum;
    rounded[i] = product + minimum;
    if (!(std::fabs(static_cast<double>(rounded[i]) - static_cast<double>(block[i])) <= max_error)) return 0;
  }
  const Lattice lattice{minimum, quantum,
                        static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint32_t>(largest)))};
  return encode_exact(coder_, constants_of(std::nullopt), lattice, rounded, out);
}

}  // namespace weir
