// Quantised files of the hard cases, read back by stock NanoVDB: the requested size to the byte, the certificate, the
// values outside the domain, macrocells, and node statistics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/encode/leaf_record.h"
#include "format/base/error.h"
#include "format/base/little_endian.h"
#include "format/layout/nanovdb_layout.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/compressor/support/measured.h"
#include "tests/stock/stock_tree.h"

namespace weir::quantised_conversion_test {
namespace {

using test::bits_of;
using test::Converted;
using test::HardCase;
using test::Measured;
using test::MemoryVolume;
using test::StockReader;

constexpr Encoding kQuantised[] = {Encoding::automatic, Encoding::fpn, Encoding::fp4, Encoding::fp8, Encoding::fp16};

// Returns the policies under which a quantised file can hold the volume.
std::vector<NonFinitePolicy> quantised_policies(const MemoryVolume& volume) {
  std::vector<NonFinitePolicy> policies = test::policies_of(volume);
  std::erase(policies, NonFinitePolicy::keep);
  return policies;
}

// Returns the size beyond which more bytes buy nothing, from the notice for a much larger file.
std::uint64_t full_size(MemoryVolume& volume, ConversionOptions options) {
  const std::uint64_t dense = static_cast<std::uint64_t>(volume.info().domain().voxels()) * sizeof(float);
  const Converted converted = test::convert_to(volume, options, 2 * dense + 10'000'000);
  static const std::regex form(
      "out\\.nvdb: (lossless|the best that this encoding can do) takes ([0-9]+) bytes; the other .*");
  std::smatch match;
  if (converted.notices.size() == 1 && std::regex_match(converted.notices[0], match, form)) {
    return std::stoull(match[2]);
  }
  ADD_FAILURE() << "no notice of padding";
  return 0;
}

// Returns the minimum size, two sizes in between, the size that buys everything, and a larger size.
std::vector<std::uint64_t> sizes_of(MemoryVolume& volume, const ConversionOptions& options) {
  const std::uint64_t minimum = test::minimum_size(volume, options);
  const std::uint64_t full = full_size(volume, options);
  return {minimum, minimum + (full - minimum) / 5, minimum + (full - minimum) * 2 / 3, full, full + 12345};
}

// Outside the domain nothing is active. A block that touches the domain reads there as at its nearest voxel inside (a
// tile reads its value). Float leaves and everything else read the background.
void expect_outside(const Converted& converted, const StockReader& reader, const Box& domain) {
  const NvdbGrid grid = converted.grid();
  const Index3 margin{9, 9, 9};
  const Box box{domain.lo - margin, domain.hi + margin};
  for (std::int64_t n = 0; n < box.voxels(); ++n) {
    const Index3 i = box.lo + index_at(n, box.extent());
    if (domain.contains(i)) continue;
    ASSERT_FALSE(reader.active(i)) << i.x << ' ' << i.y << ' ' << i.z;
    const GridBlock block = grid.block_at(i);
    const Box touching = intersect({block.origin, block.origin + Index3{block.dim, block.dim, block.dim}}, domain);
    float expected = grid.background();
    if (!touching.empty() && (block.leaf == nullptr || grid.type() != GridType::float32)) {
      expected = reader.value(max(touching.lo, min(touching.hi - Index3{1, 1, 1}, i)));
    }
    ASSERT_EQ(bits_of(reader.value(i)), bits_of(expected)) << i.x << ' ' << i.y << ' ' << i.z;
  }
}

// Macrocells are the bounds of all decoded voxels in the cell and its apron. Outside the domain the background counts.
void expect_macrocells(const Converted& converted, const StockReader& reader, const Box& domain) {
  const NvdbGrid grid = converted.grid();
  const MacrocellView view = grid.macrocells();
  ASSERT_EQ(view.lattice.domain, domain);
  std::vector<MinMax> expected(view.cells.size(), kNoBounds);
  const Index3 apron{view.apron, view.apron, view.apron};
  for (std::int64_t n = 0; n < domain.voxels(); ++n) {
    const Index3 i = domain.lo + index_at(n, domain.extent());
    const float value = reader.value(i);
    const Index3 lo = max(floor_div(i - apron, view.cell) - view.lattice.first, Index3{0, 0, 0});
    const Index3 last = min(floor_div(i + apron, view.cell) - view.lattice.first, view.lattice.count - Index3{1, 1, 1});
    for (std::int64_t z = lo.z; z <= last.z; ++z) {
      for (std::int64_t y = lo.y; y <= last.y; ++y) {
        for (std::int64_t x = lo.x; x <= last.x; ++x) {
          widen(expected[static_cast<std::size_t>(view.lattice.linear({x, y, z}))], {value, value});
        }
      }
    }
  }
  for (std::size_t c = 0; c < expected.size(); ++c) {
    const Box box = view.lattice.node_box(view.lattice.position(static_cast<std::int64_t>(c)));
    const Box reach{box.lo - apron, box.hi + apron};
    if (!domain.contains(reach)) widen(expected[c], {grid.background(), grid.background()});
    ASSERT_EQ(view.cells[c].min, expected[c].min) << c;
    ASSERT_EQ(view.cells[c].max, expected[c].max) << c;
  }
}

// Stock statistics divide by the quantum, which is zero in a leaf of one value, and they invert the box of a node
// without active voxels. These bytes are not compared.
void expect_stock_statistics(const Converted& converted, const StockReader& reader) {
  const NvdbGrid grid = converted.grid();
  std::vector<std::byte> ours = reader.grid();
  std::vector<std::byte> stock = reader.grid_with_stock_statistics();
  ASSERT_EQ(ours.size(), stock.size());
  const auto blank = [&](std::uint64_t offset, std::uint64_t bytes) {
    for (auto* grid_bytes : {&ours, &stock}) {
      std::fill_n(grid_bytes->begin() + static_cast<std::ptrdiff_t>(offset), bytes, std::byte{0});
    }
  };
  grid.for_each_block([&](const GridBlock& block) {
    if (block.leaf == nullptr || grid.type() == GridType::float32) return;
    float quantum;
    std::memcpy(&quantum, block.leaf + nvdb::leaf::kQuantum, sizeof quantum);
    const auto at = static_cast<std::uint64_t>(block.leaf - converted.file.data()) - grid.grid_offset();
    if (quantum == 0) blank(at + nvdb::leaf::kQuantMin, 8);
  });
  std::uint64_t node = nvdb::kRootTilesOffset + grid.root_tiles() * nvdb::kRootTileBytes;
  const auto blank_empty = [&](std::uint64_t count, std::uint64_t bytes) {
    for (std::uint64_t i = 0; i < count; ++i, node += bytes) {
      if ((load<std::uint64_t>(ours, node + nvdb::kNodeFlags) & 2U) == 0) blank(node, nvdb::kNodeFlags);
    }
  };
  blank_empty(grid.node_counts()[2], nvdb::kUpperBytes);
  blank_empty(grid.node_counts()[1], nvdb::kLowerBytes);
  EXPECT_EQ(std::mismatch(ours.begin(), ours.end(), stock.begin()).first - ours.begin(), std::ssize(ours));
}

class QuantisedConversionTest : public testing::TestWithParam<HardCase> {};

TEST_P(QuantisedConversionTest, HoldsItsCertificateInTheBytesAsked) {
  MemoryVolume volume = GetParam().make();
  const Box domain = volume.info().domain();
  for (const NonFinitePolicy policy : quantised_policies(volume)) {
    for (const Encoding encoding : kQuantised) {
      ConversionOptions options;
      options.non_finite = policy;
      options.encoding = encoding;
      const auto sizes = sizes_of(volume, options);
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        SCOPED_TRACE(encoding_name(encoding) + ", " + std::to_string(sizes[i]) + " bytes");
        const Converted converted = test::convert_to(volume, options, sizes[i]);
        ASSERT_EQ(converted.file.size(), sizes[i]);
        // At one of the sizes, auto may settle for the best that FpN can do.
        if (encoding != Encoding::automatic || i == 4) {
          EXPECT_EQ(converted.notices.size(), i == 4 ? 1U : 0U);
        }
        EXPECT_EQ(converted.sidecar.selection.leaves_kept, converted.grid().node_counts()[0]);
        if (encoding != Encoding::automatic) {
          EXPECT_EQ(converted.grid().type(), grid_type_of(encoding));
        }
        test::expect_certificate(converted, test::measure(volume, converted, policy));
        const StockReader reader(converted.file);
        expect_stock_statistics(converted, reader);
        expect_macrocells(converted, reader, domain);
        if (i == 1) expect_outside(converted, reader, domain);
        if (HasFailure()) return;
      }
    }
  }
}

TEST_P(QuantisedConversionTest, FilledWithTheBackground_CertificateAndMacrocellsHold) {
  MemoryVolume volume = GetParam().make();
  for (const NonFinitePolicy policy : quantised_policies(volume)) {
    ConversionOptions options;
    options.non_finite = policy;
    options.fill = FillMode::background;
    options.encoding = Encoding::fpn;
    const Converted converted = test::convert_to(volume, options, sizes_of(volume, options)[1]);
    test::expect_certificate(converted, test::measure(volume, converted, policy));
    const StockReader reader(converted.file);
    expect_macrocells(converted, reader, volume.info().domain());
    expect_outside(converted, reader, volume.info().domain());
  }
}

// A larger file buys more of the same steps. Their gains are estimates, so this is measured and not proven.
TEST_P(QuantisedConversionTest, LargerFileNeverHasALargerError) {
  MemoryVolume volume = GetParam().make();
  for (const NonFinitePolicy policy : quantised_policies(volume)) {
    for (const Encoding encoding : kQuantised) {
      ConversionOptions options;
      options.non_finite = policy;
      options.encoding = encoding;
      const std::uint64_t minimum = test::minimum_size(volume, options);
      const std::uint64_t full = full_size(volume, options);
      double last = std::numeric_limits<double>::infinity();
      for (std::uint64_t part = 0; part <= 16; ++part) {
        const Converted converted = test::convert_to(volume, options, minimum + (full - minimum) * part / 16);
        EXPECT_LE(converted.sidecar.error.mse, last) << encoding_name(encoding) << ' ' << part;
        last = converted.sidecar.error.mse;
      }
    }
  }
}

TEST_P(QuantisedConversionTest, AutoIsAsGoodAsTheBetterOfFloatAndFpn) {
  MemoryVolume volume = GetParam().make();
  for (const NonFinitePolicy policy : quantised_policies(volume)) {
    ConversionOptions options;
    options.non_finite = policy;
    options.encoding = Encoding::automatic;
    const std::uint64_t minimum = test::minimum_size(volume, options);
    ConversionOptions plain = options;
    plain.encoding = Encoding::float32;
    plain.budget.kind = Budget::Kind::lossless;
    const std::uint64_t lossless = test::convert(volume, plain).file.size();
    const std::uint64_t float_minimum = test::minimum_size(volume, plain);
    for (std::uint64_t part = 0; part <= 12; ++part) {
      const std::uint64_t size = minimum + (lossless - minimum) * part / 12;
      SCOPED_TRACE(size);
      options.encoding = Encoding::automatic;
      const Converted best = test::convert_to(volume, options, size);
      options.encoding = Encoding::fpn;
      const Converted quantised = test::convert_to(volume, options, size);
      EXPECT_LE(best.sidecar.error.mse, quantised.sidecar.error.mse * 1.001);
      EXPECT_TRUE(best.sidecar.error.lossless || !quantised.sidecar.error.lossless);
      if (size < float_minimum) continue;
      options.encoding = Encoding::float32;
      const Converted floats = test::convert_to(volume, options, size);
      EXPECT_LE(best.sidecar.error.mse, floats.sidecar.error.mse * 1.001);
      EXPECT_TRUE(best.sidecar.error.lossless || !floats.sidecar.error.lossless);
    }
  }
}

TEST_P(QuantisedConversionTest, LosslessAutoIsTheSmallerOfFloatAndFpn) {
  MemoryVolume volume = GetParam().make();
  for (const NonFinitePolicy policy : quantised_policies(volume)) {
    ConversionOptions options;
    options.non_finite = policy;
    options.budget.kind = Budget::Kind::lossless;
    options.encoding = Encoding::float32;
    const Converted floats = test::convert(volume, options);
    options.encoding = Encoding::automatic;
    const Converted best = test::convert(volume, options);
    EXPECT_TRUE(best.sidecar.error.lossless);
    EXPECT_TRUE(test::measure(volume, best, policy).lossless);
    EXPECT_LE(best.file.size(), floats.file.size());
    options.encoding = Encoding::fpn;
    static const std::regex refusal(
        "out\\.nvdb: --encoding fpn cannot be lossless: ([0-9]+ blocks need|1 block needs) full float32; "
        "use --encoding auto or float");
    try {
      const Converted quantised = test::convert(volume, options);
      EXPECT_TRUE(test::measure(volume, quantised, policy).lossless);
      EXPECT_EQ(best.notices.size(), 0U);
      EXPECT_EQ(best.file.size(), std::min(quantised.file.size(), floats.file.size()));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::budget);
      EXPECT_TRUE(std::regex_match(error.what(), refusal)) << error.what();
      EXPECT_EQ(best.file, floats.file);
      ASSERT_EQ(best.notices.size(), 1U);
      static const std::regex notice("out\\.nvdb: ([0-9]+ blocks need|1 block needs) full float32 to be lossless");
      EXPECT_TRUE(std::regex_match(best.notices[0], notice)) << best.notices[0];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, QuantisedConversionTest, testing::ValuesIn(test::hard_cases()),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace weir::quantised_conversion_test
