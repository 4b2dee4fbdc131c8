// Tests the digest over the states of several files.
#include "ingest/files/file_states.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_directory.h"

namespace weir::file_states_test {
namespace {

namespace fs = std::filesystem;

void write(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

class FileStatesTest : public testing::Test {
 protected:
  FileStatesTest() {
    write(a_, "one");
    write(b_, "two");
  }

  std::string digest(const std::string& named = {}) const {
    FileStates states;
    states.add(a_);
    states.add(b_, named);
    return states.digest();
  }

  TemporaryDirectory directory_;
  std::string a_ = directory_ / "a";
  std::string b_ = directory_ / "b";
};

TEST_F(FileStatesTest, SingleFileHasNoDigest) {
  FileStates states;
  EXPECT_EQ(states.digest(), "");
  states.add(a_);
  EXPECT_EQ(states.digest(), "");
  states.add(b_);
  EXPECT_EQ(states.digest().size(), 32U);
  FileStates header;
  header.add(a_, "0123");
  EXPECT_EQ(header.digest().size(), 32U) << "which names another one";
}

TEST_F(FileStatesTest, DigestDependsOnTheStateOfEachFile) {
  const std::string before = digest();
  EXPECT_EQ(digest(), before);
  EXPECT_NE(digest("0123"), before);

  const auto time = fs::last_write_time(a_);
  write(a_, "ONE");
  fs::last_write_time(a_, time);
  const std::string same_size_and_time = digest();
  EXPECT_NE(same_size_and_time, before) << "the status has changed";

  fs::last_write_time(a_, time - std::chrono::hours(1));
  const std::string older = digest();
  EXPECT_NE(older, same_size_and_time) << "older than the newest";

  write(b_, "three");
  EXPECT_NE(digest(), older);
}

TEST_F(FileStatesTest, DependsOnNameAndOrderButNotOnTheDirectory) {
  FileStates turned;
  turned.add(b_);
  turned.add(a_);
  EXPECT_NE(turned.digest(), digest());
  FileStates seen_otherwise;
  seen_otherwise.add(directory_ / "./a");
  seen_otherwise.add(b_);
  EXPECT_EQ(seen_otherwise.digest(), digest());
}

TEST_F(FileStatesTest, MissingFileChangesTheDigest) {
  const std::string before = digest();
  fs::remove(b_);
  const std::string missing = digest();
  EXPECT_NE(missing, before);
  EXPECT_EQ(missing, digest());
}

}  // namespace
}  // namespace weir::file_states_test
