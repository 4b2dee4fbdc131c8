// Tests --trace as a user runs it: the contents of the trace file of a conversion.
#include "tools/options/trace_option.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "tests/support/run_command.h"

namespace weir::trace_option_test {
namespace {

using Json = nlohmann::json;
using Names = std::set<std::string>;

struct Span {
  std::string name;
  double begin;  // microseconds
  double end;
  double bytes;
};

using Threads = std::map<int, std::vector<Span>>;

// Returns the file's events by thread, each outer event before its inner ones. Expects any two events of a thread to be
// nested or apart.
Threads read_trace(const std::string& path) {
  Threads threads;
  for (const Json& event : Json::parse(read_file(path))) {
    if (event["ph"] != "X") continue;
    const double begin = event["ts"];
    const double bytes = event.contains("args") ? event["args"]["bytes"].get<double>() : 0;
    threads[event["tid"].get<int>()].push_back(
        {event["name"].get<std::string>(), begin, begin + event["dur"].get<double>(), bytes});
  }
  constexpr double kRounding = 0.0021;
  for (auto& [thread, spans] : threads) {
    std::sort(spans.begin(), spans.end(),
              [](const Span& a, const Span& b) { return a.begin != b.begin ? a.begin < b.begin : a.end > b.end; });
    std::vector<Span> open;
    for (const Span& span : spans) {
      while (!open.empty() && open.back().end <= span.begin + kRounding) open.pop_back();
      if (!open.empty()) {
        EXPECT_LE(span.end, open.back().end + kRounding) << span.name << " in " << open.back().name;
      }
      open.push_back(span);
    }
  }
  return threads;
}

Names names_of(const std::vector<Span>& spans) {
  Names names;
  for (const Span& span : spans) names.insert(span.name);
  return names;
}

double bytes_of(const Threads& threads, const std::string& name) {
  double bytes = 0;
  for (const auto& [thread, spans] : threads) {
    for (const Span& span : spans) bytes += span.name == name ? span.bytes : 0;
  }
  return bytes;
}

constexpr double kVoxels = 256 * 256 * 40;
constexpr double kLeaves = 32 * 32 * 5;

class TraceOption : public ::testing::Test {
 protected:
  TraceOption() { EXPECT_EQ(run_weir({"sample", "noise", "--dims", "256,256,40", "-o", input_}).exit_code, 0); }
  // Checks the trace of a conversion that reads ahead (`direct_io` "on") or in place.
  void expect_whole(const std::string& direct_io) {
    const CommandResult result =
        run_weir({"convert", input_, "-o", directory_ / "o.nvdb", "--overwrite", "--lossless", "--encoding", "float",
                  "--threads", "2", "--direct-io", direct_io, "--trace", trace_, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    Threads threads = read_trace(trace_);
    const double leaves = kLeaves * 2144;
    // The survey reads all voxels. The encode pass reads them again unless the survey has left them in memory.
    EXPECT_EQ(bytes_of(threads, "read"), (direct_io == "on" ? 1 : 2) * 4 * kVoxels);
    EXPECT_EQ(bytes_of(threads, "write"), leaves + kLeaves * 64) << "leaves and the survey's rows";
    EXPECT_EQ(bytes_of(threads, "survey pass"), 4 * kVoxels);
    Names inner = names_of(threads[0]);
    for (const char* pass : {"survey pass", "background", "select", "encode pass", "write tree", "digest", "commit"}) {
      EXPECT_EQ(std::count_if(threads[0].begin(), threads[0].end(), [&](const Span& s) { return s.name == pass; }), 1)
          << pass;
      inner.erase(pass);
    }
    for (const auto& [thread, spans] : threads) {
      if (thread != 0) inner.merge(names_of(spans));
    }
    EXPECT_EQ(inner, (Names{"read", "survey", "encode", "write"}));
    // The passes take at least half of the total time.
    const Json timing = Json::parse(result.out)["timing"];
    double passes = 0;
    for (const Span& span : threads[0]) {
      const bool pass = span.name == "survey pass" || span.name == "background" || span.name == "select" ||
                        span.name == "encode pass" || span.name == "write tree" || span.name == "digest";
      passes += pass ? span.end - span.begin : 0;
    }
    EXPECT_LE(passes / 1e6, timing["total_s"].get<double>() + 0.001);
    EXPECT_GE(passes / 1e6, 0.5 * timing["total_s"].get<double>());
    EXPECT_FALSE(Json::parse(result.out)["weir"]["options"].contains("trace"));
  }

  TemporaryDirectory directory_;
  std::string input_ = directory_ / "n_256x256x40_float32.raw";
  std::string trace_ = directory_ / "t.json";
};

TEST_F(TraceOption, TellsWhatIsReadSurveyedEncodedAndWritten) {
  expect_whole("off");
  expect_whole("on");
}

TEST_F(TraceOption, TellsWhatIsCompared) {
  ASSERT_EQ(run_weir({"convert", input_, "-o", directory_ / "o.nvdb"}).exit_code, 0);
  ASSERT_EQ(run_weir({"compare", input_, directory_ / "o.nvdb", "--trace", trace_}).exit_code, 0);
  const Threads threads = read_trace(trace_);
  EXPECT_EQ(bytes_of(threads, "read"), 4 * kVoxels);
  EXPECT_EQ(bytes_of(threads, "compare"), 4 * kVoxels);
  EXPECT_EQ(names_of(threads.at(0)), Names{"compare"});
  EXPECT_EQ(run_weir({"compare", input_, directory_ / "o.nvdb", "--trace", input_}).exit_code, 2);
  const std::string missing = directory_ / "missing";
  const CommandResult refused = run_weir({"compare", input_, directory_ / "o.nvdb", "--trace", missing + "/t.json"});
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_EQ(refused.err, "weir: --trace " + missing + "/t.json: the directory " + missing +
                             " does not exist; make it or choose another\n");
}

TEST_F(TraceOption, TraceOverAVolumeOfAVectorField_IsRefused) {
  const std::string x = directory_ / "x.nvdb";
  const std::string y = directory_ / "y.nvdb";
  const std::string z = directory_ / "z.nvdb";
  const std::string source = directory_ / "s_256x256x40_float32.raw";
  std::filesystem::copy_file(input_, source);
  for (const std::string& volume : {x, y, z}) {
    ASSERT_EQ(run_weir({"convert", volume == z ? source : input_, "-o", volume, "--rate", "2"}).exit_code, 0);
  }
  for (const std::string& file : {y, z, z + ".json", source}) {
    const CommandResult result = run_weir({"compare", input_, x, "--vector", input_, y, source, z, "--trace", file});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "weir: --trace " + file + ": is an input or an output; choose another\n");
  }
}

TEST_F(TraceOption, TellsWhatIsVerified) {
  const std::string output = directory_ / "o.nvdb";
  ASSERT_EQ(run_weir({"convert", input_, "-o", output, "--rate", "2", "--encoding", "float"}).exit_code, 0);
  const CommandResult result = run_weir({"verify", output, "--trace", trace_});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Threads threads = read_trace(trace_);
  const auto file_bytes = static_cast<double>(std::filesystem::file_size(output));
  const Json sidecar = Json::parse(read_file(output + ".json"));
  EXPECT_EQ(bytes_of(threads, "digest"), file_bytes);
  EXPECT_EQ(bytes_of(threads, "hash"), file_bytes);
  EXPECT_EQ(bytes_of(threads, "decode"), sidecar["selection"]["leaves_kept"].get<double>() * 2048);
  EXPECT_LE(bytes_of(threads, "leaves"), file_bytes);
  Names inner = names_of(threads[0]);
  for (const char* pass : {"open", "leaves", "digest"}) EXPECT_EQ(inner.erase(pass), 1U) << pass;
  for (const auto& [thread, spans] : threads) {
    if (thread != 0) inner.merge(names_of(spans));
  }
  EXPECT_EQ(inner, (Names{"decode", "hash"}));
  for (const std::string& file : {output, output + ".json"}) {
    EXPECT_EQ(run_weir({"verify", output, "--trace", file}).err,
              "weir: --trace " + file + ": is an input or an output; choose another\n");
  }
  std::filesystem::resize_file(output, 10000);
  EXPECT_EQ(run_weir({"verify", output, "--trace", trace_}).exit_code, 3);
  EXPECT_EQ(names_of(read_trace(trace_)[0]), Names{"open"});
}

TEST_F(TraceOption, FailedOrInterruptedConversion_WritesACompleteTrace) {
  EXPECT_EQ(run_weir({"convert", input_, "-o", directory_ / "o.nvdb", "--size", "1", "--trace", trace_}).exit_code, 4);
  Threads threads = read_trace(trace_);
  EXPECT_EQ(bytes_of(threads, "read"), 4 * kVoxels);
  EXPECT_TRUE(names_of(threads[0]).contains("select"));
  EXPECT_FALSE(names_of(threads[0]).contains("encode pass"));

  const std::string zeros = directory_ / "zeros_1024x1024x1024_uint8.raw";
  write_file(zeros, "");
  std::filesystem::resize_file(zeros, std::uintmax_t{1} << 30U);
  ChildProcess child({WEIR_COMMAND, "convert", zeros, "-o", directory_ / "z.nvdb", "--threads", "1", "--save-interval",
                      "0", "--trace", trace_});
  while (child.running() && !std::filesystem::exists(directory_ / ".z.nvdb.work/journal")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  child.send_signal(SIGINT);
  EXPECT_EQ(child.wait().exit_code, 130);
  threads = read_trace(trace_);
  EXPECT_TRUE(names_of(threads[0]).contains("survey pass"));
  EXPECT_TRUE(names_of(threads[0]).contains("save")) << "waited for at the end";
}

TEST_F(TraceOption, TraceOverAnInputOrOutput_IsRefused) {
  for (const std::string& file : {input_, directory_ / "o.nvdb", directory_ / "o.nvdb.json"}) {
    const CommandResult result =
        run_weir({"convert", input_, "-o", directory_ / "o.nvdb", "--overwrite", "--trace", file});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "weir: --trace " + file + ": is an input or an output; choose another\n");
  }
  EXPECT_EQ(std::filesystem::file_size(input_), static_cast<std::uintmax_t>(4 * kVoxels));
}

TEST_F(TraceOption, FileThatIsNoTrace_IsRefusedAndATraceIsReplaced) {
  const std::string output = directory_ / "o.nvdb";
  ASSERT_EQ(run_weir({"convert", input_, "-o", output, "--rate", "2"}).exit_code, 0);
  const std::string picture = directory_ / "cloud.png";
  const std::string refused = "weir: --trace " + picture + ": exists and is no trace; choose another\n";
  write_file(picture, "a picture");
  const std::vector<std::vector<std::string>> commands{
      {"verify", output}, {"compare", input_, output}, {"convert", input_, "-o", output, "--rate", "2", "--overwrite"}};
  for (std::vector<std::string> arguments : commands) {
    arguments.insert(arguments.end(), {"--trace", picture});
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, refused);
  }
  EXPECT_EQ(read_file(picture), "a picture");
  write_file(trace_, "");
  EXPECT_EQ(run_weir({"compare", input_, output, "--trace", trace_}).exit_code, 0) << "one that never began";
  EXPECT_EQ(names_of(read_trace(trace_).at(0)), Names{"compare"});
  EXPECT_EQ(run_weir({"verify", output, "--trace", trace_}).exit_code, 0);
  EXPECT_TRUE(names_of(read_trace(trace_).at(0)).contains("digest"));
  EXPECT_EQ(run_weir({"verify", output, "--trace", "/dev/null"}).exit_code, 0);
}

}  // namespace
}  // namespace weir::trace_option_test
