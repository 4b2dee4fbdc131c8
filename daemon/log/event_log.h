// The daemon's log. Each event is one line, "NAME key=value ...", that people can read and programs can parse. One
// thread.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/config/config.h"
#include "format/base/text.h"

namespace spdlog {
class logger;
}

namespace weir {

/// A key and its value as text.
struct Field {
  template <typename T>
  Field(std::string_view name, const T& content) : key(name), value(cat(content)) {}
  std::string_view key;
  std::string value;
};

/// Returns the line of an event, for example "done job=7 source=\"/in/a b.raw\"". A value with a space, a quote, an
/// equals sign or a character that is not plain (plain_bytes) is quoted. Quotes and backslashes inside get a
/// backslash, and each byte that is not plain becomes \n or \x1b, so that an event stays one line of UTF-8.
std::string event_text(std::string_view name, std::initializer_list<Field> fields);

class EventLog {
 public:
  /// Logs to service.log_file, rotated at log_size, or to stderr. Throws Error(io) if the file cannot be opened.
  explicit EventLog(const ServiceConfig& service);

  /// Opens the file of `service` anew (another program may have renamed the old one) and takes its level. Throws like
  /// the constructor; in this case the old log stays in use.
  void reopen(const ServiceConfig& service);

  /// Each writes one event. An event that cannot be written, for example on a full disk, is counted and lost. The
  /// first loss is reported on stderr. The next event that can be written follows a line `log-lost lines=N`.
  void debug(std::string_view name, std::initializer_list<Field> fields) const;
  void info(std::string_view name, std::initializer_list<Field> fields) const;
  void warn(std::string_view name, std::initializer_list<Field> fields) const;
  void error(std::string_view name, std::initializer_list<Field> fields) const;

  /// Returns the number of lines lost since the beginning.
  std::uint64_t lines_lost() const { return lost_; }

 private:
  /// `level` is one of spdlog::level::level_enum.
  void write(int level, std::string_view name, std::initializer_list<Field> fields) const;
  bool try_write(int level, const std::string& line) const;
  bool say_lost(int level) const;

  /// The fault of the last line. The logger writes it.
  std::shared_ptr<std::string> fault_ = std::make_shared<std::string>();
  mutable std::uint64_t lost_ = 0;
  mutable std::uint64_t unsaid_ = 0;  ///< lost lines that no log-lost line has reported yet
  std::string file_;                  ///< empty: stderr
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace weir
