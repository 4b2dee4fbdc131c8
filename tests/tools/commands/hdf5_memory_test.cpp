// Tests the memory ceiling of the whole process with gzip-chunked HDF5 files several times as large. The chunks are
// cubes, planes, and planes so large that the chunks of a layer of leaves do not fit the ceiling. Another file's values
// stay in memory.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"

namespace weir::hdf5_memory_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

/// Extents in the file's axis order, slowest first.
struct ChunkedVolume {
  std::string name;
  std::vector<hsize_t> extent;
  std::vector<hsize_t> chunk;
  std::string memory;
  std::uint64_t memory_bytes = 0;
  bool decodes_twice = false;
};

std::ostream& operator<<(std::ostream& out, const ChunkedVolume& v) { return out << v.name; }

/// Returns a stored chunk of ramps and plateaus; only one value differs between chunks and identifies the chunk.
std::vector<std::byte> stored_chunk(hsize_t elements, std::uint32_t number) {
  std::vector<float> values(elements);
  for (hsize_t i = 0; i < elements; ++i) values[i] = static_cast<float>((i >> 6U) % 1000) + static_cast<float>(number);
  uLongf size = compressBound(elements * sizeof(float));
  std::vector<std::byte> stored(size);
  EXPECT_EQ(compress2(reinterpret_cast<Bytef*>(stored.data()), &size, reinterpret_cast<const Bytef*>(values.data()),
                      elements * sizeof(float), 1),
            Z_OK);
  stored.resize(size);
  return stored;
}

hsize_t product(const std::vector<hsize_t>& extents) {
  return std::accumulate(extents.begin(), extents.end(), hsize_t{1}, std::multiplies<>());
}

/// Writes a volume without deflating every chunk: seven different chunks take turns. Returns the bytes of the chunks
/// in the file.
std::uint64_t write_volume(const std::string& path, const ChunkedVolume& volume) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const auto rank = static_cast<int>(volume.extent.size());
  const hid_t space = H5Screate_simple(rank, volume.extent.data(), nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(creation, rank, volume.chunk.data());
  H5Pset_deflate(creation, 1);
  const hid_t dataset = H5Dcreate2(file, "density", H5T_IEEE_F32LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  EXPECT_GE(dataset, 0);
  std::vector<std::vector<std::byte>> chunks;
  for (std::uint32_t i = 0; i < 7; ++i) {
    chunks.push_back(stored_chunk(product(volume.chunk), i));
  }
  std::size_t next = 0;
  std::vector<hsize_t> at(volume.extent.size());
  while (at[0] < volume.extent[0]) {
    const std::vector<std::byte>& chunk = chunks[next++ % chunks.size()];
    EXPECT_GE(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, at.data(), chunk.size(), chunk.data()), 0);
    std::size_t axis = at.size() - 1;
    while ((at[axis] += volume.chunk[axis]) >= volume.extent[axis] && axis > 0) at[axis--] = 0;
  }
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  H5Dclose(dataset);
  H5Pclose(creation);
  H5Sclose(space);
  H5Fclose(file);
  return stored;
}

class Hdf5Memory : public testing::TestWithParam<ChunkedVolume> {};

TEST_P(Hdf5Memory, StaysUnderTheCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const ChunkedVolume& volume = GetParam();
  const TemporaryDirectory directory;
  const std::string input = directory / "run.h5";
  const std::uint64_t stored = write_volume(input, volume);
  const std::uint64_t bytes = volume.extent[0] * volume.extent[1] * volume.extent[2] * 4;
  ASSERT_GE(bytes, 4 * volume.memory_bytes);

  CommandOptions patient;
  patient.timeout = std::chrono::minutes(10);
  const std::string output = directory / "out.nvdb";
  const CommandResult convert =
      run_weir({"convert", input, "-o", output, "--memory", volume.memory, "--json"}, patient);
  ASSERT_EQ(convert.exit_code, 0) << convert.err;
  EXPECT_LT(convert.peak_rss_bytes, volume.memory_bytes);
  EXPECT_EQ(std::filesystem::file_size(output), bytes / 8);
  EXPECT_EQ(convert.err.find("times in a pass") != std::string::npos, volume.decodes_twice) << convert.err;
  // Each of the two passes reads the stored bytes of each chunk once, unless a pass decodes chunks several times.
  const auto bytes_read = nlohmann::json::parse(convert.out)["timing"]["bytes_read"].get<std::uint64_t>();
  if (volume.decodes_twice) {
    EXPECT_GT(bytes_read, 2 * stored);
  } else {
    EXPECT_EQ(bytes_read, 2 * stored);
  }
  RecordProperty("peak_rss_mib", static_cast<int>(convert.peak_rss_bytes / kMiB));

  const CommandResult compare = run_weir({"compare", input, output, "--memory", volume.memory, "--json"}, patient);
  ASSERT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_LT(compare.peak_rss_bytes, volume.memory_bytes);
  const nlohmann::json certified = nlohmann::json::parse(read_file(directory / "out.nvdb.json"))["error"];
  EXPECT_EQ(nlohmann::json::parse(compare.out)["max_abs"].get<double>(), certified["max_abs"].get<double>());
}

