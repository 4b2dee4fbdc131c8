// A single output file: every call of its protocol fails in turn, and the
// directory is then compared exactly.
#include "format/output/partial_file.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/support/directory_contents.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::partial_file_test {
namespace {

class PartialFileTest : public ::testing::Test {
 protected:
  std::string output() const { return directory_ / "out.raw"; }
  void put(const std::string& name, const std::string& text) const { std::ofstream(directory_ / name) << text; }

  Listing listing() const { return listing_of(directory_.path()); }

  std::string write_output(FileSystem& files, bool overwrite) const {
    try {
      PartialFile partial(files, output(), overwrite);
      partial.reserve(6);
      partial.file().write_at(0, std::as_bytes(std::span("volume", 6)));
      partial.commit();
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  }

  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
  TemporaryDirectory directory_;
};

TEST_F(PartialFileTest, MakesTheDocumentedSequenceOfCalls) {
  FaultyFileSystem files(*real_, -1, 0);
  EXPECT_EQ(write_output(files, false), "");
  EXPECT_EQ(files.calls(),
            (std::vector<std::string>{"create", "preallocate", "write", "sync", "rename_new", "sync_directory"}));
  FaultyFileSystem again(*real_, -1, 0);
  EXPECT_EQ(write_output(again, true), "");
  EXPECT_EQ(again.calls(),
            (std::vector<std::string>{"create", "preallocate", "write", "sync", "rename", "sync_directory"}));
  EXPECT_EQ(listing(), (Listing{{"out.raw", "volume"}}));
}

TEST_F(PartialFileTest, EachFailureLeavesWhatWasThere) {
  for (const bool overwrite : {false, true}) {
    const Listing before = overwrite ? Listing{{"out.raw", "old"}} : Listing{};
    for (int call = 0; call < 6; ++call) {
      std::filesystem::remove(output());
      for (const auto& [name, text] : before) put(name, text);
      FaultyFileSystem files(*real_, call, ENOSPC);
      EXPECT_NE(write_output(files, overwrite).find("call " + std::to_string(call) + " "), std::string::npos);
      EXPECT_TRUE(files.failed());
      // The last call flushes the directory: the file has its name by then.
      EXPECT_EQ(listing(), call < 5 ? before : (Listing{{"out.raw", "volume"}})) << call;
    }
  }
}

TEST_F(PartialFileTest, UncommittedFilesDisappear) {
  {
    const PartialFile partial(*real_, output(), false);
    EXPECT_EQ(listing(), (Listing{{"out.raw.partial", ""}}));
  }
  EXPECT_EQ(listing(), Listing{});
}

TEST_F(PartialFileTest, KeepsAFileThatAppearedBeforeTheCommit) {
  {
    PartialFile partial(*real_, output(), false);
    put("out.raw", "mine");
    EXPECT_THROW(partial.commit(), Error);
  }
  EXPECT_EQ(listing(), (Listing{{"out.raw", "mine"}}));
}

TEST_F(PartialFileTest, PartialThatAnotherProcessMadeAnew_IsNeitherRenamedNorRemoved) {
  for (const bool overwrite : {false, true}) {
    {
      PartialFile partial(*real_, output(), overwrite);
      std::filesystem::remove(output() + ".partial");
      put("out.raw.partial", "another's half");
      EXPECT_EQ(message_of_error(ErrorKind::io, [&] { partial.commit(); }),
                output() +
                    ".partial: was removed or replaced while it was written; let nobody remove it, and try "
                    "again");
    }
    EXPECT_EQ(listing(), (Listing{{"out.raw.partial", "another's half"}}));
    std::filesystem::remove(output() + ".partial");
  }
}

TEST_F(PartialFileTest, OneWriterAtATime) {
  const PartialFile first(*real_, output(), false);
  EXPECT_EQ(write_output(*real_, false),
            output() +
                ".partial: is being written by another process or conversion; wait for it or choose "
                "another output");
  EXPECT_EQ(listing(), (Listing{{"out.raw.partial", ""}}));
}

}  // namespace
}  // namespace weir::partial_file_test
