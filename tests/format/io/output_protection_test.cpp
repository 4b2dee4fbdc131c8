// Files that an output must not touch, and file systems that cannot do all of its protocol.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/io/digest.h"
#include "format/output/commit_leftovers.h"
#include "format/output/output_files.h"
#include "format/output/partial_file.h"
#include "format/sidecar/sidecar.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/temporary_directory.h"

namespace weir::output_protection_test {
namespace {

namespace fs = std::filesystem;

using Listing = std::map<std::string, std::string>;

int no_locks(int, int) {
  errno = ENOLCK;
  return -1;
}

class OutputProtection : public ::testing::Test {
 protected:
  std::string output() const { return directory_ / "out.nvdb"; }
  void put(const std::string& name, const std::string& text) const { std::ofstream(directory_ / name) << text; }

  // A file that a sidecar of weir can describe: `seed` tells it from others.
  static std::string volume(char seed) {
    std::string bytes(64, '\0');
    bytes[8] = seed;
    return bytes;
  }
  static std::string sidecar_of(const std::string& volume, const std::string& source) {
    Sidecar sidecar;
    sidecar.source.path = source;
    sidecar.file.bytes = volume.size();
    std::memcpy(&sidecar.file.head_checksum, volume.data() + 8, 4);
    sidecar.file.digest = whole_digest(std::as_bytes(std::span(volume))).hex();
    return to_json_text(sidecar);
  }

  Listing listing() const {
    Listing all;
    for (const auto& entry : fs::directory_iterator(directory_.path())) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      all[entry.path().filename().string()] = std::string(std::istreambuf_iterator<char>(file), {});
    }
    return all;
  }

