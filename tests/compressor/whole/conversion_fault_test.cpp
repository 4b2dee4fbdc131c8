// A whole conversion in which each call to the file system fails in turn. The error is reported, and the directory is
// as it was before.
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/temporary_directory.h"

namespace weir::conversion_fault_test {
namespace {

class ConversionFaultTest : public ::testing::Test {
 protected:
  std::set<std::string> listing() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory_.path()))
      names.insert(entry.path().filename());
    return names;
  }

  // With one thread the calls come in one order.
  void convert(FileSystem& files, Resume resume = Resume::automatic) const {
    const auto source = open_synthetic("cloud", {{40, 33, 21}, 1});
    ConversionOptions options;
    options.output = directory_ / "out.nvdb";
    options.threads = 1;
    options.work_dir = work_dir_;
    options.resume = resume;
    convert_volume(*source, options, {}, files);
  }

  TemporaryDirectory directory_;
  std::string work_dir_;
  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
};

TEST_F(ConversionFaultTest, EveryCallFailsInTurnAndNothingIsLeft) {
  FaultyFileSystem none(*real_, -1, 0);
  convert(none);
  const std::vector<std::string> calls = none.calls();
  ASSERT_GT(calls.size(), 20U);
  const std::set<std::string> result{"out.nvdb", "out.nvdb.json"};
  EXPECT_EQ(listing(), result);
  for (const int reason : {ENOSPC, EIO}) {
    for (int call = 0; call < static_cast<int>(calls.size()); ++call) {
      for (const std::string& name : result) std::filesystem::remove(directory_ / name);
      FaultyFileSystem files(*real_, call, reason);
      std::string message;
      try {
        convert(files);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::io);
        message = error.what();
      }
      const std::string& name = calls[static_cast<std::size_t>(call)];
      SCOPED_TRACE("call " + std::to_string(call) + " " + name + ": " + message);
      EXPECT_TRUE(files.failed());
      if (name == "remove_directory") {
        // The empty hidden work directory stays, but the conversion itself is done.
        EXPECT_EQ(message, "");
        EXPECT_EQ(listing(), (std::set<std::string>{".out.nvdb.work", "out.nvdb", "out.nvdb.json"}));
        std::filesystem::remove(directory_ / ".out.nvdb.work");
      } else {
        EXPECT_NE(message.find("call " + std::to_string(call) + " "), std::string::npos);
        EXPECT_EQ(listing(), name == "sync_directory" ? result : std::set<std::string>{});
      }
    }
  }
}

TEST_F(ConversionFaultTest, NamesThatCannotBeFlushed_AreThereAndLeaveNothingToContinue) {
  for (const Resume resume : {Resume::off, Resume::on}) {
    FaultyFileSystem none(*real_, -1, 0);
    convert(none, resume);
    const std::set<std::string> result = listing();
    EXPECT_EQ(result, (std::set<std::string>{"out.nvdb", "out.nvdb.json"}));
    for (const std::string& name : result) std::filesystem::remove(directory_ / name);
    const std::vector<std::string> calls = none.calls();
    const auto last = std::find(calls.rbegin(), calls.rend(), "sync_directory");
    ASSERT_NE(last, calls.rend());
    FaultyFileSystem files(*real_, static_cast<int>(calls.rend() - last) - 1, EIO);
    std::string message;
    try {
      convert(files, resume);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
      message = error.what();
    }
    EXPECT_TRUE(message.starts_with((directory_ / "out.nvdb") +
                                    ": is there and whole, but may be gone after a power failure: "))
        << message;
    EXPECT_TRUE(message.ends_with("check the disk or the file server")) << message;
    EXPECT_EQ(listing(), result);
    for (const std::string& name : result) std::filesystem::remove(directory_ / name);
  }
}

TEST_F(ConversionFaultTest, CancelledBeforeItBeginsLeavesNothing) {
  const auto source = open_synthetic("cloud", {{40, 33, 21}, 1});
  const std::atomic<bool> cancel{true};
  ConversionControl control;
  control.cancel = &cancel;
  ConversionOptions options;
  options.output = directory_ / "out.nvdb";
  try {
    convert_volume(*source, options, control, *real_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
  }
  EXPECT_EQ(listing(), std::set<std::string>{});
}

TEST_F(ConversionFaultTest, RefusesAWorkDirectoryInMemory) {
  if (!std::filesystem::exists("/dev/shm") || !real_->is_memory("/dev/shm"))
    GTEST_SKIP() << "no memory file system here";
  work_dir_ = "/dev/shm";
  try {
    convert(*real_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(), "--work-dir /dev/shm: is a memory file system; choose a directory on a disk");
  }
  EXPECT_EQ(listing(), std::set<std::string>{});
}

}  // namespace
}  // namespace weir::conversion_fault_test
