// Tests signals during a conversion. The exit code is 130. The output's directory keeps its former files and, of the
// conversion, only the work that the same command continues. The continued conversion gives the same bytes.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "tests/support/run_command.h"

namespace weir::interrupt_test {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

/// Converts `volume` to out/volume.nvdb below `directory` and sends `signal` as soon as `now` returns true.
CommandResult interrupt(const TemporaryDirectory& directory, const std::string& volume, int signal,
                        const std::function<bool()>& now, const Names& options = {}) {
  Names command{WEIR_COMMAND, "convert",     volume,      "-o", directory / "out/volume.nvdb",
                "--lossless", "--overwrite", "--threads", "1",  "--memory",
                "256MiB"};
  command.insert(command.end(), options.begin(), options.end());
  ChildProcess child(command);
  while (child.running() && !now()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(child.running()) << "the conversion was over before it could be interrupted";
  child.send_signal(signal);
  return child.wait();
}

/// Returns whether the KiB at `offset` of the file has a byte other than zero. Reserved space reads as zeros.
bool written_at(const fs::path& path, std::streamoff offset) {
  std::ifstream file(path, std::ios::binary);
  std::string piece(1024, '\0');
  file.seekg(offset).read(piece.data(), static_cast<std::streamsize>(piece.size()));
  return piece.find_first_not_of('\0') != std::string::npos;
}

std::string noise(std::size_t bytes) {
  std::string values(bytes, '\0');
  std::minstd_rand random;
  for (char& value : values) value = static_cast<char>(random() >> 16U);
  return values;
}

// Returns whether `text` is one line with this beginning. Lines of progress before it are ignored.
bool is_one_line(std::string_view text, std::string_view beginning) {
  for (const char* pass : {"weir: survey ", "weir: encode "}) {
    while (text.starts_with(pass)) text.remove_prefix(text.find('\n') + 1);
  }
  return text.starts_with(beginning) && text.find('\n') == text.size() - 1;
}

TEST(Interrupt, InTheSurveyLeavesNothing) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "out");
  // A gibibyte that takes no disk space. Reading it takes so long that the signal arrives during the conversion.
  const std::string volume = directory / "zeros_1024x1024x1024_uint8.raw";
  write_file(volume, "");
  fs::resize_file(volume, std::uintmax_t{1} << 30U);
  for (const int signal : {SIGINT, SIGTERM}) {
    const CommandResult result = interrupt(
        directory, volume, signal, [&] { return !list_directory(directory / "out").empty(); }, {"--resume", "off"});
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_TRUE(is_one_line(result.err, "weir: interrupted")) << result.err;
    EXPECT_EQ(list_directory(directory / "out"), Names{});
  }
}

TEST(Interrupt, InTheEncodePass_KeepsTheOldOutput) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "out");
  const std::string volume = directory / "noise_512x512x128_uint8.raw";
  write_file(volume, noise(std::size_t{512} * 512 * 128));
  write_file(directory / "out/volume.nvdb", "the old volume");
  write_file(directory / "out/volume.nvdb.json", "the old sidecar");

  const CommandResult result = interrupt(directory, volume, SIGINT, [&] {
    return written_at(directory / "out/volume.nvdb.partial",
                      16 << 20);  // the file has 135 MiB; leaves begin at 1.4 MiB
  });
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_TRUE(is_one_line(result.err, "weir: interrupted")) << result.err;
  EXPECT_EQ(list_directory(directory / "out"), (Names{"volume.nvdb", "volume.nvdb.json"}));
  EXPECT_EQ(read_file(directory / "out/volume.nvdb"), "the old volume");
  EXPECT_EQ(read_file(directory / "out/volume.nvdb.json"), "the old sidecar");
}

