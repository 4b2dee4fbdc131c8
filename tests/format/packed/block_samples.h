// What the tests of packed blocks share: blocks to encode, file constants, and a decoding that checks the decoders
// against each other.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "format/packed/block_decode.h"
#include "format/packed/block_encode.h"
#include "format/packed/lattice_block.h"
#include "tests/format/packed/plain_decode.h"

namespace weir::packed_test {

using BlockValues = std::array<float, 512>;
using Stream = std::vector<std::byte>;

/// No clamp; steps from `coarsest` to 63 finer ones.
inline BlockConstants constants_from(std::int32_t coarsest) {
  BlockConstants constants;
  constants.minimum = std::numeric_limits<float>::lowest();
  constants.maximum = std::numeric_limits<float>::max();
  constants.coarsest = coarsest;
  constants.below_one = kBelowOne;
  constants.below_more = kBelowMore;
  constants.tables = built_in_tables();
  return constants;
}

/// A stream in memory of exactly its size, so that a sanitizer sees each read outside.
struct ExactBuffer {
  explicit ExactBuffer(std::span<const std::byte> stream) : bytes(new std::byte[stream.size()]), size(stream.size()) {
    if (!stream.empty()) std::memcpy(bytes.get(), stream.data(), stream.size());
  }
  std::unique_ptr<std::byte[]> bytes;
  std::size_t size;
};

inline std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }

inline bool same_bits(const BlockValues& a, const BlockValues& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

/// Decodes with both decoders, which must agree in every bit. None where the stream is invalid.
inline std::optional<BlockValues> decode(const BlockConstants& constants, const MeanRange& means,
                                         std::span<const std::byte> stream) {
  const ExactBuffer buffer(stream);
  const auto bytes = static_cast<std::uint32_t>(buffer.size);
  BlockValues fast;
  BlockValues plain;
  fast.fill(-1);
  plain.fill(-2);
  const bool fast_valid = decode_block(constants, means, buffer.bytes.get(), bytes, fast.data());
  const bool plain_valid = plain::decode_block(constants, kBlockScan, means, buffer.bytes.get(), bytes, plain.data());
  EXPECT_EQ(fast_valid, plain_valid);
  if (!fast_valid || !plain_valid) return std::nullopt;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    // Which NaN an operation makes is the processor's affair.
    const bool same = bits_of(fast[i]) == bits_of(plain[i]) || (fast[i] != fast[i] && plain[i] != plain[i]);
    if (!same) ADD_FAILURE() << "value " << i << ": " << fast[i] << " and plainly " << plain[i];
    if (!same) break;
  }
  return plain;
}

/// Whole numbers from a generator that is the same everywhere.
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(engine_() % limit); }
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  /// -1 to 1, in 2^-15.
  float signed_unit() { return static_cast<float>(static_cast<std::int32_t>(below(65537)) - 32768) / 32768; }

 private:
  std::mt19937 engine_;
};

enum class Shape { smooth, noisy, sparse, ramp, mixed };
inline constexpr Shape kShapes[] = {Shape::smooth, Shape::noisy, Shape::sparse, Shape::ramp, Shape::mixed};

/// Values between about -amplitude and amplitude around `offset`; whole-number arithmetic, and no function of libm.
inline BlockValues sample(Shape shape, Numbers& numbers, float amplitude, float offset) {
  BlockValues values;
  const float a = numbers.signed_unit();
  const float b = numbers.signed_unit();
  const float c = numbers.signed_unit();
  for (unsigned i = 0; i < 512; ++i) {
    const float x = static_cast<float>(i >> 6U) / 8 - 0.5F;
    const float y = static_cast<float>(i >> 3U & 7U) / 8 - 0.5F;
    const float z = static_cast<float>(i & 7U) / 8 - 0.5F;
    const float square = a * x;
    const float product = b * y;
    const float ramp = square + product + c * z;
    const float bowl = square * x + product * z + c * y * z;
    const float noise = numbers.signed_unit();
    float v = ramp;
    if (shape == Shape::smooth) v = ramp + bowl;
    if (shape == Shape::noisy) v = noise;
    if (shape == Shape::sparse) v = numbers.below(40) == 0 ? noise : 0;
    if (shape == Shape::mixed) v = bowl + noise / 64;
    values[i] = offset + amplitude * v;
  }
  return values;
}

/// FNV-1a, 64 bits.
class Digest {
 public:
  void add(std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) {
      value_ ^= static_cast<std::uint64_t>(b);
      value_ *= 1099511628211U;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037U;
};

}  // namespace weir::packed_test
