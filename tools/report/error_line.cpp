#include "tools/report/error_line.h"

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <ctime>
#include <memory>
#include <utility>

#include "format/base/printable.h"

namespace weir {
namespace {

class OneLine : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string line = one_line(std::string(message.payload.data(), message.payload.size()));
    out.append(line.data(), line.data() + line.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<OneLine>(); }
};

}  // namespace

void print_error_line(const std::string& message, const std::string& program) {
  std::fprintf(stderr, "%s: %s\n", program.c_str(), one_line(message).c_str());
}

void log_in_lines(const std::string& program) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt(program));
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<OneLine>('*').set_pattern("%H:%M:%S %l %*");
  spdlog::set_formatter(std::move(formatter));
}

}  // namespace weir
