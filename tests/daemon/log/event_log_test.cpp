#include "daemon/log/event_log.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "format/base/error.h"
#include "tests/support/run_command.h"

namespace weir::event_log_test {
namespace {

namespace fs = std::filesystem;

TEST(EventText, QuotesWhatIsNotOneWord) {
  EXPECT_EQ(event_text("done", {{"job", 7}, {"seconds", 1.5}, {"source", "/in/a.raw"}}),
            "done job=7 seconds=1.5 source=/in/a.raw");
  EXPECT_EQ(event_text("x", {{"a", ""}, {"b", "two words"}, {"c", "a=b"}, {"d", "say \"no\" \\"}}),
            "x a=\"\" b=\"two words\" c=\"a=b\" d=\"say \\\"no\\\" \\\\\"");
  EXPECT_EQ(event_text("x", {{"a", "line\nline\x1b[31m\xc3\xa9"}}), "x a=\"line\\nline\\x1b[31m\xc3\xa9\"");
  EXPECT_EQ(event_text("pause", {}), "pause");
}

TEST(EventLog, ALineHasTimeLevelAndEvent) {
  const TemporaryDirectory directory;
  ServiceConfig service;
  service.log_file = directory / "weir.log";
  const EventLog log(service);
  log.info("done", {{"job", 7}});
  log.debug("not", {{"at", "this level"}});
  log.error("failed", {{"job", 8}});
  const std::regex expected(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z info done job=7\n\S+Z error failed job=8\n)");
  EXPECT_TRUE(std::regex_match(read_file(service.log_file), expected)) << read_file(service.log_file);
}

TEST(EventLog, ReopensAFileThatWasRenamed) {
  const TemporaryDirectory directory;
  ServiceConfig service;
  service.log_file = directory / "weir.log";
  service.log_size = 0;
  EventLog log(service);
  log.info("one", {});
  fs::rename(service.log_file, directory / "weir.log.1");
  log.info("two", {});
  service.log_level = "warn";
  log.reopen(service);
  log.info("three", {});
  log.warn("four", {});
  EXPECT_NE(read_file(directory / "weir.log.1").find(" info two\n"), std::string::npos);
  EXPECT_EQ(read_file(service.log_file).substr(25), "warning four\n");
}

TEST(EventLog, RotatesAtItsSize) {
  const TemporaryDirectory directory;
  ServiceConfig service;
  service.log_file = directory / "weir.log";
  service.log_size = 1000;
  service.log_files = 2;
  const EventLog log(service);
  for (int i = 0; i < 100; ++i) log.info("event", {{"number", i}});
  EXPECT_EQ(list_directory(directory.path()), (std::vector<std::string>{"weir.1.log", "weir.2.log", "weir.log"}));
  EXPECT_LE(fs::file_size(service.log_file), 1000U);
}

TEST(EventLog, SaysWhereItCannotWrite) {
  ServiceConfig service;
  service.log_file = "/proc/nowhere/weir.log";
  try {
    const EventLog log(service);
    FAIL() << "opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_TRUE(std::string(error.what()).starts_with("/proc/nowhere/weir.log: cannot be opened for the log: "));
  }
}

}  // namespace
}  // namespace weir::event_log_test
