#include "compressor/compare/compare.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

#include "format/base/error.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/converted.h"

namespace weir::compare_test {
namespace {

using test::bits_of;
using test::convert;
using test::convert_to;
using test::Converted;
using test::MemoryVolume;
using test::minimum_size;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

float ramp(const Index3& i) { return static_cast<float>(i.x + 100 * i.y + 10000 * i.z); }

/// Compares the lossless file of `value` with sources that differ from it at voxels that the test chooses.
class CompareLossless : public testing::Test {
 protected:
  void convert_domain(const Box& domain, const std::function<float(const Index3&)>& value) {
    domain_ = domain;
    value_ = value;
    MemoryVolume volume(domain, value);
    ConversionOptions options;
    options.budget.kind = Budget::Kind::lossless;
    options.non_finite = NonFinitePolicy::keep;
    converted_ = convert(volume, options);
  }

  Comparison compare_with(const std::map<std::int64_t, float>& changes, const CompareOptions& options = {}) {
    MemoryVolume volume(domain_, [&](const Index3& i) {
      const auto change = changes.find(linear_index(i - domain_.lo, domain_.extent()));
      return change == changes.end() ? value_(i) : change->second;
    });
    return compare_volumes(volume, converted_.grid(), "out.nvdb", options);
  }

  std::int64_t at(const Index3& i) const { return linear_index(i - domain_.lo, domain_.extent()); }

