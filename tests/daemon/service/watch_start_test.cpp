// Tests the checks of `weir watch` before it runs, and how its systemd unit handles the exit code.
#include <gtest/gtest.h>

#include <filesystem>

#include "format/base/text.h"
#include "tests/daemon/support/service_harness.h"

namespace weir::watch_start_test {
namespace {

namespace fs = std::filesystem;

CommandResult check(const ServiceHarness& service, std::vector<std::string> launcher = {}) {
  launcher.insert(launcher.end(), {WEIR_COMMAND, "watch", "--check", service.path("weir.toml")});
  return run_command(launcher);
}

TEST(WatchStart, OutputThatCannotBeMade_EndsItAsCheckDoes) {
  ServiceHarness service("", "output = \"file/out\"\n");
  write_file(service.path("file"), "");
  service.launch();
  CommandResult end;
  EXPECT_EQ(service.wait(&end), 5);
  EXPECT_TRUE(end.err.starts_with(cat("weir: ", service.path("file"), ": output cannot be written to by user ")))
      << end.err;
  EXPECT_TRUE(end.err.ends_with(": Not a directory; choose another output\n")) << end.err;
  const CommandResult checked = check(service);
  EXPECT_EQ(checked.exit_code, 5);
  EXPECT_EQ(checked.err, end.err);
  EXPECT_FALSE(fs::exists(service.path("weir.db"))) << "nothing has begun";
}

TEST(WatchStart, DirectoryThatMayNotBeRead_EndsItAsCheckDoes) {
  ServiceHarness service;
  service.run_unprivileged();
  fs::permissions(service.in(), fs::perms::none);
  service.launch();
  CommandResult end;
  EXPECT_EQ(service.wait(&end), 5);
  const std::string directory = service.in().substr(0, service.in().size() - 1);
  EXPECT_TRUE(end.err.starts_with(cat("weir: ", directory, ": directory cannot be read by user "))) << end.err;
  EXPECT_TRUE(end.err.ends_with(
      ": Permission denied; give that user the permission (chown, chmod, setfacl), or choose another directory\n"))
      << end.err;
  fs::permissions(service.in(), fs::perms::all);
}

TEST(WatchStart, PortThatFindsNoRoom_LeavesTheFileOfTheLastOne) {
  ServiceHarness service("port_file = \"last\"\n", "");
  write_file(service.path("last"), "1234\n");
  fs::create_symlink("/dev/full", service.path("last.new"));
  service.launch();
  CommandResult end;
  EXPECT_EQ(service.wait(&end), 5);
  EXPECT_NE(end.err.find("/last: the port cannot be written there; check the directory\n"), std::string::npos)
      << end.err;
  EXPECT_EQ(read_file(service.path("last")), "1234\n");
}

TEST(WatchStart, WrongConfiguration_EndsItWith3AsCheckDoes) {
  ServiceHarness service("", "rate = \"much\"\n");
  service.launch();
  CommandResult end;
  EXPECT_EQ(service.wait(&end), 3);
  const CommandResult checked = check(service);
  EXPECT_EQ(checked.exit_code, 3);
  EXPECT_EQ(checked.err, end.err);
  EXPECT_NE(end.err.find("rate is \"much\""), std::string::npos) << end.err;
}

// systemd applies RestartPreventExitStatus only to ExecStart: a check that failed before it was repeated forever.
TEST(WatchStart, UnitStartsTheServiceAloneAndStaysDownAfter2And3) {
  const std::string unit = read_file(WEIR_SOURCE_DIR "/daemon/weir@.service");
  EXPECT_NE(unit.find("\nExecStart=/usr/bin/weir watch /etc/weir/%i.toml\n"), std::string::npos) << unit;
  EXPECT_EQ(unit.find("\nExecStartPre="), std::string::npos) << unit;
  EXPECT_NE(unit.find("\nRestart=on-failure\n"), std::string::npos) << unit;
  EXPECT_NE(unit.find("\nRestartPreventExitStatus=2 3\n"), std::string::npos) << unit;
  EXPECT_NE(unit.find("\nOOMPolicy=continue\n"), std::string::npos) << unit;
}

}  // namespace
}  // namespace weir::watch_start_test
