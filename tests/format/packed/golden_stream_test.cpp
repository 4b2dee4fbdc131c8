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
  const Golden expected[] = {{0x5FCC6B40EF27BBD6U, 0xBE87F9C9B22B231AU},
                             {0x2432210AAD81F277U, 0x02D29FC36E656F41U},
                             {0x970917CE053A24D1U, 0x05699BD50CB921C5U},
                             {0x1A9C22F9F8F4F817U, 0xF13C3CC64D2D3E1BU},
                             {0xB61B80FB12D003C2U, 0x69A539A27E317393U}};
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
        stream.resize(encode_exact({constants.tables, ValueEncoder::Kind::lattice}, constants,
                                   own ? std::optional(lattice) : std::nullopt, block, stream));
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
