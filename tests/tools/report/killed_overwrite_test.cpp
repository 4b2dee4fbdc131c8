// Tests an --overwrite that was killed between its renames: no command takes the new sidecar for that of the old
// volume, even though size and head checksum agree.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/killed_overwrite.h"

namespace weir::killed_overwrite_test {
namespace {

namespace fs = std::filesystem;

class KilledOverwriteTest : public testing::Test {
 protected:
  bool inspect_takes_the_sidecar(const std::string& volume) const {
    const CommandResult result = run_weir({"inspect", volume, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["sidecar_matches"].get<bool>();
  }

  TemporaryDirectory directory_;
  KilledOverwrite killed_{directory_};
};

TEST_F(KilledOverwriteTest, SkipDone_ConvertsAgainAndLeavesTheNewPair) {
  std::vector<std::string> command = killed_.command();
  command.emplace_back("--skip-done");
  const CommandResult again = run_weir(command);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(
      again.err.find(killed_.output + ": converted again: " + killed_.output + ": does not agree with its sidecar\n"),
      std::string::npos)
      << again.err;
  EXPECT_EQ(read_file(killed_.output), killed_.new_volume);
  EXPECT_EQ(list_directory(directory_.path()),
            (std::vector<std::string>{"noise_64x64x64_uint8.raw", "out.nvdb", "out.nvdb.json"}));
  EXPECT_NE(run_weir(command).err.find("done already"), std::string::npos);
}

// The process was killed a moment later, before it removed the old sidecar.
TEST_F(KilledOverwriteTest, SkipDone_OfTheNewVolume_IsDoneAndRemovesWhatIsLeft) {
  fs::rename(killed_.partial, killed_.output);
  std::vector<std::string> command = killed_.command();
  command.emplace_back("--skip-done");
  const auto before = fs::last_write_time(killed_.output);
  const CommandResult again = run_weir(command);
  EXPECT_NE(again.err.find(killed_.output + ": done already\n"), std::string::npos) << again.err;
  EXPECT_EQ(fs::last_write_time(killed_.output), before);
  EXPECT_EQ(read_file(killed_.sidecar), killed_.new_sidecar);
  EXPECT_FALSE(fs::exists(killed_.previous));
}

TEST_F(KilledOverwriteTest, Inspect_TakesNoSidecarOfAnotherVolume) {
  EXPECT_FALSE(inspect_takes_the_sidecar(killed_.output));
  const TemporaryDirectory elsewhere;
  fs::create_symlink(killed_.output, elsewhere / "link.nvdb");
  EXPECT_FALSE(inspect_takes_the_sidecar(elsewhere / "link.nvdb"));
  fs::remove(killed_.previous);
  EXPECT_FALSE(inspect_takes_the_sidecar(killed_.output)) << "beside OUT.nvdb.partial";
  fs::rename(killed_.partial, killed_.output);
  write_file(killed_.previous, killed_.old_sidecar);
  EXPECT_TRUE(inspect_takes_the_sidecar(killed_.output)) << "its own";
}

// A lock or an unfinished volume, from a running --overwrite or one killed before its commit, is no reason to read a
// whole large file.
TEST_F(KilledOverwriteTest, BesideALockOrAnUnfinishedVolume_TheHeadTells) {
  fs::remove(killed_.previous);
  std::string sidecar = killed_.old_sidecar;
  const std::string digest = parse_sidecar(sidecar, "sidecar").file.digest;
  write_file(killed_.sidecar, sidecar.replace(sidecar.find(digest), digest.size(), std::string(digest.size(), '0')));
  std::string unfinished = killed_.new_volume;
  unfinished.replace(0, 8192, 8192, '\0');
  for (const std::string& lock : {std::string(), std::string(32, '0'), unfinished}) {
    write_file(killed_.partial, lock);
    EXPECT_TRUE(inspect_takes_the_sidecar(killed_.output)) << lock.size();
  }
  // Another volume, with another head.
  std::string previous = killed_.old_sidecar;
  const std::string head = "\"head_checksum\": \"";
  const std::size_t at = previous.find(head) + head.size();
  previous[at] = previous[at] == '0' ? '1' : '0';
  write_file(killed_.previous, previous);
  EXPECT_TRUE(inspect_takes_the_sidecar(killed_.output));
}

TEST_F(KilledOverwriteTest, Verify_SaysWhichSidecarIsTheVolumesOwn) {
  const std::vector<std::string> command{"verify", killed_.output, "--progress", "never"};
  const CommandResult mixed = run_weir(command);
  EXPECT_EQ(mixed.exit_code, 3);
  EXPECT_TRUE(mixed.err.starts_with("weir: sidecar: " + killed_.previous + ": is the sidecar of " + killed_.output +
                                    ": an --overwrite was killed before it replaced the volume; rename it to " +
                                    killed_.sidecar + "\nweir: " + killed_.output + ": sidecar file.digest: found "))
      << mixed.err;
  fs::rename(killed_.previous, killed_.sidecar);
  const CommandResult mended = run_weir(command);
  EXPECT_EQ(mended.exit_code, 0) << mended.err;
}

// The other sidecar does not describe the volume either, so verify cannot know to which volume it belongs.
TEST_F(KilledOverwriteTest, Verify_OfADamagedVolume_NamesNoOtherSidecar) {
  std::string damaged = killed_.old_volume;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  write_file(killed_.output, damaged);
  const CommandResult result = run_weir({"verify", killed_.output, "--progress", "never"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err.find(killed_.previous), std::string::npos) << result.err;
}

}  // namespace
}  // namespace weir::killed_overwrite_test
