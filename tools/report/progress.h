// Progress of a long command. People see it on stderr: on a terminal a bar with pass, share, rate and time left,
// otherwise one line every few seconds. Programs read JSON lines on a descriptor of their choice. Only one thread at a
// time may call it. stdout is never written.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace weir {

enum class ProgressMode {
  automatic,  ///< a bar on a terminal, otherwise a line every kLineInterval_s
  always,     ///< the same; without a terminal also a line at the end of every pass, however short
  never
};

/// Where progress is shown.
struct ProgressOptions {
  ProgressOptions(ProgressMode shown = ProgressMode::automatic) : mode(shown) {}
  ProgressMode mode;
  /// An open descriptor of the caller's, or -1. It receives announce() lines and, at the begin and end of a pass and
  /// every kBarInterval_s, {"pass": "survey", "done": 1048576, "total": 8388608, "unit": "bytes"}.
  int descriptor = -1;
};

/// What a pass counts.
enum class ProgressUnit { bytes, samples };

/// Seconds between two drawings of the bar, and between two lines without a terminal.
inline constexpr double kBarInterval_s = 0.1;
inline constexpr double kLineInterval_s = 5.0;

/// Returns "survey 43 % of 8.0 GiB, 1.32 GB/s, 0:04 left"; the rate is the mean since the pass began. For samples:
/// "render 43 % of 44.2 M samples, 1.32 M/s, 0:19 left". `done` above `total` counts as `total`; the time left is
/// absent while nothing is done.
std::string progress_text(const std::string& pass, std::uint64_t done, std::uint64_t total, double elapsed_s,
                          ProgressUnit unit = ProgressUnit::bytes);

class Progress {
 public:
  /// `clock_s` returns monotonic seconds; tests pass their own.
  explicit Progress(ProgressOptions options, std::FILE* out = stderr, std::function<double()> clock_s = {});
  /// Ends a bar that an exception left unfinished, so that the error message starts on a new line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins a pass over `total` units and finishes the previous pass.
  void start(const std::string& pass, std::uint64_t total, ProgressUnit unit = ProgressUnit::bytes);
  /// Reports that `done` units of the pass are done; cheap enough to call for every block.
  void update(std::uint64_t done);
  /// Completes the pass.
  void finish();

 private:
  void draw();
  void tell();
  void end_bar();

  ProgressOptions options_;
  std::FILE* out_;
  std::function<double()> clock_s_;
  bool terminal_;
  bool running_ = false;
  bool bar_on_screen_ = false;
  std::string pass_;
  ProgressUnit unit_ = ProgressUnit::bytes;
  std::uint64_t total_ = 0;
  std::uint64_t done_ = 0;
  double started_s_ = 0;
  double drawn_s_ = 0;
  double told_s_ = 0;
};

/// Writes `line` and a newline to the descriptor of `options`, if it has one. A closed reader is no error.
void announce(const ProgressOptions& options, std::string line);

/// Adds --progress auto|always|never and --progress-fd N, stored in `options`.
void add_progress_options(CLI::App& command, ProgressOptions& options);

}  // namespace weir
