// Tests weir sample as a user runs it: files, exit codes, messages, and the files that a failure leaves behind.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ingest/synthetic/synthetic.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"
#include "tests/support/scoped_mount.h"

namespace weir::sample_test {
namespace {

std::string expected_bytes(std::string_view kind, const Index3& extent, std::uint64_t seed) {
  const auto source = open_synthetic(kind, {extent, seed});
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  source->read(source->info().domain(), values);
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

void expect_refusal(const CommandResult& result, int exit_code, const std::string& message) {
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_EQ(result.err, "weir: " + message + "\n");
  EXPECT_EQ(result.out, "");
}

TEST(Sample, WritesTheValuesOfTheSyntheticSource) {
  const TemporaryDirectory directory;
  const CommandResult result = run_weir(
      {"sample", "cloud", "--dims", "70,45,37", "--seed", "7", "-o", directory / "a.raw", "--log-level", "off"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(read_file(directory / "a.raw"), expected_bytes("cloud", {70, 45, 37}, 7));
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{"a.raw"});
}

TEST(Sample, WritesAFileOfEveryKind) {
  const TemporaryDirectory directory;
  for (const SyntheticKind& kind : synthetic_kinds()) {
    const std::string path = directory / (std::string(kind.name) + "_9x8x7_float32.raw");
    const CommandResult result = run_weir({"sample", std::string(kind.name), "-o", path});
    EXPECT_EQ(result.exit_code, 0) << kind.name << result.err;
    EXPECT_EQ(read_file(path), expected_bytes(kind.name, {9, 8, 7}, 1)) << kind.name;
  }
}

TEST(Sample, SeedThatIsNoneIsRefused) {
  for (const char* seed : {"-1", "18446744073709551616", "1.5"}) {
    const CommandResult result = run_weir({"sample", "noise", "--dims", "8,8,8", "--seed", seed, "-o", "a.raw"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err,
              cat("weir: --seed is \"", seed, "\", it must be a whole number from 0 to 18446744073709551615\n"));
  }
}

TEST(Sample, SameBytesWhateverThreadsAndMemory) {
  const TemporaryDirectory directory;
  const std::vector<std::vector<std::string>> ways{
      {"--threads", "1"}, {"--threads", "7"}, {"--memory", "64MiB"}, {"--memory", "3GiB"}};
  const std::string expected = expected_bytes("turbulence", {200, 200, 200}, 1);
  for (const auto& way : ways) {
    std::vector<std::string> arguments{"sample",      "turbulence", "--dims",           "200,200,200",
                                       "--overwrite", "-o",         directory / "a.raw"};
    arguments.insert(arguments.end(), way.begin(), way.end());
    ASSERT_EQ(run_weir(arguments).exit_code, 0);
    EXPECT_TRUE(read_file(directory / "a.raw") == expected) << way[0] << ' ' << way[1];
  }
}

TEST(Sample, TypesAndByteOrder) {
  const TemporaryDirectory directory;
  ASSERT_EQ(
      run_weir({"sample", "checkerboard", "--dims", "3,1,1", "--type", "uint8", "-o", directory / "a.raw"}).exit_code,
      0);
  EXPECT_EQ(read_file(directory / "a.raw"), std::string("\x00\xff\x00", 3));
  ASSERT_EQ(run_weir({"sample", "checkerboard", "-o", directory / "b_3x1x1_int16be.raw"}).exit_code, 0);
  EXPECT_EQ(read_file(directory / "b_3x1x1_int16be.raw"), std::string("\x00\x00\x7f\xff\x00\x00", 6));
  ASSERT_EQ(run_weir({"sample", "checkerboard", "--dims", "2,1,1", "--type", "float64", "--endian", "big", "-o",
                      directory / "c.raw"})
                .exit_code,
            0);
  EXPECT_EQ(read_file(directory / "c.raw"), std::string(8, '\0') + std::string("\x3f\xf0\0\0\0\0\0\0", 8));
}

TEST(Sample, JsonIsAllOfStdout) {
  const TemporaryDirectory directory;
  const CommandResult result =
      run_weir({"sample", "noise", "--dims", "20,30,40", "--type", "uint16", "--json", "-o", directory / "a.raw"});
  ASSERT_EQ(result.exit_code, 0);
  nlohmann::json report = nlohmann::json::parse(result.out);
  EXPECT_GT(report["total_s"].get<double>(), 0.0);
  EXPECT_GT(report["peak_rss_bytes"].get<std::uint64_t>(), 1000000U);
  report.erase("total_s");
  report.erase("peak_rss_bytes");
  EXPECT_EQ(report, (nlohmann::json{{"output", directory / "a.raw"},
                                    {"kind", "noise"},
                                    {"extent", {20, 30, 40}},
                                    {"type", "uint16"},
                                    {"endian", "little"},
                                    {"seed", 1},
                                    {"bytes", 48000}}));
}

TEST(Sample, HelpListsTheKinds) {
  const CommandResult result = run_weir({"sample", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const SyntheticKind& kind : synthetic_kinds()) {
    EXPECT_NE(result.out.find(std::string(kind.description)), std::string::npos) << kind.name;
  }
}

TEST(Sample, ProgressAlwaysSaysThePass) {
  const TemporaryDirectory directory;
  const CommandResult result = run_weir({"sample", "zero", "--dims", "64,64,64", "--progress", "always", "--log-level",
                                         "off", "-o", directory / "a.raw"});
  EXPECT_EQ(result.err.substr(0, 38), "weir: sample zero 100 % of 1.0 MiB, 0.");
}

TEST(Sample, BoundedMemory) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  for (const std::string dims : {"256,256,256", "640,640,512"}) {  // 64 MiB, 800 MiB
    const CommandResult result = run_weir(
        {"sample", "cloud", "--dims", dims, "--memory", "100MiB", "--json", "--overwrite", "-o", directory / "a.raw"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_LT(nlohmann::json::parse(result.out)["peak_rss_bytes"], std::uint64_t{100} << 20U) << dims;
  }
}

TEST(Sample, NamesThatContradictTheOptions) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a_8x8x8_float32.raw";
  const std::string remedy = "; drop the option or choose another name";
  expect_refusal(run_weir({"sample", "zero", "--dims", "8,8,9", "-o", path}), 2,
                 path + ": --dims 8,8,9 contradicts the file's name, which says 8x8x8" + remedy);
  expect_refusal(run_weir({"sample", "zero", "--type", "uint8", "-o", path}), 2,
                 path + ": --type uint8 contradicts the file's name, which says float32" + remedy);
  expect_refusal(run_weir({"sample", "zero", "--endian", "big", "-o", path}), 2,
                 path + ": --endian big contradicts the file's name, which says float32" + remedy);
  const std::string big = directory / "a_8x8x8_float32be.raw";
  expect_refusal(run_weir({"sample", "zero", "--endian", "little", "-o", big}), 2,
                 big + ": --endian little contradicts the file's name, which says float32be" + remedy);
  const std::string half = directory / "a_8x8x8_half.raw";
  expect_refusal(run_weir({"sample", "zero", "-o", half}), 2,
                 half +
                     ": unknown type 'half' in the file's name; it must be one of uint8, int8, uint16, int16, uint32, "
                     "int32, uint64, int64, float16, bfloat16, float32, float64, with be appended for big-endian");
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{});
}

TEST(Sample, BadArguments) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  expect_refusal(run_weir({"sample", "zero", "-o", path}), 2,
                 path + ": extent unknown; give --dims X,Y,Z or name it NAME_XxYxZ_TYPE.raw");
  expect_refusal(run_weir({"sample", "zero", "--dims", "0,8,8", "-o", path}), 2,
                 "--dims is \"0,8,8\", it must be X,Y,Z, three whole numbers of voxels, each from 1 to 2147483647");
  expect_refusal(run_weir({"sample", "zero", "--dims", "-8,8,8", "-o", path}), 2,
                 "--dims is \"-8,8,8\", it must be X,Y,Z, three whole numbers of voxels, each from 1 to 2147483647");
  expect_refusal(run_weir({"sample", "zero", "--dims", "8,8", "-o", path}), 2,
                 "--dims is \"8,8\", it must be X,Y,Z, three whole numbers of voxels");
  expect_refusal(run_weir({"sample", "nan", "--dims", "8,8,8", "--type", "uint8", "-o", path}), 2,
                 "kind 'nan' has values that are not finite, which uint8 cannot hold; use --type float32 or float64");
  const std::string flat = directory / "a_8x0x8_float32.raw";
  expect_refusal(run_weir({"sample", "zero", "-o", flat}), 2,
                 flat +
                     ": the name says 8x0x8; every axis must be 1 to 2147483647 and the volume below 2^60 voxels; "
                     "choose another name");
  expect_refusal(run_weir({"sample", "zero", "--dims", "8,8,8", "-o", "-"}), 2,
                 "-: cannot write to standard output: slabs are written in place; name a file, and stream that when it "
                 "is done");
  const CommandResult unknown = run_weir({"sample", "fog", "--dims", "8,8,8", "-o", path});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(unknown.err.starts_with("weir: kind of volume is \"fog\", it must be one of cloud, turbulenc"))
      << unknown.err;
  EXPECT_EQ(run_weir({"sample", "fog", "-o", path}).err, unknown.err) << "whatever else is wrong";
  EXPECT_EQ(run_weir({"sample", "zero", "--dims", "8,8,8"}).exit_code, 2);
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{});
}

TEST(Sample, KeepsAnExistingFileUnlessToldTo) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  write_file(path, "mine");
  expect_refusal(run_weir({"sample", "zero", "--dims", "1,1,1", "-o", path}), 2,
                 path + ": exists; choose another output or pass --overwrite");
  EXPECT_EQ(read_file(path), "mine");
  EXPECT_EQ(run_weir({"sample", "zero", "--dims", "1,1,1", "--overwrite", "-o", path}).exit_code, 0);
  EXPECT_EQ(read_file(path), std::string(4, '\0'));
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{"a.raw"});
}

TEST(Sample, MissingDirectory) {
  const TemporaryDirectory directory;
  const std::string path = directory / "none/a.raw";
  expect_refusal(
      run_weir({"sample", "zero", "--dims", "1,1,1", "-o", path}), 5,
      path + ": the directory " + (directory / "none") + " does not exist; make it or choose another output");
}

TEST(Sample, AVolumeThatNoDiskHoldsIsRefusedBeforeTheFirstByte) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  const CommandResult result = run_weir({"sample", "zero", "--dims", "65536,65536,16384", "-o", path});  // 256 TiB
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err.find("weir: " + path + ".partial: cannot "), 0U) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{});
}

