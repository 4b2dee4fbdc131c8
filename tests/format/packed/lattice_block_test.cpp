#include "format/packed/lattice_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "format/packed/lattice_codes.h"
#include "tests/format/packed/block_samples.h"

namespace weir::lattice_block_test {
namespace {

using packed_test::BlockValues;
using packed_test::constants_from;
using packed_test::decode;
using packed_test::Numbers;
using packed_test::sample;
using packed_test::Shape;
using packed_test::Stream;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

enum class Kind { file, own, ordered, raw, constant };

Kind kind_of(const Stream& stream) {
  const auto head = static_cast<unsigned>(stream[0]);
  if ((head & 3U) == 3) return head >> 2U != 0 ? Kind::constant : Kind::raw;
  return static_cast<Kind>(head >> 4U);
}

// Encodes, checks that every bit comes back, and returns the stream.
Stream encode_and_check(const BlockValues& values, const BlockConstants& constants,
                        const std::optional<Lattice>& own = std::nullopt, FloatOrder order = FloatOrder::used) {
  Stream stream(kRawStreamBytes + 1, std::byte{0xA5});
  const std::uint32_t bytes = encode_exact({constants.tables, ValueEncoder::Kind::lattice}, constants, own, values,
                                           std::span(stream).first(kRawStreamBytes), order);
  EXPECT_LE(bytes, kRawStreamBytes);
  EXPECT_EQ(stream[kRawStreamBytes], std::byte{0xA5});
  stream.resize(bytes);
  const auto decoded = decode(constants, {}, stream);
  EXPECT_TRUE(decoded.has_value());
  EXPECT_TRUE(decoded && std::memcmp(decoded->data(), values.data(), sizeof values) == 0);
  return stream;
}

BlockConstants on_lattice(float minimum, float quantum, std::uint32_t bits) {
  BlockConstants constants = constants_from(0);
  constants.lattice_minimum = minimum;
  constants.lattice_quantum = quantum;
  constants.lattice_bits = bits;
  return constants;
}

TEST(LatticeBlock, WholeNumbersOnTheFilesLatticeComeBack) {
  Numbers numbers(21);
  for (const std::uint32_t bits : {1U, 4U, 8U, 12U, 16U, 24U}) {
    for (const float minimum : {0.0F, -128.0F, -32768.0F}) {
      for (const std::uint32_t noise : {1U, 3U, 40U, 1U << 24U}) {
        const std::uint32_t most = 1U << bits;
        BlockValues values;
        for (unsigned i = 0; i < 512; ++i) {
          const std::uint32_t code = (i / 64 * 3 + i / 8 % 8 + numbers.below(noise)) % most;
          values[i] = static_cast<float>(code) + minimum;
        }
        // 24 bits of a code and a minimum may not fit a float: such blocks are not on the lattice.
        const Stream stream = encode_and_check(values, on_lattice(minimum, 1, bits));
        if (bits <= 16 && noise < 4) {
          EXPECT_EQ(kind_of(stream), Kind::file);
          EXPECT_LT(stream.size(), 512U);
        }
      }
    }
  }
}

TEST(LatticeBlock, CodesOfMoreBitsThanTheFilesAreNotOnItsLattice) {
  for (const float first : {255.0F, 256.0F, 257.0F, -1.0F}) {
    BlockValues values;
    for (unsigned i = 0; i < 512; ++i) values[i] = static_cast<float>(255 - i % 8);
    values[0] = first;
    const Stream stream = encode_and_check(values, on_lattice(0, 1, 8));
    EXPECT_EQ(kind_of(stream) == Kind::file, first == 255) << first;
  }
}

TEST(LatticeBlock, ValuesOnTheirOwnLatticeComeBack) {
  Numbers numbers(22);
  for (const std::uint32_t bits : {3U, 9U, 17U, 24U}) {
    for (const float quantum : {0.1F, 1e-30F, 3e20F, 0x1p-149F}) {
      const Lattice own{quantum * 7, quantum, bits};
      BlockValues values;
      for (unsigned i = 0; i < 512; ++i) {
        const float product = static_cast<float>(numbers.below(1U << std::min(bits, 9U)) + i) * quantum;
        values[i] = product + own.minimum;
      }
      const Stream stream = encode_and_check(values, constants_from(0), own);
      if (bits == 17) {
        EXPECT_EQ(kind_of(stream), Kind::own);
      }
    }
  }
}

TEST(LatticeBlock, FloatsInOrderComeBack) {
  Numbers numbers(23);
  for (const Shape shape : packed_test::kShapes) {
    for (const float offset : {0.0F, 1.0F, -1000.0F}) {
      const BlockValues values = sample(shape, numbers, 1, offset);
      encode_and_check(values, constants_from(0));
      EXPECT_EQ(kind_of(encode_and_check(values, constants_from(0), std::nullopt, FloatOrder::unused)), Kind::raw);
    }
  }
  const BlockValues smooth = sample(Shape::smooth, numbers, 0.001F, 1);
  const Stream stream = encode_and_check(smooth, constants_from(0));
  EXPECT_EQ(kind_of(stream), Kind::ordered);
  EXPECT_LT(stream.size(), kRawStreamBytes * 3 / 4);
}

TEST(LatticeBlock, OrderOfFloatsIsThatOfTheirCodesAndComesBack) {
  const float rising[] = {-kInfinity, -3.5F, -0x1p-149F, -0.0F, 0.0F, 0x1p-149F, 1.0F, 3.5F, kInfinity};
  for (std::size_t i = 0; i < std::size(rising); ++i) {
    const std::uint32_t code = ordered_of_float(rising[i]);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(float_of_ordered(code)), std::bit_cast<std::uint32_t>(rising[i]));
    if (i > 0) {
      EXPECT_GT(static_cast<std::int32_t>(code), static_cast<std::int32_t>(ordered_of_float(rising[i - 1])));
    }
  }
}

TEST(LatticeBlock, SpecialValuesAmongOthersComeBackBitForBit) {
  const std::uint32_t specials[] = {0x7FC00000U, 0xFFC00000U, 0x7F800001U, 0xFFABCDEFU, 0x7FFFFFFFU,
                                    0xFFFFFFFFU, 0x80000000U, 0x00000001U, 0x807FFFFFU, 0x7F800000U,
                                    0xFF800000U, 0x7F7FFFFFU, 0xFF7FFFFFU};
  Numbers numbers(24);
  for (const std::uint32_t special : specials) {
    for (const unsigned share : {1U, 4U, 100U, 511U}) {
      for (const float other : {0.0F, 1.0F, -7.0F}) {
        BlockValues values;
        for (float& v : values) v = numbers.below(512) < share ? std::bit_cast<float>(special) : other;
        values[numbers.below(512)] = std::bit_cast<float>(special);
        encode_and_check(values, on_lattice(0, 1, 8));
        encode_and_check(values, constants_from(0), Lattice{0, 1, 8});
      }
    }
  }
}

TEST(LatticeBlock, ConstantBlocksTakeFiveBytes) {
  for (const std::uint32_t bits : {0U, 0x80000000U, 0x3F800000U, 0x7FC12345U, 0xFF800000U, 1U}) {
    BlockValues values;
    values.fill(std::bit_cast<float>(bits));
    const Stream stream = encode_and_check(values, on_lattice(0, 1, 8));
    EXPECT_EQ(stream.size(), 5U);
    EXPECT_EQ(kind_of(stream), Kind::constant);
  }
}

TEST(LatticeBlock, OneSpikeTakesFewBytes) {
  for (unsigned at = 0; at < 512; ++at) {
    BlockValues values{};
    values[at] = 200;
    EXPECT_LT(encode_and_check(values, on_lattice(0, 1, 8)).size(), 130U) << at;
  }
}

TEST(LatticeBlock, AnyBitsComeBackRawOrShorter) {
  Numbers numbers(25);
  for (int trial = 0; trial < 50; ++trial) {
    BlockValues values;
    for (float& v : values) v = std::bit_cast<float>(numbers.bits());
    EXPECT_EQ(kind_of(encode_and_check(values, constants_from(0))), Kind::raw);
  }
}

// Codes that jump over the whole range: residuals of 2^31 and above, escapes of every length.
TEST(LatticeBlock, ResidualsOfEveryLengthComeBack) {
  Numbers numbers(26);
  for (unsigned length = 1; length <= 32; ++length) {
    for (const unsigned apart : {3U, 20U, 200U}) {
      BlockValues values;
      for (float& v : values) {
        const std::uint32_t jump = length == 32 ? numbers.bits() : numbers.bits() & ((1U << length) - 1U);
        v = std::bit_cast<float>(numbers.below(apart) == 0 ? jump : 1U << (length - 1U));
      }
      encode_and_check(values, constants_from(0));
    }
  }
}

TEST(LatticeBlock, ClampDoesNotChangeExactKinds) {
  Numbers numbers(27);
  const BlockValues values = sample(Shape::smooth, numbers, 4, 0);
  BlockConstants constants = constants_from(0);
  constants.minimum = 0;
  constants.maximum = 0;
  encode_and_check(values, constants);
  encode_and_check(values, constants, std::nullopt, FloatOrder::unused);
}

TEST(LatticeBlock, PredictionsAreThoseOfTheFormat) {
  Numbers numbers(28);
  for (int trial = 0; trial < 20; ++trial) {
    std::array<std::uint32_t, 512> codes;
    for (std::uint32_t& c : codes) c = numbers.bits() >> numbers.below(32);
    for (unsigned i = 1; i < 512; ++i) {
      const unsigned x = i / 64;
      const unsigned y = i / 8 % 8;
      const unsigned z = i % 8;
      const bool is_signed = trial % 2 == 1;
      const auto at = [&](unsigned dx, unsigned dy, unsigned dz) -> std::int64_t {
        const std::uint32_t c = codes[(x - dx) * 64 + (y - dy) * 8 + (z - dz)];
        return is_signed ? static_cast<std::int64_t>(static_cast<std::int32_t>(c)) : static_cast<std::int64_t>(c);
      };
      std::vector<std::int64_t> near;
      if (x > 0) near.push_back(at(1, 0, 0));
      if (y > 0) near.push_back(at(0, 1, 0));
      if (z > 0) near.push_back(at(0, 0, 1));
      std::int64_t sum = 0;
      for (const std::int64_t n : near) sum += n;
      const auto mean =
          static_cast<std::int64_t>(std::floor(static_cast<long double>(sum) / static_cast<long double>(near.size())));
      std::int64_t lorenzo = near[0];
      std::int64_t median = lorenzo;
      if (near.size() == 2) {
        lorenzo = sum - (x == 0 ? at(0, 1, 1) : y == 0 ? at(1, 0, 1) : at(1, 1, 0));
        median = lorenzo;
      }
      if (near.size() == 3) {
        lorenzo = sum - at(1, 1, 0) - at(1, 0, 1) - at(0, 1, 1) + at(1, 1, 1);
        std::int64_t planes[] = {near[0] + near[1] - at(1, 1, 0), near[0] + near[2] - at(1, 0, 1),
                                 near[1] + near[2] - at(0, 1, 1)};
        std::sort(std::begin(planes), std::end(planes));
        median = planes[1];
      }
      ASSERT_EQ(predict(0, is_signed, codes.data(), x, y, z), lorenzo);
      ASSERT_EQ(predict(1, is_signed, codes.data(), x, y, z), mean);
      ASSERT_EQ(predict(2, is_signed, codes.data(), x, y, z), *std::min_element(near.begin(), near.end()));
      ASSERT_EQ(predict(3, is_signed, codes.data(), x, y, z), median);
    }
  }
}

}  // namespace
}  // namespace weir::lattice_block_test
