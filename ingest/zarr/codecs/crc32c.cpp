#include "ingest/zarr/codecs/crc32c.h"

#include <array>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::uint32_t kPolynomial = 0x82F63B78U;  // Castagnoli's, bits reversed
constexpr std::size_t kSlices = 8;                  // bytes processed at a time

using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

/// tables[k][b] is the effect of the byte b on the checksum k bytes later.
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? kPolynomial : 0U);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < kSlices; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8U) ^ tables[0][before & 0xFFU];
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  std::uint32_t crc = ~std::uint32_t{0};
  while (bytes.size() >= kSlices) {
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < kSlices; ++i) {
      const std::uint32_t of_crc = i < sizeof crc ? crc >> (8 * i) & 0xFFU : 0U;
      next ^= kTables[kSlices - 1 - i][of_crc ^ std::to_integer<std::uint32_t>(bytes[i])];
    }
    crc = next;
    bytes = bytes.subspan(kSlices);
  }
  for (const std::byte byte : bytes) {
    crc = (crc >> 8U) ^ kTables[0][(crc ^ std::to_integer<std::uint32_t>(byte)) & 0xFFU];
  }
  return ~crc;
}

std::span<std::byte> check_crc32c(std::span<std::byte> bytes) {
  if (bytes.size() < kCrc32cBytes) {
    throw Error(ErrorKind::input, cat("holds ", bytes.size(), " bytes, fewer than its crc32c takes"));
  }
  const std::span<std::byte> checked = bytes.first(bytes.size() - kCrc32cBytes);
  std::uint32_t stored = 0;
  for (std::size_t i = 0; i < kCrc32cBytes; ++i) {
    stored |= std::to_integer<std::uint32_t>(bytes[checked.size() + i]) << (8 * i);
  }
  const std::uint32_t computed = crc32c(checked);
  if (stored == computed) return checked;
  throw Error(ErrorKind::input, cat("its crc32c is ", hex(stored, 8), ", its bytes give ", hex(computed, 8)));
}

}  // namespace weir
