#include "daemon/config/own_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/config/load_config.h"
#include "format/base/error.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::own_files_test {
namespace {

namespace fs = std::filesystem;

const std::string kOneWatch = "[[watch]]\ndirectory = 'in'\noutput = 'out'\n";

class OwnFiles : public testing::Test {
 protected:
  DaemonConfig load(const std::string& text) {
    write_file(path_, text);
    return load_config(path_);
  }
  /// Returns the message without the path before ":LINE:COLUMN: "; empty if the text is accepted.
  std::string refusal(const std::string& text) {
    try {
      load(text);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return std::string(error.what()).substr(path_.size() + 1);
    }
  }
  std::string service_refusal(const std::string& lines) { return refusal("[service]\n" + lines + "\n" + kOneWatch); }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "watch.toml";
};

TEST_F(OwnFiles, WhatTheServiceReads_IsNeverWrittenOver) {
  const std::string other = "; choose another name";
  write_file(directory_ / "secret", "s3cret");
  fs::permissions(directory_ / "secret", fs::perms(0600));
  fs::create_symlink(path_, directory_ / "link.toml");
  for (const std::string key : {"state", "log", "port_file", "control_socket"}) {
    const std::string place = "2:" + std::to_string(key.size() + 4) + ": " + key;
    EXPECT_EQ(service_refusal(key + " = 'watch.toml'"), place + " is this file, " + path_ + other);
    EXPECT_EQ(service_refusal(key + " = 'link.toml'"), place + " is this file, " + (directory_ / "link.toml") + other);
    EXPECT_EQ(service_refusal(key + " = 'secret'\ntoken_file = 'secret'"),
              place + " is the token_file, " + (directory_ / "secret") + other);
  }
  write_file(directory_ / "scene.toml", "[volume]\niso = 1\n");
  EXPECT_EQ(
      refusal("[service]\nlog = 'scene.toml'\n" + kOneWatch + "scene = 'scene.toml'\n"),
      "2:7: log is the scene of the watch \"" + (directory_ / "in") + "\", " + (directory_ / "scene.toml") + other);
  EXPECT_EQ(load("[service]\ntoken_file = 'secret'\n" + kOneWatch).service.token_file, directory_ / "secret");
}

TEST_F(OwnFiles, WhatIsMadeBesideAnOwnFile_IsNoOtherOwnFile) {
  for (const std::string journal : {"-wal", "-shm", "-journal"}) {
    EXPECT_EQ(service_refusal("port_file = 'weir.db" + journal + "'"),
              "2:13: port_file is a file that state makes beside its own, " + (directory_ / "weir.db" + journal) +
                  "; choose another name");
  }
  EXPECT_EQ(
      service_refusal("log = 'port.new'\nport_file = 'port'"),
      "2:7: log is a file that port_file makes beside its own, " + (directory_ / "port.new") + "; choose another name");
  write_file(directory_ / "port.new", "s3cret");
  fs::permissions(directory_ / "port.new", fs::perms(0600));
  EXPECT_EQ(service_refusal("port_file = 'port'\ntoken_file = 'port.new'"),
            "2:13: port_file makes a file beside it that is the token_file, " + (directory_ / "port.new") +
                "; choose another name");
}

TEST_F(OwnFiles, OwnFilesAreNeverSources) {
  const DaemonConfig config = load(R"([service]
state = "in/weir.db"
log = "in/deep/weir.log"
work_dir = "elsewhere"
[[watch]]
directory = "in"
output = "in/nvdb"
[[watch]]
directory = "in2"
output = "in/deep/nvdb"
)");
  const std::string in = directory_ / "in/";
  EXPECT_EQ(config.watches[0].excluded_paths,
            (std::vector<std::string>{in + "deep/nvdb", in + "deep/weir.log", in + "nvdb", in + "weir.db",
                                      in + "weir.db-journal", in + "weir.db-shm", in + "weir.db-wal"}));
  EXPECT_TRUE(config.watches[1].excluded_paths.empty());
  const std::vector<NumberedFiles> numbered{{in + "weir.db.corrupt-", "", true}, {in + "deep/weir.", ".log"}};
  EXPECT_EQ(config.watches[0].excluded_numbers, numbered);
  EXPECT_TRUE(config.watches[1].excluded_numbers.empty());
}

}  // namespace
}  // namespace weir::own_files_test