  std::string write_output(FileSystem& files, bool overwrite, const std::string& bytes = volume('n'),
                           ErrorKind kind = ErrorKind::usage) const {
    try {
      OutputFiles output_files(files, output(), overwrite);
      output_files.volume().write_at(0, std::as_bytes(std::span(bytes)));
      output_files.commit(sidecar_of(bytes, "new"));
      return {};
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
  }

  const Listing new_pair_{{"out.nvdb", volume('n')}, {"out.nvdb.json", sidecar_of(volume('n'), "new")}};
  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
  TemporaryDirectory directory_;
};

TEST_F(OutputProtection, TemporaryNameThatIsASymbolicLink_IsRefusedAndItsTargetStays) {
  put("precious", "mine");
  for (const char* name : {"out.nvdb.partial", "out.nvdb.json.partial"}) {
    for (const bool overwrite : {false, true}) {
      fs::create_symlink("precious", directory_ / name);
      EXPECT_EQ(write_output(*real_, overwrite),
                directory_ / name +
                    ": is a symbolic link, so it is none of weir's own files; remove it or choose another output");
      EXPECT_TRUE(fs::is_symlink(directory_ / name));
      EXPECT_EQ(listing().at("precious"), "mine");
      fs::remove(directory_ / name);
    }
  }
}

TEST_F(OutputProtection, TemporaryNameThatIsAHardLink_IsRefusedAndItsContentStays) {
  put("precious", "mine");
  fs::create_hard_link(directory_ / "precious", directory_ / "out.nvdb.partial");
  EXPECT_EQ(write_output(*real_, false), output() +
                                             ".partial: has a second name (a hard link), so it is none of weir's own "
                                             "files; remove it or choose another output");
  EXPECT_EQ(listing(), (Listing{{"out.nvdb.partial", "mine"}, {"precious", "mine"}}));
}

TEST_F(OutputProtection, TemporaryNameThatIsAPipe_IsRefusedWithoutWaiting) {
  ASSERT_EQ(::mkfifo((output() + ".partial").c_str(), 0600), 0);
  EXPECT_EQ(write_output(*real_, false),
            output() +
                ".partial: is no regular file, so it is none of weir's own files; remove it or choose another "
                "output");
}

TEST_F(OutputProtection, SingleFileWhoseTemporaryNameIsALink_IsRefused) {
  put("precious", "mine");
  fs::create_symlink("precious", output() + ".partial");
  EXPECT_THROW(PartialFile(*real_, output(), true), Error);
  EXPECT_EQ(listing(), (Listing{{"out.nvdb.partial", "mine"}, {"precious", "mine"}}));
}

TEST_F(OutputProtection, HiddenDirectoryThatIsALink_IsRefused) {
  fs::create_directory(directory_ / "elsewhere");
  fs::create_directory_symlink("elsewhere", directory_ / ".out.nvdb.work");
  EXPECT_THROW(real_->make_directory(directory_ / ".out.nvdb.work"), Error);
}

TEST_F(OutputProtection, WhatIsNoRegularFile_IsNotReplaced) {
  const auto refused = [&](const std::string& path) {
    EXPECT_EQ(write_output(*real_, true),
              path + ": is no regular file, and nothing else is replaced; choose another output");
    EXPECT_FALSE(fs::exists(output() + ".partial"));
  };
  ASSERT_EQ(::mkfifo(output().c_str(), 0600), 0);
  refused(output());
  fs::remove(output());
  fs::create_symlink("/dev/null", output());
  refused(output());
  EXPECT_TRUE(fs::is_symlink(output()));
  fs::remove(output());
  fs::create_directory(output() + ".json");
  refused(output() + ".json");
}

// As docs/options.md says.
TEST_F(OutputProtection, LinkToARegularFile_IsReplacedAndItsTargetStays) {
  put("target", "old");
  fs::create_symlink("target", output());
  EXPECT_EQ(write_output(*real_, true), "");
  Listing expected = new_pair_;
  expected["target"] = "old";
  EXPECT_EQ(listing(), expected);
}

TEST_F(OutputProtection, ForeignSidecarBesideAStalePartial_IsKept) {
  put("out.nvdb.json", "{\"mine\": 1}");
  put("out.nvdb.partial", "half of a volume");
  const Listing before = listing();
  EXPECT_EQ(write_output(*real_, false), output() + ".json: exists; choose another output or pass --overwrite");
  EXPECT_EQ(listing(), before);
  put("out.nvdb.json", sidecar_of(volume('o'), "another volume"));
  put("out.nvdb.partial", volume('x'));
  const Listing of_another = listing();
  EXPECT_EQ(write_output(*real_, false), output() + ".json: exists; choose another output or pass --overwrite");
  EXPECT_EQ(listing(), of_another);
}

TEST_F(OutputProtection, SidecarOfTheStalePartial_IsReplaced) {
  put("out.nvdb.json", sidecar_of(volume('x'), "killed"));
  put("out.nvdb.partial", volume('x'));
  EXPECT_EQ(write_output(*real_, false), "");
  EXPECT_EQ(listing(), new_pair_);
}

// Killed between its renames, and the next commit fails: the sidecar of the volume that stands there comes back.
TEST_F(OutputProtection, KillBetweenTheRenamesAndAFailureAfterwards_KeepTheOldCertificate) {
  const Listing old{{"out.nvdb", volume('o')}, {"out.nvdb.json", sidecar_of(volume('o'), "old")}};
  for (int call = 0; call < 9; ++call) {
    for (const auto& [name, text] : old) put(name, text);
    put("out.nvdb.json.previous", old.at("out.nvdb.json"));
    put("out.nvdb.json", sidecar_of(volume('k'), "killed"));
    put("out.nvdb.partial", volume('k'));
    FaultyFileSystem files(*real_, -1, 0);
    // From the lock on: what fails before it finds the state as it was.
    files.fail_after_rename_to(output() + ".json", call);
    EXPECT_NE(write_output(files, true, volume('n'), ErrorKind::io), "");
    EXPECT_TRUE(files.failed());
    EXPECT_EQ(listing().at("out.nvdb"), volume('o')) << call;
    EXPECT_EQ(listing().at("out.nvdb.json"), old.at("out.nvdb.json")) << call;
    for (const char* left : {"out.nvdb.json.previous", "out.nvdb.partial"}) fs::remove(directory_ / left);
  }
}

TEST_F(OutputProtection, SidecarThatAnotherProcessHasOpen_DescribesItsVolume) {
  put("out.nvdb", volume('o'));
  put("out.nvdb.json", sidecar_of(volume('o'), "old"));
  const auto other = real_->open(output() + ".json");
  EXPECT_TRUE(describes(*real_, output() + ".json", output()));
  EXPECT_FALSE(belongs_back(*real_, output() + ".json", output() + ".json", output()));
}

TEST_F(OutputProtection, Sidecar_DescribesNothingWhereItIsMissingOrNoSidecar) {
  put("out.nvdb", volume('o'));
  EXPECT_FALSE(describes(*real_, output() + ".json", output()));
  put("out.nvdb.json", "no sidecar");
  EXPECT_FALSE(describes(*real_, output() + ".json", output()));
  put("out.nvdb.json", sidecar_of(volume('o'), "old"));
  EXPECT_TRUE(describes(*real_, output() + ".json", output()));
  fs::remove(output());
  EXPECT_FALSE(describes(*real_, output() + ".json", output()));
  EXPECT_EQ(listing().size(), 1U) << "nothing was made";
}

// Which of the two is the volume's own cannot be told then: the next attempt can.
TEST_F(OutputProtection, SidecarThatCannotBeRead_StaysAndSoDoesThePreviousOne) {
  put("out.nvdb", volume('o'));
  put("out.nvdb.json", sidecar_of(volume('o'), "live"));
  put("out.nvdb.json.previous", sidecar_of(volume('o'), "previous"));
  const Listing before = listing();
  const std::vector<std::string> expected{"create", "open_to_read", "open_to_read", "read"};
  for (int call = 1; call <= 3; ++call) {  // after the lock: opens the volume, opens and reads the sidecar
    FaultyFileSystem files(*real_, call, EIO);
    const std::string message = write_output(files, true, volume('n'), ErrorKind::io);
    EXPECT_EQ(files.calls().at(static_cast<std::size_t>(call)), expected[static_cast<std::size_t>(call)]);
    EXPECT_NE(message.find("Input/output error"), std::string::npos) << call;
    EXPECT_EQ(listing(), before) << call;
  }
  put("out.nvdb.partial", volume('o'));
  fs::remove(output());
  FaultyFileSystem files(*real_, 1, EIO);
  EXPECT_NE(write_output(files, false, volume('n'), ErrorKind::io), "") << "the sidecar of a commit that was killed?";
  EXPECT_EQ(listing().at("out.nvdb.json"), before.at("out.nvdb.json"));
}

TEST_F(OutputProtection, WithoutHardLinks_OverwritingSucceeds) {
  for (const auto& [name, text] : Listing{{"out.nvdb", "old"}, {"out.nvdb.json", "old sidecar"}}) put(name, text);
  FaultyFileSystem files(*real_, -1, 0);
  files.take_links_away();
  EXPECT_EQ(write_output(files, true), "");
  EXPECT_EQ(listing(), new_pair_);
}

TEST_F(OutputProtection, WithoutHardLinks_EachFailureLeavesTheOldPair) {
  const Listing old{{"out.nvdb", "old"}, {"out.nvdb.json", "old sidecar"}};
  int failures = 0;
  for (int call = 0;; ++call) {
    for (const auto& [name, text] : old) put(name, text);
    FaultyFileSystem files(*real_, call, EIO);
    files.take_links_away();
    const std::string message = write_output(files, true, volume('n'), ErrorKind::io);
    if (listing().at("out.nvdb") != "old") break;  // the second rename is done
    ++failures;
    EXPECT_NE(message, "");
    EXPECT_EQ(listing(), old) << call;
    fs::remove(output() + ".json.previous");
  }
  EXPECT_EQ(failures, 15) << "calls up to the second rename";
}

TEST_F(OutputProtection, NameTooLongForTheFilesBesideIt_IsRefused) {
  const std::string fits = directory_ / (std::string(236, 'n') + ".nvdb");
  const OutputFiles longest(*real_, fits, false);
  EXPECT_TRUE(fs::exists(fits + ".partial"));
  for (const std::size_t bytes : {242U, 255U}) {
    const std::string path = directory_ / std::string(bytes, 'n');
    try {
      const OutputFiles refused(*real_, path, false);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_EQ(std::string(error.what()),
                path + ": its name has " + std::to_string(bytes) +
                    " bytes, and with what weir writes beside it at most 241 can be used; choose a shorter one");
    }
  }
  EXPECT_THROW(PartialFile(*real_, directory_ / std::string(248, 'n'), false), Error);
  EXPECT_NO_THROW(PartialFile(*real_, directory_ / std::string(247, 'n'), false));
}

TEST_F(OutputProtection, WithoutLocks_OneNoticeAndTheSameFiles) {
  std::vector<std::string> notices;
  const auto files = make_posix_file_system({[&](const Message& line) { notices.push_back(line.text()); }, &no_locks});
  EXPECT_EQ(write_output(*files, false), "");
  EXPECT_EQ(write_output(*files, true), "");
  EXPECT_EQ(listing(), new_pair_);
  EXPECT_EQ(notices, (std::vector<std::string>{output() + ".partial: cannot be locked: No locks available; see to it "
                                                          "that no other process writes this output"}));
}

TEST_F(OutputProtection, WithoutLocks_ASecondWriterIsRefused) {
  const auto files = make_posix_file_system({{}, &no_locks});
  const std::string refusal = output() +
                              ".partial: exists, and files cannot be locked here, so that its writer may still be at "
                              "work; remove it if there is none";
  {
    OutputFiles first(*files, output(), false);
    first.volume().write_at(0, std::as_bytes(std::span("first", 5)));
    EXPECT_EQ(write_output(*files, true, "", ErrorKind::io), refusal);
    EXPECT_EQ(listing(), (Listing{{"out.nvdb.partial", "first"}}));
    first.commit("sidecar");
  }
  EXPECT_EQ(listing(), (Listing{{"out.nvdb", "first"}, {"out.nvdb.json", "sidecar"}}));
}

}  // namespace
}  // namespace weir::output_protection_test