  Box domain_;
  std::function<float(const Index3&)> value_;
  Converted converted_;
};

TEST_F(CompareLossless, NoDifference) {
  convert_domain({{0, 0, 0}, {20, 9, 17}}, ramp);
  const Comparison c = compare_with({});
  EXPECT_TRUE(c.error.lossless);
  EXPECT_EQ(c.error.mse, 0.0);
  EXPECT_EQ(c.error.max_abs, 0.0);
  EXPECT_EQ(c.error.psnr_db, std::nullopt);
  EXPECT_EQ(c.max_abs_at, std::nullopt);
  EXPECT_EQ(c.voxels, 3060U);
  EXPECT_EQ(c.finite, 3060U);
  EXPECT_EQ(c.different, 0U);
  EXPECT_EQ(c.range->min, 0.0F);
  EXPECT_EQ(c.range->max, ramp({19, 8, 16}));
}

TEST_F(CompareLossless, KnownDifferences) {
  convert_domain({{0, 0, 0}, {20, 9, 17}}, ramp);
  const Comparison c =
      compare_with({{at({3, 2, 1}), ramp({3, 2, 1}) + 0.5F}, {at({19, 8, 16}), ramp({19, 8, 16}) - 2.0F}});
  EXPECT_FALSE(c.error.lossless);
  EXPECT_EQ(c.error.mse, 4.25 / 3060);
  EXPECT_EQ(c.error.rmse, std::sqrt(4.25 / 3060));
  EXPECT_EQ(c.error.max_abs, 2.0);
  EXPECT_EQ(c.max_abs_at, (Index3{19, 8, 16}));
  EXPECT_EQ(c.different, 2U);
  const auto range = static_cast<double>(ramp({18, 8, 16}));  // now the largest value
  EXPECT_NEAR(c.error.nmse, 4.25 / 3060 / (range * range), 1e-20);
  EXPECT_NEAR(*c.error.psnr_db, 10 * std::log10(range * range / (4.25 / 3060)), 1e-9);
}

TEST_F(CompareLossless, FirstOfEqualMaximaInFileOrder) {
  convert_domain({{0, 0, 0}, {40, 24, 20}}, [](const Index3&) { return 1.0F; });
  // In leaf order, (20, 1, 0) also comes before (1, 9, 0), but (1, 1, 9) comes before (33, 17, 2).
  EXPECT_EQ(compare_with({{at({33, 17, 2}), 3.0F}, {at({1, 1, 9}), -1.0F}}).max_abs_at, (Index3{33, 17, 2}));
  EXPECT_EQ(compare_with({{at({1, 9, 0}), 3.0F}, {at({20, 1, 0}), -1.0F}}).max_abs_at, (Index3{20, 1, 0}));
  // The same within a leaf, although the leaf's own order has z fastest.
  EXPECT_EQ(compare_with({{at({1, 0, 0}), 3.0F}, {at({0, 0, 1}), 3.0F}}).max_abs_at, (Index3{1, 0, 0}));
}

TEST_F(CompareLossless, DomainThatBeginsBelowZeroAndOffTheLeafLattice) {
  convert_domain({{-13, 5, -200}, {9, 30, -130}}, ramp);
  EXPECT_TRUE(compare_with({}).error.lossless);
  const Comparison c = compare_with({{at({-13, 5, -200}), ramp({-13, 5, -200}) + 4.0F}});
  EXPECT_EQ(c.error.max_abs, 4.0);
  EXPECT_EQ(c.max_abs_at, (Index3{-13, 5, -200}));
  EXPECT_EQ(c.error.mse, 16.0 / static_cast<double>(domain_.voxels()));
}

TEST_F(CompareLossless, NonFiniteVoxels) {
  convert_domain({{0, 0, 0}, {9, 9, 9}}, [](const Index3& i) {
    return i == Index3{1, 1, 1} ? kNaN : i == Index3{8, 8, 8} ? kInf : 5.0F;
  });
  EXPECT_TRUE(compare_with({}).error.lossless);
  const Comparison c = compare_with({{at({2, 2, 2}), -kInf}, {at({8, 8, 8}), 6.0F}, {at({0, 0, 0}), 7.0F}});
  EXPECT_EQ(c.nonfinite, 2U);          // the kept NaN and the new -Inf
  EXPECT_EQ(c.nonfinite_decoded, 1U);  // the 6 decodes to +Inf
  EXPECT_EQ(c.finite, 727U);
  EXPECT_EQ(c.different, 2U);
  EXPECT_EQ(c.nonfinite_different, 1U);
  EXPECT_EQ(c.error.max_abs, 2.0);
  EXPECT_EQ(c.error.mse, 4.0 / 726);  // over the voxels that are finite on both sides
  EXPECT_FALSE(c.error.lossless);
}

TEST_F(CompareLossless, FileThatIsFiniteNowhere_HasNoErrorAndIsNotLossless) {
  convert_domain({{0, 0, 0}, {9, 9, 9}}, [](const Index3&) { return kNaN; });
  std::map<std::int64_t, float> changes;
  for (std::int64_t i = 0; i < domain_.voxels(); ++i) changes[i] = static_cast<float>(i);
  const Comparison c = compare_with(changes);
  EXPECT_EQ(c.nonfinite_decoded, 729U);
  EXPECT_EQ(c.error.mse, 0.0);
  EXPECT_EQ(c.error.psnr_db, std::nullopt);
  EXPECT_FALSE(c.error.lossless);
}

TEST_F(CompareLossless, AllNaN) {
  convert_domain({{0, 0, 0}, {9, 9, 9}}, [](const Index3&) { return kNaN; });
  const Comparison c = compare_with({});
  EXPECT_TRUE(c.error.lossless);
  EXPECT_EQ(c.finite, 0U);
  EXPECT_EQ(c.range, std::nullopt);
  EXPECT_EQ(c.error.mse, 0.0);
  EXPECT_EQ(c.error.psnr_db, std::nullopt);
}

TEST_F(CompareLossless, NegativeZeroIsNotLossless) {
  convert_domain({{0, 0, 0}, {9, 9, 9}}, [](const Index3&) { return 0.0F; });
  const Comparison c = compare_with({{0, -0.0F}});
  EXPECT_FALSE(c.error.lossless);
  EXPECT_EQ(c.different, 1U);
  EXPECT_EQ(c.error.mse, 0.0);
  EXPECT_EQ(c.max_abs_at, std::nullopt);
}

TEST_F(CompareLossless, OtherDomainIsAnInputError) {
  convert_domain({{0, 0, 0}, {9, 9, 9}}, ramp);
  MemoryVolume other({{0, 0, 0}, {9, 9, 10}}, ramp);
  other.info().path = "in.raw";
  try {
    compare_volumes(other, converted_.grid(), "out.nvdb", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_STREQ(error.what(),
                 "out.nvdb: holds the voxels 0:9,0:9,0:9, in.raw holds 0:9,0:9,0:10; give the source it was converted "
                 "from, with the same --dims and --roi");
  }
}

TEST_F(CompareLossless, CancelledIsInterrupted) {
  convert_domain({{0, 0, 0}, {9, 9, 9}}, ramp);
  const std::atomic<bool> cancel{true};
  CompareOptions options;
  options.cancel = &cancel;
  try {
    compare_with({}, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
  }
}

TEST_F(CompareLossless, ProgressEndsAtTheVolumesBytes) {
  convert_domain({{0, 0, 0}, {20, 20, 20}}, ramp);
  CompareOptions options;
  options.block_bytes = 20 * 8 * 8 * 4;
  std::uint64_t last = 0;
  int released = 0;
  options.progress = [&](std::uint64_t done) {
    EXPECT_GT(done, last);
    last = done;
  };
  options.release_pages = [&] { ++released; };
  compare_with({}, options);
  EXPECT_EQ(last, 20U * 20 * 20 * 4);
  EXPECT_GE(released, 9);
}

// Compares lossy files of every synthetic kind, for several block sizes and thread counts. The results must agree with
// voxel-by-voxel look-ups and a long double sum, and with the certificate of the conversion itself.
TEST(Compare, AgreesWithTheDefinitionAndTheCertificate) {
  for (const SyntheticKind& kind : synthetic_kinds()) {
    const auto source = open_synthetic(kind.name, {{150, 37, 29}, 3});
    MemoryVolume volume(*source);
    ConversionOptions options;
    options.non_finite = NonFinitePolicy::background;
    const Converted converted = convert_to(volume, options, minimum_size(volume, options) + 100000);
    const NvdbGrid grid = converted.grid();
    const Comparison c = compare_volumes(volume, grid, "out.nvdb", {});

    long double squared_error = 0;
    double max_abs = 0;
    std::uint64_t finite = 0;
    std::uint64_t different = 0;
    const Box domain = volume.info().domain();
    for (std::int64_t n = 0; n < domain.voxels(); ++n) {
      const Index3 i = index_at(n, domain.extent());
      const float original = volume.at(i);
      const float decoded = grid.value(i);
      if (!std::isfinite(original)) continue;
      different += bits_of(original) != bits_of(decoded);
      ++finite;
      const double difference = static_cast<double>(original) - static_cast<double>(decoded);
      squared_error += static_cast<long double>(difference) * static_cast<long double>(difference);
      max_abs = std::max(max_abs, std::abs(difference));
    }
    const double mse = finite == 0 ? 0.0 : static_cast<double>(squared_error / static_cast<long double>(finite));
    EXPECT_NEAR(c.error.mse, mse, 1e-14 * mse) << kind.name;
    EXPECT_EQ(c.error.max_abs, max_abs) << kind.name;
    EXPECT_EQ(c.finite, finite) << kind.name;
    EXPECT_EQ(c.different, different) << kind.name;
    EXPECT_EQ(c.error.lossless, different == 0) << kind.name;

    const auto& certificate = converted.sidecar.error;
    EXPECT_NEAR(certificate.mse, c.error.mse, 1e-6 * c.error.mse) << kind.name;
    EXPECT_EQ(certificate.max_abs, c.error.max_abs) << kind.name;
    EXPECT_EQ(certificate.lossless, c.error.lossless) << kind.name;

    for (const std::uint64_t block_bytes : {2048U, 40000U, 300000U}) {
      const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1 + block_bytes % 3);
      CompareOptions small;
      small.block_bytes = block_bytes;
      const Comparison again = compare_volumes(volume, grid, "out.nvdb", small);
      EXPECT_EQ(again.error.mse, c.error.mse) << kind.name << ' ' << block_bytes;
      EXPECT_EQ(again.max_abs_at, c.max_abs_at) << kind.name << ' ' << block_bytes;
      EXPECT_EQ(again.different, c.different) << kind.name << ' ' << block_bytes;
    }
  }
}

}  // namespace
}  // namespace weir::compare_test
