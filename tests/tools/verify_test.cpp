// weir verify and inspect as a user runs them: an intact volume, and every kind of
// damage to it or to its sidecar, by the line that it is reported with.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "format/nanovdb_layout.h"
#include "format/nvdb_file.h"
#include "tests/tools/run_command.h"
#include "tools/read_sidecar.h"
#include "tools/volume_check.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

// 40 x 30 x 20 voxels, half of them zero, converted to a size that has leaves, tiles and padding.
class Verify : public testing::Test {
 protected:
  Verify() {
    std::vector<float> values;
    for (int i = 0; i < 40 * 30 * 20; ++i) values.push_back(i % 40 < 20 ? 0.0F : static_cast<float>(i % 997) * 0.25F);
    std::string bytes(values.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    write_file(directory_.path() / "v_40x30x20_float32.raw", bytes);
    const auto made = run_weir({"convert", directory_ / "v_40x30x20_float32.raw", "-o", volume_, "--size", "450001"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }

  CommandResult verify() const { return run_weir({"verify", volume_, "--progress", "never"}); }
  NvdbFile open() const { return NvdbFile(volume_); }
  Sidecar sidecar() const { return read_sidecar(sidecar_path(volume_)); }

  // Exchanges the bytes at `offset`; expects exit code 3 and exactly these lines on stderr.
  void damage(std::uint64_t offset, const std::string& bytes) const {
    std::string file = read_file(volume_);
    file.replace(offset, bytes.size(), bytes);
    write_file(volume_, file);
  }
  void expect_failures(const std::vector<std::string>& lines) const {
    const CommandResult result = verify();
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.out, "");
    std::string expected;
    for (const std::string& line : lines) expected += "weir: " + line + "\n";
    EXPECT_EQ(result.err, expected);
  }

  TemporaryDirectory directory_;
  std::string volume_ = directory_ / "v.nvdb";
};

template <typename T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

std::string failed_names(const std::vector<VolumeCheck>& checks) {
  std::string names;
  for (const VolumeCheck& check : checks) {
    if (!check.ok) names += check.name + '\n';
  }
  return names;
}

TEST_F(Verify, IntactVolumeHoldsAllChecks) {
  const CommandResult result = verify();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, volume_ + ": all 25 checks hold\n");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(fs::file_size(volume_), 450001U);
}

TEST_F(Verify, JsonListsEveryCheck) {
  const CommandResult result = run_weir({"verify", volume_, "--json", "--progress", "never"});
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["ok"], true);
  EXPECT_EQ(report["checks"].size(), 25U);
  write_file(sidecar_path(volume_), "{}");
  const CommandResult broken = run_weir({"verify", volume_, "--json", "--progress", "never"});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_EQ(nlohmann::json::parse(broken.out)["ok"], false);
}

TEST_F(Verify, ByteOfThePaddingBreaksTheDigestAlone) {
  const std::string digest = sidecar().file.digest;
  std::uint64_t padding = 0;
  {
    const NvdbFile file = open();
    padding = file.grid().grid_offset() + file.grid().data_bytes();
    ASSERT_LT(padding, file.bytes().size());
  }
  damage(padding, "\x01");
  const CommandResult result = verify();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err.substr(0, result.err.find(" found ")), "weir: " + volume_ + ": sidecar file.digest:");
  EXPECT_NE(result.err.find(", expected " + digest + "\n"), std::string::npos);
}

TEST_F(Verify, ValueBeyondItsMacrocellIsFound) {
  std::uint64_t leaf = 0;
  {
    const NvdbFile file = open();
    file.grid().for_each_block([&](const GridBlock& block) {
      if (block.leaf != nullptr && leaf == 0) leaf = static_cast<std::uint64_t>(block.leaf - file.bytes().data());
    });
  }
  damage(leaf + nvdb::leaf::kValues, bytes_of(1e6F));
  const std::string err = verify().err;
  EXPECT_NE(err.find(volume_ + ": macrocells: found the block at (0, 0, 0) exceeds its cell, expected bounds of every "
                               "decoded value\n"),
            std::string::npos)
      << err;
  EXPECT_NE(err.find(volume_ + ": stored range: found 0 .. 249, expected 0 .. 1000000\n"), std::string::npos) << err;
  EXPECT_NE(err.find(": sidecar value_range: found 0 .. 1000000, expected within "), std::string::npos) << err;
}

TEST_F(Verify, ByteOfTheHeadBreaksChecksumAndDigest) {
  damage(nvdb::kPage + nvdb::grid::kName + 200, "x");
  const CommandResult result = verify();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find(volume_ + ": head checksum: found "), std::string::npos);
  EXPECT_NE(result.err.find(volume_ + ": sidecar file.digest: found "), std::string::npos);
}

TEST_F(Verify, StoredCountsAreHeldAgainstTheTree) {
  const std::uint64_t tree = nvdb::kPage + nvdb::kTreeOffset;
  const std::uint64_t active = open().grid().active_voxels();
  damage(tree + nvdb::tree::kTileCount, bytes_of<std::uint32_t>(12345));
  damage(tree + nvdb::tree::kVoxelCount, bytes_of<std::uint64_t>(7));
  const std::string err = verify().err;
  EXPECT_NE(err.find(": active tiles: found (12345, 0, 0), expected ("), std::string::npos) << err;
  EXPECT_NE(err.find(": active voxels: found 7, expected " + std::to_string(active) + "\n"), std::string::npos) << err;
}

TEST_F(Verify, TruncatedVolumeIsAStructureFailure) {
  fs::resize_file(volume_, 450000);
  expect_failures(
      {"structure: " + volume_ +
       ": at byte 16: a grid of 445905 bytes at byte 4096 reaches beyond the file's 450000; is it complete?"});
}

