#include "daemon/config/watch_options.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::watch_options_test {
namespace {

const std::string kPath = "/etc/weir/c.toml";
using Arguments = std::vector<std::string>;

Arguments read(const std::string& text, const std::string& path = kPath) {
  const toml::table table = parse_toml(text, path);
  TomlReader reader(table, "[[watch]]", path);
  const Arguments arguments = read_watch_options(reader, table);
  reader.finish();
  return arguments;
}

std::string refusal(const std::string& text) {
  try {
    read(text);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
}

TEST(WatchOptions, KeysBecomeCommandLineOptions) {
  EXPECT_EQ(read(""), Arguments{});
  EXPECT_EQ(read("lossless = true\ndims = '64,64,64'\nnonfinite = 'keep'\ndirect_io = 'off'"),
            (Arguments{"--dims=64,64,64", "--direct-io=off", "--nonfinite=keep", "--lossless"}));
  EXPECT_EQ(read("lossless = false\nrate = 4"), Arguments{"--rate=4"});
  EXPECT_EQ(read("component = 2"), Arguments{"--component=2"});
  EXPECT_EQ(read("component = 'magnitude'"), Arguments{"--component=magnitude"});
}

TEST(WatchOptions, Backend_IsAKey) {
  EXPECT_EQ(read("backend = 'cpu'"), Arguments{"--backend=cpu"});
  EXPECT_EQ(read("encoding = 'packed'\nbackend = 'cuda'"), (Arguments{"--encoding=packed", "--backend=cuda"}));
  EXPECT_EQ(refusal("backend = 'gpu'"), "/etc/weir/c.toml:1:11: backend is \"gpu\", it must be auto, cpu or cuda");
  EXPECT_EQ(refusal("rate = 4\nbackend = 'cuda'"),
            "/etc/weir/c.toml:2:11: backend cuda converts to encoding packed alone; give that, or use backend auto");
}

TEST(WatchOptions, RelativeScenesStartAtTheConfigurationFile) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory / "looks");
  for (const char* name : {"looks/a.toml", "a.toml"}) write_file(directory / name, "[volume]\niso = 1\n");
  EXPECT_EQ(read("scene = 'looks/a.toml'", directory / "c.toml"), Arguments{"--scene=" + (directory / "looks/a.toml")});
  EXPECT_EQ(read("scene = '../a.toml'", directory / "looks/c.toml"), Arguments{"--scene=" + (directory / "a.toml")});
  EXPECT_EQ(read("scene = '" + (directory / "a.toml") + "'"), Arguments{"--scene=" + (directory / "a.toml")});
}

TEST(WatchOptions, SceneThatIsAPipe_IsRefused) {
  const TemporaryDirectory directory;
  const std::string pipe = directory / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal("rate = 4\nscene = '" + pipe + "'"),
            "/etc/weir/c.toml:2:9: " + pipe +
                ": is no regular file, and weir watch reads it again at each reload; name a file");
}

TEST(WatchOptions, NumbersKeepAllTheirDigits) {
  EXPECT_EQ(read("size = 9007199254740993"), Arguments{"--size=9007199254740993"});
  EXPECT_EQ(read("background = -0.1"), Arguments{"--background=-0.1"});
  EXPECT_EQ(read("max_error = 1e-16"), Arguments{"--max-error=1e-16"});
  EXPECT_EQ(read("missing = nan"), Arguments{"--missing=nan"});
  EXPECT_EQ(read("missing_policy = 'background'"), Arguments{"--missing-policy=background"});
  EXPECT_EQ(read("spacing = [64, 32, 0.5]"), Arguments{"--spacing=64,32,0.5"});
  EXPECT_EQ(read("roi = ['0:8', '0:8', '2:4']"), Arguments{"--roi=0:8,0:8,2:4"});
}

TEST(WatchOptions, DatasetsAreAnArgumentEach) {
  EXPECT_EQ(read("dataset = ['/rho', '/fields/T']"), (Arguments{"--dataset=/rho", "--dataset=/fields/T"}));
  EXPECT_EQ(read("dataset = '*'"), Arguments{"--dataset=*"});
}

TEST(WatchOptions, EmptyTextsAreNotGiven) {
  EXPECT_EQ(read("dataset = ''\nscene = ''\nrate = 4"), Arguments{"--rate=4"});
}

TEST(WatchOptions, RefusesWrongTypesAndUnknownKeys) {
  EXPECT_EQ(refusal("lossless = 1"), "/etc/weir/c.toml:1:12: lossless must be true or false");
  EXPECT_EQ(refusal("max_error = true"),
            "/etc/weir/c.toml:1:13: max_error must be a string, a number or an array of them");
  EXPECT_EQ(refusal("dims = []"), "/etc/weir/c.toml:1:8: dims must be a string, a number or an array of them");
  EXPECT_EQ(refusal("dims = [[1], 2]"), "/etc/weir/c.toml:1:9: dims must not be an array of arrays");
  EXPECT_EQ(refusal("dims = 1979-05-27"), "/etc/weir/c.toml:1:8: dims must be a string, a number or an array of them");
  EXPECT_EQ(refusal("max-error = 1").substr(0, 69),
            "/etc/weir/c.toml:1:1: unknown key \"max-error\" in [[watch]]; there are");
  EXPECT_EQ(refusal("stack = true").substr(0, 55), "/etc/weir/c.toml:1:1: unknown key \"stack\" in [[watch]];")
      << "the job of a watch is one file";
}

TEST(WatchOptions, RefusalNamesThePlaceOfItsKey) {
  const std::string message = "size, rate, psnr, max_error and lossless exclude each other; give one";
  EXPECT_EQ(refusal("max_error = 1\nrate = 8\nbrick = 3"), "/etc/weir/c.toml:2:8: " + message);
  EXPECT_EQ(refusal("rate = 8\nmax_error = 1"), "/etc/weir/c.toml:2:13: " + message);
  EXPECT_EQ(refusal("rate = 8\nmetric = 'best'"),
            "/etc/weir/c.toml:2:10: metric is \"best\", it must be sse, farthest, closest or median");
  EXPECT_EQ(refusal("psnr = 60\nmetric = 'farthest'"),
            "/etc/weir/c.toml:2:10: metric farthest has no error target; psnr and max_error select by sse");
}

TEST(WatchOptions, SceneThatCannotBeUsed_IsReportedAtItsKeyWithItsOwnPlace) {
  EXPECT_EQ(refusal("rate = 8\nscene = 'none.toml'"),
            "/etc/weir/c.toml:2:9: /etc/weir/none.toml: cannot read the scene; it must be an existing TOML file");
  const TemporaryDirectory directory;
  write_file(directory / "s.toml", "[volume]\niso = 'high'\n");
  EXPECT_EQ(refusal("scene = '" + (directory / "s.toml") + "'"),
            cat("/etc/weir/c.toml:1:9: ", directory / "s.toml", ":2:7: iso is \"high\", it must be a number"));
}

}  // namespace
}  // namespace weir::watch_options_test
