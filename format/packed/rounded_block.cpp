#include "format/packed/rounded_block.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "format/base/doubles8.h"
#include "format/packed/block_decode.h"
#include "format/packed/lattice_block.h"
#include "format/packed/lattice_codes.h"
#include "format/packed/near_rungs.h"

namespace weir {
namespace {

static_assert(kMostRoundedResidual <= RowCosts::kMostMagnitude);

struct Rounded {
  std::int32_t low;
  std::int32_t high;
  double squared_error;  // in squared quanta
};

WEIR_SIMD float largest_of(const float* values) {
  Floats8 largest{};
  for (unsigned i = 0; i < 512; i += 8) {
    Floats8 v;
    std::memcpy(&v, values + i, sizeof v);
    const Floats8 size = v < 0 ? -v : v;
    largest = size > largest ? size : largest;
  }
  float found = 0;
  for (int l = 0; l < 8; ++l) found = std::max(found, largest[l]);
  return found;
}

// All values lie above this many quanta. Codes counted from here have the same residuals as codes counted from the
// lowest value.
constexpr std::int32_t kLeastMultiple = -(1 << kMostRoundedBits);

// Rounds the values to the nearest whole multiples of the quantum, halves away from zero. `scale` is the quantum's
// inverse. The products are exact, except those too small for a float, with errors too small to count.
WEIR_SIMD Rounded round_all(const float* values, float scale, std::uint32_t* codes) {
  constexpr float kBelowHalf = 0x1.FFFFFEp-2F;  // the float below 0.5; adding 0.5 would round this float itself up to 1
  Doubles8 errors{};
  Ints8 low{};
  Ints8 high{};
  for (unsigned row = 0; row < 64; ++row) {
    Floats8 v;
    std::memcpy(&v, values + 8 * row, sizeof v);
    const Floats8 scaled = v * scale;
    const Floats8 half = scaled < 0 ? Floats8{} - kBelowHalf : Floats8{} + kBelowHalf;
    const Ints8 m = __builtin_convertvector(scaled + half, Ints8);
    const Ints8 code = m - kLeastMultiple;
    std::memcpy(codes + 8 * row, &code, sizeof code);
    const Doubles8 error(scaled - __builtin_convertvector(m, Floats8));
    errors += error * error;
    if (row == 0) low = high = m;
    low = m < low ? m : low;
    high = m > high ? m : high;
  }
  Rounded rounded{low[0], high[0], 0};
  for (int l = 0; l < 8; ++l) {
    rounded.low = std::min(rounded.low, low[l]);
    rounded.high = std::max(rounded.high, high[l]);
    rounded.squared_error += errors[l];
  }
  return rounded;
}

// lattice_value() for codes below 2^24.
WEIR_SIMD void values_at(const std::uint32_t* codes, const BlockConstants& constants, float minimum, float quantum,
                         float* values) {
  const Floats8 none{};
  const Floats8 low = constants.minimum - none;
  const Floats8 high = constants.maximum - none;
  for (unsigned i = 0; i < 512; i += 8) {
    Ints8 code;
    std::memcpy(&code, codes + i, sizeof code);
    const Floats8 product = __builtin_convertvector(code, Floats8) * quantum;
    Floats8 v = product + minimum;
    v = v <= high ? v : high;
    v = v >= low ? v : low;
    std::memcpy(values + i, &v, sizeof v);
  }
}

}  // namespace

RoundedBlock::RoundedBlock(const std::uint16_t* tables)
    : coder_(tables, ValueEncoder::Kind::lattice), rows_(symbol_costs(tables), RowCosts::Contexts::lattice) {}

void RoundedBlock::set(std::span<const float, 512> values) {
  std::copy(values.begin(), values.end(), values_.begin());
  exponent_ = rounded_exponent(largest_of(values_.data()));
  predictor_ = 0;
  if (find_codes(exponent_ - kUsualRoundedBits)) predictor_ = best_predictor(codes_, false, residuals_);
}

bool RoundedBlock::find_codes(int quantum_exponent) {
  if (!is_quantum_exponent(quantum_exponent, exponent_)) return false;
  const double quantum = std::ldexp(1.0, quantum_exponent);
  const Rounded rounded = round_all(values_.data(), static_cast<float>(1 / quantum), codes_.data());
  lowest_ = rounded.low;
  if (rounded.high == rounded.low || rounded.high - rounded.low >= 1 << kRoundedNumberBits) return false;
  squared_error_ = rounded.squared_error * quantum * quantum;
  return true;
}

std::optional<RoundedBlock::Cost> RoundedBlock::cost(int quantum_exponent) {
  if (!find_codes(quantum_exponent)) return std::nullopt;
  residuals_of(codes_, predictor_, false, residuals_);
  const ResidualSizes sizes = fill_magnitudes(residuals_, magnitudes_);
  if (sizes.last_place == 0 || sizes.bits >= kMostRoundedResidual) return std::nullopt;
  const unsigned end = end_at(sizes.last_place);
  const std::uint32_t bits =
      rows_.of(magnitudes_, end).stream_bits(end, kLatticeEndBits, kRoundedNumberBits) + kRoundedNumberBits;
  const std::uint32_t bytes = kRoundedFrontBytes + (bits + 7) / 8;
  if (bytes >= kRawStreamBytes) return std::nullopt;
  return Cost{bytes, squared_error_};
}

bool RoundedBlock::encode(int quantum_exponent, std::span<std::byte> out) {
  coarser_ = false;
  for (; quantum_exponent <= kMostQuantumExponent; ++quantum_exponent) {
    if (!find_codes(quantum_exponent)) return false;
    residuals_of(codes_, predictor_, false, residuals_);
    if (write(quantum_exponent, out)) return true;
    coarser_ = true;
  }
  return false;
}

bool RoundedBlock::write(int quantum_exponent, std::span<std::byte> out) {
  if (out.size() <= kRoundedFrontBytes) return false;
  const auto lowest = static_cast<std::uint32_t>(lowest_ - kLeastMultiple);
  for (std::uint32_t& code : codes_) code -= lowest;
  StreamFront front;
  front.end = end_at(fill_magnitudes(residuals_, magnitudes_).last_place);
  front.end_bits = kLatticeEndBits;
  front.number = codes_[0];
  front.number_bits = kRoundedNumberBits;
  if (!coder_.encode(front, {magnitudes_, residuals_}, out.subspan(kRoundedFrontBytes))) return false;
  out[0] = static_cast<std::byte>(static_cast<unsigned>(PackedKind::lattice) | predictor_ << 2U |
                                  static_cast<unsigned>(LatticeKind::own) << 4U);
  quantum_ = static_cast<float>(std::ldexp(1.0, quantum_exponent));
  minimum_ = static_cast<float>(lowest_) * quantum_;
  std::memcpy(out.data() + 1, &minimum_, sizeof minimum_);
  std::memcpy(out.data() + 5, &quantum_, sizeof quantum_);
  return true;
}

void RoundedBlock::decoded(const BlockConstants& constants, std::span<float, 512> values) const {
  values_at(codes_.data(), constants, minimum_, quantum_, values.data());
}

}  // namespace weir
