// Progress of a long command: for people on stderr, a bar with pass, share, rate
// and time left on a terminal, one line every few seconds elsewhere; for programs
// JSON lines on a descriptor of their choice. One thread at a time may call it.
// stdout is never written.
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
  automatic,  ///< a bar on a terminal, elsewhere a line every kLineInterval_s
  always,     ///< the same, and elsewhere a line at the end of every pass however short
  never
};

/// Where progress is shown.
struct ProgressOptions {
  ProgressOptions(ProgressMode shown = ProgressMode::automatic) : mode(shown) {}
  ProgressMode mode;
  /// An open descriptor of the caller's, or -1. At the begin and end of a pass and every kBarInterval_s
  /// {"pass": "survey", "done": 1048576, "total": 8388608, "unit": "bytes"} and what is announced.
  int descriptor = -1;
};

/// What a pass counts.
enum class ProgressUnit { bytes, samples };

/// Seconds between two drawings of the bar, and between two lines where there is no terminal.
inline constexpr double kBarInterval_s = 0.1;
inline constexpr double kLineInterval_s = 5.0;

/// "survey 43 % of 8.0 GiB, 1.32 GB/s, 0:04 left"; the rate is the mean since the pass began.
/// Samples: "render 43 % of 44.2 M samples, 1.32 M/s, 0:19 left".
/// `done` above `total` counts as `total`; the time left is absent while nothing is done.
std::string progress_text(const std::string& pass, std::uint64_t done, std::uint64_t total, double elapsed_s,
                          ProgressUnit unit = ProgressUnit::bytes);

class Progress {
 public:
  /// `clock_s` returns monotonic seconds; tests pass their own.
  explicit Progress(ProgressOptions options, std::FILE* out = stderr, std::function<double()> clock_s = {});
  /// Ends a bar that an exception left unfinished, so that the message starts on a line of its own.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins a pass over `total` units; finishes the one before.
  void start(const std::string& pass, std::uint64_t total, ProgressUnit unit = ProgressUnit::bytes);
  /// `done` units of the pass are done; cheap enough to be called for every block.
  void update(std::uint64_t done);
  /// The pass is complete.
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

/// Writes `line` and a newline to the descriptor of `options`, if it has one. A reader that has gone is no error.
void announce(const ProgressOptions& options, std::string line);

/// Adds --progress auto|always|never and --progress-fd N, stored in `options`.
void add_progress_options(CLI::App& command, ProgressOptions& options);

}  // namespace weir
