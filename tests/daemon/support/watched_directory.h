// A real directory that a test watches, and the events that were reported.
#pragma once

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/watch/choosing_watch.h"
#include "daemon/watch/inotify.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir {

/// An inotify that must not be used.
inline OpenInotify no_inotify() {
  return []() -> std::unique_ptr<Inotify> { throw std::logic_error("inotify was used"); };
}

class WatchedDirectory {
 public:
  using Kind = FileEventKind;

  explicit WatchedDirectory(WatchMethod method) {
    std::filesystem::create_directory(root());
    config.directory = root();
    config.recursive = true;
    config.include = {"*.raw"};
    config.watch = method;
    // Polling must not find a change that inotify fails to report.
    config.poll_interval_s = method == WatchMethod::poll ? 0.02 : 3600;
    open_inotify = method == WatchMethod::poll ? no_inotify() : open_system_inotify;
  }

  std::string root() const { return temporary_ / "in"; }
  /// Returns the path of `name` in the watched directory.
  std::string operator/(std::string_view name) const { return root() + "/" + std::string(name); }
  /// Returns the path of `name` beside the watched directory.
  std::string outside(std::string_view name) const { return temporary_ / name; }

  void start() {
    watch = make_directory_watch(io, config,
                                 {[this](const FileEvent& event) { events.push_back(event); },
                                  [this](const std::string& line) { notices.push_back(line); }},
                                 open_inotify);
  }
  /// Watches until `enough` returns true, for at most 10 s. Returns whether it did.
  bool run_until(const std::function<bool()>& enough) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    io.restart();
    while (!enough()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      io.run_one_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  void run_for(std::chrono::milliseconds time) {
    io.restart();
    io.run_for(time);
  }
  /// Waits until everything that was there at the call has been looked at and is watched.
  bool settle() {
    write_file(*this / "settled.raw", "x");
    const bool told = run_until([this] { return last(*this / "settled.raw").has_value(); });
    run_for(std::chrono::milliseconds(60));
    std::filesystem::remove(*this / "settled.raw");
    const bool gone = run_until([this] { return last(*this / "settled.raw") == Kind::removed; });
    events.clear();
    return told && gone;
  }
  bool told(Kind kind, const std::string& path) const {
    return std::find(events.begin(), events.end(), FileEvent{kind, path}) != events.end();
  }
  bool run_until_told(Kind kind, const std::string& path) {
    return run_until([&] { return told(kind, path); });
  }
  /// Waits for the event that the file is there with its content: closed with inotify, found with polling.
  bool run_until_written(const std::string& path) {
    return run_until_told(config.watch == WatchMethod::poll ? Kind::found : Kind::closed, path);
  }
  std::optional<Kind> last(const std::string& path) const {
    for (auto event = events.rbegin(); event != events.rend(); ++event) {
      if (event->path == path) return event->kind;
    }
    return std::nullopt;
  }
  std::vector<Kind> kinds(const std::string& path) const {
    std::vector<Kind> kinds;
    for (const FileEvent& event : events) {
      if (event.path == path) kinds.push_back(event.kind);
    }
    return kinds;
  }

 private:
  TemporaryDirectory temporary_;

 public:
  WatchConfig config;
  OpenInotify open_inotify;
  boost::asio::io_context io;
  std::vector<FileEvent> events;
  std::vector<std::string> notices;
  std::unique_ptr<DirectoryWatch> watch;
};

}  // namespace weir
