// Records spans of work, thread by thread, as Chrome trace events for chrome://tracing and ui.perfetto.dev, to show
// where the time goes. Events go to the file through a buffer as they come. So a long run takes no more memory than a
// short one, and a killed run leaves a file that both viewers still read. Thread-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace weir {

class Trace {
 public:
  using Clock = std::chrono::steady_clock;

  /// Creates or replaces the file `path`. Throws Error(io).
  explicit Trace(const std::string& path);
  /// Completes the file; reports no errors.
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  /// Adds a span of the calling thread called `name` (letters and spaces). `bytes` is the amount of data it handled; 0:
  /// not counted.
  void add(const char* name, Clock::time_point begin, Clock::time_point end, std::uint64_t bytes);

  /// Completes the file. Throws Error(io) if any of it could not be written. Nothing may be added afterwards.
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::unique_ptr<std::FILE, Close> file_;
  std::map<std::thread::id, int> threads_;  // numbered in the order of their first span
};

/// A span that begins and ends with this object. Costs nothing if `trace` is null.
class TraceSpan {
 public:
  TraceSpan(Trace* trace, const char* name, std::uint64_t bytes = 0) : trace_(trace), name_(name), bytes_(bytes) {
    if (trace_ != nullptr) begin_ = Trace::Clock::now();
  }
  ~TraceSpan() {
    if (trace_ != nullptr) trace_->add(name_, begin_, Trace::Clock::now(), bytes_);
  }
  TraceSpan(const TraceSpan&) = delete;
  TraceSpan& operator=(const TraceSpan&) = delete;

 private:
  Trace* trace_;
  const char* name_;
  std::uint64_t bytes_;
  Trace::Clock::time_point begin_;
};

}  // namespace weir
