// The conversion request of a command that signals may interrupt.
#pragma once

#include "compressor/options/conversion_request.h"
#include "format/base/message.h"

namespace weir {

/// Logs `line`: a remark as information, any other line as a warning.
void log_notice(const Message& line);

/// Returns read_conversion_request(given). Its source stops unpacking when interrupt_flag() is set, and logs notices
/// that only reading reveals.
ConversionRequest command_request(const GivenOptions& given);

}  // namespace weir
