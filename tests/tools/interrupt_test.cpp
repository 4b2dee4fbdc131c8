// Signals during a conversion: exit code 130, and the output's directory keeps nothing of it, or what it held
// before.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <random>
#include <thread>

#include "tests/tools/run_command.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

/// Converts `volume` to out/volume.nvdb below `directory` and sends `signal` as soon as `now` holds.
CommandResult interrupt(const TemporaryDirectory& directory, const std::string& volume, int signal,
                        const std::function<bool()>& now) {
  ChildProcess child({WEIR_COMMAND, "convert", volume, "-o", directory / "out/volume.nvdb", "--lossless", "--overwrite",
                      "--threads", "1", "--memory", "256MiB"});
  while (child.running() && !now()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(child.running()) << "the conversion was over before it could be interrupted";
  child.send_signal(signal);
  return child.wait();
}

/// Whether the file holds a byte other than zero in the KiB at `offset`: reserved space reads as zeros.
bool written_at(const fs::path& path, std::streamoff offset) {
  std::ifstream file(path, std::ios::binary);
  std::string piece(1024, '\0');
  file.seekg(offset).read(piece.data(), static_cast<std::streamsize>(piece.size()));
  return piece.find_first_not_of('\0') != std::string::npos;
}

bool is_one_line(const std::string& text, std::string_view beginning) {
  return text.starts_with(beginning) && text.find('\n') == text.size() - 1;
}

TEST(Interrupt, InTheSurveyLeavesNothing) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "out");
  // A gibibyte that takes no disk, and long enough to read that the signal meets the conversion at work.
  const std::string volume = directory / "zeros_1024x1024x1024_uint8.raw";
  write_file(volume, "");
  fs::resize_file(volume, std::uintmax_t{1} << 30U);
  for (const int signal : {SIGINT, SIGTERM}) {
    const CommandResult result =
        interrupt(directory, volume, signal, [&] { return !list_directory(directory / "out").empty(); });
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_TRUE(is_one_line(result.err, "weir: interrupted")) << result.err;
    EXPECT_EQ(list_directory(directory / "out"), Names{});
  }
}

TEST(Interrupt, InTheEncodePassKeepsWhatWasThere) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "out");
  const std::string volume = directory / "noise_512x512x128_uint8.raw";
  std::string noise(std::size_t{512} * 512 * 128, '\0');
  std::minstd_rand random;
  for (char& value : noise) value = static_cast<char>(random() >> 16U);
  write_file(volume, noise);
  write_file(directory / "out/volume.nvdb", "the old volume");
  write_file(directory / "out/volume.nvdb.json", "the old sidecar");

  const CommandResult result = interrupt(directory, volume, SIGINT, [&] {
    return written_at(directory / "out/volume.nvdb.partial", 16 << 20);  // of 135 MiB, leaves from 1.4 MiB on
  });
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_TRUE(is_one_line(result.err, "weir: interrupted")) << result.err;
  EXPECT_EQ(list_directory(directory / "out"), (Names{"volume.nvdb", "volume.nvdb.json"}));
  EXPECT_EQ(read_file(directory / "out/volume.nvdb"), "the old volume");
  EXPECT_EQ(read_file(directory / "out/volume.nvdb.json"), "the old sidecar");
}

}  // namespace
}  // namespace weir
