#include "daemon/log/event_log.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "format/base/error.h"
#include "format/base/printable.h"

namespace weir {
namespace {

std::string logfmt(std::string_view value) {
  std::string text = "\"";
  bool is_word = !value.empty();  // the value needs no quotes
  for (std::string_view rest = value; !rest.empty();) {
    const std::size_t plain = plain_bytes(rest);
    const char c = rest.front();
    is_word = is_word && plain != 0 && c != ' ' && c != '"' && c != '=';
    if (c == '"' || c == '\\') {
      text += cat('\\', c);
    } else if (c == '\n') {
      text += "\\n";
    } else if (plain == 0) {
      text += cat("\\x", hex(static_cast<unsigned char>(c), 2));
    } else {
      text += rest.substr(0, plain);
    }
    rest.remove_prefix(std::max<std::size_t>(plain, 1));
  }
  return is_word ? std::string(value) : text + '"';
}

// Sets the layout of a line; `before` is put in front of it.
void set_line(spdlog::logger& logger, const std::string& before) {
  logger.set_pattern(before + "%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc);
}

// Opens the log. The logger writes the reason of a failed line to `fault`.
std::shared_ptr<spdlog::logger> open_log(const ServiceConfig& service, std::shared_ptr<std::string> fault) {
  spdlog::sink_ptr sink;
  try {
    if (service.log_file.empty()) {
      sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    } else if (service.log_size == 0) {
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
  set_line(*logger, "");
  logger->set_level(spdlog::level::from_str(service.log_level));
  logger->flush_on(spdlog::level::trace);  // every line is flushed, so that a crash loses none
  logger->set_error_handler([fault = std::move(fault)](const std::string& text) { *fault = text; });
  return logger;
}

// Returns whether the file ends within a line, for example because the disk had no room for its rest. False for a
// file that is empty or cannot be read.
bool ends_within_line(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char last = '\n';
  return file.seekg(-1, std::ios::end) && file.get(last) && last != '\n';
}

}  // namespace

std::string event_text(std::string_view name, std::initializer_list<Field> fields) {
  std::string text(name);
  for (const Field& field : fields) text += cat(' ', field.key, '=', logfmt(field.value));
  return text;
}

EventLog::EventLog(const ServiceConfig& service) : file_(service.log_file), logger_(open_log(service, fault_)) {}

void EventLog::reopen(const ServiceConfig& service) {
  logger_ = open_log(service, fault_);
  file_ = service.log_file;
}

void EventLog::write(int level, std::string_view name, std::initializer_list<Field> fields) const {
  if (!logger_->should_log(static_cast<spdlog::level::level_enum>(level))) return;
  const bool lost_before = unsaid_ > 0;
  if (lost_before && say_lost(level)) unsaid_ = 0;
  if (unsaid_ == 0 && try_write(level, event_text(name, fields))) return;
  ++lost_;
  ++unsaid_;
  if (lost_before) return;
  const std::string notice = cat("weir: the log cannot be written: ", *fault_, "; events are lost until it can\n");
  std::fputs(notice.c_str(), stderr);
}

bool EventLog::try_write(int level, const std::string& line) const {
  fault_->clear();
  logger_->log(static_cast<spdlog::level::level_enum>(level), line);
  return fault_->empty();
}

bool EventLog::say_lost(int level) const {
  if (ends_within_line(file_)) set_line(*logger_, "\n");
  const bool written =
      try_write(std::max<int>(level, spdlog::level::warn), event_text("log-lost", {{"lines", unsaid_}}));
  set_line(*logger_, "");
  return written;
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
