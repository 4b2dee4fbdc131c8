#include "format/packed/coefficient_encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace weir {
namespace {

constexpr std::uint32_t kTotal = 1U << kFrequencyBits;
// A symbol, or raw bits: low and frequency of a total of 2^bits.
struct Piece {
  std::uint32_t low;
  std::uint16_t frequency;  // 0: `bits` raw bits of value `low`
  std::uint8_t bits;
  std::uint8_t state;
};

// ceil(2^44 / f): x * inverse >> 44 is x / f for every x below f * 2^20, which is what a state is reduced to before it
// takes a symbol of frequency f.
static_assert(kFrequencyBits <= 12, "a state below 2^32 is below f * 2^20 then");
constexpr unsigned kInverseBits = 44;
constexpr std::array<std::uint64_t, kTotal + 1> make_inverses() {
  std::array<std::uint64_t, kTotal + 1> inverses{};
  for (std::uint64_t f = 1; f <= kTotal; ++f) inverses[f] = ((std::uint64_t{1} << kInverseBits) + f - 1) / f;
  return inverses;
}
constexpr std::array<std::uint64_t, kTotal + 1> kInverses = make_inverses();

// At most, for each value: a symbol, five bits of an escape, twice two halves of raw bits.
constexpr std::size_t kMostPieces = 512 * 6;

class PieceList {
 public:
  void add_symbol(unsigned state, const std::uint16_t* table, unsigned symbol) {
    const std::uint32_t high = symbol + 1 < kPackedSymbols ? table[symbol + 1] : kTotal;
    pieces_[count_++] = {table[symbol], static_cast<std::uint16_t>(high - table[symbol]), 0,
                         static_cast<std::uint8_t>(state)};
  }
  void add_raw(unsigned state, std::uint32_t value, unsigned bits) {
    for (unsigned done = 0; done < bits;) {
      const unsigned take = std::min(bits - done, 16U);
      pieces_[count_++] = {value >> done & ((1U << take) - 1U), 0, static_cast<std::uint8_t>(take),
                           static_cast<std::uint8_t>(state)};
      done += take;
    }
  }
  std::span<const Piece> pieces() const { return {pieces_.data(), count_}; }

 private:
  std::array<Piece, kMostPieces> pieces_;
  std::size_t count_ = 0;
};

void list_pieces(const CoderContexts& contexts, unsigned end, const ScanValues& values, PieceList& list) {
  std::array<std::uint32_t, 513> by_index{};
  const BlockScan& scan = kBlockScan;
  const unsigned states = states_of(end);
  for (unsigned place = 1; place < kEndUnit * end; ++place) {
    const unsigned s = states == 2 ? place & 1U : 0;
    std::uint32_t sum = 0;
    for (const std::uint16_t near : scan.neighbour[place]) sum += std::min(by_index[near], kMostOfNeighbour);
    const std::uint32_t t = scan.weight[place] * sum;
    const unsigned level = t < kLevelSums ? scan.level[t] : kPackedLevels - 1;
    const unsigned context = (contexts.bands ? scan.band[place] * kPackedLevels : 0) + level;
    const std::uint32_t m = values.magnitudes[place];
    const unsigned extra = extra_bits(t);
    const std::uint32_t high = m >> extra;
    const std::uint16_t* table = contexts.tables + std::size_t{kPackedSymbols} * context;
    list.add_symbol(s, table, std::min(high, kEscape));
    if (high >= kEscape) {
      const std::uint32_t over = high - (kEscape - 1);
      const auto length = static_cast<unsigned>(std::bit_width(over) - 1);
      list.add_raw(s, length, 5);
      list.add_raw(s, over - (1U << length), length);
    }
    list.add_raw(s, m & ((1U << extra) - 1U), extra);
    by_index[scan.index[place]] = m;
  }
}

// Words in the order in which they are made, which is that of their addresses.
class RansEncoder {
 public:
  RansEncoder(std::uint32_t payload) : state_{kLeastState | (payload & 0xFFFFU), kLeastState | payload >> 16U} {}

  void put(const Piece& piece) {
    std::uint32_t& x = state_[piece.state];
    if (piece.frequency == 0) {
      // Decoding shifts right and then reads a word where the state is below the least.
      if (x >> (32U - piece.bits) != 0) emit(x);
      x = x << piece.bits | piece.low;
      return;
    }
    const std::uint64_t limit = static_cast<std::uint64_t>(piece.frequency) << (32U - kFrequencyBits);
    if (x >= limit) emit(x);
    const auto whole = static_cast<std::uint32_t>(x * kInverses[piece.frequency] >> kInverseBits);
    x = (whole << kFrequencyBits) + (x - whole * piece.frequency) + piece.low;
  }
  std::span<const std::uint16_t> words() const { return {words_.data(), count_}; }
  std::uint32_t state(unsigned s) const { return state_[s]; }

 private:
  void emit(std::uint32_t& x) {
    words_[count_++] = static_cast<std::uint16_t>(x & 0xFFFFU);
    x >>= 16U;
  }

