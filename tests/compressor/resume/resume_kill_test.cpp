// Conversions that die at any call to the file system (killed, with the machine, or because of a full disk) and are run
// again. The bytes are those of an undisturbed conversion.
#include <gtest/gtest.h>

#include "compressor/packed/block_sample.h"
#include "compressor/resume.h"
#include "tests/compressor/support/resumed.h"

namespace weir::test {
namespace {

using ResumeKill = ResumeTest;
using ResumeKillOfHoles = ResumeOfHoles;

TEST_F(ResumeKill, Float) {
  ConversionOptions options = base();
  expect_same_bytes(options, 60);
}

TEST_F(ResumeKill, Quantised) {
  ConversionOptions options = base();
  options.encoding = Encoding::fpn;
  options.budget.kind = Budget::Kind::rate;
  options.budget.rate = 5;
  expect_same_bytes(options, 24);
}

TEST_F(ResumeKill, WhicheverEncodingIsBetter) {
  ConversionOptions options = base();
  options.encoding = Encoding::automatic;
  expect_same_bytes(options, 24);
}

TEST_F(ResumeKill, Packed) {
  ConversionOptions options = base();
  options.encoding = Encoding::packed;
  options.memory = 12U << 20U;  // room for the steps of the blocks
  options.budget.kind = Budget::Kind::rate;
  options.budget.rate = 20;
  expect_same_bytes(options, 24);
  options.budget.kind = Budget::Kind::psnr;
  options.budget.target = 50;
  expect_same_bytes(options, 24);
}

// Whole numbers; a voxel or two of each block are missing.
class ResumeKillOfMissing : public ResumeTest {
 protected:
  ResumeKillOfMissing()
      : ResumeTest([](const Index3& i) {
          return (i.x * 7 + i.y * 13 + i.z * 29) % 317 == 0 ? NAN : std::round(200 * ripples(i));
        }) {}
};

// Ladders of such blocks are built anew when the background is known. Whether that happened before the kill must not
// change what the ladders decide.
TEST_F(ResumeKillOfMissing, PackedNearlyLossless) {
  ConversionOptions options = base();
  options.encoding = Encoding::packed;
  options.memory = 12U << 20U;
  options.non_finite = NonFinitePolicy::background;
  options.budget.kind = Budget::Kind::rate;
  options.budget.rate = 4;
  expect_same_bytes(options, kSanitized ? 6 : 16);
}

// A volume that is large enough for a look ahead. The look ahead misleads: all blocks that it does not see are rough.
class ResumeKillOfLarge : public ResumeTest {
 protected:
  static constexpr Box kLarge{{0, 0, 0}, {208, 208, 200}};
  ResumeKillOfLarge()
      : ResumeTest(
            [](const Index3& i) {
              static const BlockSample sample(make_lattice(kLarge, kLeafDim));
              const bool sampled = sample.has(floor_div(i, kLeafDim));
              return ripples(i) / 100 + (sampled ? 0 : static_cast<float>((i.x * 37 + i.y * 59 + i.z * 83) % 101));
            },
            kLarge) {}
};

TEST_F(ResumeKillOfLarge, PackedWithAnotherWindow) {
  ConversionOptions options = base();
  options.encoding = Encoding::packed;
  options.memory = 12U << 20U;
  options.budget.kind = Budget::Kind::rate;
  options.budget.rate = 30;
  expect_same_bytes(options, 12);
}

TEST_F(ResumeKill, ErrorTargetOfSeveralAttempts) {
  ConversionOptions options = base();
  options.encoding = Encoding::fpn;
  options.budget.kind = Budget::Kind::psnr;
  options.budget.target = 38;
  EXPECT_GE(undisturbed(options).encode_passes, 2);
  expect_same_bytes(options, 40);
  options.budget.kind = Budget::Kind::max_error;
  options.budget.target = 0.5;
  EXPECT_EQ(undisturbed(options).encode_passes, 1);
  expect_same_bytes(options, 24);
}

// The process lives on and says what is kept. Everything else is removed.
TEST_F(ResumeKill, FullDisk_ResumesToTheSameBytes) {
  ConversionOptions options = base();
  options.encoding = Encoding::fpn;
  const Result expected = undisturbed(options);
  const int calls = calls_of(options);
  const std::string kept = "; what is done is kept in ./.out.nvdb.work, the same command continues it";
  constexpr int kPoints = 40;
  int continued = 0;
  for (int i = 0; i < kPoints; ++i) {
    const int at = calls * i / kPoints;
    SCOPED_TRACE("call " + std::to_string(at) + " of " + std::to_string(calls));
    CrashFileSystem memory;
    FaultyFileSystem files(memory, at, ENOSPC);
    std::string message;
    try {
      run(options, files);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
      ASSERT_TRUE(error.system_failure()) << "also where the work is kept";
      EXPECT_EQ(error.system_failure()->errno_value, ENOSPC);
      message = error.what();
    }
    if (message.empty()) {  // only the removal of files that are not needed any more failed
      EXPECT_TRUE(memory.content("out.nvdb") == expected.file);
      continue;
    }
    const Names names = memory.names();
    const bool resumable = message.ends_with(kept);
    EXPECT_EQ(!names.empty(), resumable) << message;
    for (const std::string& name : names) EXPECT_TRUE(name.starts_with(kHidden)) << name;
    continued += resumable ? 1 : 0;
    run(options, memory);
    EXPECT_EQ(memory.names(), kResult);
    EXPECT_TRUE(memory.content("out.nvdb") == expected.file);
  }
  if (!kSanitized) {
    EXPECT_GT(continued, kPoints / 5);
  }
}

// The conversion dies when the outputs have their names but the files they were made from are not removed yet.
TEST_F(ResumeKill, DeathAfterTheRename_LeftoversAreCleared) {
  for (const bool overwrite : {false, true}) {
    // Returns whether the conversion died at call number `at` after the volume got its name.
    const auto dies = [&](CrashFileSystem& memory, int at) {
      ConversionOptions options = base();
      if (overwrite) run(options, memory);
      options.overwrite = overwrite;
      FaultyFileSystem files(memory, -1, EIO, FaultyFileSystem::After::fails);
      files.fail_after_rename_to("out.nvdb", at);
      try {
        run(options, files);
      } catch (const Error&) {
        EXPECT_TRUE(files.failed());
      }
      return files.failed();
    };
    int left = 0;
    for (int at = 0;; ++at) {
      SCOPED_TRACE(at);
      CrashFileSystem memory;
      if (!dies(memory, at)) break;
      left += memory.names() == kResult ? 0 : 1;
      discard_all_beside(memory, "out.nvdb");
      EXPECT_EQ(memory.names(), kResult);
      EXPECT_EQ(memory.directories(), Names{});
      EXPECT_FALSE(discard_all_beside(memory, "out.nvdb")) << "nothing is there";

      CrashFileSystem other;
      dies(other, at);
      other.make_directory("/scratch");
      ConversionOptions again = base();
      again.overwrite = true;
      again.work_dir = "/scratch";
      again.resume = Resume::off;
      run(again, other);
      EXPECT_EQ(other.names(), kResult);
      EXPECT_EQ(other.directories(), Names{"/scratch"});
    }
    EXPECT_GE(left, 4) << "lock, directory, journal, rows";
  }
}

TEST_F(ResumeKill, Scene) {
  ConversionOptions options = base();
  options.encoding = Encoding::automatic;
  Scene scene;
  scene.volume.range = {-100, 110};
  scene.volume.opacity = {{0, 0}, {0.6, 0}, {0.8, 0.3}, {1, 1}};
  options.scene = SceneFile{scene, "s.toml"};
  expect_same_bytes(options, 24);
}

TEST_F(ResumeKillOfHoles, PaperMethod_ResumesToTheSameBytes) {
  ConversionOptions options = base();
  options.paper_background = true;
  options.metric = Metric::farthest;
  options.fill = FillMode::background;
  options.non_finite = NonFinitePolicy::background;
  expect_same_bytes(options, 24);
}

// The result exists. The same command says so, and removes the files that it was made from.
TEST_F(ResumeKill, AfterTheCommit_TheSameCommandRemovesWhatIsLeft) {
  const ConversionOptions options = base();
  for (const int call : {0, 1, 2}) {
    CrashFileSystem memory;
    FaultyFileSystem files(memory, -1, EIO, FaultyFileSystem::After::fails);
    files.fail_after_rename_to("out.nvdb", call);
    try {
      run(options, files);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
    }
    ASSERT_TRUE(files.failed()) << call;
    EXPECT_TRUE(memory.exists("out.nvdb.partial")) << "the lock goes last";
    try {
      run(options, memory);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()), "out.nvdb: exists; choose another output or pass --overwrite");
    }
    EXPECT_EQ(memory.names(), kResult) << call;
    EXPECT_EQ(memory.directories(), Names{}) << call;
  }
}