TEST(Interrupt, KeepsALargeConversionThatTheSameCommandContinues) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "out");
  const std::string volume = directory / "zeros_1024x1024x1024_uint8.raw";
  write_file(volume, "");
  fs::resize_file(volume, std::uintmax_t{1} << 30U);
  const CommandResult result =
      interrupt(directory, volume, SIGINT, [&] { return fs::exists(directory / "out/.volume.nvdb.work/journal"); },
                {"--save-interval", "0"});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, "weir: interrupted; what is done is kept in " + (directory / "out/.volume.nvdb.work") +
                            ", the same command continues it\n");
  EXPECT_EQ(list_directory(directory / "out"),
            (Names{".volume.nvdb.work/", ".volume.nvdb.work/journal", ".volume.nvdb.work/rows"}));
}

// The signal comes long before the first save is due, while the conversion waits for its bandwidth.
TEST(Interrupt, WithABandwidthLimit_KeepsTheFinishedPart) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "out");
  const std::string volume = directory / "zeros_1024x1024x1024_uint8.raw";
  write_file(volume, "");
  fs::resize_file(volume, std::uintmax_t{1} << 30U);
  const fs::path work = directory / "out/.volume.nvdb.work";
  const CommandResult result = interrupt(directory, volume, SIGINT, [&] { return written_at(work / "rows", 0); },
                                         {"--bandwidth", "10MB", "--save-interval", "3600"});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err,
            "weir: interrupted; what is done is kept in " + work.string() + ", the same command continues it\n");
  EXPECT_EQ(list_directory(directory / "out"),
            (Names{".volume.nvdb.work/", ".volume.nvdb.work/journal", ".volume.nvdb.work/rows"}));
}

TEST(Interrupt, KilledRepeatedly_EndsWithTheSameBytes) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "out");
  const std::string volume = directory / "noise_512x512x512_uint8.raw";
  write_file(volume, noise(std::size_t{512} * 512 * 512));
  const Names command{"convert", volume, "--overwrite", "--lossless", "--json", "-o"};
  const auto convert_to = [&](const std::string& output, const Names& options) {
    Names arguments = command;
    arguments.push_back(directory / output);
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_weir(arguments);
  };
  const CommandResult expected = convert_to("expected.nvdb", {});
  ASSERT_EQ(expected.exit_code, 0) << expected.err;

  const fs::path work = directory / "out/.volume.nvdb.work";
  const Names resumable{"--resume", "on", "--save-interval", "0"};
  const auto kill = [&](const std::function<bool()>& now) {
    const CommandResult result = interrupt(directory, volume, SIGKILL, now, resumable);
    EXPECT_EQ(result.exit_code, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(directory / "out/volume.nvdb"));
    return result.err;
  };
  kill([&] { return fs::exists(work / "journal"); });
  // The encode pass saves once, half way through z. In the file, regions follow each other along z first. They begin at
  // 2.4 MiB and have 2.4 MiB each.
  kill([&] { return written_at(work / "volume", 4 << 20); });
  EXPECT_NE(kill([&] { return written_at(work / "volume", 11 << 20); }).find("continues a conversion"),
            std::string::npos);
  const CommandResult result = convert_to("out/volume.nvdb", {"--resume", "on", "--memory", "300MiB"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("continues a conversion that was interrupted, survey 100 %, encode "), std::string::npos);
  EXPECT_EQ(list_directory(directory / "out"), (Names{"volume.nvdb", "volume.nvdb.json"}));
  EXPECT_TRUE(read_file(directory / "out/volume.nvdb") == read_file(directory / "expected.nvdb"));
  nlohmann::json done = nlohmann::json::parse(result.out);
  nlohmann::json whole = nlohmann::json::parse(expected.out);
  EXPECT_LT(done["timing"]["bytes_read"].get<std::uint64_t>(), whole["timing"]["bytes_read"].get<std::uint64_t>() / 2);
  for (nlohmann::json* record : {&done, &whole}) {
    record->erase("timing");
    (*record)["weir"].erase("options");
  }
  EXPECT_EQ(done, whole);
}

}  // namespace
}  // namespace weir::interrupt_test