TEST(Sample, InterruptLeavesNothing) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  ChildProcess child(
      {WEIR_COMMAND, "sample", "turbulence", "--dims", "1024,1024,1024", "-o", path, "--progress", "never"});
  while (child.running() && list_directory(directory.path()).empty()) usleep(1000);
  child.send_signal(SIGINT);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, "weir: " + path + ": interrupted; nothing was left behind\n");
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{});
}

TEST(Sample, InterruptKeepsWhatWasThereBefore) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  write_file(path, "mine");
  ChildProcess child({WEIR_COMMAND, "sample", "turbulence", "--dims", "1024,1024,1024", "-o", path, "--overwrite"});
  while (child.running() && list_directory(directory.path()).size() < 2) usleep(1000);
  child.send_signal(SIGTERM);
  EXPECT_EQ(child.wait().exit_code, 130);
  EXPECT_EQ(list_directory(directory.path()), std::vector<std::string>{"a.raw"});
  EXPECT_EQ(read_file(path), "mine");
}

TEST(Sample, FullDisk_OffersAnotherOutputAlone) {
  const TemporaryDirectory directory;
  const ScopedMount mount(directory.path(), 1 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  const std::string path = directory / "a.raw";
  expect_refusal(run_weir({"sample", "cloud", "--dims", "128,128,128", "-o", path}), 5,
                 path +
                     ".partial: cannot reserve 8388608 bytes: No space left on device; free space on that file "
                     "system or choose another with -o");
}

TEST(Sample, Help_OffersTheTypesThatItWrites) {
  std::string help = run_weir({"sample", "--help"}).out;
  std::erase(help, ' ');
  std::erase(help, '\n');
  EXPECT_NE(help.find("uint8,int8,uint16,int16,uint32,int32,float32orfloat64;default:"), std::string::npos) << help;
  EXPECT_EQ(help.find("float16"), std::string::npos) << help;
}

}  // namespace
}  // namespace weir::sample_test
