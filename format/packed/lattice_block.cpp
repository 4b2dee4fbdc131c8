#include "format/packed/lattice_block.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "format/packed/block_decode.h"
#include "format/packed/coefficient_encoder.h"

namespace weir {
namespace {

using Codes = std::array<std::uint32_t, 512>;

std::optional<Codes> codes_on(const Lattice& lattice, std::span<const float, 512> values) {
  if (!(lattice.quantum > 0)) return std::nullopt;
  Codes codes;
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

ScanValues residuals_of(const Codes& codes, unsigned predictor, bool ordered) {
  ScanValues values;
  for (unsigned place = 1; place < 512; ++place) {
    const unsigned i = kBlockScan.index[place];
    const std::int64_t predicted = predict(predictor, ordered, codes.data(), i >> 6U, i >> 3U & 7U, i & 7U);
    const std::uint32_t residual = codes[i] - static_cast<std::uint32_t>(predicted);
    values.negative[place] = residual >> 31U != 0;
    values.magnitudes[place] = values.negative[place] ? 0U - residual : residual;
  }
  return values;
}

// What residuals take about, to choose a predictor by.
std::uint32_t rough_bits(const ScanValues& values) {
  std::uint32_t bits = 0;
  for (const std::uint32_t m : values.magnitudes) bits += static_cast<std::uint32_t>(std::bit_width(3 * m));
  return bits;
}

ScanValues best_residuals(const Codes& codes, bool ordered, unsigned& best_predictor) {
  ScanValues best;
  std::uint32_t least = ~0U;
  for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
    const ScanValues values = residuals_of(codes, predictor, ordered);
    const std::uint32_t bits = rough_bits(values);
    if (bits >= least) continue;
    least = bits;
    best = values;
    best_predictor = predictor;
  }
  return best;
}

// Writes the stream of kind 2 over those codes where it is shorter than raw values. Returns its bytes, else 0.
std::uint32_t write_codes(const BlockConstants& constants, LatticeKind kind, const Lattice& lattice, const Codes& codes,
                          std::span<std::byte> out) {
  const bool ordered = kind == LatticeKind::ordered;
  const std::size_t front_at = kind == LatticeKind::own ? 9 : 1;
  const CoderContexts contexts{constants.tables + std::size_t{kPackedSymbols} * kPackedLevels * kPackedBands, false};
  StreamFront front;
  front.end_bits = 6;
  front.number = codes[0];
  front.number_bits = kind == LatticeKind::own ? 24 : ordered ? 32 : lattice.bits;
  unsigned predictor = 0;
  const ScanValues values = best_residuals(codes, ordered, predictor);
  front.end = end_of(values);
  std::array<std::byte, 2 * kRawStreamBytes> scratch;
  std::uint32_t coded = 0;
  encode_values(contexts, front, values, scratch, &coded);
  const auto bytes = static_cast<std::uint32_t>(coded + front_at);
  if (bytes >= kRawStreamBytes) return 0;
  encode_values(contexts, front, values, out.first(bytes).subspan(front_at));
  out[0] = static_cast<std::byte>(static_cast<unsigned>(StreamKind::lattice) | predictor << 2U |
                                  static_cast<unsigned>(kind) << 4U);
  if (kind == LatticeKind::own) {
    std::memcpy(out.data() + 1, &lattice.minimum, sizeof lattice.minimum);
    std::memcpy(out.data() + 5, &lattice.quantum, sizeof lattice.quantum);
  }
  return bytes;
}

}  // namespace

std::uint32_t encode_raw(std::span<const float, 512> values, std::span<std::byte> out) {
  out[0] = static_cast<std::byte>(StreamKind::raw);
  std::memcpy(out.data() + 1, values.data(), values.size_bytes());
  return kRawStreamBytes;
}

std::uint32_t encode_exact(const BlockConstants& constants, const std::optional<Lattice>& own,
                           std::span<const float, 512> values, std::span<std::byte> out, FloatOrder order) {
  const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
  if (std::all_of(values.begin(), values.end(), [&](float v) { return bits(v) == bits(values[0]); })) {
    out[0] = static_cast<std::byte>(static_cast<unsigned>(StreamKind::raw) | 4U);
    std::memcpy(out.data() + 1, values.data(), sizeof(float));
    return 5;
  }
  const Lattice file{constants.lattice_minimum, constants.lattice_quantum, constants.lattice_bits};
  std::uint32_t bytes = 0;
  if (const auto codes = codes_on(file, values)) {
    bytes = write_codes(constants, LatticeKind::file, file, *codes, out);
  } else if (const auto own_codes = own ? codes_on(*own, values) : std::nullopt) {
    bytes = write_codes(constants, LatticeKind::own, *own, *own_codes, out);
  } else if (order == FloatOrder::used) {
    Codes in_order;
    std::transform(values.begin(), values.end(), in_order.begin(), ordered_of_float);
    bytes = write_codes(constants, LatticeKind::ordered, {}, in_order, out);
  }
  return bytes == 0 ? encode_raw(values, out) : bytes;
}

}  // namespace weir
