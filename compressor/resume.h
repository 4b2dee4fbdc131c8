// Which conversions can be continued, and what is said about it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "compressor/conversion_control.h"
#include "compressor/conversion_options.h"
#include "compressor/resume/journal.h"
#include "format/base/error.h"
#include "format/io/file_system.h"
#include "format/output/output_files.h"

namespace weir {

/// The journal of a conversion, with what an interrupted one left in it. Null where `options` or the volume's size say
/// that an interruption is to lose everything; then what was left goes too, with a notice. Throws Error(usage) for
/// Resume::on where the output's file system keeps nothing.
std::unique_ptr<Journal> open_journal(const SourceInfo& info, const ConversionOptions& options,
                                      const ConversionControl& control, const OutputFiles& output, FileSystem& files);

/// Removes what a conversion of `output` that was killed after it was done has left beside it, under the lock on it.
/// False where there is nothing. Throws Error(io) where another process has the lock.
bool clear_leftovers(FileSystem& files, const std::string& output);

/// What a conversion left of itself that was killed when its output was in place already. Takes the lock for it;
/// another process that holds it is Error(io).
void clear_after_commit(FileSystem& files, const std::string& output);

/// "OUT.nvdb: continues a conversion that was interrupted, survey 100 %, encode 37 % done".
std::string continued_notice(const std::string& output, const Checkpoint& state, std::int64_t leaves);

/// Saves what is done after `error`, or discards it where the same conversion would end the same way. Returns the error
/// to report.
Error ended_with(const Error& error, Journal& journal);

}  // namespace weir
