// The device's encoder of rounded values and of ordered floats, run on the host: its streams and decoded values are
// bit for bit those of RoundedBlock, encode_exact() and decode_block().
#include "gpu/cuda/encode/lattice_code_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "format/packed/lattice_block.h"
#include "format/packed/rounded_block.h"
#include "gpu/cuda/encode/stream_steps.h"
#include "tests/gpu/encode/boxed_volume.h"

namespace weir::encode_steps_test {
namespace {

using encode_detail::HostWarp;
using test::BlockVolume;

struct Made {
  bool made = false;
  std::vector<std::byte> stream;
  Values decoded{};
};

class LatticeCodeSteps : public testing::Test {
 protected:
  LatticeCodeSteps() {
    make_encoder_tables(built_in_tables(), tables_, codes_);
    volumes_ = test::block_volumes();
    for (BlockVolume& volume : test::mixed_volumes()) volumes_.push_back(std::move(volume));
  }

  static BlockConstants constants_of(const BlockVolume& volume) {
    BlockConstants constants;
    constants.minimum = std::numeric_limits<float>::max();
    constants.maximum = std::numeric_limits<float>::lowest();
    for (const float v : volume.values) {
      if (!std::isfinite(v)) continue;
      constants.minimum = std::min(constants.minimum, v);
      constants.maximum = std::max(constants.maximum, v);
    }
    constants.tables = built_in_tables();
    return constants;
  }

  Made make(const BlockBox& box, const BlockConstants& constants, const StreamAsk& ask) const {
    Made made{false, std::vector<std::byte>(ask.bytes + 1U, std::byte{0x5A})};
    StreamState state{};
    std::vector<std::uint16_t> words(ask.bytes / 2U + 2, 0xABCD);
    std::uint8_t is_made = 2;
    EncodeCall call;
    call.box = box;
    call.constants = constants;
    call.tables = &tables_;
    call.codes = &codes_;
    call.asks = &ask;
    call.count = 1;
    call.states = &state;
    call.words = words.data();
    call.decoded = made.decoded.data();
    call.out = made.stream.data();
    call.made = &is_made;
    encode_detail::LatticeStage stage;
    code_lattice_block(HostWarp{}, call, tables_, 0, stage);
    put_words(call, codes_.transform, 0);
    put_bytes(HostWarp{}, call, 0);
    EXPECT_EQ(words[ask.bytes / 2U], 0xABCD) << "beyond the room for words";
    EXPECT_EQ(made.stream.back(), std::byte{0x5A}) << "beyond the stream";
    EXPECT_LE(is_made, 1);
    made.stream.pop_back();
    made.made = is_made == 1;
    return made;
  }

  CostTables tables_;
  CodeTables codes_;
  std::vector<BlockVolume> volumes_;
};

TEST_F(LatticeCodeSteps, RoundedStreamsAndWhatTheyDecodeToAreThoseOfTheCpu) {
  RoundedBlock rounded;
  std::size_t made = 0;
  std::size_t left = 0;
  for (const BlockVolume& volume : volumes_) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, volume.extent.x > 1 ? kBefores[1] : kBefores[0]);
    const BlockConstants constants = constants_of(volume);
    for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
      const Values values = boxed.block(b);
      if (!all_finite(values)) {
        EXPECT_FALSE(make(boxed.box, constants, {{}, b, 0, 900, -9, StreamAskKind::rounded}).made) << b;
        continue;
      }
      rounded.set(values);
      const std::int32_t coarsest = coarsest_near_exponent(rounded.exponent());
      for (std::int32_t rung = 0; rung < kNearRungs; ++rung) {
        const auto cost = rounded.cost(coarsest - rung);
        if (!cost) continue;
        for (const std::uint32_t bytes : {cost->bytes, cost->bytes + 1, cost->bytes + 37, cost->bytes - 9}) {
          const StreamAsk ask{{},
                              b,
                              0,
                              static_cast<std::uint16_t>(bytes),
                              static_cast<std::int16_t>(coarsest - rung),
                              StreamAskKind::rounded};
          const Made found = make(boxed.box, constants, ask);
          std::vector<std::byte> stream(bytes);
          const bool fits = rounded.encode(coarsest - rung, stream) && !rounded.coarser();
          ASSERT_EQ(found.made, fits) << b << ", rung " << rung << " in " << bytes;
          if (!fits) {
            left += bytes < cost->bytes ? 0 : 1;
            continue;
          }
          Values decoded;
          ASSERT_TRUE(decode_block(constants, {}, stream.data(), bytes, decoded.data()));
          ASSERT_EQ(found.stream, stream) << b << ", rung " << rung << " in " << bytes;
          ASSERT_EQ(std::memcmp(found.decoded.data(), decoded.data(), sizeof decoded), 0) << b << ", rung " << rung;
          ++made;
        }
      }
    }
  }
  EXPECT_GT(made, 8000U);
  EXPECT_LT(left, made / 200) << "in as many bytes as was promised";
}

TEST_F(LatticeCodeSteps, StreamsOfFloatsInOrderAreThoseOfTheCpu) {
  const ValueEncoder coder(built_in_tables(), ValueEncoder::Kind::lattice);
  std::size_t made = 0;
  std::size_t left = 0;
  for (const BlockVolume& volume : volumes_) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, volume.extent.x > 1 ? kBefores[1] : kBefores[0]);
    const BlockConstants constants = constants_of(volume);
    for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
      const Values values = boxed.block(b);
      if (!all_finite(values)) {
        EXPECT_FALSE(make(boxed.box, constants, {{}, b, 0, 900, 0, StreamAskKind::exact}).made) << b;
        continue;
      }
      std::vector<std::byte> stream(4096);
      stream.resize(encode_exact(coder, constants, std::nullopt, values, stream));
      const auto bytes = static_cast<std::uint16_t>(stream.size());
      const Made found = make(boxed.box, constants, {{}, b, 0, bytes, 0, StreamAskKind::exact});
      EXPECT_FALSE(
          make(boxed.box, constants, {{}, b, 0, static_cast<std::uint16_t>(bytes + 1), 0, StreamAskKind::exact}).made)
          << b;
      if (!found.made) {
        left += bytes < kRawStreamBytes && is_ordered(stream) ? 1 : 0;
        continue;
      }
      ASSERT_EQ(found.stream, stream) << b;
      ASSERT_EQ(std::memcmp(found.decoded.data(), values.data(), sizeof values), 0) << b;
      ++made;
    }
  }
  EXPECT_GT(made, 300U);
  EXPECT_LT(left, made) << "on a lattice of their own";
}

}  // namespace
}  // namespace weir::encode_steps_test
