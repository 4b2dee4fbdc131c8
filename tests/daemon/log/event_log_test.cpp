#include "daemon/log/event_log.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <regex>

#include "format/base/error.h"
#include "format/base/text.h"
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

TEST(EventText, NamesThatAreNoUtf8OrSteerATerminal_AreEscaped) {
  EXPECT_EQ(event_text("x", {{"source", "/in/caf\xe9.raw"}}), "x source=\"/in/caf\\xe9.raw\"");
  EXPECT_EQ(event_text("x", {{"a", "caf\xc3\xa9"}}), "x a=caf\xc3\xa9");
  EXPECT_EQ(event_text("x", {{"a",
                              "\xc2\x9b"
                              "31m"}}),
            "x a=\"\\xc2\\x9b31m\"");
  EXPECT_EQ(event_text("x", {{"a", "\xe2\x80\xaewar.a"}}), "x a=\"\\xe2\\x80\\xaewar.a\"");
  EXPECT_EQ(event_text("x", {{"a", "\xe2\x80"}}), "x a=\"\\xe2\\x80\"") << "cut off";
  EXPECT_EQ(event_text("x", {{"a", "back\\slash"}}), "x a=back\\slash");
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

// Imitates a full disk: a write across the limit is shortened, and the next write fails.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : former_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit limit{bytes, former_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, former_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit former_{};
  void (*former_handler_)(int);
};

std::string without_time(const std::string& log) {
  return std::regex_replace(log, std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z )"), "");
}

TEST(EventLog, LinesThatCannotBeWritten_AreCountedAndSaid) {
  const TemporaryDirectory directory;
  for (const std::uint64_t log_size : {0, 100000}) {
    ServiceConfig service;
    service.log_file = directory / cat("log", log_size);
    service.log_size = log_size;
    service.log_level = "info";
    const EventLog log(service);
    const std::string first(3000, 'x');  // so that stderr stays below the limit
    log.info(first, {});
    std::string said;
    {
      const FileSizeLimit limit(fs::file_size(service.log_file) + 30);
      testing::internal::CaptureStderr();
      for (int i = 0; i < 3; ++i) log.info("lost", {{"number", i}});
      log.debug("below the level", {});
      said = testing::internal::GetCapturedStderr();
    }
    EXPECT_EQ(log.lines_lost(), 3U);
    log.info("next", {});
    log.info("last", {});
    EXPECT_EQ(without_time(read_file(service.log_file)),
              "info " + first + "\ninfo \nwarning log-lost lines=3\ninfo next\ninfo last\n");
    EXPECT_TRUE(said.starts_with("weir: the log cannot be written: ")) << said;
    EXPECT_NE(said.find("File too large"), std::string::npos) << said;
    EXPECT_TRUE(said.ends_with("; events are lost until it can\n")) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_EQ(log.lines_lost(), 3U);
  }
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
