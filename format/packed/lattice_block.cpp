#include "format/packed/lattice_block.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "format/packed/block_decode.h"
#include "format/packed/residuals.h"

namespace weir {
namespace {

std::optional<BlockCodes> codes_on(const Lattice& lattice, std::span<const float, 512> values) {
  if (!(lattice.quantum > 0)) return std::nullopt;
  BlockCodes codes;
  const double most = std::ldexp(1.0, static_cast<int>(lattice.bits));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double code = std::nearbyint((static_cast<double>(values[i]) - static_cast<double>(lattice.minimum)) /
                                       static_cast<double>(lattice.quantum));
    if (!(code >= 0 && code < most)) return std::nullopt;
    const float product = static_cast<float>(code) * lattice.quantum;
    const float decoded = product + lattice.minimum;
    if (std::bit_cast<std::uint32_t>(decoded) != std::bit_cast<std::uint32_t>(values[i])) return std::nullopt;
    codes[i] = static_cast<std::uint32_t>(code);
  }
  return codes;
}

// Writes the stream of kind 2 for `codes` if it is shorter than raw values. Returns its bytes, otherwise 0.
std::uint32_t write_codes(const ValueEncoder& coder, LatticeKind kind, const Lattice& lattice, const BlockCodes& codes,
                          std::span<std::byte> out) {
  const bool ordered = kind == LatticeKind::ordered;
  const std::size_t front_at = kind == LatticeKind::own ? 9 : 1;
  StreamFront front;
  front.end_bits = kLatticeEndBits;
  front.number = codes[0];
  front.number_bits = kind == LatticeKind::own ? kMostLatticeBits : ordered ? kOrderedNumberBits : lattice.bits;
  BlockCodes residuals;
  const unsigned predictor = best_predictor(codes, ordered, residuals);
  MagnitudeRows magnitudes;
  front.end = end_at(fill_magnitudes(residuals, magnitudes).last_place);
  std::array<std::byte, 2 * kRawStreamBytes> scratch;
  StreamSize size;
  coder.encode(front, {magnitudes, residuals}, scratch, &size);
  const auto bytes = static_cast<std::uint32_t>(front_at + size.front + size.back);
  if (bytes >= kRawStreamBytes) return 0;
  std::copy_n(scratch.begin(), size.front, out.begin() + static_cast<std::ptrdiff_t>(front_at));
  std::copy_n(scratch.end() - size.back, size.back, out.begin() + static_cast<std::ptrdiff_t>(front_at + size.front));
  out[0] = static_cast<std::byte>(static_cast<unsigned>(PackedKind::lattice) | predictor << 2U |
                                  static_cast<unsigned>(kind) << 4U);
  if (kind == LatticeKind::own) {
    std::memcpy(out.data() + 1, &lattice.minimum, sizeof lattice.minimum);
    std::memcpy(out.data() + 5, &lattice.quantum, sizeof lattice.quantum);
  }
  return bytes;
}

}  // namespace

bool is_ordered(std::span<const std::byte> stream) {
  const auto head = std::to_integer<unsigned>(stream[0]);
  return (head & 3U) == static_cast<unsigned>(PackedKind::lattice) &&
         (head >> 4U & 3U) == static_cast<unsigned>(LatticeKind::ordered);
}

std::uint32_t encode_raw(std::span<const float, 512> values, std::span<std::byte> out) {
  out[0] = static_cast<std::byte>(PackedKind::raw);
  std::memcpy(out.data() + 1, values.data(), values.size_bytes());
  return kRawStreamBytes;
}

std::uint32_t encode_exact(const ValueEncoder& coder, const BlockConstants& constants,
                           const std::optional<Lattice>& own, std::span<const float, 512> values,
                           std::span<std::byte> out, FloatOrder order) {
  const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
  if (std::all_of(values.begin(), values.end(), [&](float v) { return bits(v) == bits(values[0]); })) {
    out[0] = static_cast<std::byte>(static_cast<unsigned>(PackedKind::raw) | 4U);
    std::memcpy(out.data() + 1, values.data(), sizeof(float));
    return kOneValueStreamBytes;
  }
  const Lattice file{constants.lattice_minimum, constants.lattice_quantum, constants.lattice_bits};
  std::uint32_t bytes = 0;
  if (const auto codes = codes_on(file, values)) {
    bytes = write_codes(coder, LatticeKind::file, file, *codes, out);
  } else if (const auto own_codes = own ? codes_on(*own, values) : std::nullopt) {
    bytes = write_codes(coder, LatticeKind::own, *own, *own_codes, out);
  } else if (order == FloatOrder::used) {
    BlockCodes in_order;
    std::transform(values.begin(), values.end(), in_order.begin(), ordered_of_float);
    bytes = write_codes(coder, LatticeKind::ordered, {}, in_order, out);
  }
  return bytes == 0 ? encode_raw(values, out) : bytes;
}

}  // namespace weir
