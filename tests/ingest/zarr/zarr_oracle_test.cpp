// Zarr arrays that other libraries write: weir reads the values that these libraries have.
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "ingest/source_registry.h"
#include "ingest/zarr/codecs/library_codecs.h"
#include "tests/ingest/support/scratch.h"
#include "tests/support/python.h"

namespace weir::zarr_oracle_test {
namespace {

struct OracleCase {
  std::string name;
  std::string path;
  SourceOptions options;
  Index3 extent;
};

std::vector<OracleCase> read_cases(const std::string& directory) {
  std::vector<OracleCase> cases;
  std::ifstream lines(directory + "/cases.txt");
  OracleCase next;
  std::string index;
  while (lines >> next.name >> next.path >> next.options.dataset >> index >> next.extent.x >> next.extent.y >>
         next.extent.z) {
    if (next.options.dataset == "-") next.options.dataset.clear();
    next.options.index.clear();
    std::istringstream positions(index);
    for (std::string position; index != "-" && std::getline(positions, position, ',');) {
      next.options.index.push_back(std::stoll(position));
    }
    cases.push_back(next);
  }
  return cases;
}

std::vector<float> read_floats(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::vector<float> part_of_volume(const std::vector<float>& all, const Index3& extent, const Box& box) {
  std::vector<float> part;
  for (std::int64_t i = 0; i < box.voxels(); ++i) {
    part.push_back(all[static_cast<std::size_t>(linear_index(box.lo + index_at(i, box.extent()), extent))]);
  }
  return part;
}

/// Expects equal bits, except that every NaN equals every other NaN.
void expect_same_values(const std::vector<float>& values, const std::vector<float>& expected, const std::string& what) {
  ASSERT_EQ(values.size(), expected.size()) << what;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]) && std::isnan(expected[i])) continue;
    ASSERT_EQ(std::bit_cast<std::uint32_t>(values[i]), std::bit_cast<std::uint32_t>(expected[i]))
        << what << ", voxel " << i << ": " << values[i] << " instead of " << expected[i];
  }
}

std::vector<Box> odd_boxes(const Index3& e) {
  const Index3 one{1, 1, 1};
  return {{{0, 0, 0}, e},
          {{0, 0, 0}, one},
          {e - one, e},
          {{e.x / 3, e.y / 2, e.z / 4}, {e.x / 3 + 1, e.y, e.z / 4 + 2}},
          {{1, 0, e.z / 2}, {e.x, e.y - 1, e.z / 2 + 1}},
          {{0, e.y / 3, 0}, {e.x, e.y / 3 + 2, e.z}}};
}

/// Compares each array of `directory` with the values in the file of the case's name and `suffix`. Leaves out arrays
/// without such a file. Returns the number of compared arrays.
std::size_t compare_all(const TemporaryDirectory& directory, const std::string& suffix) {
  std::size_t compared = 0;
  for (const OracleCase& c : read_cases(directory.path().string())) {
    const std::string file = directory / (c.name + suffix);
    if (!std::filesystem::exists(file)) continue;
    ++compared;
    const std::vector<float> expected = read_floats(file);
    const auto source = open_source(directory / c.path, c.options);
    EXPECT_EQ(source->info().format, "zarr") << c.name;
    EXPECT_EQ(source->info().extent, c.extent) << c.name;
    for (const Box& box : odd_boxes(c.extent)) {
      std::vector<float> values(static_cast<std::size_t>(box.voxels()));
      source->read(box, values);
      expect_same_values(values, part_of_volume(expected, c.extent, box), c.name);
    }
  }
  return compared;
}

std::string support(const char* name) { return std::string(WEIR_SOURCE_DIR) + "/tests/ingest/zarr/support/" + name; }

bool write_arrays(const TemporaryDirectory& directory) {
  const std::string command = kPython + " '" + support("write_arrays.py") + "' '" + directory.path().string() + "'";
  return std::system(command.c_str()) == 0;
}

TEST(ZarrOracle, ArraysOfAllTypesOrdersAndCodecs_HaveTheValuesThatWereWritten) {
  if (!has_library_codecs()) GTEST_SKIP() << "this build was left without libblosc and libzstd (WEIR_ZARR_CODECS)";
  if (!python_has("zarr, numcodecs")) GTEST_SKIP() << "python3-zarr is not installed (tools/setup.sh)";
  const TemporaryDirectory directory;
  ASSERT_TRUE(write_arrays(directory));
  EXPECT_EQ(compare_all(directory, ".f32"), 94U);
}

// Not one of the fast tests. Run `npm install zarrita` in a folder and set WEIR_NODE_MODULES to its node_modules.
TEST(ZarrOracle, ArraysThatZarritaReads_HaveTheValuesThatItReads) {
  const char* const modules = std::getenv("WEIR_NODE_MODULES");
  if (modules == nullptr) GTEST_SKIP() << "WEIR_NODE_MODULES, the folder with npm's zarrita, is not set";
  if (!has_library_codecs()) GTEST_SKIP() << "this build was left without libblosc and libzstd (WEIR_ZARR_CODECS)";
  if (!python_has("zarr, numcodecs")) GTEST_SKIP() << "python3-zarr is not installed (tools/setup.sh)";
  const TemporaryDirectory directory;
  ASSERT_TRUE(write_arrays(directory));
  const std::string command = "node '" + support("read_with_zarrita.mjs") + "' '" + directory.path().string() + "' '" +
                              std::string(modules) + "' 2>'" + directory / "not_read" + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::size_t compared = compare_all(directory, ".zarrita");
  RecordProperty("arrays_compared", static_cast<int>(compared));
  // zarrita reads neither float16 nor an index at the start of a shard.
  EXPECT_GE(compared, 61U);
}

}  // namespace
}  // namespace weir::zarr_oracle_test
