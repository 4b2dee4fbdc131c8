// Error targets instead of sizes. The decoded values meet them, with fused operations or without, and the file is no
// larger than needed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/select/encoding_choice.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/leaf/leaf_decode.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/two_materials.h"
#include "tests/stock/stock_tree.h"
#include "tests/support/message_of_error.h"

namespace weir::error_target_test {
namespace {

using test::Converted;
using test::MemoryVolume;
using test::StockReader;

struct Case {
  std::string name;
  std::string kind;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const SyntheticKind& kind : synthetic_kinds()) {
    std::string name;
    for (const char c : kind.name) {
      if (c != '-') name += c;
    }
    all.push_back({name, std::string(kind.name)});
  }
  return all;
}

class ErrorTarget : public testing::TestWithParam<Case> {
 protected:
  MemoryVolume volume() const {
    const auto source = open_synthetic(GetParam().kind, {{45, 30, 25}, 5});
    return MemoryVolume(*source);
  }
  static ConversionOptions options_for(Budget::Kind kind, double target, Encoding encoding) {
    ConversionOptions options;
    options.budget.kind = kind;
    options.budget.target = target;
    options.encoding = encoding;
    options.non_finite = NonFinitePolicy::background;
    return options;
  }
};

// Largest error, mean squared error and range over the finite voxels, as the stock reader finds them.
struct Read {
  double max_abs = 0;
  double mse = 0;
  double range = 0;
};

Read read_back(const MemoryVolume& volume, const Converted& converted) {
  const StockReader reader(converted.file);
  EXPECT_TRUE(reader.valid());
  Read read;
  long double squares = 0;
  std::uint64_t finite = 0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const Box domain = volume.info().domain();
  for (std::int64_t n = 0; n < domain.voxels(); ++n) {
    const Index3 i = domain.lo + index_at(n, domain.extent());
    const float v = volume.at(i);
    if (!std::isfinite(v)) continue;
    const double d = std::fabs(static_cast<double>(v) - static_cast<double>(reader.value(i)));
    read.max_abs = std::max(read.max_abs, d);
    squares += static_cast<long double>(d) * static_cast<long double>(d);
    low = std::min(low, static_cast<double>(v));
    high = std::max(high, static_cast<double>(v));
    ++finite;
  }
  if (finite == 0) return read;
  read.mse = static_cast<double>(squares / static_cast<long double>(finite));
  read.range = high - low;
  return read;
}

TEST_P(ErrorTarget, EveryVoxelIsWithinTheLargestErrorAsked) {
  MemoryVolume source = volume();
  const auto& values = source.values();
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  for (const float v : values) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  const double range = high > low ? static_cast<double>(high) - static_cast<double>(low) : 1;
  std::size_t last_bytes = 0;
  for (const double part : {0.0, 1e-6, 1e-3, 0.02, 0.3, 2.0}) {
    const Converted converted =
        test::convert(source, options_for(Budget::Kind::max_error, part * range, Encoding::automatic));
    EXPECT_LE(read_back(source, converted).max_abs, part * range) << part;
    EXPECT_LE(converted.sidecar.error.max_abs, part * range) << part;
    EXPECT_EQ(converted.sidecar.budget.kind, "max_error");
    EXPECT_EQ(converted.sidecar.budget.requested, part * range);
    if (part > 0) {
      EXPECT_LE(converted.file.size(), last_bytes) << part;
    }
    last_bytes = converted.file.size();
  }
}

TEST_P(ErrorTarget, ThePsnrIsAtLeastTheOneAsked) {
  MemoryVolume source = volume();
  for (const double target : {20.0, 45.0, 70.0, 110.0}) {
    const Converted converted = test::convert(source, options_for(Budget::Kind::psnr, target, Encoding::automatic));
    const Read read = read_back(source, converted);
    if (read.mse > 0 && read.range > 0) {
      EXPECT_GE(20 * std::log10(read.range) - 10 * std::log10(read.mse), target - 1e-9) << target;
      EXPECT_GE(converted.sidecar.error.psnr_db, target);
    }
    EXPECT_EQ(converted.sidecar.budget.kind, "psnr");
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ErrorTarget, testing::ValuesIn(cases()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(ErrorTargets, ASmallerFileMissesThePsnr) {
  const auto source = open_synthetic("turbulence", {{128, 64, 64}, 5});
  MemoryVolume volume(*source);
  for (const Encoding encoding : {Encoding::automatic, Encoding::fpn, Encoding::float32}) {
    ConversionOptions options;
    options.encoding = encoding;
    options.budget.kind = Budget::Kind::psnr;
    options.budget.target = 40;
    const Converted converted = test::convert(volume, options);
    EXPECT_GE(converted.sidecar.error.psnr_db, 40);
    EXPECT_LE(converted.sidecar.error.psnr_db, 40.1);
    const Converted smaller = test::convert_to(volume, options, converted.file.size() * 97 / 100);
    EXPECT_LT(smaller.sidecar.error.psnr_db, 40);
  }
}

TEST(ErrorTargets, UnreachableTargetIsRefusedWithAReason) {
  const auto source = open_synthetic("noise", {{64, 32, 32}, 5});
  MemoryVolume volume(*source);
  const auto refusal = [&](Budget::Kind kind, double target, Encoding encoding) -> std::string {
    ConversionOptions options;
    options.encoding = encoding;
    options.budget.kind = kind;
    options.budget.target = target;
    try {
      test::convert(volume, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::budget);
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(refusal(Budget::Kind::max_error, 1e-9, Encoding::fpn),
            "out.nvdb: --max-error 1e-09 cannot be met: --encoding fpn has leaves whose range 16 bits do not divide "
            "that finely; use --encoding auto or float");
  const std::string at_most = refusal(Budget::Kind::psnr, 90, Encoding::fp8);
  EXPECT_EQ(at_most.substr(0, at_most.find("about")), "out.nvdb: --psnr 90 cannot be met: --encoding fp8 reaches ");
  EXPECT_EQ(refusal(Budget::Kind::psnr, 300, Encoding::automatic), "no error");  // float32 keeps every bit
  FileRequest tiny;  // the square of its range is below every double
  tiny.path = "out.nvdb";
  tiny.budget.kind = Budget::Kind::psnr;
  tiny.budget.target = 60;
  EXPECT_STREQ(unmet_target(tiny, Encoding::fpn, 1e-300).what(),
               "out.nvdb: --psnr 60 cannot be met: --encoding fpn has leaves whose range 16 bits do not divide that "
               "finely; use --encoding auto or float");
  EXPECT_EQ(refusal(Budget::Kind::max_error, 0, Encoding::automatic), "no error");
}

// Estimates of the errors of quantised leaves are good enough over many leaves.
TEST(ErrorTargets, TakeOneFileOfAVolumeOfManyLeaves) {
  for (const auto& [kind, width] : {std::pair{"turbulence", 128}, {"cloud", 320}}) {
    const auto source = open_synthetic(kind, {{width, width, width}, 4});
    MemoryVolume volume(*source);
    for (const double target : {40.0, 50.0, 60.0, 70.0, 80.0, 90.0}) {
      ConversionOptions options;
      options.output = "out.nvdb";
      options.budget.kind = Budget::Kind::psnr;
      options.budget.target = target;
      options.encoding = Encoding::automatic;
      std::vector<std::string> passes;
      ConversionControl control;
      control.pass_started = [&](const std::string& pass, std::uint64_t) { passes.push_back(pass); };
      test::CrashFileSystem files;
      const Sidecar sidecar = convert_volume(volume, options, control, files);
      EXPECT_EQ(passes, (std::vector<std::string>{"survey", "encode"})) << kind << ' ' << target;
      EXPECT_GE(sidecar.error.psnr_db, target) << kind;
      EXPECT_LE(sidecar.error.psnr_db, target + 0.14) << kind;
    }
  }
}

TEST(ErrorTargets, PsnrOfAFileWithoutBlocks_TakesTheSmallestFile) {
  MemoryVolume volume({{0, 0, 0}, {40, 40, 40}}, [](const Index3& i) {
    return i == Index3{17, 20, 9} ? 1e30F : static_cast<float>(1 + (i.x * 7 + i.y * 13 + i.z * 29) % 31) * 1e-30F;
  });
  for (const Encoding encoding : {Encoding::automatic, Encoding::float32, Encoding::packed}) {
    ConversionOptions options;
    options.encoding = encoding;
    const std::uint64_t smallest = test::minimum_size(volume, options);
    options.budget.kind = Budget::Kind::psnr;
    for (const double psnr : {20.0, 45.0}) {  // losing one voxel of 64,000 gives 48 dB
      options.budget.target = psnr;
      EXPECT_EQ(test::convert(volume, options).file.size(), smallest) << encoding_name(encoding) << ' ' << psnr;
    }
    options.budget.target = 49;
    EXPECT_GT(test::convert(volume, options).file.size(), smallest) << encoding_name(encoding);
  }
}

TEST(ErrorTargets, HoldForADecoderWithFusedMultiplyAdd) {
  // fma(code, quantum, minimum) may differ by an ulp. The bound leaves room for this.
  const auto source = open_synthetic("turbulence", {{64, 64, 64}, 9});
  MemoryVolume volume(*source);
  for (const double target : {1e-5, 1e-4, 1e-3, 1e-2}) {
    ConversionOptions options;
    options.encoding = Encoding::fpn;
    options.budget.kind = Budget::Kind::max_error;
    options.budget.target = target;
    const Converted converted = test::convert(volume, options);
    double worst = 0;
    converted.grid().for_each_block([&](const GridBlock& block) {
      if (block.leaf == nullptr) return;
      for (unsigned n = 0; n < 512; ++n) {
        const std::uint32_t code = leaf_code(block.leaf + nvdb::leaf::kCodes, fpn_bits_log2(block.leaf), n);
        const float fused = std::fma(static_cast<float>(code), load<float>(block.leaf + nvdb::leaf::kQuantum),
                                     load<float>(block.leaf + nvdb::leaf::kQuantMinimum));
        const float value = volume.at(block.origin + Index3{n >> 6U, n >> 3U & 7U, n & 7U});
        worst = std::max(worst, std::fabs(static_cast<double>(value) - static_cast<double>(fused)));
      }
    });
    EXPECT_GT(worst, 0);
    EXPECT_LE(worst, target);
  }
}

// Float cannot hold two levels so far apart. Such a leaf decodes to one value, and the error of that value is known.
TEST(ErrorTarget, OfALeafThatSpansAllOfFloat_IsThatOfOneLevel) {
  constexpr float kMost = std::numeric_limits<float>::max();
  const auto ends = [](const Index3& i) { return (i.x + i.y + i.z) % 2 == 0 ? kMost : -kMost; };
  for (const Encoding encoding : {Encoding::fpn, Encoding::fp4, Encoding::fp16}) {
    MemoryVolume volume({{0, 0, 0}, {8, 8, 8}}, ends);
    ConversionOptions options;
    options.encoding = encoding;
    options.budget.kind = Budget::Kind::max_error;
    options.budget.target = 5e38;
    const Converted converted = test::convert(volume, options);
    EXPECT_LE(converted.sidecar.error.max_abs, 5e38) << encoding_name(encoding);
    options.budget.target = 1e38;
    EXPECT_THROW(test::convert(volume, options), Error) << encoding_name(encoding);
  }
}

// Returns a volume of zeros in which one voxel in 50 has a random value.
MemoryVolume sparse_noise() {
  MemoryVolume volume({{0, 0, 0}, {32, 32, 32}}, [](const Index3& i) {
    const auto n = static_cast<std::uint32_t>(i.x + 32 * (i.y + 32 * i.z)) * 2654435761U;
    return n % 50 == 0 ? static_cast<float>(n >> 8U) * 0x1p-22F - 2 : 0.0F;
  });
  return volume;
}

// The estimated errors of leaves with sparse values are far too high.
TEST(ErrorTargetOfSparseValues, WhatTheEncodingReachesIsNotRefused) {
  MemoryVolume volume = sparse_noise();
  ConversionOptions options;
  options.encoding = Encoding::fp4;
  options.budget.kind = Budget::Kind::size;
  options.budget.bytes = 3'000'000;
  options.budget.at_most = true;
  const double most = test::convert(volume, options).sidecar.error.psnr_db.value();
  options.budget = {};
  options.budget.kind = Budget::Kind::psnr;
  options.budget.target = most - 0.5;
  EXPECT_GE(test::convert(volume, options).sidecar.error.psnr_db.value(), most - 0.5);
  options.budget.target = most + 1;
  const std::string message = message_of_error(ErrorKind::budget, [&] { test::convert(volume, options); });
  EXPECT_NE(message.find(cat(" reaches about ", std::floor(most * 10) / 10, " dB at most")), std::string::npos)
      << message;
}

// Two materials, and voxels without a value. Estimates for leaves with such voxels assume any background.
TEST(ErrorTargetOfMissingValues, WhatIsExactTakesNoMoreBitsThanItNeeds) {
  MemoryVolume volume = test::two_materials(32);
  ConversionOptions options;
  options.non_finite = NonFinitePolicy::background;
  options.background = 0.5F;
  options.budget.kind = Budget::Kind::psnr;
  options.budget.target = 60;
  const Converted converted = test::convert(volume, options);
  EXPECT_EQ(converted.sidecar.error.max_abs, 0);
  const auto& bits = converted.sidecar.selection.bits;
  EXPECT_EQ(bits[4], 0U) << "leaves of 16 bits, of 64";
}

// An early quantised file meets the target. A float file that replaces it must not be planned for a larger error.
TEST(ErrorTargets, SpikesOnSmallNoise_ReachThePsnrAsked) {
  std::mt19937_64 engine(1);
  const auto draw = [&] { return std::ldexp(static_cast<double>(engine() >> 11U), -53); };
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}},
                      [&](const Index3&) { return static_cast<float>((draw() < 3e-4 ? 6e5 : 0) + draw() * 1e-3); });
  ConversionOptions options;
  options.encoding = Encoding::automatic;
  options.budget = {Budget::Kind::psnr, 8, 0, 60};
  EXPECT_GE(test::convert(volume, options).sidecar.error.psnr_db, 60);
}

}  // namespace
}  // namespace weir::error_target_test
