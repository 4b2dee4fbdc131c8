// Tests weir verify as a user runs it: an intact volume, and the line that reports each kind of damage to the volume or
// its sidecar.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/layout/nanovdb_layout.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::verify_test {
namespace {

namespace fs = std::filesystem;

class Verify : public ConvertedVolume {
 protected:
  CommandResult verify() const { return run_weir({"verify", volume_, "--progress", "never"}); }

  // Replaces the bytes of the volume at `offset`.
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
};

template <typename T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

TEST_F(Verify, NameThatSteersATerminal_IsOneLine) {
  const std::string name = "den\nweir: ok \x1b[31m\xff" + std::string(1, '\0');
  damage(192, name);
  damage(4136, name);
  const CommandResult result = verify();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find('\xff'), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("\nweir: ok"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("weir: " + volume_ +
                            ": sidecar grid.name: found den\\nweir: ok \\x1b[31m\\xff, expected density\n"),
            std::string::npos)
      << result.err;
}

// verify maps the file that it reads, and mapped pages count as memory of the process.
TEST(VerifyMemory, OfALargeFile_IsFarBelowItsSize) {
  const TemporaryDirectory directory;
  const std::string source = directory / "v.raw";
  const std::string volume = directory / "v.nvdb";
  ASSERT_EQ(run_weir({"sample", "noise", "--dims", "448,384,256", "-o", source}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", source, "--dims", "448,384,256", "--type", "float32", "--encoding", "float",
                      "--lossless", "-o", volume})
                .exit_code,
            0);
  ASSERT_GT(fs::file_size(volume), std::uint64_t{160} << 20U);
  const CommandResult result = run_weir({"verify", volume, "--progress", "never"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(result.peak_rss_bytes, std::uint64_t{120} << 20U);
}

TEST_F(Verify, FileThatIsNotThere_IsOneLine) {
  const std::string none = directory_ / "none.nvdb";
  const CommandResult result = run_weir({"verify", none, "--progress", "never"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "weir: " + none + ": cannot open: No such file or directory\n");
}

TEST_F(Verify, RelativeNameThatIsNotThere_IsSaidWithARemedy) {
  CommandOptions options;
  options.directory = directory_.path();
  const CommandResult result = run_weir({"verify", "none.nvdb", volume_, "--json", "--progress", "never"}, options);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "weir: none.nvdb: cannot open: No such file or directory; check the name and the current directory\n");
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report.at("volumes").at(0).at("ok"), true) << "the others are looked at";
  EXPECT_EQ(report.at("volumes").at(1).at("checks").at(0).at("name"), "structure");
}

// Files of sysfs cannot be mapped. Like a disk or file server that fails, this says nothing about the file's content.
TEST_F(Verify, FileThatCannotBeRead_EndsWithExitCode5) {
  const std::string unreadable = directory_ / "unreadable.nvdb";
  fs::create_symlink("/sys/devices/system/cpu/online", unreadable);
  const CommandResult result = run_weir({"verify", unreadable, "--progress", "never"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "weir: " + unreadable + ": cannot map: No such device\n");
  const CommandResult several = run_weir({"verify", unreadable, volume_, "--json", "--progress", "never"});
  EXPECT_EQ(several.exit_code, 5);
  const auto report = nlohmann::json::parse(several.out);
  EXPECT_EQ(report.at("volumes").at(0).at("checks").at(0).at("name"), "readable");
  EXPECT_EQ(report.at("volumes").at(1).at("ok"), true) << "the others are looked at";
}

TEST_F(Verify, FileOfAnotherFormat_IsSaidWithTheCommandThatConvertsIt) {
  const std::string raw = directory_ / "v_40x30x20_float32.raw";
  const CommandResult result = run_weir({"verify", raw, "--progress", "never"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err,
            "weir: structure: " + raw + ": is no NanoVDB file; convert it first: weir convert " + raw + '\n');
}

TEST_F(Verify, SeveralFiles_AreAllCheckedAndOneThatFailsCounts) {
  for (const std::string name : {"step_0001.nvdb", "step_0010.nvdb"}) {
    fs::copy_file(volume_, directory_ / name);
    fs::copy_file(sidecar_path(volume_), sidecar_path(directory_ / name));
  }
  const CommandResult whole = run_weir({"verify", directory_ / "step_%04d.nvdb", "--progress", "never"});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(whole.out.find(directory_ / "step_0001.nvdb: all "), 0U) << whole.out;
  EXPECT_NE(whole.out.find('\n' + (directory_ / "step_0010.nvdb: all ")), std::string::npos) << whole.out;
  write_file(directory_ / "step_0001.nvdb", "no volume");
  const CommandResult damaged = run_weir({"verify", directory_ / "step_*.nvdb", "--json", "--progress", "never"});
  EXPECT_EQ(damaged.exit_code, 3);
  const auto report = nlohmann::json::parse(damaged.out);
  EXPECT_EQ(report["ok"], false);
  ASSERT_EQ(report["volumes"].size(), 2U);
  EXPECT_EQ(report["volumes"][0]["ok"], false);
  EXPECT_EQ(report["volumes"][1]["ok"], true);
}

TEST_F(Verify, IntactVolumeHoldsAllChecks) {
  const CommandResult result = verify();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, volume_ + ": all 61 checks hold\n");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(fs::file_size(volume_), 450001U);
}

TEST_F(Verify, JsonListsEveryCheck) {
  const CommandResult result = run_weir({"verify", volume_, "--json", "--progress", "never"});
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["ok"], true);
  EXPECT_EQ(report["checks"].size(), 61U);
  write_file(sidecar_path(volume_), "{}");
  const CommandResult broken = run_weir({"verify", volume_, "--json", "--progress", "never"});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_EQ(nlohmann::json::parse(broken.out)["ok"], false);
}

TEST_F(Verify, DamagedPadding_FailsOnlyTheDigest) {
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

TEST_F(Verify, DamagedHead_FailsChecksumAndDigest) {
  damage(nvdb::kPage + nvdb::grid::kName + 200, "x");
  const CommandResult result = verify();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find(volume_ + ": head checksum: found "), std::string::npos);
  EXPECT_NE(result.err.find(volume_ + ": sidecar file.digest: found "), std::string::npos);
}

TEST_F(Verify, StoredCountsAreComparedWithTheTree) {
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
  EXPECT_NE(verify().err.find("weir: " + volume_ + ": cannot open: No such file or directory\n"), std::string::npos);
}

TEST_F(Verify, SidecarOfAnotherVolume) {
  const auto other =
      run_weir({"convert", directory_ / "v_40x30x20_float32.raw", "-o", directory_ / "w.nvdb", "--size", "500000"});
  ASSERT_EQ(other.exit_code, 0);
  fs::rename(directory_ / "w.nvdb.json", sidecar_path(volume_));
  const std::string err = verify().err;
  EXPECT_NE(err.find(volume_ + ": sidecar file.bytes: found 450001, expected 500000\n"), std::string::npos) << err;
  EXPECT_NE(run_weir({"inspect", volume_}).out.find("belongs to another volume (size, head checksum or digest differ)"),
            std::string::npos);
}

}  // namespace
}  // namespace weir::verify_test
