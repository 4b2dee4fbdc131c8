#include "format/quantised_codec.h"

#include <algorithm>
#include <cstring>

#include "format/leaf_head.h"
#include "format/little_endian.h"
#include "format/nanovdb_layout.h"

namespace weir {
namespace {

// Codes packed from the lowest bit up; 16-bit ones little-endian.
void pack_codes(std::span<const std::uint16_t, kLeafVoxels> codes, unsigned bits_log2, std::span<std::byte> out) {
  if (bits_log2 == 4) {
    for (std::size_t i = 0; i < codes.size(); ++i) store(out, 2 * i, codes[i]);
    return;
  }
  const unsigned bits = 1U << bits_log2;
  const std::size_t per_byte = 8 / bits;
  for (std::size_t byte = 0; byte < codes.size() / per_byte; ++byte) {
    unsigned packed = 0;
    for (std::size_t k = 0; k < per_byte; ++k) packed |= codes[byte * per_byte + k] << (k * bits);
    out[byte] = static_cast<std::byte>(packed);
  }
}

// A statistic in units of the quantum, as the stock code rounds it; zero where all values are one.
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
