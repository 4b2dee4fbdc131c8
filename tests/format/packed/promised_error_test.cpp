// Streams of the bytes that a cost promises have the error that it promises: where the cost falls short of the stream,
// a coefficient is lost, which in blocks with sharp edges at fine steps is a large one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/packed/block_decode.h"
#include "format/packed/block_encode.h"

namespace weir::promised_error_test {
namespace {

using BlockValues = std::array<float, 512>;

// A bright voxel above a slanted edge; `at`: the voxel's index.
BlockValues sharp_block(unsigned at) {
  BlockValues values;
  for (unsigned i = 0; i < 512; ++i) {
    const unsigned x = i >> 6U;
    const unsigned y = i >> 3U & 7U;
    values[i] = i == at ? 255.0F : x + y < at % 13 ? 17.0F : 0.0F;
  }
  return values;
}

// Of the stream of the promised bytes, decoded; negative where it is invalid.
double decoded_error(TransformBlock& block, const BlockValues& values, std::int32_t step, std::uint32_t bits) {
  BlockConstants constants;
  constants.minimum = -3e38F;
  constants.maximum = 3e38F;
  constants.coarsest = step - 20;
  constants.below_one = kBelowOne;
  constants.below_more = kBelowMore;
  constants.tables = built_in_tables();
  const MeanRange range{0, 255};
  std::vector<std::byte> stream(stream_bytes(bits, mean_bits(range, step)));
  block.encode(constants, range, step, stream);
  BlockValues decoded;
  if (!decode_block(constants, range, stream.data(), static_cast<std::uint32_t>(stream.size()), decoded.data())) {
    return -1;
  }
  double sum = 0;
  for (unsigned i = 0; i < 512; ++i) {
    const double difference = static_cast<double>(decoded[i]) - static_cast<double>(values[i]);
    sum += difference * difference;
  }
  return sum;
}

TEST(PromisedError, SharpBlocksAtFineStepsHaveIt) {
  TransformBlock block;
  double promised = 0;  // both in squares of the step
  double decoded = 0;
  for (unsigned at = 0; at < 512; at += 7) {
    const BlockValues values = sharp_block(at);
    ASSERT_TRUE(block.set(values));
    const auto coarsest = static_cast<std::int32_t>(std::lround(-2 * std::log2(block.largest() / 10)));
    for (std::int32_t step = coarsest; step < coarsest + 14; ++step) {
      const TransformBlock::Cost cost = block.cost(step);
      const double error = decoded_error(block, values, step, cost.bits);
      ASSERT_GE(error, 0);
      const double square = std::exp2(-static_cast<double>(step));
      promised += cost.squared_error / square + 1.0 / 12;  // that of the mean's code
      decoded += error / square;
    }
  }
  EXPECT_LT(decoded, 1.1 * promised);
}

}  // namespace
}  // namespace weir::promised_error_test
