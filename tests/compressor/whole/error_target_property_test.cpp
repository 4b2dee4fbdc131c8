// A written file keeps its error target, or the conversion is refused. Tested over random volumes with heavy tails, for
// all targets and encodings. WEIR_PROPERTY_VOLUMES sets the number of volumes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/measured.h"
#include "tests/compressor/support/random_volumes.h"

namespace weir::error_target_property_test {
namespace {

using test::Converted;
using test::MemoryVolume;
using test::RandomVolume;

// Returns the conversion; nullopt if it is refused because fpn alone cannot meet the target. The message must say what
// to do.
std::optional<Converted> converted_or_refused(MemoryVolume& volume, const ConversionOptions& options) {
  try {
    return test::convert(volume, options);
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(options.encoding, Encoding::fpn) << message;
    EXPECT_EQ(error.kind(), ErrorKind::budget) << message;
    EXPECT_EQ(message.substr(0, 12), "out.nvdb: --");
    const std::string remedy = "; use --encoding auto or float";
    EXPECT_EQ(message.substr(message.size() - std::min(message.size(), remedy.size())), remedy);
    return std::nullopt;
  }
}

double psnr_of(const test::Measured& measured) {
  const double range = static_cast<double>(measured.max) - static_cast<double>(measured.min);
  return 20 * std::log10(range) - 10 * std::log10(measured.mse);
}

void expect_met(RandomVolume& random, const ConversionOptions& options) {
  SCOPED_TRACE(cat(random.name, ", --encoding ", encoding_name(options.encoding), ", budget ",
                   static_cast<int>(options.budget.kind), " of ", options.budget.target));
  const std::optional<Converted> converted = converted_or_refused(random.volume, options);
  if (!converted) return;
  const test::Measured measured = test::measure(random.volume, *converted, NonFinitePolicy::error);
  test::expect_certificate(*converted, measured);
  if (options.encoding != Encoding::automatic) {
    EXPECT_EQ(converted->grid().type(), grid_type_of(options.encoding));
  }
  switch (options.budget.kind) {
    case Budget::Kind::psnr:
      if (measured.mse > 0) {
        EXPECT_GE(psnr_of(measured), options.budget.target - 1e-9);
        EXPECT_GE(converted->sidecar.error.psnr_db, options.budget.target);
      }
      break;
    case Budget::Kind::max_error:
      EXPECT_LE(measured.max_abs, options.budget.target);
      break;
    case Budget::Kind::lossless:
      EXPECT_TRUE(measured.lossless);
      break;
    default:
      EXPECT_EQ(converted->file.size(), converted->sidecar.budget.file_bytes);
  }
}

TEST(ErrorTargetProperty, AnyVolumeAndTarget_IsMetByTheFileOrRefused) {
  const std::uint64_t volumes = test::property_volumes(27);
  for (std::uint64_t seed = 0; seed < volumes; ++seed) {
    RandomVolume random = test::random_volume(seed, 64);
    std::mt19937_64 engine(seed);
    const double psnr = std::vector<double>{15, 30, 45, 60, 80, 100, 130, 160}[engine() % 8];
    const double part = std::pow(10, -static_cast<double>(engine() % 7));
    for (const Encoding encoding : {Encoding::automatic, Encoding::float32, Encoding::fpn}) {
      ConversionOptions options;
      options.encoding = encoding;
      for (const Budget& budget :
           {Budget{Budget::Kind::psnr, 8, 0, psnr}, Budget{Budget::Kind::max_error, 8, 0, part * random.range},
            Budget{Budget::Kind::lossless, 8, 0, 0}, Budget{Budget::Kind::automatic, 8, 0, 0}}) {
        options.budget = budget;
        expect_met(random, options);
      }
    }
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace weir::error_target_property_test
