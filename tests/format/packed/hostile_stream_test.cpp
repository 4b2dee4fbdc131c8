#include <gtest/gtest.h>

#include "tests/format/packed/block_samples.h"
#include "tests/format/packed/reference_decoder.h"

namespace weir::hostile_stream_test {
namespace {

using packed_test::BlockValues;
using packed_test::constants_from;
using packed_test::decode;
using packed_test::kShapes;
using packed_test::Numbers;
using packed_test::ReferenceDecoder;
using packed_test::sample;
using packed_test::Shape;
using packed_test::Stream;

const MeanRange kMeans{-2, 2};

BlockConstants file_constants() {
  BlockConstants constants = constants_from(-6);
  constants.lattice_minimum = -10;
  constants.lattice_quantum = 0.5F;
  constants.lattice_bits = 10;
  return constants;
}

// Streams of every kind, state count and lattice.
std::vector<Stream> valid_streams() {
  std::vector<Stream> streams;
  Numbers numbers(31);
  const BlockConstants constants = file_constants();
  TransformBlock block;
  for (const Shape shape : kShapes) {
    const BlockValues values = sample(shape, numbers, 1, 0.5F);
    EXPECT_TRUE(block.set(values));
    for (const std::int32_t step : {-4, 1, 6, 12, 20}) {
      Stream stream(stream_bytes(block.cost(step).bits, mean_bits(kMeans, step)) + 1);
      block.encode(constants, kMeans, step, stream);
      streams.push_back(stream);
    }
    Stream stream(kRawStreamBytes);
    stream.resize(
        encode_exact({constants.tables, ValueEncoder::Kind::lattice}, constants, std::nullopt, values, stream));
    streams.push_back(stream);
    BlockValues on_lattice;
    for (std::size_t i = 0; i < 512; ++i) on_lattice[i] = static_cast<float>(static_cast<int>(values[i] * 40)) / 2;
    for (const bool own : {false, true}) {
      stream.assign(kRawStreamBytes, std::byte{0});
      const Lattice lattice{-30, 0.5F, 12};
      stream.resize(encode_exact({constants.tables, ValueEncoder::Kind::lattice}, own ? constants_from(-6) : constants,
                                 own ? std::optional(lattice) : std::nullopt, on_lattice, stream));
      streams.push_back(stream);
    }
  }
  return streams;
}

// The decoders agree with each other and with the format's description. Returns whether the stream is valid.
bool check(std::span<const std::byte> stream, const BlockConstants& constants = file_constants(),
           const MeanRange& means = kMeans) {
  const auto decoded = decode(constants, means, stream);
  const auto expected = ReferenceDecoder(constants, means, stream).decode();
  EXPECT_EQ(decoded.has_value(), expected.has_value());
  if (!decoded || !expected) return false;
  for (std::size_t i = 0; i < 512; ++i) {
    const bool both_nan = (*decoded)[i] != (*decoded)[i] && (*expected)[i] != (*expected)[i];
    const bool same = both_nan || packed_test::bits_of((*decoded)[i]) == packed_test::bits_of((*expected)[i]);
    EXPECT_TRUE(same) << i << ": " << (*decoded)[i] << ", expected " << (*expected)[i];
    if (!same) break;
  }
  return true;
}

TEST(HostileStream, ValidStreamsDecodeAsTheFormatSays) {
  for (const Stream& stream : valid_streams()) {
    EXPECT_TRUE(check(stream));
    if (HasFailure()) return;
  }
}

TEST(HostileStream, TruncatedStreamsAreReadNoFurtherThanTheirEnd) {
  unsigned invalid = 0;
  unsigned cut = 0;
  for (const Stream& stream : valid_streams()) {
    for (std::size_t bytes = 0; bytes < stream.size(); bytes += bytes < 100 ? 1 : 5) {
      ++cut;
      if (!check(std::span(stream).first(bytes))) ++invalid;
      if (HasFailure()) return;
    }
    // What is left where the front is cut.
    for (std::size_t from = 1; from < stream.size(); from += from < 20 ? 1 : 61) {
      check(std::span(stream).subspan(from));
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(invalid * 10, cut * 9);
}

TEST(HostileStream, ChangedBytesAreRefusedOrDecodedAlike) {
  Numbers numbers(32);
  for (const Stream& stream : valid_streams()) {
    for (std::size_t at = 0; at < stream.size(); at += at < 100 || at + 12 > stream.size() ? 1 : 7) {
      Stream changed = stream;
      changed[at] ^= static_cast<std::byte>(1 + numbers.below(255));
      check(changed);
      changed[at] = std::byte{0xFF};
      check(changed);
      if (HasFailure()) return;
    }
  }
}

TEST(HostileStream, RandomBytesAreRefusedOrDecodedAlike) {
  Numbers numbers(33);
  for (int trial = 0; trial < 4000; ++trial) {
    Stream stream(numbers.below(trial % 4 == 0 ? 2100 : 60));
    for (std::byte& b : stream) b = static_cast<std::byte>(numbers.below(256));
    check(stream);
    if (HasFailure()) return;
  }
}

// Constants that a file may have, but no encoder writes.
TEST(HostileStream, ExtremeConstantsDecodeAlike) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  Numbers numbers(34);
  const std::vector<Stream> streams = valid_streams();
  for (const std::int32_t coarsest : {-250, -249, -190, 0, 180, 187, 249, 250}) {
    for (const float below : {0.0F, 1.0F, 2.0F, -0.5F, kLargest, -kLargest}) {
      for (const MeanRange& means : {MeanRange{0, 0}, MeanRange{-1e30F, 1e30F}, MeanRange{0, kLargest}}) {
        BlockConstants constants = file_constants();
        constants.coarsest = coarsest;
        constants.below_one = below;
        constants.below_more = -below;
        constants.lattice_quantum = below;
        constants.lattice_minimum = -below;
        for (const Stream& stream : streams) check(stream, constants, means);
        Stream changed = streams[numbers.below(static_cast<std::uint32_t>(streams.size()))];
        changed[numbers.below(static_cast<std::uint32_t>(changed.size()))] = static_cast<std::byte>(numbers.bits());
        check(changed, constants, means);
        if (HasFailure()) return;
      }
    }
  }
}

// Streams of one repeated byte behind a chosen front: states of zero, escapes of every length, endless words.
TEST(HostileStream, RepeatedBytesAreRefusedOrDecodedAlike) {
  for (unsigned head = 0; head < 256; head += 3) {
    for (const unsigned front : {0x00U, 0x1FU, 0x3FU, 0x7FU, 0xE0U, 0xFFU}) {
      for (const unsigned fill : {0x00U, 0x01U, 0x7FU, 0x80U, 0xFEU, 0xFFU}) {
        for (const std::size_t size : {2U, 5U, 6U, 9U, 10U, 300U, 2049U}) {
          Stream stream(size, static_cast<std::byte>(fill));
          stream[0] = static_cast<std::byte>(head);
          stream[1] = static_cast<std::byte>(front);
          check(stream);
          if (HasFailure()) return;
        }
      }
    }
  }
}

// Steps as coarse as a header may have let the transform overflow: infinities less infinities.
TEST(HostileStream, TransformedValuesStayWithinTheClamp) {
  Numbers numbers(77);
  TransformBlock block;
  BlockConstants constants = constants_from(0);
  constants.minimum = -1;
  constants.maximum = 1;
  std::size_t decoded = 0;
  for (const Shape shape : kShapes) {
    ASSERT_TRUE(block.set(sample(shape, numbers, 1, 0.5F)));
    for (const std::int32_t step : {4, 10, 16}) {
      Stream stream(stream_bytes(block.cost(step).bits, mean_bits(kMeans, step)) + 1);
      block.encode(constants, kMeans, step, stream);
      BlockConstants coarse = constants;
      coarse.coarsest = -250;
      const MeanRange wide{-3e38F, 3e38F};
      for (const MeanRange& means : {kMeans, wide}) {
        const auto values = decode(coarse, means, stream);
        if (!values) continue;
        ++decoded;
        for (const float v : *values) ASSERT_TRUE(v >= -1 && v <= 1) << v;
      }
    }
  }
  EXPECT_GT(decoded, 5U);
}

TEST(HostileStream, OwnLatticesThatAreNotFiniteAreRefused) {
  BlockValues values;
  for (std::size_t i = 0; i < 512; ++i) values[i] = static_cast<float>(i % 7) * 0.25F;
  Stream stream(kRawStreamBytes);
  stream.resize(encode_exact({constants_from(0).tables, ValueEncoder::Kind::lattice}, constants_from(0),
                             Lattice{0, 0.25F, 12}, values, stream));
  ASSERT_TRUE(decode(constants_from(0), kMeans, stream).has_value());
  for (const std::size_t at : {1U, 5U}) {
    for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      Stream damaged = stream;
      std::memcpy(damaged.data() + at, &wrong, sizeof wrong);
      EXPECT_FALSE(decode(constants_from(0), kMeans, damaged).has_value()) << at;
    }
  }
}

}  // namespace
}  // namespace weir::hostile_stream_test