TEST_F(Verify, MissingVolumeAndSidecar) {
  fs::remove(sidecar_path(volume_));
  expect_failures(
      {"sidecar: " + volume_ +
       ".json: cannot read the sidecar: No such file or directory; write it with weir convert, or look at the "
       "volume alone with weir inspect"});
  fs::remove(volume_);
  EXPECT_NE(verify().err.find("structure: " + volume_ + ": cannot open: No such file or directory\n"),
            std::string::npos);
}

TEST_F(Verify, SidecarOfAnotherVolume) {
  const auto other =
      run_weir({"convert", directory_ / "v_40x30x20_float32.raw", "-o", directory_ / "w.nvdb", "--size", "500000"});
  ASSERT_EQ(other.exit_code, 0);
  fs::rename(directory_ / "w.nvdb.json", sidecar_path(volume_));
  const std::string err = verify().err;
  EXPECT_NE(err.find(volume_ + ": sidecar file.bytes: found 450001, expected 500000\n"), std::string::npos) << err;
  EXPECT_NE(run_weir({"inspect", volume_}).out.find("belongs to another volume (size or head checksum differ)"),
            std::string::npos);
}

// Every key of the sidecar that verify compares, changed alone, fails that check alone.
TEST_F(Verify, EachKeyOfTheSidecarIsCompared) {
  const NvdbFile file = open();
  const TreeCensus census = take_census(file.grid(), {});
  const Sidecar good = sidecar();
  const auto failed = [&](const std::function<void(Sidecar&)>& change) {
    Sidecar changed = good;
    change(changed);
    return failed_names(check_sidecar(file.grid(), census, good.file.digest, changed));
  };
  EXPECT_EQ(failed([](Sidecar&) {}), "");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.file.bytes; }), "sidecar file.bytes\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.budget.file_bytes; }), "sidecar budget.file_bytes\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.file.grid_offset; }), "sidecar file.grid_offset\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.file.head_checksum; }), "sidecar file.head_checksum\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.file.digest[0] ^= 1; }), "sidecar file.digest\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.name += 'x'; }), "sidecar grid.name\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.type = "fpn"; }), "sidecar grid.type\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.grid.index_bbox.hi.z; }), "sidecar grid.index_bbox\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.grid.extent.y; }), "sidecar grid.extent\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.voxel_size[2] = 2; }), "sidecar grid.voxel_size\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.origin[0] = 2; }), "sidecar grid.origin\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.background.value += 1; }), "sidecar background.value\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.value_range[1] = 1, s.error.max_abs = 0; }), "sidecar value_range\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.selection.bits[0]; }), "sidecar selection.bits\n");
  EXPECT_EQ(failed([](Sidecar& s) { --s.selection.leaves_kept; }), "sidecar selection.leaves_kept\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.macrocells.cell = 8; }), "sidecar macrocells.cell\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.macrocells.dims.x; }), "sidecar macrocells.dims\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.macrocells.apron = 0; }), "sidecar macrocells.apron\n");
}

TEST_F(Verify, CensusCountsWhatIsThere) {
  const NvdbFile file = open();
  const TreeCensus census = take_census(file.grid(), {});
  EXPECT_EQ(census.leaves + census.active_tiles[0] + census.inactive_tiles[0], 4096U);  // one lower node
  EXPECT_EQ(census.leaves_by_bits, (std::array<std::uint64_t, 6>{0, 0, 0, 0, 0, census.leaves}));
  EXPECT_EQ(census.active_voxels, file.grid().active_voxels());
  EXPECT_GT(census.inactive_tiles[0], 4096U - 5 * 4 * 3);
  EXPECT_EQ(census.active_bbox, (Box{{0, 0, 0}, {40, 30, 20}}));
  EXPECT_EQ(census.min, 0.0F);
  EXPECT_EQ(census.max, file.grid().value_max());
  EXPECT_EQ(census.nonfinite, 0U);
  const auto counts = count_values(file.grid(), census.min, census.max, 10, {});
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}), census.active_voxels);
}

TEST_F(Verify, InspectShowsVolumeAndCertificate) {
  const CommandResult text = run_weir({"inspect", volume_, "--plot", directory_ / "h.png"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_NE(text.out.find("450001 bytes (439.5 KiB), grid at 4096, "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("grid        \"density\" float32, 40 x 30 x 20 voxels from (0, 0, 0)\n"), std::string::npos);
  EXPECT_NE(text.out.find("budget      size 450001: 450001 of 96000 bytes"), std::string::npos) << text.out;
  EXPECT_EQ(read_file(directory_ / "h.png").substr(0, 4), "\x89PNG");
  const auto report = nlohmann::json::parse(run_weir({"inspect", volume_, "--json"}).out);
  EXPECT_EQ(report["file"]["head_checksum_state"], "ok");
  EXPECT_EQ(report["tree"]["active_voxels"], open().grid().active_voxels());
  EXPECT_EQ(report["sidecar"]["file"]["bytes"], 450001);
  EXPECT_EQ(report["sidecar_matches"], true);
}

TEST_F(Verify, InspectWorksWithoutSidecar) {
  fs::remove(sidecar_path(volume_));
  const auto report = nlohmann::json::parse(run_weir({"inspect", volume_, "--json", "--progress", "never"}).out);
  EXPECT_TRUE(report["sidecar"].is_null());
  std::uint64_t voxels = 0;
  for (const auto& count : report["histogram"]["counts"]) voxels += count.get<std::uint64_t>();
  EXPECT_EQ(voxels, open().grid().active_voxels());
  const CommandResult bad = run_weir({"inspect", volume_, "--plot", directory_ / "h.jpg"});
  EXPECT_EQ(bad.exit_code, 2);
}

}  // namespace
}  // namespace weir
