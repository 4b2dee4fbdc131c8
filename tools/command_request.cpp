#include "tools/command_request.h"

#include <spdlog/spdlog.h>

#include "tools/command.h"

namespace weir {

void log_notice(const Message& line) {
  spdlog::log(line.is_remark() ? spdlog::level::info : spdlog::level::warn, "{}", line.text());
}

ConversionRequest command_request(const GivenOptions& given) {
  ConversionRequest request = read_conversion_request(given);
  request.source.cancel = &interrupt_flag();
  request.source.notice = log_notice;
  return request;
}

}  // namespace weir