  std::array<std::uint32_t, 2> state_;
  std::array<std::uint16_t, kMostPieces> words_;
  std::size_t count_ = 0;
};

// Signs of coded values in their order.
class SignBits {
 public:
  void add(bool negative) {
    words_[count_ / 32] |= (negative ? 1U : 0U) << (count_ % 32);
    ++count_;
  }
  std::uint32_t count() const { return count_; }
  /// At most 32 of them, from `first` on, the first one the lowest bit.
  std::uint32_t bits(std::uint32_t first, std::uint32_t count) const {
    const std::uint64_t two = words_[first / 32] | std::uint64_t{words_[first / 32 + 1]} << 32U;
    return static_cast<std::uint32_t>(two >> (first % 32) & ((std::uint64_t{1} << count) - 1));
  }

 private:
  std::array<std::uint32_t, 512 / 32 + 2> words_{};
  std::uint32_t count_ = 0;
};

class BitWriter {
 public:
  explicit BitWriter(std::span<std::byte> out) : out_(out) {}
  /// The low `bits` of `value`. What `out` has no room for is only counted.
  void write(std::uint32_t value, unsigned bits) {
    std::uint64_t shifted = (value & ((std::uint64_t{1} << bits) - 1)) << (at_ % 8);
    for (std::size_t byte = at_ / 8; shifted != 0 && byte < out_.size(); ++byte, shifted >>= 8U) {
      out_[byte] |= static_cast<std::byte>(shifted & 0xFFU);
    }
    at_ += bits;
  }
  std::uint32_t bytes() const { return static_cast<std::uint32_t>((at_ + 7) / 8); }

 private:
  std::span<std::byte> out_;
  std::size_t at_ = 0;
};

}  // namespace

unsigned end_of(const ScanValues& values) {
  for (unsigned place = 512; place > 1; --place) {
    if (values.magnitudes[place - 1] != 0) return (place + kEndUnit - 1) / kEndUnit;
  }
  return 0;
}

bool encode_values(const CoderContexts& contexts, const StreamFront& front, const ScanValues& values,
                   std::span<std::byte> out, StreamSize* size) {
  std::fill(out.begin(), out.end(), std::byte{0});
  BitWriter bits(out);
  bits.write(front.end_bits == 5 ? front.end - 1 : front.end, front.end_bits);
  if (front.end == 0) {
    bits.write(front.number, front.number_bits);
    if (size != nullptr) *size = {bits.bytes(), 0};
    return bits.bytes() <= out.size();
  }
  const unsigned states = states_of(front.end);
  const unsigned capacity = 16 * states;
  SignBits signs;
  for (unsigned place = 1; place < kEndUnit * front.end; ++place) {
    if (values.magnitudes[place] != 0) signs.add(values.negative[place]);
  }
  const std::uint32_t late = std::min(signs.count(), capacity);
  const unsigned moved = std::min(capacity - late, front.number_bits);
  std::uint32_t payload = signs.bits(signs.count() - late, late);
  if (moved > 0) {
    const std::uint32_t low = moved == 32 ? front.number : front.number & ((1U << moved) - 1U);
    payload |= low << late;
  }

  PieceList list;
  list_pieces(contexts, front.end, values, list);
  RansEncoder coder(payload);
  const std::span<const Piece> pieces = list.pieces();
  for (std::size_t i = pieces.size(); i > 0; --i) coder.put(pieces[i - 1]);

  std::array<unsigned, 2> state_bytes{};
  for (unsigned s = 0; s < states; ++s) {
    state_bytes[s] = coder.state(s) >> 24U == 0 ? 3 : 4;
    bits.write(state_bytes[s] == 3 ? 1 : 0, 1);
  }
  bits.write(moved == 32 ? 0 : front.number >> moved, front.number_bits - moved);
  for (std::uint32_t i = 0; i + late < signs.count(); i += 32) {
    const std::uint32_t some = std::min(32U, signs.count() - late - i);
    bits.write(signs.bits(i, some), some);
  }
  const std::size_t back = coder.words().size() * 2 + state_bytes[0] + state_bytes[1];
  if (size != nullptr) *size = {bits.bytes(), static_cast<std::uint32_t>(back)};
  if (bits.bytes() + back > out.size()) return false;
  std::size_t at = out.size() - back;
  for (const std::uint16_t word : coder.words()) {
    out[at++] = static_cast<std::byte>(word & 0xFFU);
    out[at++] = static_cast<std::byte>(word >> 8U);
  }
  for (unsigned s = states; s > 0; --s) {
    for (unsigned b = 0; b < state_bytes[s - 1]; ++b)
      out[at++] = static_cast<std::byte>(coder.state(s - 1) >> (8 * b) & 0xFFU);
  }
  return true;
}

SymbolCosts symbol_costs(const std::uint16_t* tables) {
  SymbolCosts costs{};
  for (unsigned context = 0; context < kPackedTables; ++context) {
    const std::uint16_t* table = tables + std::size_t{kPackedSymbols} * context;
    for (unsigned symbol = 0; symbol < kPackedSymbols; ++symbol) {
      const std::uint32_t high = symbol + 1 < kPackedSymbols ? table[symbol + 1] : kTotal;
      const double share = static_cast<double>(high - table[symbol]) / kTotal;
      costs[context][symbol] = static_cast<std::uint16_t>(std::lround(-256 * std::log2(share)));
    }
  }
  return costs;
}

unsigned escape_bits(std::uint32_t high) { return 5 + static_cast<unsigned>(std::bit_width(high - (kEscape - 1)) - 1); }

}  // namespace weir
