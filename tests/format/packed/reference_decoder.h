// A decoder of streams written from the format's description alone, slow and plain, to test the others against.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "format/packed/block_constants.h"

namespace weir::packed_test {

class ReferenceDecoder {
 public:
  ReferenceDecoder(const BlockConstants& constants, const MeanRange& means, std::span<const std::byte> stream)
      : constants_(constants), means_(means), stream_(stream) {}

  /// None where the stream is invalid.
  std::optional<std::array<float, 512>> decode() {
    try {
      return values();
    } catch (const std::out_of_range&) {
      return std::nullopt;
    }
  }

 private:
  using Floats = std::array<float, 512>;

  static void require(bool holds) {
    if (!holds) throw std::out_of_range("invalid stream");
  }
  unsigned byte(std::size_t at) const {
    require(at < stream_.size());
    return static_cast<unsigned>(stream_[at]);
  }
  std::uint32_t front(unsigned count) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < count; ++i, ++bit_) value |= (byte(bit_ / 8) >> (bit_ % 8) & 1U) << i;
    return value;
  }
  float number(std::size_t at) const {
    std::uint32_t bits = 0;
    for (unsigned b = 0; b < 4; ++b) bits |= byte(at + b) << (8 * b);
    return std::bit_cast<float>(bits);
  }

  Floats values() {
    require(stream_.size() >= 2);
    const unsigned kind = byte(0) & 3U;
    Floats out;
    bit_ = 8;
    if (kind == 3) {
      require(byte(0) >> 3U == 0);
      const bool one = (byte(0) & 4U) != 0;
      require(stream_.size() == (one ? 5 : 2049));
      for (unsigned i = 0; i < 512; ++i) out[i] = number(one ? 1 : 1 + 4 * i);
      return out;
    }
    return kind == 2 ? lattice() : transform(kind == 0);
  }

  float clamp(float v) const {
    if (!(v >= constants_.minimum)) return constants_.minimum;
    return v <= constants_.maximum ? v : constants_.maximum;
  }

  Floats transform(bool mean_alone) {
    const int step = constants_.coarsest + static_cast<int>(byte(0) >> 2U);
    require(step >= -250 && step <= 250);
    const float q = step % 2 == 0 ? std::ldexp(1.0F, -step / 2) : std::ldexp(0.70710678F, -(step - 1) / 2);
    const float quantum = q * 0.044194173F;
    const float width = means_.high - means_.low;
    const float codes = width / quantum;
    require(codes < 16777215.0F);
    const auto bits = static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(codes) + 1));
    Floats out;
    if (mean_alone) {
      const float offset = static_cast<float>(front(bits)) * quantum;
      out.fill(clamp(means_.low + offset));
      return out;
    }
    const unsigned end = front(5) + 1;
    const std::uint32_t code = coded_values(0, true, end, bits);
    const float offset = static_cast<float>(code) * quantum;
    const float mean = means_.low + offset;
    for (unsigned i = 0; i < 512; ++i) {
      // Signed values are kept modulo 2^32, so that magnitudes above 2^31, which no encoder writes, wrap.
      const std::uint32_t value = negative_[i] ? 0U - magnitude_[i] : magnitude_[i];
      const bool negative = value >> 31U != 0;
      const std::uint32_t magnitude = negative ? 0U - value : value;
      const float below = magnitude == 1 ? constants_.below_one : constants_.below_more;
      const float whole = static_cast<float>(magnitude) - below;
      const float size = whole * q;
      out[i] = magnitude == 0 ? 0 : negative ? -size : size;
    }
    for (const unsigned stride : {1U, 8U, 64U}) {
      for (unsigned i = 0; i < 512; ++i) {
        if (i / stride % 8 == 0) inverse(out.data() + i, stride);
      }
    }
    for (float& v : out) v = clamp(mean + v);
    return out;
  }

  static void inverse(float* x, unsigned s) {
    std::array<float, 8> c;
    for (unsigned n = 0; n < 8; ++n) c[n] = static_cast<float>(std::cos(n * 3.14159265358979323846 / 16) / 2);
    const float x0 = x[0], x1 = x[s], x2 = x[2 * s], x3 = x[3 * s], x4 = x[4 * s], x5 = x[5 * s], x6 = x[6 * s],
                x7 = x[7 * s];
    const float a0 = c[4] * (x0 + x4), a1 = c[4] * (x0 - x4), a2 = c[2] * x2 + c[6] * x6, a3 = c[6] * x2 - c[2] * x6;
    const float e[] = {a0 + a2, a1 + a3, a1 - a3, a0 - a2};
    const float o[] = {c[1] * x1 + c[3] * x3 + c[5] * x5 + c[7] * x7, c[3] * x1 - c[7] * x3 - c[1] * x5 - c[5] * x7,
                       c[5] * x1 - c[1] * x3 + c[7] * x5 + c[3] * x7, c[7] * x1 - c[5] * x3 + c[3] * x5 - c[1] * x7};
    for (unsigned n = 0; n < 4; ++n) {
      x[n * s] = e[n] + o[n];
      x[(7 - n) * s] = e[n] - o[n];
    }
  }

  Floats lattice() {
    const unsigned head = byte(0);
    const unsigned predictor = head >> 2U & 3U;
    const unsigned kind = head >> 4U & 3U;
    require(head >> 6U == 0 && kind < 3);
    float minimum = constants_.lattice_minimum, quantum = constants_.lattice_quantum;
    if (kind == 1) {
      minimum = number(1);
      quantum = number(5);
      require(std::isfinite(minimum) && std::isfinite(quantum));
      bit_ += 64;
    }
    const unsigned bits = kind == 0 ? constants_.lattice_bits : kind == 1 ? 24 : 32;
    const unsigned end = front(6);
    require(end <= 32);
    std::array<std::uint32_t, 512> u{};
    u[0] = coded_values(96, false, end, bits);
    Floats out;
    for (unsigned i = 0; i < 512; ++i) {
      if (i > 0) {
        u[i] = static_cast<std::uint32_t>(prediction(predictor, kind == 2, u, i)) +
               (negative_[i] ? 0U - magnitude_[i] : magnitude_[i]);
      }
      if (kind == 2) {
        const auto code = static_cast<std::int32_t>(u[i]);
        out[i] = std::bit_cast<float>(code < 0 ? code ^ 0x7FFFFFFF : code);
        continue;
      }
      require(u[i] < 1U << 24U);
      const float product = static_cast<float>(u[i]) * quantum;
      out[i] = clamp(product + minimum);
    }
    return out;
  }

  static std::int64_t prediction(unsigned predictor, bool is_signed, const std::array<std::uint32_t, 512>& u,
                                 unsigned i) {
    const auto at = [&](unsigned back) -> std::int64_t {
      return is_signed ? static_cast<std::int64_t>(static_cast<std::int32_t>(u[i - back]))
                       : static_cast<std::int64_t>(u[i - back]);
    };
    std::vector<unsigned> steps;
    for (const unsigned stride : {64U, 8U, 1U}) {
      if (i / stride % 8 > 0) steps.push_back(stride);
    }
    std::int64_t sum = 0, least = at(steps[0]);
    for (const unsigned s : steps) {
      sum += at(s);
      least = std::min(least, at(s));
    }
    const auto count = static_cast<std::int64_t>(steps.size());
    if (predictor == 1) return (sum - ((sum % count) + count) % count) / count;
    if (predictor == 2) return least;
    if (steps.size() == 1) return sum;
    if (steps.size() == 2) return sum - at(steps[0] + steps[1]);
    if (predictor == 0) return sum - at(72) - at(65) - at(9) + at(73);
    std::array<std::int64_t, 3> planes{at(64) + at(8) - at(72), at(64) + at(1) - at(65), at(8) + at(1) - at(9)};
    std::sort(planes.begin(), planes.end());
    return planes[1];
  }

  // Fills magnitude_ and negative_; returns the number of `bits` bits that goes with them.
  std::uint32_t coded_values(unsigned first_context, bool bands, unsigned end, unsigned bits) {
    if (end == 0) return front(bits);
    const unsigned states = end <= 8 ? 1 : 2;
    const unsigned flags = front(states);
    const std::size_t words_from = (bit_ + 7) / 8;
    std::size_t last = stream_.size();
    for (unsigned s = 0; s < states; ++s) {
      const unsigned length = (flags >> s & 1U) != 0 ? 3 : 4;
      require(last >= words_from + length);
      last -= length;
      state_[s] = 0;
      for (unsigned b = 0; b < length; ++b) state_[s] |= byte(last + b) << (8 * b);
    }
    word_end_ = last;
    words_from_ = words_from;
    std::vector<unsigned> order(512);
    std::iota(order.begin(), order.end(), 0U);
    const auto most = [](unsigned i) { return std::max({i / 64, i / 8 % 8, i % 8}); };
    const auto total = [](unsigned i) { return i / 64 + i / 8 % 8 + i % 8; };
    const auto shell = [&](unsigned i) { return most(i) < 2 ? 0 : most(i) < 4 ? 1 : 2; };
    std::sort(order.begin(), order.end(), [&](unsigned a, unsigned b) {
      if (shell(a) != shell(b)) return shell(a) < shell(b);
      return total(a) != total(b) ? total(a) < total(b) : a < b;
    });
    std::vector<unsigned> nonzero;  // in the order of the scan
    for (unsigned p = 1; p < 16 * end; ++p) {
      const unsigned i = order[p];
      std::uint32_t sum = 0;
      std::uint32_t count = 0;
      const auto add = [&](unsigned near) {
        sum += std::min(magnitude_[near], 1U << 20U);
        ++count;
      };
      if (total(i) == 1) {
        for (unsigned q = 1; q < p; ++q) add(order[q]);
      } else {
        for (const unsigned stride : {64U, 8U, 1U}) {
          if (i / stride % 8 > 0) add(i - stride);
        }
      }
      const std::uint32_t t = count == 0 ? 0 : 6 * sum / count;
      const unsigned band = total(i) < 2 ? 0 : total(i) < 6 ? 1 : total(i) < 10 ? 2 : 3;
      const unsigned context = first_context + (bands ? band * 24 : 0) + level(t);
      magnitude_[i] = one(p % states, constants_.tables + std::size_t{16} * context, t);
      if (magnitude_[i] != 0) nonzero.push_back(i);
    }
    for (unsigned s = 0; s < states; ++s) require(state_[s] >= 65536 && state_[s] < 131072);
    const std::uint32_t payload = (state_[0] & 0xFFFFU) | (states == 2 ? state_[1] << 16U : 0);
    const auto n = static_cast<unsigned>(nonzero.size());
    const unsigned late = std::min(n, 16 * states);
    const unsigned moved = std::min(16 * states - late, bits);
    std::uint64_t number = static_cast<std::uint64_t>(front(bits - moved)) << moved;
    for (unsigned b = 0; b < moved; ++b) number |= static_cast<std::uint64_t>(payload >> (late + b) & 1U) << b;
    for (unsigned k = 0; k < n - late; ++k) negative_[nonzero[k]] = front(1) != 0;
    for (unsigned k = 0; k < late; ++k) negative_[nonzero[n - late + k]] = (payload >> k & 1U) != 0;
    require((bit_ + 7) / 8 <= word_end_);
    return static_cast<std::uint32_t>(number);
  }

  static unsigned level(std::uint32_t t) {
    if (t > 320) return 23;
    return std::min(23U, static_cast<unsigned>(std::floor(3 * std::log2(1 + 4 * static_cast<double>(t) / 6))));
  }

  std::uint32_t one(unsigned s, const std::uint16_t* table, std::uint32_t t) {
    const std::uint32_t slot = state_[s] & 4095U;
    unsigned y = 15;
    while (table[y] > slot) --y;
    const std::uint32_t next = y == 15 ? 4096 : table[y + 1];
    state_[s] = (next - table[y]) * (state_[s] >> 12U) + slot - table[y];
    renormalise(s);
    std::uint32_t m = y;
    if (y == 15) {
      const unsigned length = bypass(s, 5);
      m = 14 + (1U << length) + bypass(s, length);
    }
    const unsigned k = t <= 36 ? 0 : std::min(16U, static_cast<unsigned>(std::bit_width(t / 18)) - 1);
    if (k == 0) return m;
    require((static_cast<std::uint64_t>(m) << k) <= 0xFFFFFFFFU);
    return m << k | bypass(s, k);
  }

  std::uint32_t bypass(unsigned s, unsigned bits) {
    if (bits > 16) {
      const std::uint32_t low = bypass(s, 16);
      return low | bypass(s, bits - 16) << 16U;
    }
    if (bits == 0) return 0;
    const std::uint32_t value = state_[s] & ((1U << bits) - 1U);
    state_[s] >>= bits;
    renormalise(s);
    return value;
  }

  void renormalise(unsigned s) {
    if (state_[s] >= 65536) return;
    require(word_end_ >= words_from_ + 2);
    word_end_ -= 2;
    state_[s] = state_[s] << 16U | byte(word_end_) | byte(word_end_ + 1) << 8U;
  }

  const BlockConstants& constants_;
  MeanRange means_;
  std::span<const std::byte> stream_;
  std::size_t bit_ = 0;
  std::size_t words_from_ = 0;
  std::size_t word_end_ = 0;
  std::array<std::uint32_t, 2> state_{};
  std::array<std::uint32_t, 512> magnitude_{};
  std::array<bool, 512> negative_{};
};

}  // namespace weir::packed_test
