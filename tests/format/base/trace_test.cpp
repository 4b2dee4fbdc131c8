#include "format/base/trace.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "tests/support/temporary_directory.h"

namespace weir::trace_test {
namespace {

using Json = nlohmann::json;

Json read(const std::string& path) {
  std::ifstream file(path);
  return Json::parse(file);
}

TEST(Trace, AnEmptyOneNamesTheMainThread) {
  const TemporaryDirectory directory;
  { const Trace trace(directory / "t.json"); }
  EXPECT_EQ(read(directory / "t.json"),
            Json::parse(R"([{"name": "thread_name", "ph": "M", "pid": 1, "tid": 0, "args": {"name": "main"}}])"));
}

TEST(Trace, WritesEachEventWithThreadTimeAndBytes) {
  const TemporaryDirectory directory;
  Trace trace(directory / "t.json");
  const auto start = Trace::Clock::now() + std::chrono::seconds(1);
  trace.add("read", start, start + std::chrono::nanoseconds(1'500), 4096);
  std::thread([&] {
    trace.add("survey", start + std::chrono::microseconds(2), start + std::chrono::seconds(3), 0);
  }).join();
  trace.close();
  Json events = read(directory / "t.json");
  ASSERT_EQ(events.size(), 4U);
  const double first = events[1]["ts"];
  EXPECT_GE(first, 1e6);
  EXPECT_LT(first, 11e6);
  EXPECT_NEAR(events[3]["ts"].get<double>(), first + 2, 0.0015);
  events[1].erase("ts");
  events[3].erase("ts");
  EXPECT_EQ(events[1], Json::parse(R"({"name": "read", "ph": "X", "pid": 1, "tid": 0, "dur": 1.5,
                                       "args": {"bytes": 4096}})"));
  EXPECT_EQ(events[2], Json::parse(R"({"name": "thread_name", "ph": "M", "pid": 1, "tid": 1,
                                       "args": {"name": "thread 1"}})"));
  EXPECT_EQ(events[3], Json::parse(R"({"name": "survey", "ph": "X", "pid": 1, "tid": 1, "dur": 2999998.0})"));
}

TEST(Trace, SpansNestAndThreadsDoNotMix) {
  const TemporaryDirectory directory;
  {
    Trace trace(directory / "t.json");
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (int k = 0; k < 500; ++k) {
          const TraceSpan outer(&trace, "outer", 1);
          const TraceSpan inner(&trace, "inner", 2);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  std::set<int> seen;
  Json inner;
  int pairs = 0;
  for (const Json& event : read(directory / "t.json")) {
    if (event["ph"] != "X") continue;
    seen.insert(event["tid"].get<int>());
    EXPECT_EQ(event["args"]["bytes"], event["name"] == "outer" ? 1 : 2);
    pairs += event["name"] == "outer" ? 1 : 0;
  }
  EXPECT_EQ(pairs, 2000);
  EXPECT_EQ(seen, (std::set<int>{1, 2, 3, 4}));
}

TEST(Trace, UnwritableFileIsReported) {
  try {
    const Trace trace("/nowhere/t.json");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_STREQ(error.what(), "/nowhere/t.json: cannot create: No such file or directory");
  }
  Trace full("/dev/full");
  try {
    full.close();
    FAIL();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("/dev/full: cannot write the trace: No space left on device; free space"))
        << message;
  }
}

}  // namespace
}  // namespace weir::trace_test
