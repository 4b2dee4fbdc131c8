#include "tools/report/progress.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr int kBarWidth = 24;
constexpr const char* kClearLine = "\r\x1b[K";

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Returns a time as "0:04", "12:30" or "3:00:00".
std::string clock_text(double seconds) {
  const long whole = std::lround(std::min(seconds, 359999.0));
  std::array<char, 32> text{};
  if (whole >= 3600) {
    std::snprintf(text.data(), text.size(), "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  } else {
    std::snprintf(text.data(), text.size(), "%ld:%02ld", whole / 60, whole % 60);
  }
  return text.data();
}

double share(std::uint64_t done, std::uint64_t total) {
  return total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
}

}  // namespace

std::string progress_text(const std::string& pass, std::uint64_t done, std::uint64_t total, double elapsed_s,
                          ProgressUnit unit) {
  const bool bytes = unit == ProgressUnit::bytes;
  const double part = share(done, total);
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%.1f M samples", static_cast<double>(total) / 1e6);
  std::string text =
      cat(pass, ' ', static_cast<int>(part * 100), " % of ", bytes ? format_bytes(total) : std::string(number.data()));
  if (done == 0 || elapsed_s <= 0) return text;
  const double rate = static_cast<double>(std::min(done, total)) / elapsed_s;
  std::snprintf(number.data(), number.size(), bytes ? ", %.2f GB/s" : ", %.2f M/s", rate / (bytes ? 1e9 : 1e6));
  text += number.data();
  if (part < 1.0) text += cat(", ", clock_text(elapsed_s * (1.0 - part) / part), " left");
  return text;
}

Progress::Progress(ProgressOptions options, std::FILE* out, std::function<double()> clock_s)
    : options_(options),
      out_(out),
      clock_s_(clock_s ? std::move(clock_s) : steady_seconds),
      terminal_(isatty(fileno(out)) == 1) {
  if (options_.mode == ProgressMode::automatic && !spdlog::should_log(spdlog::level::info)) {
    options_.mode = ProgressMode::never;
  }
}

Progress::~Progress() { end_bar(); }

void Progress::start(const std::string& pass, std::uint64_t total, ProgressUnit unit) {
  finish();
  if (options_.mode == ProgressMode::never && options_.descriptor < 0) return;
  running_ = true;
  pass_ = pass;
  unit_ = unit;
  total_ = total;
  done_ = 0;
  started_s_ = drawn_s_ = clock_s_();
  tell();
}

void Progress::update(std::uint64_t done) {
  if (!running_) return;
  done_ = done;
  const double now_s = clock_s_();
  if (options_.descriptor >= 0 && now_s - told_s_ >= kBarInterval_s) tell();
  if (options_.mode == ProgressMode::never) return;
  if (now_s - drawn_s_ >= (terminal_ ? kBarInterval_s : kLineInterval_s)) draw();
}

void Progress::finish() {
  if (!running_) return;
  done_ = total_;
  tell();
  if (options_.mode == ProgressMode::always || (terminal_ && options_.mode != ProgressMode::never)) draw();
  end_bar();
  running_ = false;
}

void Progress::draw() {
  drawn_s_ = clock_s_();
  std::string line = progress_text(pass_, done_, total_, drawn_s_ - started_s_, unit_);
  if (terminal_) {
    const auto filled = static_cast<std::size_t>(share(done_, total_) * kBarWidth);
    line = cat(kClearLine, '[', std::string(filled, '#'), std::string(kBarWidth - filled, '.'), "] ", line);
    bar_on_screen_ = true;
  } else {
    line = cat("weir: ", line, '\n');
  }
  std::fputs(line.c_str(), out_);
  std::fflush(out_);
}

void Progress::tell() {
  if (options_.descriptor < 0) return;
  told_s_ = clock_s_();
  announce(options_, nlohmann::ordered_json{{"pass", pass_},
                                            {"done", std::min(done_, total_)},
                                            {"total", total_},
                                            {"unit", unit_ == ProgressUnit::bytes ? "bytes" : "samples"}}
                         .dump());
}

void Progress::end_bar() {
  if (!bar_on_screen_) return;
  std::fputc('\n', out_);
  std::fflush(out_);
  bar_on_screen_ = false;
}

void announce(const ProgressOptions& options, std::string line) {
  if (options.descriptor < 0) return;
  line += '\n';
  std::string_view rest = line;
  while (!rest.empty()) {
    const ssize_t written = ::write(options.descriptor, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return;  // the reader is gone; the work goes on
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

void add_progress_options(CLI::App& command, ProgressOptions& options) {
  const std::map<std::string, ProgressMode> modes{
      {"auto", ProgressMode::automatic}, {"always", ProgressMode::always}, {"never", ProgressMode::never}};
  command
      .add_option_function<std::string>(
          "--progress", [&options, modes](const std::string& name) { options.mode = modes.at(name); },
          "auto: a bar on a terminal, elsewhere a line every 5 s; always: a line for every pass too; never")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->default_str("auto");
  const auto is_open = [](const std::string& text) -> std::string {
    const auto descriptor = parse_int(text);
    if (descriptor && *descriptor >= 0 && *descriptor <= INT_MAX &&
        ::fcntl(static_cast<int>(*descriptor), F_GETFD) >= 0)
      return {};
    return cat("\"", text, "\" is not the number of an open descriptor");
  };
  command.add_option("--progress-fd", options.descriptor, "also as JSON lines, to this open descriptor")
      ->type_name("N")
      ->check(CLI::Validator(is_open, ""));
}

}  // namespace weir
