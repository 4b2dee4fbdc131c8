// Compares the composited grid of generated plotfiles with the covering grid of yt, value by value.
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/plotfile_writer.h"
#include "tests/support/python.h"

namespace weir::yt_oracle_test {
namespace {

using test::PlotfilePlan;

/// Returns the plan of a plotfile that yt can read: the same ratio along all axes and for all levels, a domain that
/// begins at 0, and boxes aligned to coarse cells. All values are exact in float32.
PlotfilePlan plan_for_yt(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&](std::int64_t lo, std::int64_t hi) {
    return lo + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(hi - lo + 1));
  };
  PlotfilePlan plan;
  plan.components = {"density", "Temp"};
  plan.domain = {{0, 0, 0}, {between(5, 14), between(5, 14), between(5, 14)}};
  plan.boxes = {test::random_boxes(plan.domain, between(4, 9), 100, seed)};
  const std::int64_t r = seed % 3 == 0 ? 4 : 2;
  const std::size_t levels = r == 4 ? 2 : 1 + seed % 4;
  Box within = plan.domain;  // each level lies inside the previous one
  for (std::size_t l = 1; l < levels; ++l) {
    const Box coarse{within.lo + Index3{1, 1, 1}, within.hi - Index3{1, 1, 1}};
    if (coarse.empty()) break;
    std::vector<Box> boxes = test::random_boxes(coarse, 6, 100, seed + 100 * l);
    if (l + 1 == levels) boxes.resize(1 + boxes.size() / 2);
    for (Box& box : boxes) box = {box.lo * r, box.hi * r};
    within = {coarse.lo * r, coarse.hi * r};
    plan.ratios.push_back({r, r, r});
    plan.boxes.push_back(std::move(boxes));
  }
  plan.corner = {-1.5, 0, 8};
  plan.spacing = {0.5, 0.25, 2};
  plan.single = seed % 2 == 0;
  plan.fabs_per_file = static_cast<std::size_t>(between(1, 5));
  return plan;
}

// Writes PATH.f32 for each plotfile PATH: its Temp on the finest level as float32, x fastest.
constexpr const char* kScript = R"(
import glob, sys
import numpy, yt
yt.set_log_level("error")
for path in sorted(glob.glob(sys.argv[1] + "/plt?????")):
    ds = yt.load(path)
    level = ds.index.max_level
    dims = ds.domain_dimensions * ds.refine_by ** level
    grid = ds.covering_grid(level, left_edge=ds.domain_left_edge, dims=dims)
    numpy.asarray(grid[("boxlib", "Temp")].d.T, dtype="f4", order="C").tofile(path + ".f32")
)";

TEST(YtOracle, CoveringGridsAreOurComposites) {
  if (std::getenv("WEIR_YT") == nullptr) GTEST_SKIP() << "tools/test.sh --full runs it";
  if (!python_has("yt")) GTEST_SKIP() << "python3-yt is not installed";
  const Scratch scratch;
  const std::string directory = std::filesystem::path(scratch.path("x")).parent_path();
  constexpr std::uint64_t kCases = 24;
  const auto path_of = [&](std::uint64_t seed) { return scratch.path("plt" + std::to_string(10'000 + seed)); };
  for (std::uint64_t seed = 1; seed <= kCases; ++seed) test::write_plotfile(path_of(seed), plan_for_yt(seed));
  ASSERT_TRUE(run_python(kScript, directory));
  std::size_t refined = 0;
  for (std::uint64_t seed = 1; seed <= kCases; ++seed) {
    SCOPED_TRACE(seed);
    SourceOptions options;
    options.dataset = "Temp";
    const auto source = open_source(path_of(seed), options);
    const Box domain = source->info().domain();
    std::vector<float> values(static_cast<std::size_t>(domain.voxels()));
    source->read(domain, values);
    std::ifstream file(path_of(seed) + ".f32", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    ASSERT_EQ(bytes.size(), values.size() * sizeof(float));
    std::vector<float> expected(values.size());
    std::memcpy(expected.data(), bytes.data(), bytes.size());
    ASSERT_EQ(values, expected);
    refined += plan_for_yt(seed).levels() > 1 ? 1 : 0;
  }
  EXPECT_GE(refined, 12U);
}

}  // namespace
}  // namespace weir::yt_oracle_test
