// Tests `weir watch --check` for a user who may not write everywhere.
#include "daemon/config/check_access.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "format/base/text.h"
#include "format/io/file_system.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::check_access_test {
namespace {

namespace fs = std::filesystem;

class CheckAccess : public testing::Test {
 protected:
  CheckAccess() {
    for (const char* name : {"in", "out", "state"}) fs::create_directory(directory_ / name);
    fs::permissions(directory_.path(), fs::perms::owner_all | fs::perms::others_read | fs::perms::others_exec);
    configure();
  }
  void configure(const std::string& service = "state = 'state/weir.db'\n", const std::string& directory = "in",
                 const std::string& more = "") const {
    write_file(directory_ / "weir.toml",
               cat("[service]\n", service, "[[watch]]\ndirectory = '", directory, "'\noutput = 'out/deep'\n", more));
  }
  /// Runs the check as nobody if the test runs as root, because permissions do not stop root.
  CommandResult check() const {
    std::vector<std::string> command{WEIR_COMMAND, "watch", "--check", directory_ / "weir.toml"};
    if (::geteuid() == 0)
      command.insert(command.begin(), {"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
    return run_command(command);
  }
  void allow(const char* name, bool allowed) const {
    using fs::perms;
    fs::permissions(directory_ / name, allowed ? perms::all : perms::owner_exec | perms::others_exec);
  }
  /// Expects a refusal of `path`, with `what` between the path and the remedy.
  void expect_refused(const std::string& path, const std::string& key, const std::string& what) const {
    const CommandResult result = check();
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_TRUE(result.err.starts_with(cat("weir: ", path, ": ", key, " cannot be ", what, " by user "))) << result.err;
    EXPECT_TRUE(
        result.err.ends_with(cat(": Permission denied; give that user the permission (chown, chmod, setfacl), or "
                                 "choose another ",
                                 key, "\n")))
        << result.err;
  }

  /// Expects a refusal of a configuration with more lines in [service], in which all directories are writable.
  void expect_service_refused(const std::string& lines, const std::string& begin, const std::string& end) const {
    for (const char* name : {"in", "out", "state"}) allow(name, true);
    configure(cat("state = 'state/weir.db'\n", lines, "\n"));
    const CommandResult result = check();
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_TRUE(result.err.starts_with("weir: " + begin)) << result.err;
    EXPECT_TRUE(result.err.ends_with(end + "\n")) << result.err;
  }

  TemporaryDirectory directory_;
};

TEST_F(CheckAccess, EverythingWritable_IsAccepted) {
  allow("out", true);
  allow("state", true);
  const CommandResult result = check();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(fs::exists(directory_ / "out/deep")) << "nothing is changed";
  EXPECT_FALSE(fs::exists(directory_ / "state/weir.db"));
}

TEST_F(CheckAccess, StateDirectoryNotWritable_IsRefused) {
  allow("out", true);
  allow("state", false);
  expect_refused(directory_ / "state", "state", "written to");
}

TEST_F(CheckAccess, StateThatIsAnotherFile_IsRefusedAndUnchanged) {
  for (const char* name : {"in", "out", "state"}) allow(name, true);
  const std::string state = directory_ / "state/weir.db";
  write_file(state, "\x89HDF\r\n\x1a\n and volumes");
  fs::permissions(state, fs::perms::all);
  const CommandResult result = check();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, cat("weir: ", state, ": is no state file of weir; name another file as state in [service]\n"));
  EXPECT_EQ(read_file(state), "\x89HDF\r\n\x1a\n and volumes");
}

TEST_F(CheckAccess, StateThatTheStartCouldNotOpen_IsRefused) {
  for (const char* name : {"in", "out", "state"}) allow(name, true);
  const std::string state = directory_ / "state/weir.db";
  const auto expect_said = [&](const std::string& what) {
    const CommandResult result = check();
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.err, cat("weir: ", state, ": ", what, " another file as state in [service]\n"));
    fs::remove(state);
  };
  ASSERT_EQ(::mkfifo(state.c_str(), 0666), 0);
  fs::permissions(state, fs::perms::all);
  expect_said("is no regular file; name");
  fs::create_symlink("nowhere/x", state);
  expect_said(
      cat("is a link to ", directory_ / "state/nowhere/x", ", whose directory does not exist; make it or name"));
  std::string page(4096, '\0');
  page.replace(0, 16, std::string_view("SQLite format 3\0", 16));
  page[63] = 10;
  page.replace(68, 4, "weir");
  write_file(state, page);
  fs::permissions(state, fs::perms::all);
  expect_said("has version 10, this weir knows versions up to 5; run the newer weir or name");
}

TEST_F(CheckAccess, OutputNotWritable_IsRefused) {
  allow("state", true);
  allow("out", false);
  expect_refused(directory_ / "out", "output", "written to");
}

// While nothing is mounted there, only root may write to the mount point: see docs/operations.md.
TEST_F(CheckAccess, OutputOfAFileSystemThatIsNotMounted_IsNotLookedAt) {
  allow("state", true);
  allow("out", false);
  configure("state = 'state/weir.db'\n", "in", "output_mount = 'out'\n");
  const CommandResult result = check();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string said = cat("\n  mount       ", directory_ / "out", ", where no file system is mounted now\n");
  EXPECT_NE(result.out.find(said), std::string::npos) << result.out;
}

TEST_F(CheckAccess, DirectoryNotReadable_IsRefused) {
  allow("state", true);
  allow("out", true);
  allow("in", false);
  expect_refused(directory_ / "in", "directory", "read");
}

TEST_F(CheckAccess, DirectoryOfTheStateMissing_IsRefused) {
  allow("out", true);
  configure("state = 'none/weir.db'\n");
  const CommandResult result = check();
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(result.err.ends_with(": No such file or directory; make it, or choose another state\n")) << result.err;
}

// With such a work_dir, every conversion would fail for good.
TEST_F(CheckAccess, WorkDirThatIsMissingOrMemory_IsRefused) {
  expect_service_refused("work_dir = 'none'", (directory_ / "none") + ": work_dir cannot be written to by user ",
                         ": No such file or directory; make it, or choose another work_dir");
  if (!make_posix_file_system()->is_memory("/dev/shm")) GTEST_SKIP() << "/dev/shm is on a disk";
  expect_service_refused("work_dir = '/dev/shm'",
                         "/dev/shm: work_dir lies on a memory file system; choose a directory on a disk", "");
}

// In such a directory root may write, but cannot create a directory.
TEST_F(CheckAccess, OutputThatTheKernelMakesTheFilesOf_IsRefused) {
  write_file(directory_ / "weir.toml",
             "[service]\nstate = 'weir.db'\n[[watch]]\ndirectory = 'in'\noutput = '/proc/weir/nvdb'\n");
  const CommandResult result = run_weir({"watch", "--check", directory_ / "weir.toml"});
  EXPECT_EQ(result.exit_code, 5) << result.out;
  EXPECT_EQ(result.err,
            "weir: /proc/weir/nvdb: output lies on a file system of the kernel; choose a directory on a disk\n");
}

TEST_F(CheckAccess, FileThatIsADirectory_IsRefused) {
  fs::create_directory(directory_ / "state/d");
  for (const std::string key : {"log", "port_file", "control_socket"}) {
    expect_service_refused(key + " = 'state/d'",
                           cat(directory_ / "state/d", ": ", key, " cannot be written to by user "),
                           ": Is a directory; choose another " + key);
  }
  configure("state = 'state/d'\n");
  EXPECT_TRUE(check().err.ends_with(": Is a directory; choose another state\n")) << check().err;
  EXPECT_EQ(list_directory(directory_ / "state"), std::vector<std::string>{"d/"});
}

TEST_F(CheckAccess, WatchedFile_IsRefused) {
  for (const char* name : {"out", "state"}) allow(name, true);
  configure("state = 'state/weir.db'\n", "weir.toml");
  const CommandResult result = check();
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(result.err.starts_with(cat("weir: ", directory_ / "weir.toml", ": directory cannot be read by user ")))
      << result.err;
  EXPECT_TRUE(result.err.ends_with(": Not a directory; choose another directory\n")) << result.err;
}

}  // namespace
}  // namespace weir::check_access_test
