#include "format/leaf/quantised_codec.h"

#include <algorithm>

#include "format/base/little_endian.h"
#include "format/layout/nanovdb_layout.h"
#include "format/leaf/leaf_head.h"

namespace weir {
namespace {

// Packs codes of `Bits` bits, 8 / Bits to a byte, from the lowest bit up.
template <unsigned Bits>
void pack(std::span<const std::uint16_t, kLeafVoxels> codes, std::byte* out) {
  constexpr std::size_t kPerByte = 8 / Bits;
  for (std::size_t byte = 0; byte < kLeafVoxels / kPerByte; ++byte) {
    unsigned packed = 0;
    for (std::size_t k = 0; k < kPerByte; ++k)
      packed |= static_cast<unsigned>(codes[byte * kPerByte + k]) << (k * Bits);
    out[byte] = static_cast<std::byte>(packed);
  }
}

void pack_codes(std::span<const std::uint16_t, kLeafVoxels> codes, unsigned bits_log2, std::span<std::byte> out) {
  switch (bits_log2) {
    case 0:
      return pack<1>(codes, out.data());
    case 1:
      return pack<2>(codes, out.data());
    case 2:
      return pack<4>(codes, out.data());
    case 3:
      return pack<8>(codes, out.data());
    default:
      for (std::size_t i = 0; i < codes.size(); ++i) store(out, 2 * i, codes[i]);
  }
}

// Returns a statistic in units of the quantum, rounded as in the stock code; zero if all values are equal.
std::uint16_t in_quanta(float value, float quantum) {
  if (!(quantum > 0)) return 0;
  return static_cast<std::uint16_t>(std::clamp(value / quantum + 0.5F, 0.0F, 65535.0F));
}

}  // namespace

void encode_quantised_leaf(GridType type, std::span<const std::uint16_t, kLeafVoxels> codes, unsigned bits_log2,
                           float minimum, float quantum, const Box& node, const Box& inside,
                           const NodeStatistics& statistics, std::span<std::byte> image) {
  using namespace nvdb::leaf;
  const auto width_flag = static_cast<std::uint8_t>(type == GridType::fpn ? bits_log2 << 5U : 0U);
  write_leaf_head(node, inside, width_flag, image);
  store(image, kQuantMinimum, minimum);
  store(image, kQuantum, quantum);
  store(image, kQuantMin, in_quanta(statistics.min - minimum, quantum));
  store(image, kQuantMax, in_quanta(statistics.max - minimum, quantum));
  store(image, kQuantAverage, in_quanta(statistics.average() - minimum, quantum));
  store(image, kQuantStdDev, in_quanta(statistics.deviation(), quantum));
  pack_codes(codes, bits_log2, image.subspan(kCodes));
}

}  // namespace weir