// Leftovers are removed under a lock. Until the lock itself is removed, it says that the output is done.
TEST_F(ResumeKill, AfterTheCommit_ASecondKillWhileLeftoversAreRemoved_LeavesThemToTheNext) {
  const ConversionOptions options = base();
  const auto run_refused = [&](FileSystem& files) {
    try {
      run(options, files);
      ADD_FAILURE();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  int killed_again = 0;
  for (int call = 0;; ++call) {
    SCOPED_TRACE(call);
    CrashFileSystem memory;
    FaultyFileSystem first(memory, -1, EIO, FaultyFileSystem::After::fails);
    first.fail_after_rename_to("out.nvdb", 0);
    try {
      run(options, first);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
    }
    ASSERT_TRUE(first.failed());
    FaultyFileSystem second(memory, call, EIO, FaultyFileSystem::After::fails);
    run_refused(second);
    if (!second.failed()) break;
    ++killed_again;
    EXPECT_EQ(run_refused(memory), "out.nvdb: exists; choose another output or pass --overwrite");
    EXPECT_EQ(memory.names(), kResult);
    EXPECT_EQ(memory.directories(), Names{});
  }
  EXPECT_GE(killed_again, 4) << "journal, rows, directory, lock";
}

// A user interrupted a conversion with --overwrite and will continue it. A refused command in between keeps its work.
TEST_F(ResumeKill, BeforeTheCommit_ARefusedCommandKeepsWhatIsDone) {
  ConversionOptions options = base();
  CrashFileSystem memory;
  run(options, memory);
  options.overwrite = true;
  ASSERT_TRUE(killed(options, memory, calls_of(options) / 2));
  const Names before = memory.names();
  options.overwrite = false;
  EXPECT_THROW(run(options, memory), Error);
  EXPECT_EQ(memory.names(), before);
}

}  // namespace
}  // namespace weir::test
