// Streams and decoded values must be the same on every machine, compiler and vector width: digests of both.
#include <gtest/gtest.h>

#include "tests/format/packed/block_samples.h"

namespace weir::golden_stream_test {
namespace {

using packed_test::BlockValues;
using packed_test::constants_from;
using packed_test::decode;
using packed_test::Digest;
using packed_test::kShapes;
using packed_test::Numbers;
using packed_test::sample;
using packed_test::Stream;

struct Golden {
  std::uint64_t streams;
  std::uint64_t values;
};

TEST(GoldenStream, TransformedBlocks) {
  const Golden expected[] = {{0xD7966F066538903CU, 0x45A9CFC295098A8EU},
                             {0xE811CECD6FC94AACU, 0xE6E54037C050CBB4U},
                             {0x3DA38C1E19BEC305U, 0x173FE4C330DE1758U},
                             {0x4785F6D37E5B6B86U, 0x03792385F681E5EEU},
                             {0x72A53C0F670D63B4U, 0x81BD7564F15D09D2U}};
  TransformBlock block;
  const MeanRange means{-3, 5};
  for (std::size_t n = 0; n < std::size(kShapes); ++n) {
    Numbers numbers(41);
    Digest streams;
    Digest values;
    for (const float offset : {0.0F, 0.75F, -2.0F}) {
      ASSERT_TRUE(block.set(sample(kShapes[n], numbers, 1, offset)));
      for (const std::int32_t step : {-8, -1, 0, 3, 7, 12, 17, 22}) {
        // Lengths are fixed, so that what is tested is the stream: too short ones drop coefficients.
        for (const std::size_t bytes : {12U, 60U, 1600U}) {
          Stream stream(bytes);
          block.encode(constants_from(-8), means, step, stream);
          streams.add(stream);
          const auto decoded = decode(constants_from(-8), means, stream);
          ASSERT_TRUE(decoded.has_value());
          values.add(std::as_bytes(std::span(*decoded)));
        }
      }
    }
    EXPECT_EQ(streams.value(), expected[n].streams) << n << std::hex << " 0x" << streams.value();
    EXPECT_EQ(values.value(), expected[n].values) << n << std::hex << " 0x" << values.value();
  }
}

TEST(GoldenStream, ExactBlocks) {
  const Golden expected[] = {{0x22FB5B8B8CFBC491U, 0x2EDB585CF4A19522U},
                             {0xA1C90561C04F864EU, 0x2ADDEC952489B4ECU},
                             {0x0E88D3191ECA79FAU, 0xAAB1F2795B3625BEU},
                             {0xF9A53D563C559AD5U, 0x72124E2C3D069F48U},
                             {0x51B428B4E718D943U, 0xCE2E1436CB0AC7D5U}};
  BlockConstants constants = constants_from(0);
  constants.lattice_minimum = -64;
  constants.lattice_quantum = 0.25F;
  constants.lattice_bits = 12;
  for (std::size_t n = 0; n < std::size(kShapes); ++n) {
    Numbers numbers(42);
    Digest streams;
    Digest values;
    for (const float rounded : {0.0F, 32.0F}) {
      for (const bool own : {false, true}) {
        BlockValues block = sample(kShapes[n], numbers, 1, 0.5F);
        for (float& v : block) {
          if (rounded > 0) v = static_cast<float>(static_cast<int>(v * rounded)) / 4 + (own ? 0.125F : 0);
        }
        Stream stream(kRawStreamBytes);
        const Lattice lattice{-64.125F, 0.25F, 12};
        stream.resize(encode_exact(constants, own ? std::optional(lattice) : std::nullopt, block, stream));
        streams.add(stream);
        const auto decoded = decode(constants, {}, stream);
        ASSERT_TRUE(decoded.has_value());
        values.add(std::as_bytes(std::span(*decoded)));
      }
    }
    EXPECT_EQ(streams.value(), expected[n].streams) << n << std::hex << " 0x" << streams.value();
    EXPECT_EQ(values.value(), expected[n].values) << n << std::hex << " 0x" << values.value();
  }
}

}  // namespace
}  // namespace weir::golden_stream_test
