#include "tools/describe/describe_config.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "daemon/watch/file_system_kind.h"
#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/unreadable_file.h"

namespace weir::describe_config_test {
namespace {

class WatchCheck : public testing::Test {
 protected:
  CommandResult check(const std::string& text) {
    write_file(directory_ / "watch.toml", text);
    return run_weir({"watch", "--check", directory_ / "watch.toml"});
  }
  /// Returns `text` with every @ replaced by the test's directory.
  std::string here(std::string text) const {
    for (std::size_t at; (at = text.find('@')) != std::string::npos;) text.replace(at, 1, directory_.path().string());
    return text;
  }

  TemporaryDirectory directory_;
};

TEST_F(WatchCheck, PrintsTheResolvedConfiguration) {
  std::filesystem::create_directory(directory_ / "in");
  const CommandResult result = check(R"([service]
jobs = 2
bandwidth = "100MiB"
nice = 10
[[watch]]
directory = "in"
output = "in/nvdb"
include = ["*.raw", "*.h5"]
dims = [64, 64, 64]
type = "uint8"
rate = 4
[[watch]]
label = "all"
directory = "later"
recursive = true
output = "/nvdb"
name = "{stem}_all.nvdb"
complete = "marker"
watch = "poll"
thumbnails = false
exclude = ["restart*"]
)");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const FileSystemKind kind = file_system_kind(directory_ / "in");
  const std::string method =
      cat(kind.sees_all_changes ? "inotify" : "polling every 1 s", ", as it lies on ", kind.name);
  EXPECT_EQ(result.out, here(R"(service
  state       @/weir.db
  listen      127.0.0.1:8470
  memory      1.0 GiB, 384.0 MiB for each of 2 jobs
  viewer      192.0 MiB of it
  jobs        all threads each, nice 10, I/O class none
  bandwidth   100.0 MiB/s
  work_dir    a hidden directory beside each output
  grace       30 s
  history     90 days
  log         stderr, level info
watch "@/in"
  directory   @/in
  include     *.raw *.h5
  never       @/in/nvdb
  output      @/in/nvdb/{stem}.nvdb
  thumbnails  yes
  watch       auto: )" + method +
                             R"(
  complete    auto, settled after 2 s
  priority    oldest
  source      keep
  follow      what sources name, in the directory and below
  convert     --dims=64,64,64 --type=uint8 --rate=4
watch "all"
  directory   @/later, and below, which is not there yet
  include     names of known formats; .raw only as NAME_XxYxZ_TYPE.raw; .nvdb only if named
  exclude     restart*
  output      /nvdb/{stem}_all.nvdb
  thumbnails  no
  watch       polling every 1 s
  complete    marker .done
  priority    oldest
  source      keep
  follow      what sources name, in the directory and below
  convert     as weir convert does by default
)"));
  EXPECT_EQ(list_directory(directory_.path()), (std::vector<std::string>{"in/", "watch.toml"}))
      << "checking made something";
}

TEST_F(WatchCheck, DimsOrTypeWithoutInclude_SaysThatAnyRawIsTaken) {
  const std::string keys = "[[watch]]\ndirectory = 'in'\noutput = 'out'\n";
  for (const char* key : {"dims = [4, 4, 4]\n", "type = 'uint8'\n"}) {
    const std::string out = check(keys + key).out;
    EXPECT_NE(out.find("\n  include     names of known formats; any .raw; .nvdb only if named\n"), std::string::npos)
        << out;
  }
}

TEST_F(WatchCheck, ControlSocketAndPortFile_ArePrintedWhereTheyAreSet) {
  const std::string out = check(R"([service]
control_socket = "weir.sock"
port_file = "port"
[[watch]]
directory = "in"
output = "out"
)")
                              .out;
  EXPECT_NE(
      out.find(here("\n  listen      127.0.0.1:8470\n  control     @/weir.sock\n  port_file   @/port\n  memory ")),
      std::string::npos)
      << out;
}

TEST_F(WatchCheck, MissingDirectory_LeavesTheWatchMethodOpen) {
  const std::string keys = "[[watch]]\ndirectory = 'later'\noutput = 'out'\n";
  EXPECT_NE(check(keys).out.find("\n  watch       auto: inotify or polling every 1 s, by its file system\n"),
            std::string::npos);
  EXPECT_NE(check(keys + "watch = 'inotify'\n").out.find("\n  watch       inotify\n"), std::string::npos);
}

TEST_F(WatchCheck, WithoutAViewer_SaysWhy) {
  const auto viewer = [&](const std::string& keys) {
    return check("[service]\n" + keys + "\n[[watch]]\ndirectory = 'in'\noutput = 'out'\n").out;
  };
  EXPECT_NE(viewer("memory = '256MiB'")
                .find("\n  viewer      none: memory is 256.0 MiB, and below 1.0 GiB there is none by default; set "
                      "viewer_memory = \"128MiB\" or give more memory\n"),
            std::string::npos);
  EXPECT_NE(viewer("viewer_memory = 0").find("\n  viewer      none: viewer_memory is 0 in the configuration\n"),
            std::string::npos);
}

TEST_F(WatchCheck, DeleteAfterWithoutADeletion_IsWarnedOf) {
  const std::string keys = "[[watch]]\ndirectory = 'in'\noutput = 'out'\n";
  const std::string warning =
      "\n  warning     delete_after has no effect, since nothing is deleted; set source = \"delete-after-verify\", or "
      "leave it out\n";
  EXPECT_NE(check(keys + "delete_after = '1h'\n").out.find(warning), std::string::npos);
  EXPECT_EQ(check(keys).out.find("delete_after"), std::string::npos);
}

TEST_F(WatchCheck, AMistakeIsOneLineAndExitCode3) {
  const CommandResult result = check("[[watch]]\ndirectory = 'in'\noutput = 'out'\nrate = 'fast'\n");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, here("weir: @/watch.toml:4:8: rate is \"fast\", it must be a positive number: dense float32 "
                             "bytes / file bytes\n"));
  EXPECT_EQ(run_weir({"watch", "--check", directory_ / "missing.toml"}).err,
            here("weir: @/missing.toml: cannot read: No such file or directory\n"));
}

TEST_F(WatchCheck, ConfigurationThatMayNotBeRead_ExitsWith5) {
  const std::string unreadable = unreadable_file();
  if (unreadable.empty()) GTEST_SKIP() << "this system has no file that root cannot read";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"watch", "--check", unreadable}, {"watch", unreadable}}) {
    const CommandResult result = run_weir(command);
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "weir: " + unreadable +
                              ": cannot read: Permission denied; give this user the right to read it and to enter its "
                              "directories\n");
  }
}

TEST_F(WatchCheck, WithoutAFileIsAUsageError) {
  const CommandResult result = run_weir({"watch", "--check"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "weir: config is required; see weir watch --help\n");
}

}  // namespace
}  // namespace weir::describe_config_test
