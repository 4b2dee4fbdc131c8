#include "daemon/log/event_log.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <array>
#include <cstdio>

#include "format/base/error.h"

namespace weir {
namespace {

std::string logfmt(std::string_view value) {
  const auto plain = [](char c) { return static_cast<unsigned char>(c) > ' ' && c != '"' && c != '=' && c != '\x7f'; };
  bool all_plain = !value.empty();
  for (const char c : value) all_plain = all_plain && plain(c);
  if (all_plain) return std::string(value);
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      text += cat('\\', c);
    } else if (c == '\n') {
      text += "\\n";
    } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
      std::array<char, 8> code{};
      std::snprintf(code.data(), code.size(), "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      text += code.data();
    } else {
      text += c;
    }
  }
  return text + '"';
}

std::shared_ptr<spdlog::logger> open_log(const ServiceConfig& service) {
  spdlog::sink_ptr sink;
  try {
    if (service.log_file.empty()) {
      sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    } else if (service.log_size == 0 || service.log_files == 0) {
      sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(service.log_file);
    } else {
      sink = std::make_shared<spdlog::sinks::rotating_file_sink_mt>(service.log_file, service.log_size,
                                                                    static_cast<std::size_t>(service.log_files));
    }
  } catch (const spdlog::spdlog_ex& error) {
    throw Error(ErrorKind::io, cat(service.log_file, ": cannot be opened for the log: ", error.what(),
                                   "; check the directory and its permissions"));
  }
  auto logger = std::make_shared<spdlog::logger>("weir", sink);
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc);
  logger->set_level(spdlog::level::from_str(service.log_level));
  logger->flush_on(spdlog::level::trace);  // a line that is not there after a crash is no log
  // A full disk under the log must not end in a message for each event.
  logger->set_error_handler([](const std::string&) {});
  return logger;
}

}  // namespace

std::string event_text(std::string_view name, std::initializer_list<Field> fields) {
  std::string text(name);
  for (const Field& field : fields) text += cat(' ', field.key, '=', logfmt(field.value));
  return text;
}

EventLog::EventLog(const ServiceConfig& service) : logger_(open_log(service)) {}

void EventLog::reopen(const ServiceConfig& service) { logger_ = open_log(service); }

void EventLog::write(int level, std::string_view name, std::initializer_list<Field> fields) const {
  const auto of_spdlog = static_cast<spdlog::level::level_enum>(level);
  if (logger_->should_log(of_spdlog)) logger_->log(of_spdlog, event_text(name, fields));
}

void EventLog::debug(std::string_view name, std::initializer_list<Field> fields) const {
  write(spdlog::level::debug, name, fields);
}
void EventLog::info(std::string_view name, std::initializer_list<Field> fields) const {
  write(spdlog::level::info, name, fields);
}
void EventLog::warn(std::string_view name, std::initializer_list<Field> fields) const {
  write(spdlog::level::warn, name, fields);
}
void EventLog::error(std::string_view name, std::initializer_list<Field> fields) const {
  write(spdlog::level::err, name, fields);
}

}  // namespace weir
