// A packed grid with streams of many kinds, magnitudes and lengths, for the tests of decoders.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

#include "format/packed/block_encode.h"
#include "format/packed/block_steps.h"
#include "format/packed/lattice_block.h"
#include "tests/support/packed_grid.h"

namespace weir::test {

inline constexpr MeanRange kKindsMeans{-40, 60};
inline constexpr std::int32_t kKindsCoarsest = -8;

// Returns the tables that PackedGridBuilder uses.
inline const std::uint16_t* even_tables() {
  static const auto tables = [] {
    std::array<std::uint16_t, std::size_t{kPackedTables} * kPackedSymbols> made{};
    for (unsigned i = 0; i < made.size(); ++i) made[i] = static_cast<std::uint16_t>(i % kPackedSymbols * 256);
    return made;
  }();
  return tables.data();
}

// Returns an exact stream of codes near each other or far apart, so that different predictors suit them, on a lattice
// or in the floats' order.
inline PackedBytes exact_stream(std::minstd_rand& engine) {
  const auto random = [&engine] { return static_cast<std::uint32_t>(engine()) >> 8U; };
  const std::uint32_t shape = random() % 4;
  const bool on_lattice = random() % 2 == 0;
  const std::uint32_t rough = random() % 14;
  std::array<float, 512> values;
  for (unsigned i = 0; i < 512; ++i) {
    const std::uint32_t x = i >> 6U, y = i >> 3U & 7U, z = i & 7U;
    const std::uint32_t noise = random() % (1U << rough);
    std::uint32_t code = 0;
    if (shape == 0) code = 1000 * x + 300 * y + x * y * 8 + 77 * z + noise % 4;
    if (shape == 1) code = noise;
    if (shape == 2) code = random() % 4 > 0 ? 0 : noise;
    if (shape == 3) code = (x > 3 ? 3000 : 0) + (y > 2 ? 500 : 0) + (z > 4 ? 9000 : 0) + noise % 2;
    values[i] = static_cast<float>(code) * 0.25F - 20.0F;
    if (!on_lattice) values[i] *= 1.0F + static_cast<float>(noise % 8) * 1.1920929e-7F;
  }
  BlockConstants constants;
  constants.tables = even_tables();
  std::optional<Lattice> own;
  if (on_lattice) own = Lattice{-20.0F, 0.25F, 24};
  PackedBytes stream(kRawStreamBytes);
  stream.resize(encode_exact({constants.tables, ValueEncoder::Kind::lattice}, constants, own, values, stream));
  return stream;
}

// Returns a stream of a random kind, with magnitudes up to and beyond those that fill all the room of a stream.
inline PackedBytes stream_of_some_kind(const Index3& block) {
  std::minstd_rand engine(static_cast<std::uint32_t>(block.x * 7919 + block.y * 104729 + block.z * 1299709));
  const auto random = [&engine] { return static_cast<std::uint32_t>(engine()); };
  const std::uint32_t kind = random() % 10;
  if (kind == 0) return {};
  if (kind == 1) return constant_stream(3.5F);
  if (kind == 2) return mean_stream(random() % 16, 4);
  if (kind >= 8) return exact_stream(engine);
  std::array<float, 512> values;
  const float wave = std::ldexp(1.0F, static_cast<int>(random() % 8));
  const float noise = std::ldexp(1.0F, static_cast<int>(random() % 12) - 8);
  for (unsigned i = 0; i < 512; ++i) {
    const float x = static_cast<float>(i >> 6U) * 0.31F + static_cast<float>(i >> 3U & 7U) * 0.17F;
    const float rough = std::ldexp(static_cast<float>(random() >> 7U), -24) - 0.5F;
    values[i] = wave * std::sin(x + static_cast<float>(i & 7U) * 0.23F) + noise * rough;
  }
  if (kind == 3) return raw_stream(values);
  TransformBlock transform(even_tables());
  EXPECT_TRUE(transform.set(values));
  const auto step = kKindsCoarsest + static_cast<std::int32_t>(random() % 34);
  const std::uint32_t bytes = stream_bytes(transform.cost(step).bits, mean_bits(kKindsMeans, step)) + random() % 3;
  if (bytes >= kRawStreamBytes) return raw_stream(values);
  BlockConstants constants;
  constants.coarsest = kKindsCoarsest;
  constants.below_one = 0.1F;
  constants.below_more = 0.05F;
  constants.tables = even_tables();
  PackedBytes stream(bytes);
  transform.encode(constants, kKindsMeans, step, stream);
  return stream;
}

inline PackedFile build_packed_kinds() {
  PackedGridOptions options;
  options.domain = {{-5, 3, 10}, {200, 60, 61}};
  options.means = kKindsMeans;
  options.coarsest = kKindsCoarsest;
  options.stream = stream_of_some_kind;
  options.value = [](const Index3& region) { return static_cast<float>(region.x) + 0.125F; };
  return PackedGridBuilder::build(options);
}

}  // namespace weir::test
