// What a command is asked to read and to convert, while signals may end it.
#pragma once

#include "compressor/options/conversion_request.h"
#include "format/base/message.h"

namespace weir {

/// `line` in the log: a remark as information, any other as a warning.
void log_notice(const Message& line);

/// read_conversion_request(), with a source that gives up unpacking where interrupt_flag() is set, and logs what only
/// reading shows.
ConversionRequest command_request(const GivenOptions& given);

}  // namespace weir