INSTANTIATE_TEST_SUITE_P(
    Chunks, Hdf5Memory,
    testing::Values(ChunkedVolume{"Cubes", {576, 520, 520}, {64, 64, 64}, "128MiB", 128 * kMiB},
                    ChunkedVolume{"Planes", {576, 520, 520}, {1, 520, 520}, "128MiB", 128 * kMiB},
                    ChunkedVolume{"LargePlanes", {80, 1500, 1500}, {1, 1500, 1500}, "160MiB", 160 * kMiB, true}),
    [](const auto& parameter) { return parameter.param.name; });

TEST(Hdf5KeptValues, AreDecodedOnceUnderTheCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  const std::string input = directory / "run.h5";
  const std::uint64_t stored = write_volume(input, {"", {256, 384, 384}, {64, 64, 64}, "", 0});
  const auto convert = [&](const char* name, const char* memory) {
    const CommandResult result =
        run_weir({"convert", input, "--rate", "2", "-o", directory / name, "--memory", memory, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  };
  const CommandResult once = convert("a.nvdb", "400MiB");
  const nlohmann::json kept = nlohmann::json::parse(once.out);
  EXPECT_EQ(kept["timing"]["bytes_read"].get<std::uint64_t>(), stored);
  EXPECT_LT(once.peak_rss_bytes, 400 * kMiB);
  EXPECT_GT(once.peak_rss_bytes, 144 * kMiB);  // the kept values alone
  const nlohmann::json not_kept = nlohmann::json::parse(convert("b.nvdb", "100MiB").out);
  EXPECT_EQ(not_kept["timing"]["bytes_read"].get<std::uint64_t>(), 2 * stored);
  EXPECT_EQ(kept["file"]["digest"], not_kept["file"]["digest"]);
}

// The components of each voxel lie in three chunks. The library would gather them one by one, with a list of each.
TEST(Hdf5ComponentsMemory, StayUnderTheCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  const std::string input = directory / "run.h5";
  const std::uint64_t stored = write_volume(input, {"", {256, 256, 320, 3}, {64, 64, 64, 1}, "", 0});
  for (const auto& [component, part] : {std::pair("y", 3U), std::pair("magnitude", 1U)}) {
    const CommandResult convert = run_weir({"convert", input, "--component", component, "-o",
                                            directory / cat(component, ".nvdb"), "--memory", "64MiB", "--json"});
    ASSERT_EQ(convert.exit_code, 0) << convert.err;
    EXPECT_LT(convert.peak_rss_bytes, 64 * kMiB) << component;
    const auto bytes_read = nlohmann::json::parse(convert.out)["timing"]["bytes_read"].get<std::uint64_t>();
    // Seven chunks of nearly equal lengths take turns.
    EXPECT_NEAR(static_cast<double>(bytes_read), 2.0 * static_cast<double>(stored) / part,
                0.01 * static_cast<double>(stored))
        << component;
  }
}

// Tests a filter that the library undoes: the library keeps some kilobytes for each chunk of a read, and these chunks
// have 64 bytes.
TEST(Hdf5SmallChunksMemory, StaysUnderTheCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  const std::string input = directory / "small.h5";
  constexpr std::array<hsize_t, 3> kExtent{64, 256, 256};
  constexpr std::array<hsize_t, 3> kChunk{4, 4, 4};
  {
    const hid_t file = H5Fcreate(input.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(3, kExtent.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, 3, kChunk.data());
    H5Pset_scaleoffset(creation, H5Z_SO_INT, 0);
    const hid_t dataset = H5Dcreate2(file, "density", H5T_STD_U8LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    // Written in parts, because the library's memory for one write counts as memory of the processes that this process
    // starts.
    constexpr std::array<hsize_t, 3> kPart{4, 64, 256};
    const hid_t in_memory = H5Screate_simple(3, kPart.data(), nullptr);
    std::vector<std::uint8_t> values(kPart[0] * kPart[1] * kPart[2]);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i * i >> 7U);
    for (hsize_t z = 0; z < kExtent[0]; z += kPart[0]) {
      for (hsize_t y = 0; y < kExtent[1]; y += kPart[1]) {
        const std::array<hsize_t, 3> at{z, y, 0};
        H5Sselect_hyperslab(space, H5S_SELECT_SET, at.data(), nullptr, kPart.data(), nullptr);
        EXPECT_GE(H5Dwrite(dataset, H5T_NATIVE_UINT8, in_memory, space, H5P_DEFAULT, values.data()), 0);
      }
    }
    H5Sclose(in_memory);
    H5Dclose(dataset);
    H5Pclose(creation);
    H5Sclose(space);
    H5Fclose(file);
  }
  const CommandResult convert =
      run_weir({"convert", input, "--lossless", "-o", directory / "out.nvdb", "--memory", "128MiB", "--json"});
  ASSERT_EQ(convert.exit_code, 0) << convert.err;
  EXPECT_LT(convert.peak_rss_bytes, 128 * kMiB);
  const CommandResult compare = run_weir({"compare", input, directory / "out.nvdb", "--memory", "128MiB", "--json"});
  ASSERT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_LT(compare.peak_rss_bytes, 128 * kMiB);
  EXPECT_EQ(nlohmann::json::parse(compare.out)["max_abs"].get<double>(), 0);
}

}  // namespace
}  // namespace weir::hdf5_memory_test
