// What weir-mpi does where its processes are not given the same command line or input.
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bindings/mpi/run_mpi.h"
#include "tests/support/temporary_directory.h"

namespace weir::mpi_agreement_test {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

const std::string kVolume = "cloud_40x30x20_float32.raw";

std::size_t count_of(const std::string& text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class MpiAgreement : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(directory_ / "other");
    CommandOptions here;
    here.directory = directory_.path();
    const CommandResult made = run_weir(
        {"sample", "cloud", "--dims", "40,30,20", "--type", "float32", "-o", kVolume, "--log-level", "error"}, here);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

  // The volume with 7 added to each value.
  std::string raised() const {
    std::string bytes = read_file(directory_ / kVolume);
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, bytes.data() + at, sizeof value);
      value += 7;
      std::memcpy(bytes.data() + at, &value, sizeof value);
    }
    return bytes;
  }

  // What the second process finds by the same name, where it works in `other`.
  fs::path copy() const { return directory_.path() / "other" / kVolume; }

  // By two processes, of which the second works in `directory`.
  CommandResult run_two(const Words& first, const Words& second, const std::string& directory = ".") const {
    Words command{WEIR_MPI_COMMAND};
    command.insert(command.end(), first.begin(), first.end());
    command.insert(command.end(),
                   {":", "-n", "1", "sh", "-c", "cd \"$0\" && exec \"$@\"", directory, WEIR_MPI_COMMAND});
    command.insert(command.end(), second.begin(), second.end());
    return run_mpi(1, command, directory_.path());
  }

  // The command's one line, and nothing written.
  void expect_refused(const CommandResult& run, const std::string& line) const {
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(line_of(run.err, "weir-mpi"), "weir-mpi: " + line);
    EXPECT_EQ(count_of(run.err, "weir-mpi: "), 1U) << run.err;
    for (const std::string& name : list_directory(directory_.path())) {
      EXPECT_EQ(name.find("nvdb"), std::string::npos) << name;
    }
  }

  TemporaryDirectory directory_;
};

Words convert(const std::string& volume, const Words& options) {
  Words words{"convert", volume, "-o", "out.nvdb"};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

TEST_F(MpiAgreement, InputsOfTwoNames_AreRefused) {
  const std::string other = "raised_40x30x20_float32.raw";
  write_file(directory_ / other, raised());
  const Words options{"--max-error", "0.01"};
  expect_refused(run_two(convert(kVolume, options), convert(other, options)),
                 cat(other, ": process 1 of 2 has input ", other, " where process 0 has input ", kVolume,
                     "; give all processes the same volume, options and output"));
}

// As on two machines of which one has an older copy.
TEST_F(MpiAgreement, InputOfOtherValuesByTheSameNameSizeAndTime_IsRefused) {
  write_file(copy(), raised());
  fs::last_write_time(copy(), fs::last_write_time(directory_ / kVolume));
  const Words words{"convert", kVolume, "-o", directory_ / "out.nvdb", "--max-error", "0.01"};
  const CommandResult run = run_two(words, words, "other");
  const std::string line = line_of(run.err, "weir-mpi");
  const std::string begin = cat(kVolume, ": process 1 of 2 has input with bytes of digest ");
  ASSERT_TRUE(line.starts_with("weir-mpi: " + begin)) << run.err;
  EXPECT_NE(line.find(" where process 0 has input with bytes of digest "), std::string::npos) << run.err;
  expect_refused(run, line.substr(line.find(begin)));
}

TEST_F(MpiAgreement, CopyOfTheInputWithAnotherTime_IsConverted) {
  fs::copy_file(directory_ / kVolume, copy());
  fs::last_write_time(copy(), fs::last_write_time(directory_ / kVolume) - std::chrono::hours(1));
  const Words words{"convert", kVolume, "-o", directory_ / "out.nvdb", "--max-error", "0.01"};
  const CommandResult run = run_two(words, words, "other");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const CommandResult verified = run_weir({"verify", directory_ / "out.nvdb"});
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

TEST_F(MpiAgreement, OtherOptions_AreRefused) {
  const auto refuses = [&](const Words& first, const Words& second, const std::string& difference) {
    expect_refused(
        run_two(convert(kVolume, first), convert(kVolume, second)),
        cat(kVolume, ": process 1 of 2 has ", difference, "; give all processes the same volume, options and output"));
  };
  refuses({"--rate", "2"}, {"--rate", "4"}, "--rate 4 where process 0 has --rate 2");
  refuses({"--rate", "2", "--fill", "mean"}, {"--rate", "2"}, "no --fill where process 0 has --fill mean");
  refuses({"--rate", "2"}, {"--rate", "2", "--roi", "0:40,0:30,0:10"},
          "--roi 0:40,0:30,0:10 where process 0 has no --roi");
  refuses({"--rate", "2"}, {"--rate", "2", "--overwrite"}, "--overwrite on where process 0 has no --overwrite");
}

TEST_F(MpiAgreement, OtherMemoryAndThreads_AreAccepted) {
  const CommandResult run = run_two(convert(kVolume, {"--lossless", "--memory", "256MiB", "--threads", "1"}),
                                    convert(kVolume, {"--lossless", "--memory", "300MiB", "--threads", "2"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(MpiAgreement, WrongOption_IsSaidOnceByOneProcessOrAll) {
  const Words right = convert(kVolume, {"--max-error", "0.01"});
  const Words wrong = convert(kVolume, {"--max-eror", "0.01"});
  const std::string line = "no option --max-eror; did you mean --max-error? see weir-mpi convert --help";
  expect_refused(run_two(right, wrong), line);
  expect_refused(run_two(wrong, right), line);
  expect_refused(run_two(wrong, wrong), line);
}

TEST_F(MpiAgreement, HelpAndVersion_AreShownOnceByOneProcessOrAll) {
  const Words right = convert(kVolume, {"--max-error", "0.01"});
  const auto shows = [&](const Words& first, const Words& second, std::string_view text) {
    const CommandResult run = run_two(first, second);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(count_of(run.out, text), 1U) << run.out;
    EXPECT_FALSE(fs::exists(directory_ / "out.nvdb"));
  };
  const std::string_view help = "Converts one volume with all processes of an MPI job.";
  shows({"--help"}, {"--help"}, help);
  shows({"--help"}, right, help);
  shows(right, {"--help"}, help);
  const CommandResult version = run_two({"--version"}, {"--version"});
  EXPECT_EQ(version.exit_code, 0) << version.err;
  EXPECT_EQ(count_of(version.out, "\n"), 1U) << version.out;
}

}  // namespace
}  // namespace weir::mpi_agreement_test
